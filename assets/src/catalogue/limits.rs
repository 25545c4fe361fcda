//! What a catalogue may hold: bounds of time and memory for files that anybody may have made.

/// Most bytes of a package: a garment with a dozen photographs.
pub const MAX_PACKAGE_BYTES: u64 = 32 << 20;

/// Most files of a package.
pub const MAX_FILES: usize = 64;

/// Most bytes of all files of a package, unpacked: a file that unpacks to more is no garment.
pub const MAX_UNPACKED_BYTES: u64 = 128 << 20;

/// Most pixels along a side of a photograph or texture.
pub const MAX_PIXELS: usize = 8_192;

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
