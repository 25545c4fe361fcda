//! Upper limits of a pattern, each with its unit and its reason.

/// Panels of one pattern: a tailored coat with its lining has some sixty.
pub const MAX_PANELS: usize = 128;

/// Edges of one panel's outline. A curve digitised every 2 mm around the largest panel has fewer.
pub const MAX_PANEL_EDGES: usize = 1_024;

/// Edges of all panels. Looking for crossings takes milliseconds for so many, whatever their order.
pub const MAX_EDGES: usize = 8_192;

/// Seams of one pattern: every edge could be sewn, two a seam.
pub const MAX_SEAMS: usize = MAX_EDGES / 2;

/// Farthest from its origin that a panel reaches (m): a bridal train has 5 m. Beyond it, the file is in another unit.
pub const MAX_REACH_M: f64 = 20.0;

/// Shortest edge (m): a tenth of a millimetre, less than what cutting can follow.
pub const LEAST_EDGE_M: f64 = 1e-4;

/// Least area of a panel (m2): a square centimetre, less than any button tab.
pub const LEAST_PANEL_M2: f64 = 1e-4;

/// Largest file of a pattern or of its seams that is read (bytes): a hundred times the largest of our examples.
pub const MAX_PATTERN_BYTES: u64 = 4 << 20;

/// Points and marks of a digitised pattern: a piece digitised every millimetre around has some thousand.
pub const MAX_POINTS: usize = 32_768;
