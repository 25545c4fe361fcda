//! The shopper's own picture in the window: drawn when the camera's next one has come, at the size that the body is drawn at.

use toile_engine::world::Snapshot;
use toile_fitting::live::own_picture::PictureReceiver;
use toile_view::image::Size;
use toile_view::own_picture::{OwnPicture, OwnPictureInput, OwnPictureOptions};

use super::body_model::BodyModel;
use crate::visitor::plain;

/// Draws the camera's pictures as a mirror shows them.
pub struct OwnPictureView {
    pictures: PictureReceiver,
    mirror: OwnPicture,
    /// Whether there is a picture to show.
    has_picture: bool,
    /// Size and free part that it was drawn for.
    drawn_for: (Size, [f32; 2]),
}

impl OwnPictureView {
    /// Of a camera's pictures.
    pub fn new(pictures: PictureReceiver) -> Self {
        let drawn_for = (Size::new(0, 0), [0.0; 2]);
        Self { pictures, mirror: OwnPicture::new(), has_picture: false, drawn_for }
    }

    /// Ends the own picture: blackens what was shown, and lets the camera's last pictures go.
    pub fn rest(&mut self) {
        _ = self.pictures.news();
        if std::mem::take(&mut self.has_picture) {
            self.mirror.forget();
        }
    }

    /// Draws the newest picture, if there is a new one; gives what is to be shown, once there is any.
    pub fn show(
        &mut self,
        model: &BodyModel,
        snapshot: Option<&Snapshot>,
        colours: &[[f32; 3]],
        size: Size,
        free: [f32; 2],
    ) -> Option<(Size, &[u8])> {
        let changed = self.drawn_for != (size, free);
        let seen = if changed { Some(self.pictures.latest()) } else { self.pictures.news() };
        let ready = seen.filter(|seen| seen.taken_ns > 0).zip(snapshot).zip(model.own.as_ref());
        if let Some(((seen, snapshot), own)) = ready
            && size.width > 0
            && size.height > 0
        {
            let input = OwnPictureInput {
                picture: &seen.picture,
                camera: seen.camera.as_ref(),
                joints: &seen.joints,
                depth: seen.depth.as_deref(),
                mask: Some(&seen.mask).filter(|mask| mask.side > 0),
                colours,
            };
            let options = OwnPictureOptions { free, ..OwnPictureOptions::of(size) };
            let drawn = self.mirror.draw(own, snapshot, &input, &options);
            self.pictures.report(plain::code(drawn.err()));
            (self.has_picture, self.drawn_for) = (true, (size, free));
        } else if !self.pictures.is_on() {
            self.rest();
        }
        self.has_picture.then(|| self.mirror.picture())
    }
}
