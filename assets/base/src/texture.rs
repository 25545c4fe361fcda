//! Pictures that lie on a surface, as texels.

/// A picture that repeats in both directions, or lies once on a mesh. Its sides are powers of two, so that each level of
/// detail halves them.
#[derive(Clone, PartialEq, Eq)]
pub struct Texture {
    /// Texels along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue in sRGB, and how much of the surface's own colour they cover (0 nothing, 255 all), rows from the
    /// top `[width x height]`.
    pub texels: Vec<[u8; 4]>,
}

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Texture({} x {})", self.width, self.height)
    }
}

impl Texture {
    /// A picture of one colour, sRGB.
    pub fn plain(colour: [u8; 3]) -> Self {
        let [r, g, b] = colour;
        Self { width: 1, height: 1, texels: vec![[r, g, b, 255]] }
    }

    /// Size of the texels (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.texels)
    }
}
