//! Tucking: the part of a garment that is worn inside of another one, although its layer lies outside.

/// Particles up to this far above the waistband belong inside as well (m), two rows or three: above it they meet nothing, and when
/// they slip below it they are where they belong.
pub const SLIPS_M: f32 = 0.04;

/// What of a garment is tucked into which other.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuck {
    /// Place in the outfit of the garment that it is tucked into.
    pub into: usize,
    /// Height of its waistband where both start (m).
    pub band: f32,
    /// Whether each particle belongs inside of that one `[particles]`.
    pub particles: Box<[bool]>,
}

impl Tuck {
    /// Whether a face belongs inside: where any of its corners does.
    pub fn holds(&self, corners: [u32; 3]) -> bool {
        corners.iter().any(|&v| self.particles[v as usize])
    }
}
