//! Follows a shopper by a sensor, dresses a body of their measures, and draws it on their picture, as the live loop does.

use std::path::Path;
use std::time::Instant;

use toile_assets::scene::SHOPPER;
use toile_assets::sizes::Population;
use toile_base::body::Measures;
use toile_base::clock::ticks_to_ns;
use toile_base::frame::{DepthFrame, Joints};
use toile_engine::frame_loop::motion_input::MotionInput;
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World};
use toile_fitting::FittingError;
use toile_fitting::dress::measured::{self, MeasuredSubject, ShopperFacts};
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::{DressedWorld, RequestedGarment, TryOn};
use toile_fitting::live::webcam::{WebcamJoints, WebcamOptions};
use toile_sensors::colour_camera::ColourCamera;
use toile_sensors::filter::JointFilter;
use toile_sensors::person_mask::PersonMask;
use toile_sensors::segment::Zone;
use toile_track::fit::FitOptions;
use toile_track::fit::tracker::BodyTracker;
use toile_track::tape_readings::{TapeError, TapeReadings};
use toile_view::image::Size;
use toile_view::own_picture::{OwnPicture, OwnPictureInput, OwnPictureModel, OwnPictureOptions, Plain};

use super::error::OwnPictureError;
use super::outline::SIZE;
use super::truth::TruthMoment;
use crate::webcam::scene;

/// From a picture's arrival until its joints are there (ns): what the tables of docs/cameras.md and docs/webcam.md have at the median.
const DEPTH_NS: u64 = 6_000_000;
const WEBCAM_NS: u64 = 8_000_000;

/// Steps whose snapshots are kept.
const KEPT: usize = 16;

toile_base::named! {
    /// The sensor that follows a shopper.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Seer {
        /// A body fitted to depth.
        Depth = "depth and colour",
        /// The pose network.
        Webcam = "webcam",
        /// The pose network, and a tape, which it asks for.
        Tape = "webcam and tape",
    }
}

impl Seer {
    /// A word for it in names of files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Depth => "depth",
            Self::Webcam => "webcam",
            Self::Tape => "tape",
        }
    }

    /// All available sensors: depth, and a webcam if its network is there. Each has watched a person stand for a second.
    pub fn all(network: Option<&Path>, standing: &[TruthMoment]) -> Result<Vec<MeasuredShopper>, OwnPictureError> {
        let mut all = vec![MeasuredShopper::by_depth(standing)?];
        if let Some(folder) = network {
            all.push(MeasuredShopper::by_webcam(folder, standing, None)?);
            all.push(MeasuredShopper::by_webcam(folder, standing, Some(told()?))?);
        }
        Ok(all)
    }
}

/// A measured shopper, and the sensor that measured them.
pub struct MeasuredShopper {
    kind: Seer,
    sensor: FollowerSensor,
    measured: MeasuredSubject,
}

/// What the shopper tells of herself, to the centimetre.
fn told() -> Result<TapeReadings, TapeError> {
    let Measures { stature, chest_girth, waist_girth, hip_girth, .. } = SHOPPER.1;
    let named = [("stature", stature), ("chest", chest_girth), ("waist", waist_girth), ("hips", hip_girth)];
    named.iter().try_fold(TapeReadings::default(), |told, (name, m)| told.and(&format!("{name}={:.0}cm", 100.0 * m)))
}

fn facts() -> ShopperFacts {
    // Sex and clothes are not guessed here: the mannequin's are known.
    ShopperFacts { sex: Some(SHOPPER.0), clothed: false, ..ShopperFacts::default() }
}

impl MeasuredShopper {
    fn by_depth(standing: &[TruthMoment]) -> Result<Self, OwnPictureError> {
        let frames: Vec<DepthFrame> = standing.iter().map(|m| m.depth.clone()).collect();
        let measured = measured::measure(&session::of_depth(frames), facts())?;
        let tracker = BodyTracker::new(SHOPPER.0, Zone::default(), FitOptions::LIVE);
        Ok(Self { kind: Seer::Depth, sensor: FollowerSensor::Depth(Box::new(tracker)), measured })
    }

    fn by_webcam(folder: &Path, standing: &[TruthMoment], told: Option<TapeReadings>) -> Result<Self, OwnPictureError> {
        let (kind, tape) = (if told.is_some() { Seer::Tape } else { Seer::Webcam }, told.unwrap_or_default());
        let options = WebcamOptions {
            sex: SHOPPER.0,
            mount: scene::mount(),
            stature_m: tape.stature(),
            own_picture: true,
            ..WebcamOptions::default()
        };
        let mut webcam = WebcamJoints::load(folder, options)?;
        let joints: Vec<Joints> = standing.iter().map(|m| webcam.push(&m.picture, m.time_ns)).collect();
        let measured = measured::measure(&session::of_directions(joints), ShopperFacts { tape, ..facts() })?;
        let webcam = WebcamJoints::load(
            folder,
            WebcamOptions { stature_m: measured.best.measures.stature.map(|s| s.value), ..options },
        )?;
        Ok(Self { kind, sensor: FollowerSensor::Webcam(Box::new(webcam)), measured })
    }

    /// The garment in the size that fits them.
    pub fn garments(&self, garment: &str) -> Result<Vec<RequestedGarment>, FittingError> {
        let shopper = ShopperFacts { sex: Some(SHOPPER.0), ..ShopperFacts::default() };
        let request = TryOn::of_shopper(&[garment.to_owned()], None, shopper);
        Ok(request.sized_for("own picture", &self.measured)?.garments)
    }
}

/// What was seen in a picture.
struct SeenPicture {
    joints: Joints,
    /// Joints in the camera's own space, and the camera.
    own: Option<(Joints, ColourCamera)>,
    mask: Option<PersonMask>,
    due_ns: u64,
    time_ns: u64,
}

/// A dressed body that follows what is seen.
pub struct Follower {
    /// What sees.
    pub seer: Seer,
    sensor: FollowerSensor,
    world: World,
    reader: Reader<Snapshot>,
    model: std::sync::Arc<OwnPictureModel>,
    filter: JointFilter,
    intake: MotionInput,
    seen: Option<SeenPicture>,
    /// The newest snapshots, each with the time of its step (ns).
    snapshots: std::collections::VecDeque<(u64, Snapshot)>,
    mirrors: [OwnPicture; 3],
}

/// A picture in every way.
pub struct Drawn {
    /// Why the garment is not drawn on it, where it is not.
    pub plain: Option<Plain>,
    /// Where cloth is seen, in each way.
    pub masks: Vec<Vec<bool>>,
    /// The mirror.
    pub rgb: Vec<u8>,
    /// How long it took to draw (ms).
    pub ms: f64,
}

impl Follower {
    /// Dresses a shopper in these garments and sizes, as they stood at the end of their first second.
    pub fn new(
        shopper: MeasuredShopper,
        garments: &[RequestedGarment],
        standing: &[TruthMoment],
    ) -> Result<Self, OwnPictureError> {
        let MeasuredShopper { kind, mut sensor, measured } = shopper;
        let (body, _) = measured::build_body(SHOPPER.0, &measured.best, Population::from(Some(SHOPPER.0)))?;
        let request = TryOn::of_body("own picture", SHOPPER.0, body.measures, garments.to_vec());
        let first = standing.iter().map(|m| sensor.look(m).joints).find(session::is_present);
        let first = first.ok_or_else(|| FittingError::Input("no person is seen; see docs/own-picture.md".into()))?;
        let DressedWorld { world, reader, .. } = request.build(&first)?;
        sensor.reset();
        Ok(Self {
            seer: kind,
            sensor,
            model: OwnPictureModel::of(world.body(), world.garments()),
            world,
            reader,
            filter: JointFilter::default(),
            intake: MotionInput::default(),
            seen: None,
            snapshots: std::collections::VecDeque::with_capacity(KEPT),
            mirrors: std::array::from_fn(|_| OwnPicture::new()),
        })
    }

    /// Looks at a picture: its joints come a little later.
    pub fn look(&mut self, moment: &TruthMoment) {
        self.seen = Some(self.sensor.look(moment));
    }

    /// A step of 120 Hz; says whether a picture's joints have come with it, so that it may be drawn.
    pub fn step(&mut self, tick: u64) -> bool {
        let end_ns = ticks_to_ns(tick + 1);
        let mut came = false;
        if let Some(seen) = &self.seen
            && seen.due_ns <= ticks_to_ns(tick)
            && self.intake.seen_ns().is_none_or(|last| last < seen.time_ns)
        {
            self.intake.take(&self.filter.push(&seen.joints), end_ns);
            came = true;
        }
        self.world.step(&self.intake.at(end_ns));
        if self.snapshots.len() == KEPT {
            self.snapshots.pop_front();
        }
        self.snapshots.push_back((end_ns, self.reader.latest().clone()));
        came
    }

    /// Draws the last picture that was seen, in every way.
    pub fn draw(&mut self, moment: &TruthMoment) -> Drawn {
        let Some(seen) = &self.seen else {
            return Drawn { plain: Some(Plain::NoPicture), masks: Vec::new(), rgb: Vec::new(), ms: 0.0 };
        };
        let (joints, camera) = seen.own.unzip();
        let depth = (self.seer == Seer::Depth).then_some(&moment.depth);
        let joints = joints.unwrap_or(Joints::absent(seen.time_ns));
        let mask = seen.mask.as_ref();
        let input = OwnPictureInput {
            picture: &moment.picture,
            camera: camera.as_ref(),
            joints: &joints,
            depth,
            mask,
            colours: &[],
        };
        let whole = OwnPictureOptions::of(Size::new(SIZE[0], SIZE[1]));
        let newest = &self.snapshots.back().expect("a step was taken").1;
        let stamp = self.snapshots.iter().min_by_key(|(at, _)| at.abs_diff(seen.time_ns));
        let stamp = &stamp.expect("a step was taken").1;
        let ways = [(newest, true), (newest, false), (stamp, false)];
        let (mut masks, mut plain, mut ms) = (Vec::new(), None, 0.0);
        for (way, (mirror, (snapshot, repose))) in self.mirrors.iter_mut().zip(ways).enumerate() {
            let begun = Instant::now();
            let drawn = mirror.draw(&self.model, snapshot, &input, &OwnPictureOptions { repose, ..whole });
            if way == 0 {
                ms = begun.elapsed().as_secs_f64() * 1e3;
            }
            plain = plain.or(drawn.err());
            masks.push(mirror.shown().collect());
        }
        Drawn { plain, masks, rgb: self.mirrors[0].picture().1.to_vec(), ms }
    }
}

/// A sensor's own part.
enum FollowerSensor {
    Depth(Box<BodyTracker>),
    Webcam(Box<WebcamJoints>),
}

impl FollowerSensor {
    fn look(&mut self, moment: &TruthMoment) -> SeenPicture {
        let time_ns = moment.time_ns;
        match self {
            Self::Depth(tracker) => {
                let joints = Joints { time_ns, ..tracker.push(&moment.depth).joints };
                let depth = &moment.depth;
                let camera = ColourCamera::pinhole(depth.intrinsics, depth.camera_to_world);
                SeenPicture { joints, own: Some((joints, camera)), mask: None, due_ns: time_ns + DEPTH_NS, time_ns }
            }
            Self::Webcam(webcam) => {
                let joints = webcam.push(&moment.picture, time_ns);
                let own = webcam.picture_fit().map(|fit| (fit.joints, fit.camera));
                let mask = webcam.mask().cloned();
                SeenPicture { joints, own, mask, due_ns: time_ns + WEBCAM_NS, time_ns }
            }
        }
    }

    /// The scene begins anew.
    fn reset(&mut self) {
        if let Self::Depth(tracker) = self {
            **tracker = BodyTracker::new(SHOPPER.0, Zone::default(), FitOptions::LIVE);
        }
    }
}
