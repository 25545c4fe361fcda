//! Makes the head of a shopper's figure from a picture of their face.
//!
//! The picture's points and the adapted head are overwritten once the head is made.

use std::hint::black_box;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DMat3, DVec3, Vec2, Vec3};
use image::RgbImage;
use toile_base::body::Sex;
use toile_base::numeric::statistics::median_of;
use toile_pose::face::{self, AdaptedHead, FaceView};
use toile_pose::face_finder::FaceFinder;
use toile_pose::face_mesh::MeshPoints;
use toile_pose::files::PoseError;
use toile_sensors::calibration::{CalibratedCamera, CameraParameters};
use toile_sensors::source::live::ColourImage;
use toile_view::figure::{OwnHead, OwnHeadPicture};

use super::own_face::{FaceTrouble, MakeHeads, Portrait, wipe};
use crate::error::KioskError;
use crate::service::config::Config;

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

    /// The maker of heads as the dressing worker calls it; none where shoppers may not have their faces taken or there is no camera.
    ///
    /// # Errors
    /// The network's file is missing from the folder, or another one.
    pub fn configured(config: &Config, folder: &Path) -> Result<Option<MakeHeads>, KioskError> {
        let has_camera = config.sensor.camera().map_err(KioskError::input)?.is_some();
        if !config.display.face || !has_camera {
            return Ok(None);
        }
        let maker = Self::load(folder).map_err(|why| KioskError::Device(why.to_string()))?;
        let maker = Mutex::new(maker);
        Ok(Some(Arc::new(move |portrait, sexes| {
            maker.lock().unwrap_or_else(PoisonError::into_inner).make(portrait, sexes)
        })))
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
