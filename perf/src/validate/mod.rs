//! Validation: the engine in its production settings against exact solutions.

pub mod case;
pub mod cases;
pub mod exact;
pub mod layered;
pub mod mesh;
pub mod run;
pub mod specimen;
pub mod turned;

use toile_engine::cloth::Quality;
use toile_gpu::backend::Backends;

/// How a case is run: the engine's settings, and what steps it.
#[derive(Debug, Clone, Copy)]
pub struct CaseSetup<'a> {
    /// Level of quality, which gives the engine's settings.
    pub level: Level,
    /// The processor, or a graphics device.
    pub backends: &'a Backends,
}

/// How the engine is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// As it ships: f32, 120 Hz, a named quality.
    Production(Quality),
    /// The same kernels with so many substeps that more of them change nothing.
    Converged,
}

impl Level {
    /// The one that targets are for.
    pub const GATED: Self = Self::Production(Quality::Fine);

    /// Every level, from coarse to converged.
    pub const ALL: [Self; 4] = [
        Self::Production(Quality::Draft),
        Self::Production(Quality::Shop),
        Self::Production(Quality::Fine),
        Self::Converged,
    ];

    /// Its name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Production(quality) => quality.name(),
            Self::Converged => "converged",
        }
    }
}
