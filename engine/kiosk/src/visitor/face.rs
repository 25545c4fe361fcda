//! A shopper's own face on the mannequin: asked for, put on, taken away. The pages know whether it is there, and never see it.

use super::model::{Effect, Effects, VisitModel};
use super::own_face::FaceTrouble;
use super::screen::Page;
use super::visit::OwnFace;

impl VisitModel {
    /// Whether the fitting page leads to the page of the face: where faces can be taken, and the mannequin is shown that would have it.
    pub(super) fn offers_face(&self) -> bool {
        self.face_offered && !self.sees_themselves()
    }

    /// Whether the fitting page offers both the shopper's own picture and their face: then measures by tape are left to the settings, for which
    /// there is room.
    pub(super) fn is_crowded(&self) -> bool {
        self.offers_face() && self.own_picture.is_some()
    }

    /// Opens the page, which no longer says what went wrong before.
    pub(super) fn open_face(&mut self) {
        self.visit.face.trouble = None;
        self.open(Page::Face);
    }

    /// Has the next picture taken, for the face; one that is on stays meanwhile.
    pub(super) fn take_face(&mut self, effects: &mut Effects) {
        let number = self.next();
        let visit = &mut self.visit;
        (visit.face.asked, visit.face.trouble) = (Some(number), None);
        let _ = effects.push(Effect::TakeFace { number, outfit: visit.outfit.clone() });
    }

    /// The face is there, and they are dressed anew with it; or everything stays as it was.
    pub(super) fn face_taken(&mut self, taken: Result<(), FaceTrouble>, effects: &mut Effects) {
        match taken {
            Ok(()) => {
                self.visit.face.on = true;
                // Two sizes were draped without it.
                self.visit.pair = None;
                self.dress(effects);
            }
            Err(trouble) => self.visit.face.trouble = Some(trouble),
        }
    }

    /// Nothing of it is shown from this moment on, as where another person looks; then they are dressed anew without it.
    pub(super) fn remove_face(&mut self, effects: &mut Effects) {
        let visit = &mut self.visit;
        (visit.face, visit.pair, visit.snapping, visit.hidden) = (OwnFace::default(), None, None, true);
        let _ = effects.push(Effect::Hide);
        self.dress(effects);
    }
}
