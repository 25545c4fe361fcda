//! The cases, each by the options of `toile bench skirt` that ask for it.

/// One case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TurnCase {
    /// What it is called.
    pub name: String,
    /// Options of `toile bench skirt`.
    pub options: Vec<String>,
}

/// Names and options of the cases that are run where none is asked for.
pub const CASES: [(&str, &[&str]); 16] = [
    ("grid", &[]),
    ("grid, 8 lanes", &["--lanes", "8"]),
    ("grid, 4 lanes", &["--lanes", "4"]),
    ("grid, wind", &["--wind"]),
    ("grid, fast", &["--motion", "fast"]),
    ("grid, 2,000 N/m", &["--stretch", "physical"]),
    ("grid, settled", &["--motion", "settled"]),
    ("grid of 1,024", &["--verts", "1024"]),
    ("grid of 16,384", &["--verts", "16384"]),
    ("the same, two threads", &["--verts", "16384", "--threads", "2"]),
    ("irregular", &["--mesh", "irregular"]),
    ("strap dress", &["--garment", "strap-dress"]),
    ("wide-leg trousers", &["--garment", "wide-leg-trousers"]),
    ("tee", &["--garment", "tee"]),
    ("tee, trousers", &["--garment", "tee", "--garment", "wide-leg-trousers"]),
    ("the same, two threads", &["--garment", "tee", "--garment", "wide-leg-trousers", "--threads", "2"]),
];

impl TurnCase {
    /// All of [`CASES`].
    pub fn all() -> Vec<Self> {
        let owned = |options: &[&str]| options.iter().map(|&o| o.to_owned()).collect();
        CASES.iter().map(|(name, options)| Self { name: (*name).to_owned(), options: owned(options) }).collect()
    }
}
