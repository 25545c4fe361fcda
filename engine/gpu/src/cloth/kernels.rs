//! Kernels: the shaders, and what each is bound to.

use crate::shader::LANES;

pub use crate::shader::Shader;

/// A kernel, in the order in which a step first runs it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// Particles that are none go back.
    Repair,
    /// The root has been put somewhere else.
    Jump,
    /// Which capsules and planes each particle may touch in the step.
    Near,
    /// What presses each triangle in the wind.
    Wind,
    /// What of the root's motion is not to be felt.
    Carry,
    /// What the wind does to each particle.
    Blown,
    /// What comes before a stage of stiff bending, or behind the last.
    Turn,
    /// Curvatures of a stage.
    Stage,
    /// What they do to each particle.
    Staged,
    /// Curvatures.
    Bending,
    /// What they do to each particle.
    Bent,
    /// Gravity, air and wind; skinned particles move on.
    Predict,
    /// Fibers along the bias.
    Diagonals,
    /// Shear links.
    Shear,
    /// Weft links.
    Weft,
    /// Fibers by index list: hoops, and what crosses.
    Lists,
    /// Warp fibers.
    Fibers,
    /// Those that are few and long.
    Cyclic,
    /// Tethers.
    Tethers,
    /// Whatever touches is pushed out.
    Contact,
    /// New velocities.
    Settle,
    /// Whether all is finite.
    Guard,
    /// The last good places.
    Publish,
    /// What the report says of the next step.
    Conclude,
    /// Where somebody draws, the triangles' normals.
    Faces,
    /// And the particles', of one unit.
    Normals,
}

const COMMON: &str = include_str!("../shaders/common.wgsl");

macro_rules! shader {
    ($name:literal, $reads:expr) => {
        Shader {
            name: $name,
            texts: &[LANES, COMMON, include_str!(concat!("../shaders/", $name, ".wgsl"))],
            reads: &$reads,
        }
    };
}

/// All shaders.
pub const SHADERS: [Shader; 19] = [
    shader!("repair", [false, true]),
    shader!("jump", [false, true]),
    shader!("wind", [true, false, true, true, false]),
    shader!("carry", [false]),
    shader!("turn", [true, true]),
    shader!("bending", [true, true, true, false, true]),
    shader!("bent", [true, true, true, true, true]),
    shader!("predict", [true, true, true]),
    shader!("diagonals", [true, true, true, false, false]),
    shader!("links", [true, true, false]),
    shader!("lists", [true, true, true, false]),
    shader!("fibers", [true, true, true, false, false]),
    shader!("tethers", [true]),
    shader!("contact", [true, true, true, true, false]),
    shader!("settle", [false]),
    shader!("guard", [false]),
    shader!("publish", [false, false, true]),
    shader!("faces", [true, true, false]),
    shader!("normals", [true, true, true, false]),
];

impl Kernel {
    /// All kernels.
    pub const ALL: [Self; 26] = [
        Self::Repair,
        Self::Jump,
        Self::Near,
        Self::Wind,
        Self::Carry,
        Self::Blown,
        Self::Turn,
        Self::Stage,
        Self::Staged,
        Self::Bending,
        Self::Bent,
        Self::Predict,
        Self::Diagonals,
        Self::Shear,
        Self::Weft,
        Self::Lists,
        Self::Fibers,
        Self::Cyclic,
        Self::Tethers,
        Self::Contact,
        Self::Settle,
        Self::Guard,
        Self::Publish,
        Self::Conclude,
        Self::Faces,
        Self::Normals,
    ];

    /// Whether it runs stage by stage in a substep.
    pub fn in_stages(self) -> bool {
        matches!(self, Self::Turn | Self::Stage | Self::Staged)
    }

    /// Its number among [`Kernel::ALL`].
    pub fn number(self) -> usize {
        self as usize
    }

    /// Which of `toile_engine::cloth::program::STAGES` it counts towards.
    pub fn stage(self) -> usize {
        match self {
            Self::Repair | Self::Jump | Self::Carry | Self::Predict => 0,
            Self::Guard | Self::Publish | Self::Conclude => 0,
            Self::Turn | Self::Stage | Self::Staged | Self::Bending | Self::Bent => 1,
            // What is drawn goes with what is published.
            Self::Faces | Self::Normals => 0,
            Self::Diagonals | Self::Shear => 2,
            Self::Weft => 3,
            Self::Lists | Self::Fibers | Self::Cyclic => 4,
            Self::Near | Self::Contact | Self::Settle => 5,
            Self::Wind | Self::Blown => 6,
            Self::Tethers => 7,
        }
    }

    /// Its shader among [`SHADERS`], and its entry point there.
    pub fn entry(self) -> (usize, &'static str) {
        let name = match self {
            Self::Repair => "repair",
            Self::Jump => "jump",
            Self::Wind | Self::Blown => "wind",
            Self::Carry => "carry",
            Self::Turn => "turn",
            Self::Bending | Self::Stage => "bending",
            Self::Bent | Self::Staged => "bent",
            Self::Predict => "predict",
            Self::Diagonals => "diagonals",
            Self::Shear | Self::Weft => "links",
            Self::Lists => "lists",
            Self::Fibers | Self::Cyclic => "fibers",
            Self::Tethers => "tethers",
            Self::Near | Self::Contact => "contact",
            Self::Settle => "settle",
            Self::Guard => "guard",
            Self::Publish | Self::Conclude => "publish",
            Self::Faces => "faces",
            Self::Normals => "normals",
        };
        let shader = SHADERS.iter().position(|s| s.name == name).unwrap_or(0);
        let entry = match self {
            Self::Near => "near",
            Self::Blown => "blown",
            Self::Stage => "stage",
            Self::Staged => "staged",
            Self::Cyclic => "cyclic",
            Self::Conclude => "conclude",
            _ => name,
        };
        (shader, entry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::valid;

    #[test]
    fn every_shader_is_valid_without_any_capability_and_bound_as_it_is_said_to_be() {
        SHADERS.iter().for_each(|shader| valid(shader, 1));
    }

    #[test]
    fn shaders_have_the_engines_limits() {
        let most = format!("const MOST_STAGES = {}u;", toile_engine::cloth::stages::MOST);
        let air = 0.25 * toile_engine::cloth::wind::AIR_DENSITY;
        assert!(COMMON.contains(&most));
        assert!(SHADERS.iter().any(|s| s.source().contains(&format!("const AIR = {air};"))));
    }

    #[test]
    fn every_kernel_has_its_number_and_its_entry_point() {
        for (number, kernel) in Kernel::ALL.into_iter().enumerate() {
            let (shader, entry) = kernel.entry();
            assert_eq!(kernel.number(), number);
            assert!(SHADERS[shader].source().contains(&format!("fn {entry}(")), "{kernel:?}");
        }
    }
}
