//! Pictures of outfits: each in some poses, from four sides, with what crosses and what the picture hides.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;
use serde::Serialize;
use toile_base::limits::STEP_SECONDS;
use toile_base::skeleton::{Pose, Skeleton};
use toile_fitting::heap::HeapProbe;
use toile_fitting::wearing::poses::{arms_down, arms_raised, sitting};
use toile_view::contact_sheet;
use toile_view::drawn_frame::DrawnFrame;
use toile_view::figure::Appearance;
use toile_view::image::{Image, Size};
use toile_view::scene::{OrbitCamera, PictureScene};
use toile_view::trace::{TraceQuality, TracedScene};

use super::row::ContactError;
use super::skin::bring_into;
use super::worn::{OUTFITS, Outfit, options};
use crate::worn::{WornScene, step_at};
use toile_fitting::crossings::CrossingWatch;

/// One view: tall enough to see a slit between two garments.
const VIEW: Size = Size::new(480, 800);

/// The four sides: what they are called, and where the camera stands (rad from before the body towards its left).
const SIDES: [(&str, f32); 4] = [("front", 0.0), ("left", FRAC_PI_2), ("back", PI), ("right", -FRAC_PI_2)];

/// How long the body takes into a pose, and how long it then stays (s).
const INTO_POSE_S: [f32; 2] = [1.5, 2.0];

/// When the performance is in the middle of a stride, after the mannequin has walked for a while (s).
const MID_STRIDE_S: f64 = 4.79;

/// How an outfit is brought to where it is drawn.
#[derive(Clone, Copy)]
enum Way {
    /// Into a pose, and there to rest.
    Into(fn(&Skeleton) -> Pose),
    /// Along the performance, until so far into it (s).
    Performing(f64),
}

/// What is drawn of each outfit.
const DRAWN: [(&str, Way); 4] = [
    ("arms-down", Way::Into(arms_down)),
    ("arms-raised", Way::Into(arms_raised)),
    ("sitting", Way::Into(sitting)),
    ("walking", Way::Performing(MID_STRIDE_S)),
];

/// A picture of an outfit in a pose.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OutfitPicture {
    /// Garments, inner first.
    pub garments: Vec<String>,
    /// The pose.
    pub pose: &'static str,
    /// Edges that pass through faces of their own garment.
    pub crossings_within: u64,
    /// Edges that pass through faces of another garment.
    pub crossings_between: u64,
    /// How far skin or inner cloth stood out of what covers it at most, which the picture hides (mm).
    pub hidden_mm: f64,
    /// The four sides.
    #[serde(skip)]
    pub image: Image,
}

impl OutfitPicture {
    /// Name of its file.
    pub fn file(&self) -> String {
        format!("{}-{}.png", self.garments.join("-"), self.pose)
    }

    /// What was seen in it.
    pub fn words(&self) -> String {
        let Self { crossings_within, crossings_between, hidden_mm, .. } = self;
        format!(
            "{crossings_within} edges pass through their own garment, {crossings_between} through another; hidden: {hidden_mm:.1} mm"
        )
    }
}

/// Draws every outfit in every pose; `done` is given each picture.
///
/// # Errors
/// A garment that cannot be made, and as `done`.
pub fn pictures<E: From<ContactError>>(done: &mut dyn FnMut(OutfitPicture) -> Result<(), E>) -> Result<(), E> {
    for outfit in &OUTFITS {
        for (pose, way) in DRAWN {
            done(picture(outfit, pose, way)?)?;
        }
    }
    Ok(())
}

fn picture(outfit: &Outfit, pose: &'static str, way: Way) -> Result<OutfitPicture, ContactError> {
    let mut scene = WornScene::new(&options(outfit.garments, 2), &HeapProbe::none())?;
    let mut drawn = DrawnFrame::of(&scene.body, &scene.garments, Appearance::default());
    match way {
        Way::Into(pose) => {
            let goal = pose(scene.skeleton());
            bring_into(&mut scene, &goal, INTO_POSE_S);
        }
        Way::Performing(until) => {
            for _ in 0..step_at(until) {
                scene.prepare();
                scene.step();
            }
        }
    }
    let at: Vec<Vec<Vec3>> =
        scene.cloths.iter().map(|c| c.positions.iter().map(|p| Vec3::from(*p)).collect()).collect();
    let faces: Vec<&[[u32; 3]]> = scene.garments.iter().map(|g| &*g.triangles).collect();
    let [within, between] = CrossingWatch::new(&faces, STEP_SECONDS.into()).look(&at);
    drawn.place(&at, scene.posed());
    let mut found = OutfitPicture {
        garments: outfit.garments.iter().map(|g| (*g).to_owned()).collect(),
        pose,
        crossings_within: within,
        crossings_between: between,
        hidden_mm: f64::from(drawn.hidden_m()) * 1e3,
        image: Image::filled(Size::new(1, 1), contact_sheet::PAPER),
    };
    found.image = sides(&drawn, &format!("{}: {pose}\n{}", outfit.name, found.words()));
    Ok(found)
}

/// The four sides on one page.
fn sides(drawn: &DrawnFrame, title: &str) -> Image {
    let surfaces = drawn.surfaces(None);
    let scene = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    let bounds = scene.bounds();
    let views = SIDES.map(|(_, yaw)| {
        let camera = OrbitCamera::framing(&bounds, yaw, VIEW.width as f32 / VIEW.height as f32);
        scene.render(&camera, VIEW, TraceQuality::Still)
    });
    contact_sheet::views(&views.each_ref(), &SIDES.map(|(name, _)| name), title)
}
