//! The compute kernels: their shaders, entry points and bindings.

use crate::shader::LANES;

pub use crate::shader::Shader;

toile_base::named! {
    /// A kernel, in the order in which a step first runs it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum Kernel {
        /// Non-finite or unreachable particles go back to their last good positions.
        Repair,
        /// Moves garments whose root has jumped.
        Teleport,
        /// Finds the capsules and planes that each particle may touch in the step (broad phase).
        ContactCandidates,
        /// Wind force on each triangle.
        Wind,
        /// Acceleration that compensates part of the root's motion.
        RootCompensation,
        /// Sums the wind forces of the triangles around each particle.
        WindForces,
        /// Combines the velocity changes of the stages of stiff bending, before each stage and after the last.
        StageCombine,
        /// Bending forces of a stage.
        StageBending,
        /// Bending forces.
        Bending,
        /// Gravity, air and wind; skinned particles move on.
        Predict,
        /// Fibers along the bias.
        Diagonals,
        /// Links along the bias that lie in no fiber.
        Shear,
        /// Links along the weft.
        Weft,
        /// Fibers by index list: hoops and crossing fibers.
        Lists,
        /// Fibers along the warp.
        Fibers,
        /// Long warp fibers, by cyclic reduction.
        Cyclic,
        /// Tethers, which limit distances from where the garment is held.
        Tethers,
        /// Contact with capsules and planes, with friction.
        Contact,
        /// New velocities from what the substep moved, and damping.
        Settle,
        /// Checks that all values are finite and within reach.
        Guard,
        /// Updates the last good positions, or rolls back to them.
        Publish,
        /// Counts the roll-backs of each garment.
        UpdateReports,
        /// Area normals of the triangles, for garments that are drawn.
        Faces,
        /// Unit normals of the particles, likewise.
        Normals,
    }
}

const COMMON: &str = include_str!("../shaders/common.wgsl");

/// The report that several kernels write: its struct and its binding, 0 of group 1.
const REPORT: &str = include_str!("../shaders/report.wgsl");

macro_rules! shader {
    ($name:literal, $reads:expr $(, $shared:ident)?) => {
        Shader {
            name: $name,
            texts: &[LANES, COMMON, $($shared,)? include_str!(concat!("../shaders/", $name, ".wgsl"))],
            reads: &$reads,
        }
    };
}

/// All shaders, by name and variants.
pub const SHADERS: [Shader; 18] = [
    shader!("repair", [false, true], REPORT),
    shader!("teleport", [false, true]),
    shader!("wind", [true, false, true, true, false]),
    shader!("root_compensation", [false]),
    shader!("stage_combine", [true, true]),
    shader!("bending", [true, true, true]),
    shader!("predict", [true, true, true]),
    shader!("diagonals", [true, true, true, false, false]),
    shader!("links", [true, true, false]),
    shader!("lists", [true, true, true, false]),
    shader!("fibers", [true, true, true, false, false]),
    shader!("tethers", [true]),
    shader!("contact", [true, true, true, true, false]),
    shader!("settle", [false], REPORT),
    shader!("guard", [false], REPORT),
    shader!("publish", [false, false, true], REPORT),
    shader!("faces", [true, true, false]),
    shader!("normals", [true, true, true, false]),
];

impl Kernel {
    /// Whether it runs stage by stage in a substep.
    pub fn in_stages(self) -> bool {
        matches!(self, Self::StageCombine | Self::StageBending)
    }

    /// Index of the kernel in [`Kernel::ALL`].
    pub fn number(self) -> usize {
        self as usize
    }

    /// Which of `toile_engine::cloth::step::program::METERED_STAGES` it counts towards.
    pub fn stage(self) -> usize {
        match self {
            Self::Repair | Self::Teleport | Self::RootCompensation | Self::Predict => 0,
            Self::Guard | Self::Publish | Self::UpdateReports => 0,
            Self::StageCombine | Self::StageBending | Self::Bending => 1,
            // What is drawn goes with what is published.
            Self::Faces | Self::Normals => 0,
            Self::Diagonals | Self::Shear => 2,
            Self::Weft => 3,
            Self::Lists | Self::Fibers | Self::Cyclic => 4,
            Self::ContactCandidates | Self::Contact | Self::Settle => 5,
            Self::Wind | Self::WindForces => 6,
            Self::Tethers => 7,
        }
    }

    /// Its shader among [`SHADERS`], and its entry point there.
    pub fn entry(self) -> (usize, &'static str) {
        let name = match self {
            Self::Repair => "repair",
            Self::Teleport => "teleport",
            Self::Wind | Self::WindForces => "wind",
            Self::RootCompensation => "root_compensation",
            Self::StageCombine => "stage_combine",
            Self::Bending | Self::StageBending => "bending",
            Self::Predict => "predict",
            Self::Diagonals => "diagonals",
            Self::Shear | Self::Weft => "links",
            Self::Lists => "lists",
            Self::Fibers | Self::Cyclic => "fibers",
            Self::Tethers => "tethers",
            Self::ContactCandidates | Self::Contact => "contact",
            Self::Settle => "settle",
            Self::Guard => "guard",
            Self::Publish | Self::UpdateReports => "publish",
            Self::Faces => "faces",
            Self::Normals => "normals",
        };
        let shader = SHADERS.iter().position(|s| s.name == name).unwrap_or(0);
        let entry = match self {
            Self::ContactCandidates => "contact_candidates",
            Self::WindForces => "wind_forces",
            Self::StageBending => "stage_bending",
            Self::Cyclic => "cyclic",
            Self::UpdateReports => "update_reports",
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
        let most = format!("const MOST_STAGES = {}u;", toile_engine::cloth::forces::stiff_bending::MAX_BENDING_STAGES);
        let air = 0.25 * toile_engine::cloth::forces::wind::AIR_DENSITY;
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
