//! From landmarks to joints in our world: directions from the network, lengths from a body of the stature that is known.
//!
//! A network that saw a picture knows no size: people report legs 60 mm apart, and shoulders that are not theirs. So only the directions
//! of limbs are taken; every limb has the length that it has in the mean body of that stature, for every person. A limb can be turned
//! the wrong way, and never be stretched.

use glam::{Mat3, Quat, Vec2, Vec3};
use toile_assets::body::En;
use toile_assets::body::shape::Shapes;
use toile_base::body::Sex;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::skeleton::{Joint, Skeleton};
use toile_sensors::filter::one_euro::{OneEuro, OneEuroSettings};
use toile_sensors::source::joint_map::{Format, JointMap};

use crate::landmarks::{Landmarks, POINTS};
use crate::plausible::{HIPS, SHOULDERS};
use crate::scale::WebcamMount;

/// Ears, left and right.
const EARS: [usize; 2] = [7, 8];

/// Knees, ankles and heels.
const KNEES: [usize; 2] = [25, 26];
const ANKLES: [usize; 2] = [27, 28];
const HEELS: [usize; 2] = [29, 30];

/// How sure landmarks have to be to say where a person stands.
const SURE: f32 = 0.5;

/// Fewest landmarks that say it.
const FEWEST: usize = 4;

/// Distances of a person from the camera (m).
const DISTANCES: std::ops::RangeInclusive<f32> = 0.3..=12.0;

/// Frames of a person who steps in, in which they stand upright to be measured (1): a second.
const STANDING: u32 = 30;

/// Largest lean that is the camera's or the network's, and not a person's own (rad): 40 degrees.
const LARGEST_LEAN: f32 = 0.7;

/// Smoothing of a person's distance (m): a person who comes nearer at 1 m/s is some 150 mm behind.
const DISTANCE: OneEuroSettings = OneEuroSettings { min_cutoff: 0.6, beta: 0.5 };

/// Longest time between two frames across which a distance is smoothed (s).
const LONGEST: f32 = 0.5;

/// Landmarks of an arm: shoulder, elbow, wrist; and of the hand, whose middle is taken: little finger, forefinger.
const ARMS: [([usize; 3], [usize; 2]); 2] = [([11, 13, 15], [17, 19]), ([12, 14, 16], [18, 20])];

/// Landmarks of a leg: hip, knee, ankle, tip of the foot.
const LEGS: [[usize; 4]; 2] = [[23, 25, 27, 31], [24, 26, 28, 32]];

/// Lengths of the limbs of one body (m).
#[derive(Debug, Clone, Copy, PartialEq)]
struct LimbLengths {
    hips: f32,
    shoulders: f32,
    trunk: f32,
    head: f32,
    arm: [f32; 3],
    leg: [f32; 3],
    /// Heights of ankle and toes above the floor, and of the hips.
    ankle: f32,
    toe: f32,
    hip: f32,
    /// By how much trunk, thighs and shins lean at rest (rad).
    leans: [f32; 3],
}

impl LimbLengths {
    fn of(skeleton: &Skeleton, scale: f32) -> Self {
        use Joint::*;
        let at = |joint: Joint| skeleton.at(joint) * scale;
        let apart = |a: Joint, b: Joint| at(a).distance(at(b));
        let middle = |a: Joint, b: Joint| (at(a) + at(b)) * 0.5;
        let (hips, shoulders) = (middle(LeftHip, RightHip), middle(LeftShoulder, RightShoulder));
        let (knees, ankles) = (middle(LeftKnee, RightKnee), middle(LeftAnkle, RightAnkle));
        Self {
            hips: apart(LeftHip, RightHip),
            shoulders: apart(LeftShoulder, RightShoulder),
            trunk: hips.distance(shoulders),
            head: shoulders.distance(at(Head)),
            arm: [apart(LeftShoulder, LeftElbow), apart(LeftElbow, LeftWrist), apart(LeftWrist, LeftHand)],
            leg: [apart(LeftHip, LeftKnee), apart(LeftKnee, LeftAnkle), apart(LeftAnkle, LeftToe)],
            ankle: at(LeftAnkle).y,
            toe: at(LeftToe).y,
            hip: hips.y,
            leans: [(shoulders, hips), (hips, knees), (knees, ankles)]
                .map(|(upper, lower)| lean((upper - lower) * Vec3::new(1.0, -1.0, -1.0))),
        }
    }
}

/// By how much a person leans away from the camera (rad); camera axes.
fn lean(up: Vec3) -> f32 {
    up.z.atan2(-up.y)
}

/// Puts landmarks into our world.
#[derive(Debug)]
pub struct JointPlacer {
    mean: Skeleton,
    mean_stature: f32,
    map: JointMap,
    mount: WebcamMount,
    /// Their distance from frame to frame.
    distance: FollowedDistance,
    /// Distance at which the followed person was first seen (m): they begin at the middle of our world.
    first: Option<f32>,
    /// Leans of trunk, thighs and shins of the followed person in their first frames (rad), and the number of these frames.
    leans: ([f32; 3], u32),
}

impl JointPlacer {
    /// For bodies like the mean of a sex, and a camera that stands so.
    pub fn new(sex: Sex, mount: WebcamMount) -> Self {
        let shapes = Shapes::of(sex);
        let mean_stature = shapes.read(shapes.mean()).readings.of(En::Stature);
        let mean = shapes.skeleton(shapes.mean());
        Self {
            mean,
            mean_stature,
            map: JointMap::of(Format::MediaPipe33),
            mount,
            distance: FollowedDistance::default(),
            first: None,
            leans: ([0.0; 3], 0),
        }
    }

    /// Another person may stand there.
    pub fn reset(&mut self) {
        self.distance = FollowedDistance::default();
        (self.first, self.leans) = (None, ([0.0; 3], 0));
    }

    /// Joints of landmarks in a picture of this size (px), for a person of this stature (m).
    pub fn joints(&mut self, landmarks: &Landmarks, size: [u32; 2], stature: f32, time_ns: u64) -> Joints {
        let lengths = LimbLengths::of(&self.mean, stature / self.mean_stature);
        let level = self.level(landmarks, size);
        let mut world = landmarks.points.map(|p| level * p.world);
        let confidence = landmarks.points.map(|p| p.confidence);
        self.learn_leans(&world, &confidence, &lengths.leans);
        upright(&mut world, &self.leans.0);
        let mut points = with_lengths(&world, &confidence, &lengths);
        let camera = self.place(landmarks, size, &points, level, time_ns);
        let up = above_floor(&points, &lengths);
        for point in &mut points {
            let p = point.position;
            point.position = Vec3::new(p.x + camera.x, up - p.y, camera.y - p.z);
        }
        self.map.joints(time_ns, &points)
    }

    /// From the network's axes to level ones. It gives a body as seen along the ray to its hips: a camera that looks down, or has a person
    /// beside the middle of its picture, sees them turned by as much.
    fn level(&self, landmarks: &Landmarks, [w, h]: [u32; 2]) -> Mat3 {
        let focal = self.mount.focal * w.max(h) as f32;
        let hips = (landmarks.points[HIPS[0]].pixel + landmarks.points[HIPS[1]].pixel) * 0.5;
        let ray = (hips - Vec2::new(w as f32, h as f32) * 0.5).extend(focal).normalize_or(Vec3::Z);
        Mat3::from_rotation_x(-self.mount.down) * Mat3::from_quat(Quat::from_rotation_arc(Vec3::Z, ray))
    }

    /// A person who steps in stands upright for a second. The network bends them: the trunk towards the camera, the shins away from it, by ten
    /// degrees and more. What each is off then, it is off by later too.
    fn learn_leans(&mut self, world: &[Vec3; POINTS], confidence: &[f32; POINTS], rest: &[f32; 3]) {
        let (means, count) = &mut self.leans;
        let middle = |[a, b]: [usize; 2]| (world[a] + world[b]) * 0.5;
        let pairs = [[SHOULDERS, HIPS], [HIPS, KNEES], [KNEES, ANKLES]];
        let seen = pairs.iter().flatten().flatten().all(|k| confidence[*k] >= SURE);
        let mut found = pairs.map(|[upper, lower]| lean(middle(upper) - middle(lower)));
        found.iter_mut().zip(rest).for_each(|(found, rest)| *found -= rest);
        if seen && *count < STANDING && found.iter().all(|lean| lean.abs() <= LARGEST_LEAN) {
            *count += 1;
            means.iter_mut().zip(found).for_each(|(mean, found)| *mean += (found - *mean) / *count as f32);
        }
    }

    /// Where the hips are: to the left of the camera's axis and towards it from where they were first (m).
    fn place(
        &mut self,
        landmarks: &Landmarks,
        [w, h]: [u32; 2],
        points: &[TrackedJoint; POINTS],
        level: Mat3,
        time_ns: u64,
    ) -> Vec2 {
        let focal = self.mount.focal * w.max(h) as f32;
        let unlevel = level.transpose();
        let seen = |k: &usize| landmarks.points[*k].confidence.min(points[*k].confidence) >= SURE;
        let known = || (SHOULDERS[0]..POINTS).filter(seen);
        let count = known().count();
        let flat = |k: usize| (unlevel * points[k].position).truncate();
        let mean = |of: &dyn Fn(usize) -> Vec2| known().map(of).sum::<Vec2>() / count.max(1) as f32;
        let (pixel, metre) = (mean(&|k| landmarks.points[k].pixel), mean(&flat));
        let (mut along, mut square) = (0.0, 0.0);
        for k in known() {
            let m = flat(k) - metre;
            along += m.dot(landmarks.points[k].pixel - pixel);
            square += m.length_squared();
        }
        let distance = focal * square / along;
        if count < FEWEST || !DISTANCES.contains(&distance) {
            return Vec2::ZERO;
        }
        let distance = self.distance.follow(distance, time_ns);
        let first = *self.first.get_or_insert(distance);
        let across = (pixel.x - 0.5 * w as f32) * distance / focal - metre.x;
        Vec2::new(across, first - distance)
    }
}

/// How far away a person is from frame to frame: people do not come nearer by jumps, and an error in a limb's direction looks like one.
#[derive(Debug, Clone, Copy, Default)]
struct FollowedDistance {
    filter: OneEuro,
    last_ns: Option<u64>,
}

impl FollowedDistance {
    fn follow(&mut self, measured: f32, time_ns: u64) -> f32 {
        let measured = Vec3::Z * measured;
        let dt = self.last_ns.map(|last| time_ns.saturating_sub(last) as f32 * 1e-9).filter(|dt| *dt <= LONGEST);
        self.last_ns = Some(time_ns);
        match dt {
            None => self.filter = OneEuro { level: measured, velocity: Vec3::ZERO },
            Some(dt) => self.filter.update(measured, dt, self.filter.speed(measured, dt), &DISTANCE),
        }
        self.filter.level.z
    }
}

/// Turns trunk, thighs and shins back by so much (rad); arms, head and feet keep their directions.
fn upright(world: &mut [Vec3; POINTS], leans: &[f32; 3]) {
    let [trunk, thigh, shin] = leans.map(Mat3::from_rotation_x);
    let before = *world;
    let middle = |[a, b]: [usize; 2]| (before[a] + before[b]) * 0.5;
    let own = middle(SHOULDERS) - middle(HIPS);
    let moved = trunk * own - own;
    world[..HIPS[0]].iter_mut().for_each(|point| *point += moved);
    for ([hip, knee, ankle, toe], heel) in LEGS.into_iter().zip(HEELS) {
        world[knee] = before[hip] + thigh * (before[knee] - before[hip]);
        world[ankle] = world[knee] + shin * (before[ankle] - before[knee]);
        [toe, heel].iter().for_each(|k| world[*k] += world[ankle] - before[ankle]);
    }
}

/// Points with the lengths of a body, from the middle of the hips; camera axes: x right, y down, z away.
fn with_lengths(world: &[Vec3; POINTS], confidence: &[f32; POINTS], lengths: &LimbLengths) -> [TrackedJoint; POINTS] {
    let mut out = [TrackedJoint::default(); POINTS];
    let middle = |[a, b]: [usize; 2]| (world[a] + world[b]) * 0.5;
    let both = |[a, b]: [usize; 2]| confidence[a].min(confidence[b]);
    let joint = |position: Vec3, confidence: f32| TrackedJoint { position, confidence };
    // A direction of no length is none: what hangs from it is not seen.
    let along = |from: TrackedJoint, towards: Vec3, length: f32, seen: f32| {
        let direction = towards.normalize_or_zero();
        let seen = if direction == Vec3::ZERO { 0.0 } else { seen.min(from.confidence) };
        joint(from.position + direction * length, seen)
    };
    let pair = |out: &mut [TrackedJoint; POINTS], middle: Vec3, [a, b]: [usize; 2], apart: f32| {
        let half = (world[a] - world[b]).normalize_or_zero() * (0.5 * apart);
        out[a] = joint(middle + half, confidence[a]);
        out[b] = joint(middle - half, confidence[b]);
    };
    pair(&mut out, Vec3::ZERO, HIPS, lengths.hips);
    let root = joint(Vec3::ZERO, 1.0);
    let chest = along(root, middle(SHOULDERS) - middle(HIPS), lengths.trunk, both(SHOULDERS));
    pair(&mut out, chest.position, SHOULDERS, lengths.shoulders);
    let head = along(chest, middle(EARS) - middle(SHOULDERS), lengths.head, both(EARS));
    EARS.iter().for_each(|k| out[*k] = head);
    for ([shoulder, elbow, wrist], hand) in ARMS {
        out[elbow] = along(out[shoulder], world[elbow] - world[shoulder], lengths.arm[0], confidence[elbow]);
        out[wrist] = along(out[elbow], world[wrist] - world[elbow], lengths.arm[1], confidence[wrist]);
        let end = along(out[wrist], middle(hand) - world[wrist], lengths.arm[2], both(hand));
        hand.iter().for_each(|k| out[*k] = end);
    }
    for [hip, knee, ankle, toe] in LEGS {
        out[knee] = along(out[hip], world[knee] - world[hip], lengths.leg[0], confidence[knee]);
        out[ankle] = along(out[knee], world[ankle] - world[knee], lengths.leg[1], confidence[ankle]);
        out[toe] = along(out[ankle], world[toe] - world[ankle], lengths.leg[2], confidence[toe]);
    }
    out
}

/// Height of the middle of the hips (m): the lower foot stands on the floor.
fn above_floor(points: &[TrackedJoint; POINTS], lengths: &LimbLengths) -> f32 {
    let feet = LEGS.iter().flat_map(|[.., ankle, toe]| [(*ankle, lengths.ankle), (*toe, lengths.toe)]);
    let lowest = feet.filter(|(k, _)| points[*k].confidence >= SURE).map(|(k, rest)| points[k].position.y + rest);
    lowest.reduce(f32::max).unwrap_or(lengths.hip)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::landmarks::PoseLandmark;

    /// A person of the network's own idea of size, upright before a level camera, seen from a distance.
    fn person(scale: f32, distance: f32) -> Landmarks {
        let shapes = Shapes::of(Sex::Female);
        let skeleton = shapes.skeleton(shapes.mean());
        let places = [
            (7, Joint::Head),
            (8, Joint::Head),
            (11, Joint::LeftShoulder),
            (12, Joint::RightShoulder),
            (13, Joint::LeftElbow),
            (14, Joint::RightElbow),
            (15, Joint::LeftWrist),
            (16, Joint::RightWrist),
            (17, Joint::LeftHand),
            (18, Joint::RightHand),
            (19, Joint::LeftHand),
            (20, Joint::RightHand),
            (23, Joint::LeftHip),
            (24, Joint::RightHip),
            (25, Joint::LeftKnee),
            (26, Joint::RightKnee),
            (27, Joint::LeftAnkle),
            (28, Joint::RightAnkle),
            (31, Joint::LeftToe),
            (32, Joint::RightToe),
        ];
        let hips = (skeleton.at(Joint::LeftHip) + skeleton.at(Joint::RightHip)) * 0.5;
        let mut points = [PoseLandmark::default(); POINTS];
        for (k, joint) in places {
            let p = skeleton.at(joint) - hips;
            let world = Vec3::new(p.x, -p.y, -p.z);
            let pixel = Vec2::new(640.0, 360.0) + world.truncate() * (0.87 * 1280.0 / distance);
            points[k] = PoseLandmark { pixel, world: world * scale, confidence: 0.9 };
        }
        Landmarks { presence: 1.0, points, next: Default::default() }
    }

    #[test]
    fn the_same_body_comes_out_whatever_size_the_network_gives_it() {
        let mut placer = JointPlacer::new(Sex::Female, WebcamMount::default());
        let stature = placer.mean_stature;
        let one = placer.joints(&person(1.0, 2.5), [1280, 720], stature, 7);
        let other = placer.joints(&person(0.7, 2.5), [1280, 720], stature, 7);
        for joint in Joint::ALL {
            assert!(one.at(joint).position.distance(other.at(joint).position) < 1e-4, "{joint:?}");
        }
        let mean = placer.mean.clone();
        for joint in [Joint::LeftShoulder, Joint::RightWrist, Joint::LeftHip, Joint::RightAnkle] {
            let apart = one.at(joint).position.distance(mean.at(joint) - Vec3::Z * mean.at(Joint::LeftHip).z);
            assert!(apart < 0.02, "{joint:?} is {apart} m from where it is at rest");
        }
        assert!(one.is_valid() && one.time_ns == 7);
    }

    #[test]
    fn a_step_to_the_side_and_towards_the_camera_is_seen() {
        let mut placer = JointPlacer::new(Sex::Female, WebcamMount::default());
        let stature = placer.mean_stature;
        placer.joints(&person(1.0, 3.0), [1280, 720], stature, 0);
        let mut near = person(1.0, 2.5);
        near.points.iter_mut().for_each(|p| p.pixel.x += 0.4 * 0.87 * 1280.0 / 2.5);
        // Across at once as far as the distance is known, nearer within a second or so.
        let hips = |placer: &mut JointPlacer, seen: &Landmarks, picture: u64| {
            placer.joints(seen, [1280, 720], stature, picture * 33_000_000).at(Joint::LeftHip).position
        };
        let mut hip = Vec3::ZERO;
        for picture in 1..40 {
            hip = hips(&mut placer, &near, picture);
        }
        let own = placer.mean.at(Joint::LeftHip);
        assert!((hip.x - 0.4 - own.x).abs() < 0.01 && (hip.z - 0.5).abs() < 0.02, "{hip}");
        // One picture in which they seem to be elsewhere moves them little.
        let jumped = hips(&mut placer, &person(1.0, 3.0), 40);
        assert!((jumped.z - hip.z).abs() < 0.16, "{hip}, then {jumped}");
    }

    #[test]
    fn an_upright_person_is_upright_under_tilted_cameras() {
        let down = 0.3;
        let mut placer = JointPlacer::new(Sex::Female, WebcamMount { down, ..WebcamMount::default() });
        let stature = placer.mean_stature;
        let mut tilted = person(1.0, 2.5);
        // What is above the hips comes nearer.
        tilted.points.iter_mut().for_each(|p| p.world = Mat3::from_rotation_x(down) * p.world);
        assert!(tilted.points[11].world.z < -0.1);
        let joints = placer.joints(&tilted, [1280, 720], stature, 0);
        let trunk = |joints: &Joints| joints.at(Joint::LeftShoulder).position - joints.at(Joint::LeftHip).position;
        let own = placer.mean.at(Joint::LeftShoulder) - placer.mean.at(Joint::LeftHip);
        assert!(trunk(&joints).angle_between(own) < 0.02, "{} instead of {own}", trunk(&joints));
        // An unknown tilt is learnt from a person who steps in upright; a person who bends afterwards is bent.
        let mut placer = JointPlacer::new(Sex::Female, WebcamMount::default());
        let upright = (0..STANDING).map(|_| placer.joints(&tilted, [1280, 720], stature, 0)).last().unwrap();
        assert!(trunk(&upright).angle_between(own) < 0.02, "{} instead of {own}", trunk(&upright));
        tilted.points.iter_mut().for_each(|p| p.world = Mat3::from_rotation_x(0.5) * p.world);
        let bent = trunk(&placer.joints(&tilted, [1280, 720], stature, 0)).angle_between(own);
        assert!((bent - 0.5).abs() < 0.05, "{bent}");
    }

    #[test]
    fn what_is_not_seen_is_absent_and_nothing_is_stretched() {
        let mut placer = JointPlacer::new(Sex::Male, WebcamMount::default());
        let mut hidden = person(1.0, 3.0);
        hidden.points[25].confidence = 0.1;
        hidden.points[14].world = hidden.points[12].world;
        hidden.points[28].world = Vec3::splat(50.0);
        let joints = placer.joints(&hidden, [1280, 720], 1.8, 0);
        assert!(!joints.at(Joint::LeftKnee).is_believed() && !joints.at(Joint::LeftAnkle).is_believed());
        assert!(!joints.at(Joint::RightElbow).is_believed());
        let shin = joints.at(Joint::RightKnee).position.distance(joints.at(Joint::RightAnkle).position);
        assert!((0.3..0.5).contains(&shin), "{shin}");
    }
}
