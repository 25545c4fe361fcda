//! The residuals of one step: depth cells, outline, ground contact, prior of the pose and joint limits.

use toile_assets::body::shape::SHAPES;
use toile_base::skeleton::Joint;

use super::correspondence::Correspondences;
use super::depth_cells::{DepthCells, RimCell};
use super::joint_angles::angle;
use super::normal_equations::NormalEquations;
use super::options::{FitOptions, Stance, is_arm};
use super::posed_body::{BodyModel, FitState, PosedBody, UNKNOWNS};

/// Cloth lies outside the skin: a point outside the surface pulls with this fraction of the weight, and not at all
/// beyond a loose fit; a point inside pushes with the full weight.
const CLOTH_PULL: f32 = 0.2;

/// The same fraction on head and neck, where hair lies farther out and has any shape.
const HAIR_PULL: f32 = 0.05;

/// How far outside the outline a sample may lie before it is pulled in (m): the outermost pixels, which see the surface
/// at a grazing angle, are lost.
const OUTLINE_PLAY: f32 = 0.010;

/// Standard deviation of a sample's distance outside the outline (m).
const OUTLINE_SIGMA: f32 = 0.030;

/// Residuals outside the outline are clamped to this (m).
const OUTLINE_REACH: f32 = 0.15;

/// Breadth of the shopper's rim that a camera loses, because it sees it at a grazing angle (m).
const RIM_LOST: f32 = 0.0015;

/// Standard deviation of the outline's place in a cell (m), correlated as cells are.
const RIM_SIGMA: f32 = 0.012;

/// Distance from the outline at which it has a quarter of its weight (m).
const RIM_ROBUST: f32 = 0.05;

/// Feet within this of the ground stand on it (m).
const STANDING: f32 = 0.05;

/// Standard deviation of a sole sample's height above the ground (m), correlated as cells are.
const SOLE_SIGMA: f32 = 0.015;

/// Shoes lie between a clothed shopper's sole and the ground: a sole above the ground is pulled down with this fraction
/// of the weight, one below it is pushed up with the full weight.
const SHOE_PULL: f32 = 0.05;

/// Height above the ground below which the depth image shows no feet, because they are removed with the floor (m).
const FLOOR_ZONE: f32 = 0.05;

/// Standard deviation of an angle beyond its range (rad).
const BEYOND: f32 = 0.03;

/// Settings of the residuals of one step.
pub(super) struct ResidualOptions {
    /// What the caller chose.
    pub fit: FitOptions,
    /// Residual at which a match loses three quarters of its weight (m).
    pub robust: f32,
}

/// A posed body, the depth cells of a frame, and the correspondences between them.
#[derive(Clone, Copy)]
pub(super) struct Observation<'a> {
    pub model: &'a BodyModel,
    pub posed: &'a PosedBody,
    pub view: &'a DepthCells,
    pub matches: &'a Correspondences,
}

/// Adds the residuals of depth cells, outline and ground at a posed body.
pub(super) fn add_observations(equations: &mut NormalEquations, scene: Observation, options: &ResidualOptions) {
    let Observation { model, posed, matches, .. } = scene;
    equations.clear();
    for (i, found) in matches.of.iter().enumerate() {
        if found.count > 0.0 {
            let normal = posed.normals[i];
            let residual = found.outside(posed.points[i], normal);
            let pull = if model.samples[i].hairy { HAIR_PULL } else { CLOTH_PULL };
            let weight = found.count * trust(residual, options, pull) / options.fit.cell_sigma().powi(2);
            equations.add(&posed.row(model, i, normal), residual, weight);
        } else if found.faces {
            outline(equations, scene, i, options);
        }
    }
    if options.fit.has_rim() {
        for cell in &scene.view.rim {
            rim(equations, scene, cell, options);
        }
    }
    if let Some(ground) = options.fit.ground {
        soles(equations, scene, ground, options);
    }
}

/// Weight of a correspondence: less the larger the residual (Geman-McClure), and less where cloth may lie between.
fn trust(residual: f32, options: &ResidualOptions, pull: f32) -> f32 {
    let share = residual / options.robust;
    let robust = (1.0 + share * share).powi(-2);
    if options.fit.clothed && residual < 0.0 { pull * robust } else { robust }
}

fn outline(
    equations: &mut NormalEquations,
    Observation { model, posed, view, matches }: Observation,
    i: usize,
    options: &ResidualOptions,
) {
    if options.fit.ground.is_some_and(|g| posed.points[i].y < g + FLOOR_ZONE) {
        return;
    }
    let found = &matches.of[i];
    // On head and neck the outline may be that of the hair.
    let play = if options.fit.clothed && model.samples[i].hairy { 0.0 } else { OUTLINE_PLAY };
    if let Some((off, along)) = view.outside(found.seen, found.z)
        && off > play
    {
        let residual = (off - play).min(OUTLINE_REACH);
        equations.add(&posed.row(model, i, along), residual, 1.0 / (OUTLINE_SIGMA * OUTLINE_SIGMA));
    }
}

/// The sample of the body's rim that belongs to a stretch of the outline, and how far it lies outside of it (m).
pub(super) fn beyond_outline(
    Observation { model, posed, view, matches }: Observation,
    cell: &RimCell,
) -> Option<(usize, f32)> {
    let i = matches.rim_sample(view, (model, posed), cell)?;
    let found = &matches.of[i];
    Some((i, (found.seen - cell.at).dot(cell.out) * view.cell_size(found.z) - RIM_LOST))
}

/// Draws the rim of the body to a stretch of the outline, from inside as from outside.
fn rim(equations: &mut NormalEquations, scene: Observation, cell: &RimCell, options: &ResidualOptions) {
    let Observation { model, posed, view, .. } = scene;
    let Some((i, residual)) = beyond_outline(scene, cell) else { return };
    if options.fit.ground.is_some_and(|g| posed.points[i].y < g + FLOOR_ZONE) {
        return;
    }
    let off = residual / RIM_ROBUST;
    let share = (1.0 + off * off).powi(-2);
    let weight = share / (RIM_SIGMA * RIM_SIGMA);
    equations.add(&posed.row(model, i, view.in_world(cell.out)), residual, weight);
}

fn soles(
    equations: &mut NormalEquations,
    Observation { model, posed, .. }: Observation,
    ground: f32,
    options: &ResidualOptions,
) {
    for (i, _) in model.samples.iter().enumerate().filter(|(_, s)| s.sole) {
        let residual = posed.above_rest(i) - ground;
        if residual.abs() < STANDING {
            let share = if options.fit.clothed && residual > 0.0 { SHOE_PULL } else { 1.0 };
            equations.add(&posed.row_above_rest(model, i), residual, share / (SOLE_SIGMA * SOLE_SIGMA));
        }
    }
}

/// What is known of the pose beforehand.
#[derive(Clone, Copy)]
pub struct PosePrior<'a> {
    /// What the shopper does.
    pub stance: Stance,
    /// The state of the frame before.
    pub before: Option<&'a FitState>,
    /// The pose that is kept, and the standard deviations of the angles of trunk and legs, and of the arms, about it (rad).
    pub held: Option<(&'a FitState, [f32; 2])>,
}

/// Adds the prior of the pose: usual angles, joint limits, small changes since the frame before, and a pose that is kept.
pub fn add_priors(equations: &mut NormalEquations, model: &BodyModel, state: &FitState, prior: &PosePrior) {
    for (t, turn) in model.joint_angles.iter().enumerate() {
        let now = angle(&state.local, turn);
        let spread = turn.spread * prior.stance.pose_spread();
        equations.add_one(3 + t, now - turn.usual, spread.powi(-2));
        let beyond = (now - turn.range[1]).max(0.0) + (now - turn.range[0]).min(0.0);
        if beyond != 0.0 {
            equations.add_one(3 + t, beyond, BEYOND.powi(-2));
        }
        let joint = turn.joint.index();
        let turned =
            |from: &FitState| (state.local[joint] * from.local[joint].inverse()).to_scaled_axis().dot(turn.axis);
        if let Some(before) = prior.before {
            equations.add_one(3 + t, turned(before), prior.stance.motion(turn.joint).powi(-2));
        }
        if let Some((held, sigmas)) = prior.held.filter(|_| turn.joint != Joint::Pelvis) {
            equations.add_one(3 + t, turned(held), sigmas[usize::from(is_arm(turn.joint))].powi(-2));
        }
    }
}

/// Largest move of the root (m) and largest joint rotation (rad) in one step.
const LARGEST_STEP: [f64; 2] = [0.25, 0.5];

/// Clamps the pose part of a step to where the linearisation holds.
pub fn limit_step(mut step: [f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
    for (i, s) in step.iter_mut().enumerate().take(UNKNOWNS - SHAPES) {
        let most = LARGEST_STEP[usize::from(i >= 3)];
        *s = s.clamp(-most, most);
    }
    step
}

/// Root mean square of the correspondences' residuals over the cells (m).
pub(super) fn rms(posed: &PosedBody, matches: &Correspondences) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (i, m) in matches.of.iter().enumerate().filter(|(_, m)| m.count > 0.0) {
        sum += m.count * m.outside(posed.points[i], posed.normals[i]).powi(2);
        count += m.count;
    }
    (sum / f32::max(count, 1.0)).sqrt()
}
