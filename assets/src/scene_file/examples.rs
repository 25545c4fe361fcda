//! Scenes inside the program: `toile run --example NAME`. Their files are `assets/data/scenes`, to be copied and changed.

macro_rules! files {
    ($($name:literal),+ $(,)?) => {
        /// Every file of the examples: name and content.
        pub const FILES: &[(&str, &str)] = &[$(($name, include_str!(concat!("../../data/scenes/", $name)))),+];
    };
}

files!(
    "bench-skirt.toml",
    "cloth-on-sphere.csv",
    "cloth-on-sphere.toml",
    "flag-in-wind.toml",
    "hanging-strip.obj",
    "hanging-strip.toml",
    "skirt-on-legs.csv",
    "skirt-on-legs.toml",
    "skirt-waistband.csv",
);

/// The examples' names.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().filter_map(|(name, _)| name.strip_suffix(".toml"))
}

/// The text of an example's scene file.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().find(|(file, _)| file.strip_suffix(".toml") == Some(name)).map(|(_, text)| *text)
}
