//! Kernels: the shaders, and what each is bound to.

use crate::shader::LANES;

pub use crate::shader::Shader;

/// A kernel, in the order in which a step first runs it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// The root has been put somewhere else.
    Jump,
    /// Which capsules and planes each particle may touch in the step.
    Near,
    /// Curvatures.
    Bending,
    /// What they do to each particle.
    Bent,
    /// Gravity and air; skinned particles move on.
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
pub const SHADERS: [Shader; 13] = [
    shader!("jump", [false, true]),
    shader!("bending", [true, true, true, false]),
    shader!("bent", [true, true, true, true, true]),
    shader!("predict", [true, true]),
    shader!("diagonals", [true, true, true, false, false]),
    shader!("links", [true, true, false]),
    shader!("lists", [true, true, true, false]),
    shader!("fibers", [true, true, true, false, false]),
    shader!("tethers", [true]),
    shader!("contact", [true, true, true, true, false]),
    shader!("settle", [false]),
    shader!("guard", [false]),
    shader!("publish", [false, false, true]),
];

impl Kernel {
    /// All kernels.
    pub const ALL: [Self; 16] = [
        Self::Jump,
        Self::Near,
        Self::Bending,
        Self::Bent,
        Self::Predict,
        Self::Diagonals,
        Self::Shear,
        Self::Weft,
        Self::Lists,
        Self::Fibers,
        Self::Tethers,
        Self::Contact,
        Self::Settle,
        Self::Guard,
        Self::Publish,
        Self::Conclude,
    ];

    /// Its number among [`Kernel::ALL`].
    pub fn number(self) -> usize {
        self as usize
    }

    /// Its shader among [`SHADERS`], and its entry point there.
    pub fn entry(self) -> (usize, &'static str) {
        let name = match self {
            Self::Jump => "jump",
            Self::Bending => "bending",
            Self::Bent => "bent",
            Self::Predict => "predict",
            Self::Diagonals => "diagonals",
            Self::Shear | Self::Weft => "links",
            Self::Lists => "lists",
            Self::Fibers => "fibers",
            Self::Tethers => "tethers",
            Self::Near | Self::Contact => "contact",
            Self::Settle => "settle",
            Self::Guard => "guard",
            Self::Publish | Self::Conclude => "publish",
        };
        let shader = SHADERS.iter().position(|s| s.name == name).unwrap_or(0);
        let entry = match self {
            Self::Near => "near",
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
    fn every_kernel_has_its_number_and_its_entry_point() {
        for (number, kernel) in Kernel::ALL.into_iter().enumerate() {
            let (shader, entry) = kernel.entry();
            assert_eq!(kernel.number(), number);
            assert!(SHADERS[shader].source().contains(&format!("fn {entry}(")), "{kernel:?}");
        }
    }
}
