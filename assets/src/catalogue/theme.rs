//! The theme of a shop's screens: its logo, its colours and its font, each checked before it is shown.

use std::fmt::{self, Debug, Formatter};
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;

use super::error::CatalogueError;
use super::font;
use super::limits::{LOGO_SIDE, MAX_FONT_BYTES, MAX_LOGO_BYTES, MAX_LOGO_SIDE, MIN_CONTRAST};
use super::package::is_plain;
use super::picture::{self, Picture};
use crate::export::linear;
use crate::file::{self, FileKind};

/// Limits of a logo file.
const LOGO: FileKind = FileKind { name: "a shop's logo", max_bytes: MAX_LOGO_BYTES, cure: "save it smaller" };

/// Limits of a font file.
const FONT: FileKind =
    FileKind { name: "a shop's font", max_bytes: MAX_FONT_BYTES, cure: "take one with fewer characters" };

/// The screens' part of `catalogue.toml`, as written.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ThemeFile {
    /// The logo's file.
    pub logo: Option<String>,
    /// Colour of the main button, sRGB, 0 .. 1.
    pub accent: Option<[f32; 3]>,
    /// Colour of the ground behind words.
    pub ground: Option<[f32; 3]>,
    /// The words.
    pub text: Option<[f32; 3]>,
    /// The font's file.
    pub font: Option<String>,
}

/// Colours of the screens, sRGB, 0 .. 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThemeColours {
    /// Colour of the main button.
    pub accent: [f32; 3],
    /// Colour of the ground behind words.
    pub ground: [f32; 3],
    /// The words: their contrast with the ground is [`MIN_CONTRAST`] at least.
    pub text: [f32; 3],
}

impl Default for ThemeColours {
    /// Those of a kiosk without a theme.
    fn default() -> Self {
        Self { accent: [0.965, 0.929, 0.871], ground: [0.067, 0.076, 0.090], text: [0.980, 0.973, 0.957] }
    }
}

/// The theme of a shop's screens, read and checked.
#[derive(Clone, PartialEq)]
pub struct ShopTheme {
    /// The logo, as it is shown.
    pub logo: Option<Arc<Picture>>,
    /// Its colours.
    pub colours: ThemeColours,
    /// The bytes of its font, TrueType or OpenType; characters that it lacks are shown in the built-in ones.
    pub font: Option<Arc<[u8]>>,
}

impl Debug for ShopTheme {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let font = self.font.as_ref().map_or(0, |font| font.len());
        write!(f, "ShopTheme({:?}, logo {:?}, font of {font} bytes)", self.colours, self.logo)
    }
}

impl ShopTheme {
    /// Reads what a catalogue's theme names; `file` is the catalogue's own.
    ///
    /// # Errors
    /// Colours that cannot be read on each other, a logo or a font that cannot be used.
    pub(super) fn read(folder: &Path, file: &str, theme: &ThemeFile) -> Result<Self, CatalogueError> {
        let wrong = |file: &str, reason: String| CatalogueError::Content {
            package: folder.display().to_string(),
            file: file.to_owned(),
            reason,
        };
        let colours = colours(theme).map_err(|reason| wrong(file, reason))?;
        let bytes = |name: &str, kind: &FileKind| {
            if !is_plain(name) {
                let shown: String = name.chars().take(80).filter(|c| !c.is_control()).collect();
                let reason = format!("theme: {shown:?} is no plain file name; lay the file beside {file}");
                return Err(wrong(file, reason));
            }
            Ok(file::read(&folder.join(name), kind)?)
        };
        let logo = theme.logo.as_deref().map(|name| {
            let bytes = bytes(name, &LOGO)?;
            logo(&bytes).map_err(|reason| wrong(name, reason))
        });
        let font = theme.font.as_deref().map(|name| {
            let bytes = bytes(name, &FONT)?;
            font::check(&bytes).map_err(|reason| wrong(name, reason))?;
            Ok::<_, CatalogueError>(Arc::from(bytes))
        });
        Ok(Self { logo: logo.transpose()?.map(Arc::new), colours, font: font.transpose()? })
    }

    /// Bytes that it holds.
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + self.logo.as_ref().map_or(0, |logo| logo.bytes())
            + self.font.as_ref().map_or(0, |font| font.len())
    }
}

fn logo(bytes: &[u8]) -> Result<Picture, String> {
    let [width, height] = picture::size(bytes)?;
    if width.max(height) > MAX_LOGO_SIDE {
        return Err(format!(
            "it has {width} x {height} pixels, and a logo has {MAX_LOGO_SIDE} at most; save it smaller"
        ));
    }
    Picture::decode(bytes, LOGO_SIDE)
}

/// The colours of a theme; what it leaves out is as without one.
fn colours(theme: &ThemeFile) -> Result<ThemeColours, String> {
    let usual = ThemeColours::default();
    let colours = ThemeColours {
        accent: theme.accent.unwrap_or(usual.accent),
        ground: theme.ground.unwrap_or(usual.ground),
        text: theme.text.unwrap_or(usual.text),
    };
    for (key, colour) in [("accent", colours.accent), ("ground", colours.ground), ("text", colours.text)] {
        if !colour.iter().all(|c| (0.0..=1.0).contains(c)) {
            return Err(format!("theme.{key} must be three numbers from 0 to 1 (sRGB); correct it"));
        }
    }
    let found = contrast(colours.text, colours.ground);
    if found < MIN_CONTRAST {
        return Err(format!(
            "theme.text on theme.ground has a contrast of {found:.1}:1, and {MIN_CONTRAST}:1 can be read; make one of \
             them lighter or darker"
        ));
    }
    Ok(colours)
}

/// Contrast of two colours (sRGB, 0 .. 1), from 1 to 21 (WCAG 2.2, contrast ratio).
pub fn contrast(a: [f32; 3], b: [f32; 3]) -> f32 {
    let luminance = |c: [f32; 3]| {
        let [r, g, b] = c.map(linear);
        0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05
    };
    let (a, b) = (luminance(a), luminance(b));
    a.max(b) / a.min(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contrast_is_that_of_the_standard() {
        assert!((contrast([0.0; 3], [1.0; 3]) - 21.0).abs() < 1e-3);
        assert!((contrast([0.5; 3], [0.5; 3]) - 1.0).abs() < 1e-6);
        // #767676 on white is the lightest grey that passes.
        let grey = [f32::from(0x76_u8) / 255.0; 3];
        assert!((contrast(grey, [1.0; 3]) - 4.54).abs() < 0.01);
    }

    #[test]
    fn words_that_cannot_be_read_are_refused_and_what_is_left_out_is_as_usual() {
        assert_eq!(colours(&ThemeFile::default()).unwrap(), ThemeColours::default());
        let pale = ThemeFile { ground: Some([1.0; 3]), text: Some([0.6; 3]), ..ThemeFile::default() };
        assert!(colours(&pale).unwrap_err().contains("2.8:1"), "{:?}", colours(&pale));
        // A light ground needs a word on its text.
        assert!(colours(&ThemeFile { ground: Some([1.0; 3]), ..ThemeFile::default() }).is_err());
        let beyond = ThemeFile { accent: Some([0.2, 0.4, 120.0]), ..ThemeFile::default() };
        assert!(colours(&beyond).unwrap_err().contains("theme.accent"));
        let none = ThemeFile { accent: Some([f32::NAN; 3]), ..ThemeFile::default() };
        assert!(colours(&none).is_err());
    }
}
