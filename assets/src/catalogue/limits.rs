//! Limits of a catalogue: bounds of time and memory for files from unknown authors.

/// Most bytes of a package: a garment with a dozen photographs.
pub const MAX_PACKAGE_BYTES: u64 = 32 << 20;

/// Most files of a package.
pub const MAX_FILES: usize = 64;

/// Most bytes of all files of a package, unpacked: a file that unpacks to more is no garment.
pub const MAX_UNPACKED_BYTES: u64 = 128 << 20;

/// Most pixels along a side of a photograph or texture.
pub const MAX_PIXELS: usize = 8_192;

/// Most pixels of a photograph: those of a camera of 24 megapixels.
pub const MAX_PICTURE_PIXELS: u64 = 24 << 20;

/// Most bytes that reading one photograph or logo may take for a moment: four a pixel, and what the decoder needs.
pub const MAX_DECODED_BYTES: u64 = 5 * MAX_PICTURE_PIXELS;

/// Most bytes of a shop's logo.
pub const MAX_LOGO_BYTES: u64 = 2 << 20;

/// Most pixels along a side of a logo's file.
pub const MAX_LOGO_SIDE: usize = 2_048;

/// Pixels along the longer side at which a logo is kept: what a large display shows of it.
pub const LOGO_SIDE: u32 = 512;

/// Most bytes of a shop's font: one with a few thousand characters.
pub const MAX_FONT_BYTES: u64 = 8 << 20;

/// Least contrast between text and ground (WCAG 2.2, success criterion 1.4.3).
pub const MIN_CONTRAST: f32 = 4.5;

/// Most packages of a catalogue.
pub const MAX_GARMENTS: usize = 2_000;

/// Most colours of a garment: what a page can show.
pub const MAX_COLOURS: usize = 8;

/// Most characters of an article number.
pub const MAX_ARTICLE: usize = 40;

/// Most characters of a name in one language.
pub const MAX_NAME: usize = 80;

/// Most bytes of a manifest or of `catalogue.toml`.
pub const MAX_TOML_BYTES: u64 = 256 << 10;
