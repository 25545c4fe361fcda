//! The reason why a shopper's own picture has no clothes on it: as a number between the renderer and the service, and as a word on the page.

use toile_view::own_picture::Plain;

use super::texts::TextKey;

/// All reasons, in the order of their numbers from 2 on; 0 is that nothing was drawn yet, 1 that the clothes are on it.
const REASONS: [Plain; 6] =
    [Plain::NoPicture, Plain::UnknownCamera, Plain::Nobody, Plain::OutOfPicture, Plain::Unsure, Plain::Changing];

/// The number of an outcome.
pub fn code(plain: Option<Plain>) -> u8 {
    let place = plain.and_then(|plain| REASONS.iter().position(|reason| *reason == plain));
    place.map_or(1, |place| place as u8 + 2)
}

/// What an outcome says; nothing where the clothes are on the picture.
pub(super) fn word(code: u8) -> Option<TextKey> {
    if code == 0 {
        return Some(TextKey::OwnPictureSoon);
    }
    match REASONS.get(usize::from(code).checked_sub(2)?)? {
        Plain::NoPicture | Plain::Changing => Some(TextKey::OwnPictureSoon),
        Plain::UnknownCamera => Some(TextKey::OwnPictureCannot),
        Plain::Nobody => Some(TextKey::OwnPictureNobody),
        Plain::OutOfPicture => Some(TextKey::OwnPictureBack),
        Plain::Unsure => Some(TextKey::OwnPictureStill),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reason_has_a_number_and_a_word_and_clothes_have_none() {
        assert_eq!((word(code(None)), word(200)), (None, None));
        assert_eq!(word(0), Some(TextKey::OwnPictureSoon));
        let words: Vec<_> = REASONS.iter().map(|reason| word(code(Some(*reason)))).collect();
        assert!(words.iter().all(Option::is_some));
        assert_eq!(code(Some(Plain::Changing)), 7);
    }
}
