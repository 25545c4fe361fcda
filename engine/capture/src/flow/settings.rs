//! Settings of a capture, and switches for its parts.

/// What the next frame's pictures are compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reference {
    /// The frame before, as in the source: errors add up.
    Previous,
    /// The first frame in which a triangle was seen by a camera.
    First,
}

/// How edges resist being stretched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Springs {
    /// Not at all.
    Off,
    /// Force proportional to the strain.
    Linear,
    /// Force proportional to the strain's cube: soft below the threshold, stiff above it (equation 5.16).
    Cubic,
}

/// Settings of a capture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowSettings {
    /// What pictures are compared with.
    pub reference: Reference,
    /// How edges resist.
    pub springs: Springs,
    /// Strain at which a linear spring counts as one standard deviation.
    pub strain: f64,
    /// Strain T at which cubic and linear springs pull alike.
    pub threshold: f64,
    /// Standard deviation of a vertex about where its motion would carry it (m).
    pub inertia: f64,
    /// Standard deviation of a fold's change from one frame to the next (m).
    pub folding: f64,
    /// Values a pixel: 1 (luminance) or 3.
    pub channels: usize,
    /// Levels of the pictures, each half the size of the one before.
    pub levels: usize,
    /// Distance of the samples on a triangle (px of the level).
    pub spacing: f64,
    /// Most iterations at each level.
    pub iterations: usize,
    /// Whether hidden triangles are left out by a depth buffer.
    pub occlusion: bool,
    /// Whether each triangle's brightness is adjusted.
    pub brightness: bool,
    /// Fewest cameras by which a triangle is placed.
    pub cameras: usize,
}

impl Default for FlowSettings {
    fn default() -> Self {
        Self {
            reference: Reference::First,
            springs: Springs::Cubic,
            strain: 0.01,
            threshold: 0.02,
            inertia: 5e-3,
            folding: 1e-3,
            channels: 1,
            levels: 4,
            spacing: 1.6,
            iterations: 8,
            occlusion: true,
            brightness: true,
            cameras: 2,
        }
    }
}
