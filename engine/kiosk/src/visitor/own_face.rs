//! A shopper's own face: from a picture of them to the head that their figure wears, in memory alone.
//!
//! What the picture, its points and the adapted head took is overwritten once the head is made; the head's own memory is, when its last
//! copy goes ([`OwnHead`]).

use std::fmt::{self, Debug, Formatter};
use std::hint::black_box;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DMat3, DVec3, Vec2, Vec3};
use image::RgbImage;
use toile_base::body::Sex;
use toile_base::numeric::statistics::median_of;
use toile_capture::face::{self, AdaptedHead, FaceView};
use toile_pose::face_finder::{FaceFault, FaceFinder};
use toile_pose::face_mesh::MeshPoints;
use toile_pose::files::PoseError;
use toile_sensors::calibration::{CalibratedCamera, CameraParameters};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::source::live::ColourImage;
use toile_view::figure::{OwnHead, OwnHeadPicture};

/// Points of the mesh: the top of the forehead, and the chin.
const TOP: usize = 10;
const CHIN: usize = 152;

/// Where the hair's colour is taken: from so far to so far above the forehead, and to both sides of it (shares of the face's height).
const HAIR_ABOVE: [f32; 2] = [0.06, 0.16];
const HAIR_ASIDE: f32 = 0.12;

/// Places along a side of that patch.
const HAIR_PLACES: usize = 12;

/// Colour of hair that the picture does not show (sRGB): a dark brown.
const HAIR: [u8; 3] = [76, 57, 47];

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

/// A picture of somebody, for their face; overwritten when it goes.
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

/// Overwrites bytes that somebody can be known by.
fn wipe(bytes: &mut [u8]) {
    bytes.fill(0);
    // Looked at, so that the writing is not left out as one that nobody sees.
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

/// Makes heads of pictures.
#[derive(Debug)]
pub struct FaceMaker {
    finder: FaceFinder,
}

impl FaceMaker {
    /// With the network's file of a folder. Called at load: it allocates.
    ///
    /// # Errors
    /// A file that is missing or another than the one that is known.
    pub fn load(folder: &Path) -> Result<Self, PoseError> {
        Ok(Self { finder: FaceFinder::load(folder)? })
    }

    /// Heads of these sexes' drawings, adapted to the face in a picture. Takes a second.
    ///
    /// # Errors
    /// Why there is none.
    pub fn make(&mut self, portrait: &Portrait, sexes: &[Sex]) -> Result<Vec<Arc<OwnHead>>, FaceTrouble> {
        let found = self.finder.find(&portrait.picture, portrait.head);
        self.finder.wipe();
        let mut points = found?;
        let made = heads(portrait, &points, sexes);
        points.wipe();
        made.ok_or(FaceTrouble::Unlike)
    }
}

/// The heads; none where no head fits the points.
fn heads(portrait: &Portrait, points: &MeshPoints, sexes: &[Sex]) -> Option<Vec<Arc<OwnHead>>> {
    let mut view = view(portrait, points)?;
    let ColourImage { width, height, rgb } = &portrait.picture;
    let photograph = RgbImage::from_raw(*width, *height, rgb.clone())?;
    let hair = hair_colour(&photograph, points);
    let made = sexes.iter().map(|sex| head(&view, &photograph, *sex, hair).map(Arc::new)).collect();
    wipe(&mut photograph.into_raw());
    view.points.fill(None);
    black_box(&view.points);
    made
}

/// The picture with its camera and the 68 points.
fn view(portrait: &Portrait, points: &MeshPoints) -> Option<FaceView> {
    Some(FaceView {
        camera: camera(portrait)?,
        points: points.marked(),
        outlines: Vec::new(),
        sigma_px: points.sigma_px(),
    })
}

/// The camera at the origin, looking along z; one of a usual lens where it is not known.
fn camera(portrait: &Portrait) -> Option<CalibratedCamera> {
    let size = [portrait.picture.width, portrait.picture.height];
    let known = portrait.camera.map(|camera| camera.scaled_to(size[0], size[1]));
    let known = known.and_then(|camera| {
        let k = camera.intrinsics;
        let [fx, fy, cx, cy] = [k.fx, k.fy, k.cx, k.cy].map(f64::from);
        // A lens of eight numbers bends the middle of its picture, where a face is, as its first five do.
        let bent = camera.lens.map(|l| [l.k[0], l.k[1], l.p[0], l.p[1], l.k[2]].map(f64::from).to_vec());
        let given = CameraParameters {
            size: size.map(f64::from),
            matrix: [[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]],
            distortion: bent.filter(|_| camera.lens.is_some_and(|l| l.k[3..] == [0.0; 3])).unwrap_or_default(),
            rotation: DMat3::IDENTITY,
            translation: DVec3::ZERO,
        };
        CalibratedCamera::new("camera", &given).ok()
    });
    known.or_else(|| face::assumed_camera(size, None).ok())
}

/// One head, with its picture; what it was made of is overwritten.
fn head(view: &FaceView, photograph: &RgbImage, sex: Sex, hair: [u8; 3]) -> Option<OwnHead> {
    let mut adapted = face::adapt(std::slice::from_ref(view), sex).ok()?;
    let texture = face::texture(&adapted, std::slice::from_ref(view), std::slice::from_ref(photograph));
    let mut rest: Vec<Vec3> = adapted.rest.iter().map(|p| p.as_vec3()).collect();
    let side = texture.picture.width() as usize;
    let picture = OwnHeadPicture { side, rgb: texture.picture.as_raw(), skin: texture.skin, hair };
    let head = OwnHead::new(sex, &rest, picture);
    rest.fill(Vec3::ZERO);
    forget(&mut adapted);
    black_box(&rest);
    wipe(&mut texture.picture.into_raw());
    head
}

fn forget(adapted: &mut AdaptedHead) {
    adapted.rest.fill(DVec3::ZERO);
    adapted.placed.fill(DVec3::ZERO);
    black_box((&adapted.rest, &adapted.placed));
}

/// The median colour above the forehead.
fn hair_colour(photograph: &RgbImage, points: &MeshPoints) -> [u8; 3] {
    let [top, chin] = [TOP, CHIN].map(|k| points.points[k]);
    let (up, aside) = (top - chin, (top - chin).perp());
    let share = |i: usize| i as f32 / (HAIR_PLACES - 1) as f32;
    let place = |i: usize| {
        let above = HAIR_ABOVE[0] + (HAIR_ABOVE[1] - HAIR_ABOVE[0]) * share(i / HAIR_PLACES);
        top + up * above + aside * HAIR_ASIDE * (2.0 * share(i % HAIR_PLACES) - 1.0)
    };
    let pixel = |p: Vec2| {
        let inside = p.x >= 0.0 && p.y >= 0.0 && p.x < photograph.width() as f32 && p.y < photograph.height() as f32;
        inside.then(|| photograph.get_pixel(p.x as u32, p.y as u32).0)
    };
    let seen: Vec<[u8; 3]> = (0..HAIR_PLACES * HAIR_PLACES).map(place).filter_map(pixel).collect();
    std::array::from_fn(|k| median_of(seen.iter().map(|c| f32::from(c[k]))).map_or(HAIR[k], |m| m.round() as u8))
}

#[cfg(test)]
mod tests {
    use super::*;

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
