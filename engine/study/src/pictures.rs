//! Pictures of typical people in their sizes, as data within a page.

use std::fmt::Write;

use toile_view::drawn_frame::{self, DrawnFrame};
use toile_view::figure::Appearance;
use toile_view::image::Size;

use crate::error::{Result, StudyError};
use crate::study::Study;

/// Size of each (px).
const SIZE: Size = Size::new(150, 300);

/// A picture of a person in a garment's size, from the front, as a `data:` address.
///
/// # Errors
/// A garment that cannot be laid on them.
pub fn picture(study: &Study, person: u64, garment: &str, size: &str) -> Result<String> {
    let place = study.garments().iter().position(|g| g.name == garment);
    let place = place.ok_or_else(|| StudyError::Internal(format!("the study has no garment {garment}")))?;
    let mut worn = study.worn_by(person, place, size)?;
    let (frame, snapshot) = worn.shown();
    let image = drawn_frame::still(DrawnFrame::new(frame, Appearance::default()), snapshot, 0.0, SIZE);
    let mut png = Vec::new();
    image.write_png(&mut png).map_err(StudyError::internal)?;
    Ok(format!("data:image/png;base64,{}", base64(&png)))
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for i in 0..4 {
            let sign = SIGNS[(bits >> (18 - 6 * i) & 63) as usize] as char;
            _ = write!(text, "{}", if i > three.len() { '=' } else { sign });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standard_s_examples_are_met() {
        for (plain, text) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(plain.as_bytes()), text);
        }
    }
}
