//! A shopper's own face: the picture that it is taken from, and the head that their figure wears, in memory alone.
//!
//! The picture is overwritten when it goes; the head's own memory is, when its last copy goes ([`OwnHead`]).

use std::fmt::{self, Debug, Formatter};
use std::hint::black_box;
use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec2;
use toile_base::body::Sex;
use toile_pose::face_finder::FaceFault;
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::source::live::ColourImage;
use toile_view::figure::OwnHead;

/// Why a face is not put on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceTrouble {
    /// The camera gave no picture.
    NoPicture,
    /// No face is seen.
    Unseen,
    /// It is too far away.
    TooFar,
    /// It is turned away.
    Turned,
    /// No head fits its points.
    Unlike,
}

impl From<FaceFault> for FaceTrouble {
    fn from(fault: FaceFault) -> Self {
        match fault {
            FaceFault::Unseen => Self::Unseen,
            FaceFault::TooFar => Self::TooFar,
            FaceFault::Turned => Self::Turned,
        }
    }
}

/// A picture of a person, for their face; overwritten when it goes.
pub struct Portrait {
    /// The picture.
    pub picture: ColourImage,
    /// How it was seen, where that is known.
    pub camera: Option<ColourCamera>,
    /// The middle and the side of a square about the head (px), where that is known.
    pub head: Option<(Vec2, f32)>,
}

impl Debug for Portrait {
    /// Nothing of it.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("Portrait")
    }
}

impl Drop for Portrait {
    fn drop(&mut self) {
        wipe(&mut self.picture.rgb);
    }
}

/// Overwrites bytes by which a person can be identified.
pub(super) fn wipe(bytes: &mut [u8]) {
    bytes.fill(0);
    // Read, so that the compiler does not leave the writing out as a dead store.
    black_box(&bytes);
}

/// The face that the shopper's figure wears, if any: what dresses them asks, and what forgets them takes it away.
#[derive(Debug, Clone, Default)]
pub struct WornFace(Arc<Mutex<Vec<Arc<OwnHead>>>>);

impl WornFace {
    /// Puts heads on, one of each drawing that the figure may have.
    pub fn put_on(&self, heads: Vec<Arc<OwnHead>>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = heads;
    }

    /// Takes it away.
    pub fn take_away(&self) {
        self.put_on(Vec::new());
    }

    /// The head of a body of this sex.
    pub fn of(&self, sex: Sex) -> Option<Arc<OwnHead>> {
        let worn = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        worn.iter().find(|head| head.sex() == sex).cloned()
    }
}

/// Makes the heads of these sexes' drawings from a picture, or says why there is none.
pub type MakeHeads = Arc<dyn Fn(&Portrait, &[Sex]) -> Result<Vec<Arc<OwnHead>>, FaceTrouble> + Send + Sync>;

#[cfg(test)]
mod tests {
    use super::*;
    use toile_view::figure::OwnHeadPicture;

    fn portrait(side: u32) -> Portrait {
        let picture = ColourImage { width: side, height: side, rgb: vec![120; 3 * (side * side) as usize] };
        Portrait { picture, camera: None, head: None }
    }

    #[test]
    fn nothing_of_a_picture_or_a_head_is_in_debug_texts() {
        assert_eq!(format!("{:?}", portrait(4)), "Portrait");
        let base = toile_assets::body::shape::Shapes::of(Sex::Female).base();
        let rgb = vec![7; 3 * 64 * 64];
        let picture = OwnHeadPicture { side: 64, rgb: &rgb, skin: [7; 3], hair: [7; 3] };
        let head = Arc::new(OwnHead::new(Sex::Female, &base.positions, picture).unwrap());
        let worn = WornFace::default();
        worn.put_on(vec![head]);
        assert_eq!(format!("{worn:?}").matches("OwnHead").count(), 1);
        assert!(worn.of(Sex::Female).is_some() && worn.of(Sex::Male).is_none());
        worn.take_away();
        assert!(worn.of(Sex::Female).is_none());
    }

    #[test]
    fn a_picture_is_overwritten() {
        let mut one = portrait(8);
        wipe(&mut one.picture.rgb);
        assert!(one.picture.rgb.iter().all(|b| *b == 0));
    }
}
