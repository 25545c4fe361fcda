//! The residuals of one step: depth cells, outline, ground contact, prior of the pose and joint limits.

use toile_assets::body::shape::SHAPES;

use super::correspondence::Correspondences;
use super::depth_cells::{DepthCells, RimCell};
use super::joint_angles::angle;
use super::normal_equations::NormalEquations;
use super::options::OutlinePull;
use super::posed_body::{BodyModel, FitState, PosedBody, UNKNOWNS};

/// Standard deviation of a cell's distance from the model's surface (m). Errors are correlated over a hand's breadth, so
/// that the thirty cells there count as one: 4 mm times the root of 30.
const CELL_SIGMA: f32 = 0.022;

/// The same where the outline counts from both sides: errors of a body that the model cannot have are correlated over more
/// than a hand's breadth, and then a front that fits a little better does not outweigh the breadth that is seen.
const CORRELATED_CELL_SIGMA: f32 = 0.040;

/// Share of the usual spreads of joint angles that somebody has who stands upright to be measured, where the outline counts from
/// both sides.
const UPRIGHT: f32 = 0.5;

impl OutlinePull {
    /// Standard deviation of a cell's distance from the model's surface (m).
    const fn cell_sigma(self) -> f32 {
        match self {
            Self::Inward => CELL_SIGMA,
            Self::BothWays => CORRELATED_CELL_SIGMA,
        }
    }

    /// What spreads of joint angles are multiplied with.
    const fn pose_spread(self) -> f32 {
        match self {
            Self::Inward => 1.0,
            Self::BothWays => UPRIGHT,
        }
    }
}

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
const RIM_LOST: f32 = 0.002;

/// Standard deviation of the outline's place in a cell (m), correlated as for [`CELL_SIGMA`].
const RIM_SIGMA: f32 = 0.012;

/// Distance from the outline at which it has a quarter of its weight (m).
const RIM_ROBUST: f32 = 0.05;

/// Feet within this of the ground stand on it (m).
const STANDING: f32 = 0.05;

/// Standard deviation of a sole sample's height above the ground (m), correlated as for [`CELL_SIGMA`].
const SOLE_SIGMA: f32 = 0.015;

/// Shoes lie between a clothed shopper's sole and the ground: a sole above the ground is pulled down with this fraction
/// of the weight, one below it is pushed up with the full weight.
const SHOE_PULL: f32 = 0.05;

/// Height above the ground below which the depth image shows no feet, because they are removed with the floor (m).
const FLOOR_ZONE: f32 = 0.05;

/// Standard deviation of a joint angle's change from one frame to the next (rad).
const MOTION: f32 = 0.25;

/// Standard deviation of an angle beyond its range (rad).
const BEYOND: f32 = 0.03;

/// Settings of the residuals of one step.
pub(super) struct ResidualOptions {
    /// Height of the ground (m), where it is known.
    pub ground: Option<f32>,
    /// Whether the visible surface is cloth over skin: residuals are then one-sided.
    pub clothed: bool,
    /// How the outline is used.
    pub outline: OutlinePull,
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
            let weight = found.count * trust(residual, options, pull) / options.outline.cell_sigma().powi(2);
            equations.add(&posed.row(model, i, normal), residual, weight);
        } else if found.faces {
            outline(equations, scene, i, options);
        }
    }
    if options.outline == OutlinePull::BothWays {
        for cell in &scene.view.rim {
            rim(equations, scene, cell, options);
        }
    }
    if let Some(ground) = options.ground {
        soles(equations, scene, ground, options);
    }
}

/// Weight of a correspondence: less the larger the residual (Geman-McClure), and less where cloth may lie between.
fn trust(residual: f32, options: &ResidualOptions, pull: f32) -> f32 {
    let share = residual / options.robust;
    let robust = (1.0 + share * share).powi(-2);
    if options.clothed && residual < 0.0 { pull * robust } else { robust }
}

fn outline(
    equations: &mut NormalEquations,
    Observation { model, posed, view, matches }: Observation,
    i: usize,
    options: &ResidualOptions,
) {
    if options.ground.is_some_and(|g| posed.points[i].y < g + FLOOR_ZONE) {
        return;
    }
    let found = &matches.of[i];
    // On head and neck the outline may be that of the hair.
    let play = if options.clothed && model.samples[i].hairy { 0.0 } else { OUTLINE_PLAY };
    if let Some((off, along)) = view.outside(found.seen, found.z)
        && off > play
    {
        let residual = (off - play).min(OUTLINE_REACH);
        equations.add(&posed.row(model, i, along), residual, 1.0 / (OUTLINE_SIGMA * OUTLINE_SIGMA));
    }
}

/// Draws the rim of the body to a stretch of the outline, from inside as from outside.
fn rim(
    equations: &mut NormalEquations,
    Observation { model, posed, view, matches }: Observation,
    cell: &RimCell,
    options: &ResidualOptions,
) {
    let Some(i) = matches.rim_sample(view, posed, cell) else { return };
    if options.ground.is_some_and(|g| posed.points[i].y < g + FLOOR_ZONE) {
        return;
    }
    let found = &matches.of[i];
    let residual = (found.seen - cell.at).dot(cell.out) * view.cell_size(found.z) - RIM_LOST;
    let pull = if model.samples[i].hairy { HAIR_PULL } else { CLOTH_PULL };
    let off = residual / RIM_ROBUST;
    let robust = (1.0 + off * off).powi(-2);
    let share = if options.clothed && residual < 0.0 { pull * robust } else { robust };
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
            let share = if options.clothed && residual > 0.0 { SHOE_PULL } else { 1.0 };
            equations.add(&posed.row_above_rest(model, i), residual, share / (SOLE_SIGMA * SOLE_SIGMA));
        }
    }
}

/// Adds the prior of the pose: usual angles, joint limits, and small changes since the frame before.
pub(super) fn add_priors(
    equations: &mut NormalEquations,
    model: &BodyModel,
    state: &FitState,
    before: Option<&FitState>,
    outline: OutlinePull,
) {
    for (t, turn) in model.joint_angles.iter().enumerate() {
        let now = angle(&state.local, turn);
        let spread = outline.pose_spread();
        equations.add_one(3 + t, now - turn.usual, (turn.spread * spread).powi(-2));
        let beyond = (now - turn.range[1]).max(0.0) + (now - turn.range[0]).min(0.0);
        if beyond != 0.0 {
            equations.add_one(3 + t, beyond, BEYOND.powi(-2));
        }
        if let Some(before) = before {
            let joint = turn.joint.index();
            let moved = (state.local[joint] * before.local[joint].inverse()).to_scaled_axis();
            equations.add_one(3 + t, moved.dot(turn.axis), MOTION.powi(-2));
        }
    }
}

/// Largest move of the root (m) and largest joint rotation (rad) in one step.
const LARGEST_STEP: [f64; 2] = [0.25, 0.5];

/// Clamps the pose part of a step to where the linearisation holds.
pub(super) fn limit_step(mut step: [f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
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
