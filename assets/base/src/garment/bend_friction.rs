//! Friction in bending as it lies in memory: which stencils rub, and how much moment each can keep.

/// One stencil that rubs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionSlot {
    /// The particle in its middle.
    pub centre: u32,
    /// Which of the stencils around that particle it is: 0 along the warp, 1 along the weft, 2 and 3 along the bias.
    pub kind: u32,
    /// Particles whose differences, the first less the second and the third less the fourth, have the cloth's normal as their
    /// product.
    pub chords: [u32; 4],
    /// Most that friction can keep of the sum (sqrt(N/m) m): half of the loop's width over the rigidity, times the root of the
    /// stencil's stiffness.
    pub limit: f32,
    /// Where its other particles begin in [`BendFriction::particles`].
    pub first: u32,
    /// Number of these.
    pub len: u32,
}

/// All stencils of a garment that rub, by kind and then in the order of memory; none where the fabric has no numbers for
/// it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BendFriction {
    /// One slot for each stencil that rubs.
    pub slots: Box<[FrictionSlot]>,
    /// Particles besides the one in the middle, slot after slot.
    pub particles: Box<[u32]>,
    /// Their coefficients, the root of the stiffness within (sqrt(N/m)); the middle's is what they lack to 0.
    pub coefficients: Box<[f32]>,
}

impl BendFriction {
    /// Kinds that a garment has, all numbers below.
    pub fn kinds(&self) -> u32 {
        self.slots.iter().map(|s| s.kind + 1).max().unwrap_or(0)
    }

    /// The other particles of a slot with their coefficients.
    pub fn entries(&self, slot: &FrictionSlot) -> impl Iterator<Item = (u32, f32)> + Clone {
        let range = slot.first as usize..(slot.first + slot.len) as usize;
        self.particles[range.clone()].iter().copied().zip(self.coefficients[range].iter().copied())
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.slots) + 8 * self.particles.len()
    }
}
