//! The next picture of a shopper, when they ask for their face: switched on for one picture, and off again.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use toile_base::skeleton::Joint;
use toile_fitting::live::own_picture::{PictureReceiver, PictureSwitch, SeenPicture};
use toile_sensors::source::live::ColourImage;

use super::own_face::{FaceTrouble, Portrait};

/// A camera that gives no picture for so long gives none (ns): ten times what one takes at 5 Hz.
const PATIENCE_NS: u64 = 2_000_000_000;

/// The middle of a head over its joint, and the side of the square about it in which the face is sought (m).
const OVER_JOINT_M: f32 = 0.09;
const AROUND_M: f32 = 0.6;

/// Takes one picture at a time.
#[derive(Debug)]
pub struct FaceCamera {
    receiver: PictureReceiver,
    switch: PictureSwitch,
    /// Number of the effect that asked, and when (ns).
    asked: Option<(u32, u64)>,
}

impl FaceCamera {
    /// Switched off.
    pub const fn new(receiver: PictureReceiver, switch: PictureSwitch) -> Self {
        Self { receiver, switch, asked: None }
    }

    /// Asks for the next picture.
    pub fn ask(&mut self, number: u32, now_ns: u64) {
        self.asked = Some((number, now_ns));
        self.switch.set(true);
    }

    /// Cancels the request.
    pub fn cancel(&mut self) {
        self.asked = None;
        self.switch.set(false);
    }

    /// The picture that was asked for, once, or that there is none.
    pub fn poll(&mut self, now_ns: u64) -> Option<(u32, Result<Arc<Portrait>, FaceTrouble>)> {
        let Some((number, since_ns)) = self.asked else {
            // Copies that are wiped are taken over, so that all of them are.
            _ = self.receiver.news();
            return None;
        };
        let seen = self.receiver.news().filter(|seen| seen.arrived_ns >= since_ns && seen.picture.width > 0);
        if let Some(seen) = seen {
            let portrait = Arc::new(portrait(seen));
            self.cancel();
            return Some((number, Ok(portrait)));
        }
        if now_ns.saturating_sub(since_ns) < PATIENCE_NS {
            return None;
        }
        self.cancel();
        Some((number, Err(FaceTrouble::NoPicture)))
    }
}

/// A copy of a picture, with where the head is in it.
fn portrait(seen: &SeenPicture) -> Portrait {
    let ColourImage { width, height, rgb } = &seen.picture;
    let picture = ColourImage { width: *width, height: *height, rgb: rgb.clone() };
    Portrait { head: head(seen), camera: seen.camera, picture }
}

/// The middle and the side of a square about the head (px).
fn head(seen: &SeenPicture) -> Option<(Vec2, f32)> {
    let camera = seen.camera?.scaled_to(seen.picture.width, seen.picture.height);
    let joint = seen.joints.believed(Joint::Head)?;
    let place = camera.camera_to_world.inverse().transform_point3(joint + Vec3::Y * OVER_JOINT_M);
    Some((camera.project(place)?, AROUND_M * camera.intrinsics.fx / place.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_fitting::live::own_picture::PictureSender;

    fn sent(sender: &mut PictureSender, at_ns: u64) {
        sender.send(|seen| {
            seen.picture = ColourImage { width: 2, height: 1, rgb: vec![9; 6] };
            (seen.taken_ns, seen.arrived_ns) = (at_ns, at_ns);
        });
    }

    #[test]
    fn one_picture_is_taken_when_it_is_asked_for_and_none_before_or_after() {
        let mut sender = PictureSender::default();
        let (receiver, switch) = sender.also();
        let mut camera = FaceCamera::new(receiver, switch);
        sent(&mut sender, 5);
        assert!(camera.poll(5).is_none() && !sender.is_on());
        camera.ask(7, 10);
        assert!(camera.poll(10).is_none() && sender.is_on());
        sent(&mut sender, 12);
        let (number, portrait) = camera.poll(12).unwrap();
        assert!(number == 7 && portrait.unwrap().picture.rgb == [9; 6] && !sender.is_on());
        // Every copy on the way is wiped.
        for _ in 0..4 {
            sent(&mut sender, 13);
            assert!(camera.poll(13).is_none());
        }
        let left = camera.receiver.latest();
        assert!(left.picture.rgb.iter().all(|b| *b == 0) && left.taken_ns == 0);
    }

    #[test]
    fn a_camera_that_gives_no_picture_is_not_waited_for_for_ever() {
        let mut sender = PictureSender::default();
        let (receiver, switch) = sender.also();
        let mut camera = FaceCamera::new(receiver, switch);
        camera.ask(1, 0);
        assert!(camera.poll(PATIENCE_NS - 1).is_none());
        assert!(matches!(camera.poll(PATIENCE_NS), Some((1, Err(FaceTrouble::NoPicture)))));
        assert!(!sender.is_on());
        camera.ask(2, 0);
        camera.cancel();
        assert!(camera.poll(PATIENCE_NS).is_none() && !sender.is_on());
    }
}
