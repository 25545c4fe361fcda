//! Slide of feet that stand, and what becomes of jumps: motion capture, seen by a sensor with noise, then posed.

use glam::Vec3;
use serde::Serialize;
use toile_base::clock::{ns_to_ticks, ticks_to_ns};
use toile_base::frame::Joints;
use toile_base::limits::STEP_SECONDS;
use toile_base::numeric::statistics::quantile;
use toile_base::skeleton::{Joint, Skeleton};
use toile_engine::body::ground::soles;
use toile_engine::body::{JointFrames, Poser};
use toile_sensors::filter::JointFilter;
use toile_sensors::sample::{between, sample};
use toile_sensors::source::Session;

use super::motions;

/// Speed (m/s) and height over its lowest (m) up to which a true toe stands.
const TRUE_SPEED: f32 = 0.1;
const TRUE_HEIGHT: f32 = 0.04;

/// Height of both true toes (m) from which the person is in the air, and of our lowest sole from which the body is.
const TRUE_AIR: f32 = 0.08;
const AIR: f32 = 0.01;

/// Time that is left to the sensor, the filters and the pose to follow (ns): a foot counts as planted that has stood so
/// long, and a jump is looked for so much later.
const DELAY_NS: u64 = 100_000_000;

const TOES: [Joint; 2] = [Joint::LeftToe, Joint::RightToe];

/// What becomes of the feet of one recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FootSlide {
    /// Name of the recording.
    pub name: String,
    /// How long feet stand, both feet's time added (s).
    pub planted_s: f64,
    /// How far standing feet move as they were recorded (mm/s).
    pub truth_mm_s: f64,
    /// The same as the filter shows them (mm/s).
    pub filtered_mm_s: f64,
    /// The same on the body posed with feet that may slide (mm/s).
    pub posed_mm_s: f64,
    /// The same with planted feet (mm/s).
    pub kept_mm_s: f64,
    /// How long the person is truly in the air (s).
    pub air_s: f64,
    /// Share of that time in which the posed body is not in the air (0..1).
    pub glued_share: f64,
    /// Highest that the true lower toe rises (mm).
    pub true_rise_mm: f64,
    /// Highest that the body's lowest sole rises (mm).
    pub rise_mm: f64,
}

/// Watches one recording.
pub fn slide(session: &Session, body: &Skeleton) -> FootSlide {
    let truth = TrueFeet::new(&session.joints);
    let seconds = session.duration_ns() as f32 * 1e-9;
    let motion = |t: f32| sample(&session.joints, (f64::from(t) * 1e9) as u64).unwrap_or(session.joints[0]);
    let seen = motions::by_kinect(&motion, seconds, 7);
    let mut filter = JointFilter::default();
    let filtered: Vec<Joints> = seen.seen.iter().map(|frame| filter.push(frame)).collect();
    let sliding = PosedFeet::new(&filtered, Poser::new(body).letting_feet_slide(), body);
    let kept = PosedFeet::new(&filtered, Poser::new(body), body);
    let ticks: Vec<u64> = (0..kept.soles.len() as u64).collect();
    let true_toes: Vec<[Vec3; 2]> = ticks.iter().map(|t| truth.toes(ticks_to_ns(*t))).collect();
    let planted = |tick: usize, foot: usize| truth.stands(ticks_to_ns(tick as u64), foot);
    let way = |track: &[[Vec3; 2]]| -> (f64, f64) {
        let (mut way, mut time) = (0.0, 0.0);
        for (tick, pair) in track.windows(2).enumerate() {
            for foot in (0..2).filter(|foot| planted(tick, *foot) && planted(tick + 1, *foot)) {
                way += f64::from((pair[1][foot] - pair[0][foot]).with_y(0.0).length());
                time += f64::from(STEP_SECONDS);
            }
        }
        (way * 1e3 / time.max(1e-9), time)
    };
    let late = |tick: usize| ticks_to_ns(tick as u64).saturating_sub(DELAY_NS);
    let air: Vec<usize> = (0..kept.lowest.len()).filter(|tick| truth.flies(late(*tick))).collect();
    let glued = air.iter().filter(|tick| kept.lowest[**tick] < AIR).count();
    let highest = |values: &mut dyn Iterator<Item = f32>| f64::from(values.fold(0.0, f32::max)) * 1e3;
    FootSlide {
        name: session.name.clone(),
        planted_s: way(&true_toes).1,
        truth_mm_s: way(&true_toes).0,
        filtered_mm_s: way(&kept.seen).0,
        posed_mm_s: way(&sliding.soles).0,
        kept_mm_s: way(&kept.soles).0,
        air_s: air.len() as f64 * f64::from(STEP_SECONDS),
        glued_share: glued as f64 / air.len().max(1) as f64,
        true_rise_mm: highest(&mut true_toes.iter().map(|[a, b]| a.y.min(b.y) - truth.floor)),
        rise_mm: highest(&mut kept.lowest.iter().copied()),
    }
}

/// A body posed 120 times a second: the balls of its feet, the toes that were seen, and its lowest sole (m).
struct PosedFeet {
    soles: Vec<[Vec3; 2]>,
    seen: Vec<[Vec3; 2]>,
    lowest: Vec<f32>,
}

impl PosedFeet {
    /// Poses filtered frames as the frame loop does: between the last two.
    fn new(track: &[Joints], mut poser: Poser, body: &Skeleton) -> Self {
        let mut out = Self { soles: Vec::new(), seen: Vec::new(), lowest: Vec::new() };
        for tick in 0..ns_to_ticks(track.last().map_or(0, |f| f.time_ns)) {
            let time = ticks_to_ns(tick);
            let after = track.partition_point(|f| f.time_ns <= time).clamp(1, track.len() - 1);
            let joints = between(&track[after - 1], &track[after], time);
            let pose = poser.pose(&joints, STEP_SECONDS);
            let soles = soles(body, &JointFrames::new(body, &pose));
            out.soles.push(soles.map(|[_, ball, _]| ball));
            out.seen.push(TOES.map(|toe| joints.at(toe).position));
            out.lowest.push(soles.iter().flatten().map(|p| p.y).fold(f32::INFINITY, f32::min));
        }
        out
    }
}

/// The recording without noise.
struct TrueFeet<'a> {
    frames: &'a [Joints],
    /// Height at which toes stand (m).
    floor: f32,
}

impl<'a> TrueFeet<'a> {
    fn new(frames: &'a [Joints]) -> Self {
        let mut heights: Vec<f32> = frames.iter().flat_map(|f| TOES.map(|toe| f.at(toe).position.y)).collect();
        Self { frames, floor: quantile(&mut heights, 0.1).unwrap_or(0.0) }
    }

    fn toes(&self, time_ns: u64) -> [Vec3; 2] {
        sample(self.frames, time_ns).map_or([Vec3::ZERO; 2], |f| TOES.map(|toe| f.at(toe).position))
    }

    /// Whether a toe stands at a time and has stood for the delay before it.
    fn stands(&self, time_ns: u64, foot: usize) -> bool {
        const LOOKS: u64 = 4;
        time_ns >= DELAY_NS
            && (0..=LOOKS).all(|k| {
                let time = time_ns - DELAY_NS * k / LOOKS;
                let [before, after] = [time.saturating_sub(16_000_000), time + 16_000_000].map(|t| self.toes(t)[foot]);
                let speed = before.distance(after) / 0.032;
                speed < TRUE_SPEED && self.toes(time)[foot].y < self.floor + TRUE_HEIGHT
            })
    }

    fn flies(&self, time_ns: u64) -> bool {
        self.toes(time_ns).iter().all(|toe| toe.y > self.floor + TRUE_AIR)
    }
}
