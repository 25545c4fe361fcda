//! The directions of a cloth: what baking sorts fibers by and the garment keeps with each set.

/// Which way a fiber runs through the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Direction {
    /// Along the loom's threads under tension: down the garment.
    Warp,
    /// Across: around the garment.
    Weft,
    /// Diagonal: resists shear.
    Bias,
}
