//! Synthetic agreement: bodies of known size, seen by a simulated depth camera, measured and compared.
//!
//! The mannequin of [`toile_assets::body`] has one shape for each set of girths; people have many. So each subject's
//! torso is reshaped as much as bodies of ANSUR II differ: flatter or rounder (log depth/breadth given the girths +-
//! .065, correlated .2 to .4 between levels), squarer or more oval (girth over that of the ellipse +- 2 %), more of
//! the depth before or behind the sides (+- 5 %, our assumption), and with levels higher or lower than the average
//! (+- 1 % of stature). The truth is then read off the reshaped mesh by the tape.
//!
//! 48 subjects other than those the charts were fitted to (seed 500, 30 frames, sex not given), in mm:
//!
//! | measure | bias | SD | mean absolute | 95 % | stated sigma | within 1, 2 sigma |
//! |---|---|---|---|---|---|---|
//! | stature | 0.3 | 0.9 | 0.7 | 2.2 | 5.4 | 100 %, 100 % |
//! | shoulder breadth | -0.2 | 3.6 | 2.8 | 7.6 | 10.5 | 98 %, 100 % |
//! | chest girth | -4.8 | 28.4 | 22.2 | 70.6 | 30.4 | 75 %, 94 % |
//! | waist girth | 0.1 | 21.2 | 16.6 | 43.0 | 26.3 | 77 %, 100 % |
//! | hip girth | -5.2 | 27.9 | 21.2 | 53.9 | 27.6 | 69 %, 98 % |

use glam::{Affine3A, Quat, Vec3};
use toile_assets::body::{BodyError, tape};
use toile_assets::sizes::Population;
use toile_base::body::{Body, Measures, Region, Sex};
use toile_base::frame::DepthFrame;
use toile_base::frame::Intrinsics;
use toile_base::numeric::random::SplitMix64;
use toile_base::numeric::statistics::quantile;
use toile_sensors::source::synthetic::{KinectNoise, SyntheticCamera};
use toile_track::estimate::Estimate;
use toile_track::measure::{Measurements, measure};
use toile_track::measures::Hint;

/// Mean and lower Cholesky factor of the covariance of stature, biacromial breadth, chest, waist and buttock girth
/// (m) in ANSUR II (public domain). The waist's mean is that of [`Measures::average`], because ANSUR measures another.
type Normal = ([f32; 5], [[f32; 5]; 5]);

const WOMEN: Normal = (
    [1.6285, 0.3653, 0.9469, 0.7869, 1.0212],
    [
        [0.0642, 0.0, 0.0, 0.0, 0.0],
        [0.0103, 0.0151, 0.0, 0.0, 0.0],
        [0.0215, 0.0143, 0.0786, 0.0, 0.0],
        [0.0229, 0.0148, 0.0798, 0.0536, 0.0],
        [0.0288, 0.0107, 0.0495, 0.0245, 0.042],
    ],
);

const MEN: Normal = (
    [1.7562, 0.4157, 1.0587, 0.9387, 1.0195],
    [
        [0.0686, 0.0, 0.0, 0.0, 0.0],
        [0.0102, 0.0162, 0.0, 0.0, 0.0],
        [0.0216, 0.0399, 0.0747, 0.0, 0.0],
        [0.0232, 0.0363, 0.0897, 0.0508, 0.0],
        [0.026, 0.028, 0.0525, 0.023, 0.0336],
    ],
);

/// Standard deviation of log depth/breadth at chest, waist and hip given the five measures (ANSUR II, both sexes).
const ASPECT: [f32; 3] = [0.064, 0.067, 0.061];

/// Lower Cholesky factor of the correlation of those residuals (.19, .15, .41).
const ASPECT_TOGETHER: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.19, 0.982, 0.0], [0.15, 0.388, 0.909]];

/// Radial growth at 45 degrees, which changes the girth by half of it at the same breadth and depth: +- 2 % at chest
/// and waist, 1.5 % at the hip (ANSUR II, girth over the girth of the ellipse given breadth and depth).
const SQUARE: [f32; 3] = [0.04, 0.04, 0.03];

/// Share of the depth that lies before or behind the sides, relative.
const FRONT: f32 = 0.05;

/// Where a person's own chest, waist and hip lie off the population's, as a fraction of stature (ANSUR II).
const LEVEL: [f32; 3] = [0.011, 0.0115, 0.014];

/// Sway of a standing person over one second: shift (m) and turn (rad).
const SWAY: [f32; 2] = [0.008, 0.03];

/// How a subject is turned from the camera when asked to face it (rad).
const TURNED: f32 = 0.06;

/// The camera's place (m): as far off as a body of 1.95 m just fits into the picture.
const EYE: [f32; 3] = [0.0, 0.95, 2.5];

/// Corners of the floor and of the wall behind (m).
const ROOM: [Vec3; 6] = [
    Vec3::new(-4.0, 0.0, 3.0),
    Vec3::new(4.0, 0.0, 3.0),
    Vec3::new(-4.0, 0.0, -1.5),
    Vec3::new(4.0, 0.0, -1.5),
    Vec3::new(-4.0, 3.0, -1.5),
    Vec3::new(4.0, 3.0, -1.5),
];

/// One subject: the mannequin, reshaped, at rest, and what the tape reads.
#[derive(Debug, Clone)]
pub struct Mannequin {
    /// The body; its `measures` are the tape's.
    pub body: Body,
}

/// Draws a subject's five measures as they are distributed in ANSUR II, within two standard deviations.
pub fn draw(sex: Sex, rng: &mut SplitMix64) -> Measures {
    let (mean, factor) = if sex == Sex::Female { WOMEN } else { MEN };
    let normal: [f32; 5] = std::array::from_fn(|_| rng.gaussian().clamp(-2.0, 2.0));
    let m: [f32; 5] = std::array::from_fn(|i| mean[i] + (0..=i).map(|j| factor[i][j] * normal[j]).sum::<f32>());
    Measures { stature: m[0], shoulder_breadth: m[1], chest_girth: m[2], waist_girth: m[3], hip_girth: m[4] }
}

impl Mannequin {
    /// A random subject with a shape of their own.
    pub fn new(sex: Sex, rng: &mut SplitMix64) -> Result<Self, BodyError> {
        let mut body = toile_assets::body::build(sex, &draw(sex, rng))?;
        let mut three = |sd: [f32; 3]| -> [f32; 3] { std::array::from_fn(|i| sd[i] * rng.gaussian()) };
        let z = three([1.0; 3]);
        let aspect: [f32; 3] =
            std::array::from_fn(|i| ASPECT[i] * (0..=i).map(|j| ASPECT_TOGETHER[i][j] * z[j]).sum::<f32>());
        let (square, front, shift) = (three(SQUARE), three([FRONT; 3]), three(LEVEL));
        let levels = [body.levels.chest, body.levels.waist, body.levels.hip];
        for level in 0..3 {
            let ends = [
                *levels.get(level + 1).unwrap_or(&(0.4 * body.measures.stature)),
                levels[level],
                match level {
                    0 => 0.82 * body.measures.stature,
                    _ => levels[level - 1],
                },
            ];
            reshape(&mut body, ends, [aspect[level], square[level], front[level]]);
        }
        let girth = |i: usize| tape::girth(&body, levels[i] + shift[i] * body.measures.stature);
        let [chest_girth, waist_girth, hip_girth] = [girth(0), girth(1), girth(2)];
        body.measures = Measures { chest_girth, waist_girth, hip_girth, ..body.measures };
        Ok(Self { body })
    }

    /// The five measures that the tape reads, in the order of [`Measurements::completed`] (m).
    pub fn truth(&self) -> [f32; 5] {
        let m = &self.body.measures;
        [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth]
    }

    /// The swaying body as a Kinect sees it, before a wall and on a floor, in as many frames.
    pub fn seen(&self, frames: usize, rng: &mut SplitMix64) -> Vec<DepthFrame> {
        let eye = Vec3::new(0.0, EYE[1], EYE[2] + 0.1 * (rng.uniform() - 0.5));
        let camera = SyntheticCamera::looking_at(Intrinsics::KINECT_V1, eye, Vec3::new(0.0, EYE[1], 0.0));
        let mut noise = KinectNoise::new(rng.next_u64());
        let turned = TURNED * rng.gaussian();
        let mut positions = self.body.mesh.positions.clone();
        positions.extend(ROOM);
        let n = self.body.mesh.positions.len() as u32;
        let mut triangles = self.body.mesh.triangles.clone();
        triangles.extend([[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]].map(|t| t.map(|i| n + i)));
        let mut image = vec![0.0; camera.intrinsics.pixels()];
        (0..frames as u64)
            .map(|i| {
                let mut sway = |by: f32| by * rng.gaussian();
                let turn = Quat::from_rotation_y(turned + sway(SWAY[1])) * Quat::from_rotation_z(sway(0.2 * SWAY[1]));
                let shift = Vec3::new(sway(SWAY[0]), 0.0, sway(SWAY[0]));
                let place = Affine3A::from_rotation_translation(turn, shift);
                for (to, from) in positions.iter_mut().zip(&self.body.mesh.positions) {
                    *to = place.transform_point3(*from);
                }
                camera.render(&positions, &triangles, &mut image);
                camera.frame(i * 33_333_333, noise.apply(&camera.intrinsics, &image))
            })
            .collect()
    }
}

/// Reshapes trunk and thighs around one level, fading to its neighbours at `ends` (below, level, above; m):
/// depth/breadth by e^aspect, girth at 45 degrees by `square`, depth before the sides by `front`.
fn reshape(body: &mut Body, ends: [f32; 3], [aspect, square, front]: [f32; 3]) {
    let near: Vec<Vec3> = body
        .mesh
        .positions
        .iter()
        .zip(&body.regions)
        .filter(|(p, r)| **r == Region::Torso && (p.y - ends[1]).abs() < 0.02)
        .map(|(p, _)| *p)
        .collect();
    let (low, high) = near.iter().fold((Vec3::MAX, Vec3::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
    let (centre, half) = ((low + high) * 0.5, (high - low) * 0.5);
    for (p, region) in body.mesh.positions.iter_mut().zip(&body.regions) {
        if matches!(region, Region::LeftArm | Region::RightArm | Region::Head) || p.y <= ends[0] || p.y >= ends[2] {
            continue;
        }
        let fade =
            if p.y < ends[1] { (p.y - ends[0]) / (ends[1] - ends[0]) } else { (ends[2] - p.y) / (ends[2] - ends[1]) };
        let (x, z) = (p.x / half.x, (p.z - centre.z) / half.z);
        let angle = z.atan2(x);
        let round = 1.0 + fade * square * (2.0 * angle).sin().powi(2);
        let split = 1.0 + fade * front * z.signum() * angle.sin().abs();
        p.x *= round * (-0.5 * fade * aspect).exp();
        p.z = centre.z + (p.z - centre.z) * round * split * (0.5 * fade * aspect).exp();
    }
}

/// How one measure agrees over the subjects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasureAgreement {
    /// Name of the measure.
    pub measure: &'static str,
    /// Subjects for whom it could be taken.
    pub taken: usize,
    /// Mean error (m).
    pub bias: f32,
    /// Standard deviation of the error (m).
    pub deviation: f32,
    /// Mean absolute error (m).
    pub mean_absolute: f32,
    /// 95th percentile of the absolute error (m).
    pub p95: f32,
    /// Fraction of errors within one and two stated sigmas.
    pub covered: [f32; 2],
    /// Mean stated sigma (m).
    pub sigma: f32,
}

/// The measures compared, in the order of [`Mannequin::truth`].
pub const COMPARED: [&str; 5] = ["stature", "shoulder_breadth", "chest_girth", "waist_girth", "hip_girth"];

/// Compares what was measured with the truth, measure by measure.
pub fn compare(results: &[(Measurements, [f32; 5])]) -> [MeasureAgreement; 5] {
    std::array::from_fn(|i| {
        let pairs: Vec<(Estimate, f32)> =
            results.iter().filter_map(|(m, truth)| Some((m.measures.named()[i].1?, truth[i]))).collect();
        let n = pairs.len().max(1) as f32;
        let errors: Vec<f32> = pairs.iter().map(|(e, t)| e.value - t).collect();
        let bias = errors.iter().sum::<f32>() / n;
        let deviation = (errors.iter().map(|e| (e - bias).powi(2)).sum::<f32>() / n).sqrt();
        let mut absolute: Vec<f32> = errors.iter().map(|e| e.abs()).collect();
        let mean_absolute = absolute.iter().sum::<f32>() / n;
        let within = |k: f32| pairs.iter().filter(|(e, t)| (e.value - t).abs() < k * e.sigma).count() as f32 / n;
        MeasureAgreement {
            measure: COMPARED[i],
            taken: pairs.len(),
            bias,
            deviation,
            mean_absolute,
            p95: quantile(&mut absolute, 0.95).unwrap_or(0.0),
            covered: [within(1.0), within(2.0)],
            sigma: pairs.iter().map(|(e, _)| e.sigma).sum::<f32>() / n,
        }
    })
}

/// Measures random subjects of both sexes: `hint` says whether their sex is given. Subjects whose measures no body has
/// together are left out, as are those whom the measuring refuses; the caller sees by the counts.
pub fn study(subjects: usize, frames: usize, seed: u64, sex_told: bool) -> Vec<(Measurements, [f32; 5])> {
    let mut results = Vec::new();
    for (i, sex) in (0..subjects as u64).flat_map(|i| [(i, Sex::Female), (i, Sex::Male)]) {
        let mut rng = SplitMix64::new(seed + 2 * i + u64::from(sex == Sex::Male));
        let Ok(subject) = Mannequin::new(sex, &mut rng) else { continue };
        let population = match (sex_told, sex) {
            (false, _) => Population::Mixed,
            (true, Sex::Female) => Population::Women,
            (true, Sex::Male) => Population::Men,
        };
        let depth = subject.seen(frames, &mut rng);
        if let Ok(measured) = measure(&[], &depth, &Hint { population, scale_known: true }) {
            results.push((measured, subject.truth()));
        }
    }
    results
}
