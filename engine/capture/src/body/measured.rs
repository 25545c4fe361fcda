//! Results from silhouettes: the eleven measures, each with its error, a body of both sexes' fits, and its pose.

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};
use toile_assets::body::shape::Shapes;
use toile_assets::body::{En, Fitted};
use toile_base::body::{Measures, Sex};
use toile_base::mesh::vertex_normals;
use toile_base::skeleton::Pose;
use toile_sensors::calibration::CalibratedCamera;
use toile_sensors::masks::Mask;
use toile_track::correlated::Correlated;
use toile_track::estimate::Estimate;
use toile_track::fit::FitState;
use toile_track::fit::measuring::{MEASURES, covariance_of};

use super::fit::{BodyFitter, COARSE, FINE};
use super::hull::{HullShape, carve};
use super::joint_point::JointPoint;
use super::start::{ARM_JOINTS, other_forearm, start, turned};
use super::view::CameraSilhouette;
use crate::error::CaptureError;

/// Fewest cameras: one outline leaves the depth of a body open.
pub(super) const FEWEST: usize = 2;

/// Heights of a hull that can be a person's (m), and the volume (m3) that the hull of two views may have at most.
const HEIGHTS: std::ops::Range<f64> = 1.0..2.6;

/// Least share of silhouettes and drawing together that both have: below it another person, or something, is in the masks.
pub(super) const LEAST_AGREEMENT: f64 = 0.80;

/// What the evidence for a sex counts: a body of either sex that the model cannot have errs as much as the sexes differ.
const EVIDENCE: f64 = 0.5;

/// By how much less than the other sex's a fit agrees that has another pose.
const BEHIND: f64 = 0.004;

/// Shares of a sex below which it takes no part.
const UNLIKELY: f64 = 0.01;

/// Error from bodies that the model cannot be, and from what two people call by one name (m), in the order of [`MEASURES`]: what
/// errors have beside what the fit itself states. Chosen on ten people of MakeHuman's family, other than those that
/// they are judged on (docs/capture.md); people of the own family err less.
const MODEL_ERROR: [f32; MEASURES.len()] =
    [0.005, 0.009, 0.008, 0.040, 0.037, 0.035, 0.024, 0.016, 0.023, 0.026, 0.016];

/// How much of that error the girths of the trunk have in common.
const TOGETHER: f32 = 0.4;

/// One camera with what it saw.
#[derive(Debug, Clone, Copy)]
pub struct SilhouetteView<'a> {
    /// The camera.
    pub camera: &'a CalibratedCamera,
    /// Its mask.
    pub mask: &'a Mask,
}

/// What is known beside the silhouettes.
#[derive(Debug, Clone, Default)]
pub struct SilhouetteOptions {
    /// The person's sex, if it is known.
    pub sex: Option<Sex>,
    /// Which way is up in the cameras' world; found from the cameras where it is absent.
    pub up: Option<DVec3>,
    /// Joints that were found in the same pictures, in the cameras' world (m).
    pub joints: Vec<JointPoint>,
}

/// A person measured by their silhouettes.
#[derive(Debug, Clone)]
pub struct SilhouetteBody {
    /// The eleven measures, in the order of [`MEASURES`].
    pub measures: [Estimate; MEASURES.len()],
    /// The same with what their errors have in common.
    pub all: Correlated<{ MEASURES.len() }>,
    /// How likely it is a woman, 0 to 1.
    pub woman: f32,
    /// The likelier sex's body, with its surface moved to the outlines.
    pub body: Fitted,
    /// Its pose, in the upright world.
    pub pose: Pose,
    /// The surface as it stands, in the cameras' world (m) `[vertices]`.
    pub standing: Vec<DVec3>,
    /// What drawing and silhouettes have in common over what either has, 0 to 1.
    pub agreement: f64,
    /// Root mean square distance of the rim from the outlines (m).
    pub off: f64,
    /// Stretches of outline that the body was fitted to.
    pub stretches: usize,
    /// Height of the visual hull (m) and its volume (m3).
    pub hull: [f64; 2],
    /// One sentence for each thing that a user should know.
    pub notes: Vec<String>,
    /// The likelier sex.
    pub sex: Sex,
    /// Where its fit ended, in the upright world.
    pub(super) state: FitState,
    /// The rotation of the cameras' world to the upright one.
    pub(super) upright: DMat3,
}

impl SilhouetteBody {
    /// A place of the cameras' world in the upright one, y up (m).
    pub fn upright_place(&self, place: DVec3) -> DVec3 {
        self.upright * place
    }
}

/// Measures the person whom these cameras see.
///
/// # Errors
/// One sentence: fewer than two cameras, silhouettes that meet nowhere or in nothing of a person's height, or that no body fits.
pub fn measure(seen: &[SilhouetteView], options: &SilhouetteOptions) -> Result<SilhouetteBody, CaptureError> {
    if seen.len() < FEWEST {
        let problem = format!("{} of them, and at least {FEWEST} are needed", seen.len());
        return Err(CaptureError::unfit("the cameras", problem, "film from the front and from one side at least"));
    }
    let upright = upright(seen, options.up);
    let views: Arc<[CameraSilhouette]> =
        seen.iter().map(|s| CameraSilhouette::new(s.mask, s.camera, upright)).collect();
    let hull = carve(&views)?;
    check(&hull)?;
    let turned = |p: &JointPoint| JointPoint { place: upright * p.place, ..*p };
    let joints: Vec<JointPoint> = options.joints.iter().map(turned).collect();
    let sexes: &[Sex] = match &options.sex {
        Some(Sex::Female) => &[Sex::Female],
        Some(Sex::Male) => &[Sex::Male],
        None => &[Sex::Female, Sex::Male],
    };
    let mut fits: Vec<SexFit> = sexes.iter().map(|s| SexFit::new(*s, &views, &joints, &hull)).collect();
    learn_poses(&mut fits);
    let best = fits.iter().map(|f| f.agreement).fold(0.0, f64::max);
    if best < LEAST_AGREEMENT {
        let problem = format!("body and silhouettes share only {:.0} % of what either covers", 100.0 * best);
        let cure = "give masks of one whole person without furniture, in the order of the cameras, of one moment";
        return Err(CaptureError::unfit("the silhouettes", problem, cure));
    }
    let least = fits.iter().map(|f| f.deviance).fold(f64::MAX, f64::min);
    let weight = |f: &SexFit| (-0.5 * EVIDENCE * (f.deviance - least)).exp();
    let whole: f64 = fits.iter().map(weight).sum();
    fits.retain(|f| weight(f) / whole > UNLIKELY);
    let weights: Vec<f64> = fits.iter().map(weight).collect();
    let whole: f64 = weights.iter().sum();
    let parts: Vec<SexMeasures> = fits.into_iter().zip(weights).map(|(f, w)| f.closely((w / whole) as f32)).collect();
    Ok(together(parts, &views, upright, &hull))
}

/// Whichever sex's fit has found less of the person tries the pose of the one that has found most: it has lost a limb, or faces the other
/// way, and would be weighed by that.
fn learn_poses(fits: &mut [SexFit]) {
    let best = fits.iter().max_by(|a, b| a.agreement.total_cmp(&b.agreement)).map(|f| (f.agreement, f.state));
    if let Some((most, pose)) = best {
        fits.iter_mut().filter(|f| f.agreement < most - BEHIND).for_each(|f| f.learn(&pose));
    }
    fits.iter_mut().for_each(SexFit::conclude);
}

/// The rotation that brings the cameras' world upright: the axis nearest to the mean of the cameras' own up becomes y.
fn upright(seen: &[SilhouetteView], up: Option<DVec3>) -> DMat3 {
    let mean: DVec3 = seen.iter().map(|s| -s.camera.rotation().row(1)).sum();
    let axes = [DVec3::Y, DVec3::Z, DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z, DVec3::NEG_X];
    let nearest = axes.into_iter().rev().max_by(|a, b| a.dot(mean).total_cmp(&b.dot(mean))).unwrap_or(DVec3::Y);
    DMat3::from_quat(DQuat::from_rotation_arc(up.unwrap_or(nearest), DVec3::Y))
}

fn check(hull: &HullShape) -> Result<(), CaptureError> {
    let height = hull.heights[1] - hull.heights[0];
    if HEIGHTS.contains(&height) {
        return Ok(());
    }
    let problem = format!("they meet in something {height:.2} m high, which no standing person is");
    let cure = "give masks of a whole standing person and a calibration in metres; --up names the world's upward axis";
    Err(CaptureError::unfit("the silhouettes", problem, cure))
}

/// The fit of one sex's body.
struct SexFit {
    sex: Sex,
    fitter: BodyFitter,
    state: FitState,
    deviance: f64,
    agreement: f64,
}

/// What it says.
struct SexMeasures {
    sex: Sex,
    share: f32,
    measures: Correlated<{ MEASURES.len() }>,
    body: Fitted,
    state: FitState,
    standing: Vec<Vec3>,
    agreement: f64,
    off: f64,
    stretches: usize,
}

impl SexFit {
    fn new(sex: Sex, views: &Arc<[CameraSilhouette]>, joints: &[JointPoint], hull: &HullShape) -> Self {
        let mut fitter = BodyFitter::new(sex, Arc::clone(views), joints.to_vec());
        let from = start(&mut fitter, hull);
        let (agreement, state) = fine(&mut fitter, &from);
        Self { sex, fitter, state, deviance: f64::MAX, agreement }
    }

    /// Tries another sex's pose.
    fn learn(&mut self, pose: &FitState) {
        let from = FitState { shape: self.state.shape, ..*pose };
        let state = self.fitter.steps(&from, &[COARSE[1], FINE[0], FINE[1]], false);
        let agreement = self.fitter.agreement(&state);
        if agreement > self.agreement {
            (self.agreement, self.state) = (agreement, state);
        }
    }

    /// Takes what the silhouettes say of the shape into the estimate.
    fn conclude(&mut self) {
        self.deviance = self.fitter.conclude(&self.state);
    }

    /// Moves the surface to its outlines and lays the tape on it.
    fn closely(mut self, share: f32) -> SexMeasures {
        let shapes = Shapes::of(self.sex);
        let (rest, state) = self.fitter.surface(&self.state);
        let agreement = self.fitter.agreement(&state);
        let (off, stretches) = self.fitter.distance(&state);
        let on_legs = self.fitter.on_its_legs(&state, &rest);
        let [lying, standing] = [&rest, &on_legs].map(|surface| shapes.read_surface(surface));
        let (_, covariance) = self.fitter.filter.estimate();
        let mut measures = covariance_of(shapes, &state.shape, &covariance);
        for (measure, (_, kind, _)) in measures.mean.iter_mut().zip(MEASURES) {
            *measure = kind.of(if kind.is_height() { &standing } else { &lying });
        }
        let posed = self.fitter.standing(&state);
        let mut body = shapes.body(&state.shape);
        body.body.mesh.positions = rest;
        vertex_normals(&body.body.mesh.positions, &body.body.mesh.triangles, &mut body.body.normals);
        body.body.measures = Measures {
            stature: lying.of(En::Stature),
            shoulder_breadth: lying.of(En::ShoulderBreadth),
            chest_girth: lying.of(En::BustGirth),
            waist_girth: lying.of(En::WaistGirth),
            hip_girth: lying.of(En::HipGirth),
        };
        body.readings = lying;
        SexMeasures { sex: self.sex, share, measures, body, state, standing: posed, agreement, off, stretches }
    }
}

/// Agreement below which a fit may face another way than the person: the model's own people come to .96 and more, others of whom no limb is
/// lost to .94.
const DOUBTFUL: f64 = 0.93;

/// By how much a body that may face another way is turned (rad): twice as far as ways of facing are tried beside those of the hull. A quarter
/// and half a turn were tried and never agreed better.
const TURNS: [f32; 2] = [0.7, -0.7];

/// The fine stages; once more for each forearm that may be elsewhere, and turned where little of the person is covered.
fn fine(fitter: &mut BodyFitter, from: &FitState) -> (f64, FitState) {
    let state = fitter.steps(from, &FINE, false);
    let mut best = (fitter.agreement(&state), state);
    if !fitter.joints.is_empty() {
        return best;
    }
    best = with_forearms(fitter, best);
    if best.0 < DOUBTFUL {
        let from = best.1;
        for turn in TURNS {
            let other = turned(fitter, &from, turn);
            let other = (fitter.agreement(&other), other);
            if other.0 > best.0 {
                best = with_forearms(fitter, other);
            }
        }
    }
    best
}

/// Each forearm elsewhere, if that agrees better once it is fitted.
fn with_forearms(fitter: &mut BodyFitter, found: (f64, FitState)) -> (f64, FitState) {
    let mut best = found;
    for arm in ARM_JOINTS {
        let Some(other) = other_forearm(fitter, &best.1, arm) else { continue };
        let other = fitter.steps(&other, &[COARSE[1], FINE[0], FINE[1]], false);
        let agreement = fitter.agreement(&other);
        if agreement > best.0 {
            best = (agreement, other);
        }
    }
    best
}

fn together(parts: Vec<SexMeasures>, views: &[CameraSilhouette], upright: DMat3, hull: &HullShape) -> SilhouetteBody {
    let mixture: Vec<_> = parts.iter().map(|p| (p.share, p.measures)).collect();
    let all = with_model_error(Correlated::mixed(&mixture));
    let woman = parts.iter().find(|p| p.sex == Sex::Female).map_or(0.0, |p| p.share);
    let best = parts.into_iter().max_by(|a, b| a.share.total_cmp(&b.share)).expect("one sex at least was fitted");
    let back = upright.transpose();
    SilhouetteBody {
        measures: all.estimates(),
        all,
        woman,
        body: best.body,
        pose: Pose { root: best.state.root, local: best.state.local.map(Quat::normalize) },
        standing: best.standing.iter().map(|p| back * p.as_dvec3()).collect(),
        agreement: best.agreement,
        off: best.off,
        stretches: best.stretches,
        hull: [hull.heights[1] - hull.heights[0], hull.volume],
        notes: notes(views),
        sex: best.sex,
        state: best.state,
        upright,
    }
}

/// Adds the error of bodies that the model cannot be.
fn with_model_error(mut measured: Correlated<{ MEASURES.len() }>) -> Correlated<{ MEASURES.len() }> {
    // Chest, underbust, waist and hip.
    let is_trunk = |i: usize| (6..=9).contains(&i);
    for (i, row) in measured.covariance.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            let share = match i == j {
                true => 1.0,
                false if is_trunk(i) && is_trunk(j) => TOGETHER,
                false => 0.0,
            };
            *value += share * MODEL_ERROR[i] * MODEL_ERROR[j];
        }
    }
    measured
}

fn notes(views: &[CameraSilhouette]) -> Vec<String> {
    let mut notes = Vec::new();
    for view in views.iter().filter(|v| v.cut) {
        let name = &view.camera.name;
        notes.push(format!("The border of camera {name}'s picture cuts the person off: what lies beyond is a guess."));
    }
    let axes: Vec<DVec3> = views.iter().map(|v| v.camera.rotation().row(2)).collect();
    let sides = axes.iter().flat_map(|a| axes.iter().map(move |b| a.dot(*b).abs()));
    if sides.fold(1.0, f64::min) > 0.8 {
        notes.push(
            "All cameras look from nearly the same side: the person's depth is a guess; add one from the side."
                .to_owned(),
        );
    }
    notes.extend(opposite(views));
    notes
}

/// Cosine of the angle between two cameras' axes, seen from above, from which on they stand opposite each other: within 15 degrees.
const OPPOSITE: f64 = -0.966;

/// Ways in which a body's breadth is seen from which on more cameras bring little.
const WAYS: usize = 4;

/// Says which cameras stand opposite each other, where they leave few ways of looking: they see the same outline.
pub(super) fn opposite(views: &[CameraSilhouette]) -> Option<String> {
    let axis = |v: &CameraSilhouette| v.camera.rotation().row(2).with_y(0.0).normalize_or_zero();
    let mut pairs = Vec::new();
    for (i, a) in views.iter().enumerate() {
        pairs.extend(views[i + 1..].iter().filter(|b| axis(a).dot(axis(b)) < OPPOSITE).map(|b| (a, b)));
    }
    if pairs.is_empty() || views.len().saturating_sub(pairs.len()) >= WAYS {
        return None;
    }
    let named: Vec<String> = pairs.iter().map(|(a, b)| format!("{} and {}", a.camera.name, b.camera.name)).collect();
    Some(format!(
        "Cameras that stand opposite each other see the same outline: {}. Ways of looking {:.0} degrees apart, from either side, show more.",
        named.join(", "),
        180.0 / views.len() as f64
    ))
}
