//! The page of the shopper's own face on the mannequin.

use super::super::own_face::FaceTrouble;
use super::super::screen::Block;
use super::super::texts::TextKey;
use super::PageWriter;

/// Why a face was not put on, and what helps.
const fn word(trouble: FaceTrouble) -> TextKey {
    match trouble {
        FaceTrouble::NoPicture => TextKey::FaceNoPicture,
        FaceTrouble::Unseen => TextKey::FaceUnseen,
        FaceTrouble::TooFar => TextKey::FaceFar,
        FaceTrouble::Turned => TextKey::FaceTurned,
        FaceTrouble::Unlike => TextKey::FaceUnlike,
    }
}

impl PageWriter<'_> {
    /// What happens, or how it went; and in any case that nothing is kept.
    pub(super) fn face(&self) -> Vec<Block> {
        let visit = &self.model.visit;
        let mut blocks = Vec::new();
        if visit.face.asked.is_some() {
            blocks.push(Block::Progress { share: 0.3, label: self.words(TextKey::FaceTaking) });
        } else if visit.dressing.is_some() {
            blocks.push(Block::Progress { share: 0.7, label: self.words(TextKey::FittingDressing) });
        } else if let Some(trouble) = visit.face.trouble {
            blocks.push(self.paragraph(word(trouble)));
        } else if visit.face.on {
            blocks.push(self.paragraph(TextKey::FaceOn));
        } else {
            blocks.push(self.paragraph(TextKey::FaceWhat));
        }
        blocks.push(self.paragraph(TextKey::FaceKept));
        blocks
    }
}
