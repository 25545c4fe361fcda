//! The two depth cameras of the study, each with small errors of its calibration.

use glam::{Affine3A, Quat, Vec3};
use toile_base::frame::{DepthFrame, Intrinsics};
use toile_base::numeric::random::SplitMix64;
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera};

use super::second_noise;
use super::standing::{JointPositions, Moment, StudyPerson};

toile_base::named! {
    /// A kind of depth camera.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Sensor {
        /// Kinect v1, upright: noise, quantisation, edge shadow and dropout after Nguyen, Izadi and Lovell (2012).
        Kinect = "kinect",
        /// A time-of-flight camera like the Azure Kinect, narrow field of view, unbinned.
        Azure = "azure",
    }
}

impl Sensor {
    /// What the camera says of itself.
    const fn stated(self) -> Intrinsics {
        match self {
            Self::Kinect => Intrinsics::KINECT_V1,
            Self::Azure => Intrinsics { width: 640, height: 576, fx: 504.0, fy: 504.0, cx: 320.0, cy: 330.0 },
        }
    }

    /// Distances at which people stand (m).
    pub const fn distances(self) -> [f32; 2] {
        match self {
            Self::Kinect => [2.0, 3.0],
            Self::Azure => [2.0, 2.5],
        }
    }
}

/// How far a calibrated camera is off what it says: focal length (relative), principal point (px), height (m), tilt
/// (rad) and, of a time-of-flight camera, all of its depths together (m).
const FOCAL: f32 = 0.0015;
const PRINCIPAL: f32 = 0.5;
const HEIGHT: f32 = 0.002;
const TILT: f32 = 0.0009;
const OFFSET: f32 = 0.003;

/// Height of the camera above the floor (m).
const EYE: f32 = 1.0;

/// Half the sides of the floor, and the height and the distance of the wall behind (m).
const ROOM: [f32; 3] = [4.0, 3.0, 1.5];

/// Standard deviation of a time-of-flight depth at 1 m and what each square metre adds (m): 1.6 mm at 2 m.
const FLIGHT: [f32; 2] = [0.0008, 0.0002];

/// Share of the pixels at an edge that see both surfaces and lie between them.
const FLYING: f32 = 0.35;

/// Jump of depth that is an edge (m).
const EDGE: f32 = 0.05;

/// Cosine of the angle to the surface's normal below which so little light comes back that a pixel is lost.
const GRAZING: f32 = 0.12;

/// Whose model of the noise a camera has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoiseModel {
    /// Nguyen, Izadi and Lovell (2012) for the Kinect v1, independent pixels for the time of flight.
    First,
    /// Khoshelham and Elberink (2012) with pixels that go together, a shadow and ragged outlines; mixed pixels and a ripple
    /// for the time of flight.
    Second,
}

/// A person before a camera.
pub struct StudyCamera {
    stated: SyntheticCamera,
    seen: SyntheticCamera,
    sensor: Sensor,
    noise: NoiseModel,
    offset: f32,
    /// Distance of the person (m).
    pub distance: f32,
}

impl StudyCamera {
    /// A camera of a kind, before a person at the origin.
    pub fn new(sensor: Sensor, noise: NoiseModel, rng: &mut SplitMix64) -> Self {
        let [near, far] = sensor.distances();
        let distance = near + (far - near) * rng.uniform();
        let stated = sensor.stated();
        let mut camera =
            SyntheticCamera::looking_at(stated, Vec3::new(0.0, EYE, distance), Vec3::new(0.0, EYE - 0.05, 0.0));
        if sensor == Sensor::Kinect {
            // 43 degrees are too few for a whole person at 2 m: it stands on its side.
            let roll = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
            camera.camera_to_world *= Affine3A::from_quat(roll);
        }
        let scale = 1.0 + FOCAL * rng.gaussian();
        let intrinsics = Intrinsics {
            fx: stated.fx * scale,
            fy: stated.fy * scale,
            cx: stated.cx + PRINCIPAL * rng.gaussian(),
            cy: stated.cy + PRINCIPAL * rng.gaussian(),
            ..stated
        };
        let place = camera.camera_to_world.translation + glam::Vec3A::Y * (HEIGHT * rng.gaussian());
        let tilt = Quat::from_rotation_x(TILT * rng.gaussian());
        let turned = Affine3A::from_quat(tilt).matrix3 * camera.camera_to_world.matrix3;
        let camera_to_world = Affine3A { matrix3: turned, translation: place };
        let offset = if sensor == Sensor::Azure { OFFSET * rng.gaussian() } else { 0.0 };
        Self { stated: camera, seen: SyntheticCamera { intrinsics, camera_to_world }, sensor, noise, offset, distance }
    }

    /// The swaying person at some moments, and where their joints are in each.
    pub fn frames(
        &self,
        person: &StudyPerson,
        moments: &[Moment],
        rng: &mut SplitMix64,
    ) -> Vec<(DepthFrame, JointPositions)> {
        let mut kinect = KinectNoise::new(rng.next_u64());
        let mut positions = Vec::new();
        let mut image = vec![0.0; self.seen.intrinsics.pixels()];
        let mut triangles = person.triangles().to_vec();
        let mut frames = Vec::with_capacity(moments.len());
        for (i, moment) in moments.iter().enumerate() {
            let joints = person.stand(*moment, rng, &mut positions);
            let n = positions.len() as u32;
            if i == 0 {
                triangles.extend([[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]].map(|t: [u32; 3]| t.map(|k| n + k)));
            }
            let [side, high, behind] = ROOM;
            for (y, z) in [(0.0, side), (0.0, -behind), (high, -behind)] {
                positions.extend([Vec3::new(-side, y, z), Vec3::new(side, y, z)]);
            }
            self.seen.render(&positions, &triangles, &mut image);
            let depth = match (self.sensor, self.noise) {
                (Sensor::Kinect, NoiseModel::First) => kinect.apply(&self.seen.intrinsics, &image),
                (Sensor::Azure, NoiseModel::First) => self.flight(&image, rng),
                (Sensor::Kinect, NoiseModel::Second) => {
                    second_noise::structured_light(&self.seen.intrinsics, &image, rng)
                }
                (Sensor::Azure, NoiseModel::Second) => {
                    second_noise::time_of_flight(&self.seen.intrinsics, &image, self.offset, rng)
                }
            };
            frames.push((self.stated.frame((moment.time * 1e9).round() as u64, depth), joints));
        }
        frames
    }

    /// A time-of-flight image (mm, 0 = nothing) of a rendered one (m).
    fn flight(&self, image: &[f32], rng: &mut SplitMix64) -> Box<[u16]> {
        let (width, height) = (self.seen.intrinsics.width as usize, self.seen.intrinsics.height as usize);
        let mut out = vec![0u16; image.len()].into_boxed_slice();
        for v in 1..height - 1 {
            for u in 1..width - 1 {
                let i = v * width + u;
                let z = image[i];
                if !z.is_finite() {
                    continue;
                }
                let (dx, dy) = (image[i + 1] - image[i - 1], image[i + width] - image[i - width]);
                let steep = dx.abs().max(dy.abs());
                let mut measured = z;
                if steep > EDGE {
                    if rng.uniform() < FLYING {
                        let other = [i - 1, i + 1, i - width, i + width][(rng.next_u64() % 4) as usize];
                        if image[other].is_finite() {
                            measured = z + (image[other] - z) * rng.uniform();
                        }
                    }
                } else {
                    let pixel = 2.0 * z / self.seen.intrinsics.fx;
                    let slope = (dx * dx + dy * dy).sqrt() / pixel;
                    if 1.0 / (1.0 + slope * slope).sqrt() < GRAZING {
                        continue;
                    }
                }
                let sigma = FLIGHT[0] + FLIGHT[1] * z * z;
                measured += self.offset + sigma * rng.gaussian();
                out[i] = (measured * 1e3).round().clamp(0.0, 65_000.0) as u16;
            }
        }
        out
    }
}
