//! Simulated hands of spheres and cones before a depth camera: spread, stretched and closed.

use std::f32::consts::TAU;

use glam::{Quat, Vec3};
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_base::numeric::random::SplitMix64;
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera};
use toile_track::gesture::{Grip, HandRegion, HandSegmenter, HandShape};

toile_base::named! {
    /// What a hand is like.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum HandPose {
        /// Open, fingers spread.
        Spread = "open, fingers spread",
        /// Open, fingers together.
        Stretched = "open, fingers together",
        /// Closed to a fist.
        Fist = "closed",
    }
}

/// How hands of one pose were classified at one distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GripRow {
    /// The pose; its changes are those into it.
    pub pose: HandPose,
    /// Distance of the shopper (m).
    pub distance: f32,
    /// Frames that were classified.
    pub frames: u32,
    /// Frames classified wrongly.
    pub wrong: u32,
    /// Frames in which no hand was found.
    pub unseen: u32,
    /// Frames classified wrongly by the gap alone.
    pub wrong_by_gap: u32,
    /// Frames classified wrongly by solidity alone.
    pub wrong_by_solidity: u32,
    /// Changes from another pose.
    pub changes: u32,
    /// Changes that gave no event.
    pub missed: u32,
    /// Events without a change.
    pub false_events: u32,
    /// Mean and standard deviation of solidity, spread and gap.
    pub features: [[f32; 2]; 3],
}

/// Length of a hand (m), ANSUR II women and men.
const LENGTHS: [[f32; 2]; 2] = [[0.1812, 0.0096], [0.1933, 0.0099]];

/// Error of the hand joint and the wrist of a tracker (m), and of the length it takes a hand for (relative).
const OFF: f32 = 0.012;
const LENGTH_OFF: f32 = 0.06;

/// How far a hand is turned from facing the camera upright (rad, standard deviations: pitch, yaw, roll).
const TURNS: [f32; 3] = [0.25, 0.35, 0.35];

/// Frames of each pose in a change.
const FRAMES: u32 = 24;

/// Fingers of a hand of length 1: root (across from the thumb's side, up from the wrist), spread (rad), length, radius.
const FINGERS: [([f32; 2], f32, f32, f32); 4] = [
    ([0.14, 0.50], 0.24, 0.38, 0.046),
    ([0.045, 0.53], 0.07, 0.43, 0.046),
    ([-0.05, 0.52], -0.10, 0.40, 0.044),
    ([-0.135, 0.47], -0.30, 0.32, 0.040),
];

/// A surface under construction.
#[derive(Default)]
struct HandMesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl HandMesh {
    /// A cone with round ends between two points.
    fn cone(&mut self, a: Vec3, b: Vec3, [ra, rb]: [f32; 2]) {
        const AROUND: u32 = 10;
        let along = (b - a).try_normalize().unwrap_or(Vec3::Y);
        let side = along.any_orthonormal_vector();
        // Rings of the round ends at 80, 50 and 0 degrees.
        let ring = [(-0.985, 0.17), (-0.766, 0.643), (0.0, 1.0)];
        let near = ring.map(|(x, r)| (a + along * (x * ra), r * ra));
        let far = ring.map(|(x, r)| (b - along * (x * rb), r * rb));
        let first = self.positions.len() as u32;
        for (centre, radius) in near.into_iter().chain(far.into_iter().rev()) {
            for k in 0..AROUND {
                let turn = Quat::from_axis_angle(along, TAU * k as f32 / AROUND as f32);
                self.positions.push(centre + turn * side * radius);
            }
        }
        for r in 0..5 {
            for k in 0..AROUND {
                let [p, q] = [k, (k + 1) % AROUND].map(|k| first + r * AROUND + k);
                self.triangles.extend([[p, q, p + AROUND], [q, q + AROUND, p + AROUND]]);
            }
        }
    }

    /// A hand of length 1 that faces +z with its fingers up, the wrist at the origin, and its forearm.
    fn hand(pose: HandPose, rng: &mut SplitMix64) -> Self {
        let mut solid = Self::default();
        let v = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        solid.cone(v(0.0, -1.2, -0.05), v(0.0, -0.02, 0.0), [0.22, 0.145]);
        for x in [-0.10, -0.035, 0.035, 0.10] {
            solid.cone(v(0.6 * x, 0.06, 0.0), v(1.1 * x, 0.46, 0.0), [0.085, 0.075]);
        }
        let thumb = match pose {
            HandPose::Spread => [v(0.17, 0.14, 0.02), v(0.30, 0.30, 0.04), v(0.38, 0.47, 0.05)],
            HandPose::Stretched => [v(0.15, 0.14, 0.04), v(0.20, 0.33, 0.06), v(0.20, 0.52, 0.06)],
            HandPose::Fist => [v(0.15, 0.16, 0.05), v(0.16, 0.33, 0.14), v(0.02, 0.38, 0.20)],
        };
        thumb.windows(2).for_each(|w| solid.cone(w[0], w[1], [0.06, 0.052]));
        for (root, angle, length, radius) in FINGERS {
            let root = v(root[0], root[1], 0.0);
            let own = 0.05 * rng.gaussian();
            if pose == HandPose::Fist {
                // Two bones curl forward into the palm.
                let knuckle = root + v(0.0, 0.02, 0.17);
                solid.cone(root, knuckle, [1.1 * radius; 2]);
                solid.cone(knuckle, knuckle - v(0.0, 0.17, 0.01), [radius; 2]);
                continue;
            }
            let spread = if pose == HandPose::Spread { angle } else { 0.12 * angle };
            let bent = 0.12 + 0.1 * rng.uniform();
            let tip = Quat::from_rotation_z(-(spread + own * 0.6)) * v(0.0, length, length * bent);
            solid.cone(root, root + tip, [radius, 0.85 * radius]);
        }
        solid
    }
}

/// One hand held up before a camera, in one pose.
struct HeldHand {
    solid: HandMesh,
    wrist: Vec3,
    palm: Vec3,
    along: Vec3,
}

/// A place to hold a hand up at, and the person it belongs to.
struct HandScene {
    camera: SyntheticCamera,
    noise: KinectNoise,
    length: f32,
    assumed: f32,
    wrist: Vec3,
    turn: Quat,
    mirrored: bool,
    image: Vec<f32>,
}

impl HandScene {
    fn new(distance: f32, rng: &mut SplitMix64) -> Self {
        let [mean, sd] = LENGTHS[(rng.next_u64() & 1) as usize];
        let length = mean + sd * rng.gaussian();
        // The window of a Kinect's image about the hand: the rest of the picture costs time and shows nothing.
        let half = (0.42 * 575.8 / distance).ceil() as u32;
        let centre = half as f32 - 0.5;
        let intrinsics = Intrinsics { width: 2 * half, height: 2 * half, fx: 575.8, fy: 575.8, cx: centre, cy: centre };
        let camera = SyntheticCamera::looking_at(intrinsics, Vec3::new(0.0, 0.0, distance), Vec3::ZERO);
        let [pitch, yaw, roll] = TURNS.map(|sd| sd * rng.gaussian().clamp(-2.0, 2.0));
        let pixels = intrinsics.pixels();
        Self {
            camera,
            noise: KinectNoise::new(rng.next_u64()),
            length,
            assumed: length * (1.0 + LENGTH_OFF * rng.gaussian()),
            wrist: Vec3::new(0.03 * rng.gaussian(), -0.1 + 0.03 * rng.gaussian(), 0.0),
            turn: Quat::from_rotation_z(roll) * Quat::from_rotation_y(yaw) * Quat::from_rotation_x(pitch),
            mirrored: rng.next_u64() & 1 == 0,
            image: vec![0.0; pixels],
        }
    }

    fn held(&self, pose: HandPose, rng: &mut SplitMix64) -> HeldHand {
        let mut solid = HandMesh::hand(pose, rng);
        let flip = if self.mirrored { Vec3::new(-1.0, 1.0, 1.0) } else { Vec3::ONE };
        let world = |p: Vec3| self.wrist + self.turn * (p * flip * self.length);
        solid.positions.iter_mut().for_each(|p| *p = world(*p));
        // The trunk behind, an arm's length away.
        let first = solid.positions.len() as u32;
        let trunk = [[-0.25, -0.6], [0.25, -0.6], [-0.25, 0.1], [0.25, 0.1]];
        solid.positions.extend(trunk.map(|[x, y]| Vec3::new(x + 0.15, y, -0.45)));
        solid.triangles.extend([[0, 1, 2], [1, 3, 2]].map(|t| t.map(|i| first + i)));
        HeldHand { solid, wrist: self.wrist, palm: world(Vec3::new(0.0, 0.3, 0.0)), along: self.turn * Vec3::Y }
    }

    /// One frame, and where a tracker says that the hand is; the hand trembles.
    fn frame(&mut self, held: &HeldHand, rng: &mut SplitMix64) -> (DepthFrame, HandRegion) {
        let mut off = |by: f32| Vec3::new(rng.gaussian(), rng.gaussian(), rng.gaussian()) * by;
        let shift = off(0.003);
        let moved: Vec<Vec3> = held.solid.positions.iter().map(|p| *p + shift).collect();
        self.camera.render(&moved, &held.solid.triangles, &mut self.image);
        let depth = self.noise.apply(&self.camera.intrinsics, &self.image);
        let sight = HandRegion {
            palm: held.palm + off(OFF),
            wrist: Some(held.wrist + off(OFF)),
            along: (held.along + off(0.06)).normalize(),
            length: self.assumed,
        };
        (self.camera.frame(0, depth), sight)
    }
}

/// A spread hand held up at a distance (m): a frame, and where a tracker says that the hand is.
pub fn held_up(distance: f32, seed: u64) -> (DepthFrame, HandRegion) {
    let mut rng = SplitMix64::new(seed);
    let mut scene = HandScene::new(distance, &mut rng);
    let held = scene.held(HandPose::Spread, &mut rng);
    scene.frame(&held, &mut rng)
}

/// What is summed up of one pose at one distance.
struct GripSum {
    row: GripRow,
    shapes: Vec<HandShape>,
}

impl GripSum {
    fn new(pose: HandPose, distance: f32) -> Self {
        let row = GripRow {
            pose,
            distance,
            frames: 0,
            wrong: 0,
            unseen: 0,
            wrong_by_gap: 0,
            wrong_by_solidity: 0,
            changes: 0,
            missed: 0,
            false_events: 0,
            features: [[0.0; 2]; 3],
        };
        Self { row, shapes: Vec::new() }
    }

    fn add(&mut self, shape: Option<HandShape>) {
        let row = &mut self.row;
        row.frames += 1;
        let Some(shape) = shape else {
            row.unseen += 1;
            return;
        };
        let open = row.pose != HandPose::Fist;
        row.wrong += u32::from((shape.openness() > 0.5) != open);
        row.wrong_by_gap += u32::from(shape.is_open_by_gap() != open);
        row.wrong_by_solidity += u32::from(shape.is_open_by_solidity() != open);
        self.shapes.push(shape);
    }

    fn row(self) -> GripRow {
        let n = self.shapes.len().max(1) as f32;
        let feature = |of: fn(&HandShape) -> f32| {
            let mean = self.shapes.iter().map(of).sum::<f32>() / n;
            [mean, (self.shapes.iter().map(|s| (of(s) - mean).powi(2)).sum::<f32>() / n).sqrt()]
        };
        GripRow { features: [feature(|s| s.solidity), feature(|s| s.spread), feature(|s| s.gap)], ..self.row }
    }
}

/// Tells so many hands of each pose at each distance: each hand changes from an open pose to a fist and back.
pub fn grips(distances: &[f32], hands: u32, seed: u64) -> Vec<GripRow> {
    let mut rows = Vec::new();
    let mut segmenter = HandSegmenter::new();
    for (k, &distance) in distances.iter().enumerate() {
        let mut sums = HandPose::ALL.map(|pose| GripSum::new(pose, distance));
        for hand in 0..hands {
            let mut rng = SplitMix64::new(seed + 1_000_000 * (k as u64 + 1) + u64::from(hand));
            let mut scene = HandScene::new(distance, &mut rng);
            let open = usize::from(hand % 2 == 1);
            let mut grip = Grip::new();
            let mut time_ns = 0;
            for (turn, i) in [open, 2, open].into_iter().enumerate() {
                let pose = HandPose::ALL[i];
                let held = scene.held(pose, &mut rng);
                let mut found = 0;
                for _ in 0..FRAMES {
                    let (frame, sight) = scene.frame(&held, &mut rng);
                    let shape = segmenter.shape(&frame, &sight);
                    sums[i].add(shape);
                    found += u32::from(grip.step(time_ns, shape.map(|s| s.openness())).is_some());
                    time_ns += 33_333_333;
                }
                let wanted = u32::from(turn > 0);
                sums[i].row.changes += wanted;
                sums[i].row.missed += wanted.saturating_sub(found);
                sums[i].row.false_events += found.saturating_sub(wanted);
            }
        }
        rows.extend(sums.map(GripSum::row));
    }
    rows
}
