//! Tucking: the part of a garment that is worn inside of another one, although its layer lies outside.

/// What of a garment is tucked into which other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tuck {
    /// Place in the outfit of the garment that it is tucked into.
    pub into: usize,
    /// Whether each particle belongs inside of that one `[particles]`.
    pub particles: Box<[bool]>,
}

impl Tuck {
    /// Whether a face belongs inside: where any of its corners does.
    pub fn holds(&self, corners: [u32; 3]) -> bool {
        corners.iter().any(|&v| self.particles[v as usize])
    }
}
