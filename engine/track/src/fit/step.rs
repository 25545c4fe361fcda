//! One step of the fit: what picture, ground, habit and the body's limits say, added up and solved.

use toile_assets::body::shape::SHAPES;

use super::equations::Equations;
use super::figure::{Cast, Figure, State, UNKNOWNS};
use super::matching::Matching;
use super::turns::angle;
use super::view::View;

/// How far a cell's point is off the surface of a body of the family (m). What is off is off together over a hand's
/// breadth, so that the thirty cells there count as one: 4 mm times the root of 30.
const CELL_SIGMA: f32 = 0.022;

/// Cloth lies outside the skin: a point outside of it pulls with this share of the weight, and none of it beyond a
/// loose fit; a point inside of it pushes with all.
const CLOTH_PULL: f32 = 0.2;

/// The same on head and neck, for hair stands farther off and is combed to any shape.
const HAIR_PULL: f32 = 0.05;

/// How far outside of the outline a sample may be before it is pulled in (m): the outermost pixels, which see the
/// surface at a grazing angle, are lost.
const OUTLINE_PLAY: f32 = 0.010;

/// How far samples outside of the outline are off (m).
const OUTLINE_SIGMA: f32 = 0.030;

/// Farther outside than this nothing more is learned from how far (m).
const OUTLINE_REACH: f32 = 0.15;

/// Feet within this of the ground stand on it (m).
const STANDING: f32 = 0.05;

/// How far a sample of a sole is off the ground (m), as for [`CELL_SIGMA`].
const SOLE_SIGMA: f32 = 0.015;

/// Shoes lie between a clothed shopper's sole and the ground: a sole above the ground is pulled down with this share of
/// the weight, one below it is pushed up with all of it.
const SHOE_PULL: f32 = 0.05;

/// Height above the ground up to which the picture shows no feet: they go with the floor (m).
const FLOOR_ZONE: f32 = 0.05;

/// How far an angle goes from one frame to the next (rad).
const MOTION: f32 = 0.25;

/// Spread of an angle beyond its range (rad).
const BEYOND: f32 = 0.03;

/// What a step is told besides the picture.
pub(super) struct Known {
    /// Height of the ground (m), where it is known.
    pub ground: Option<f32>,
    /// Whether what is seen is cloth over skin.
    pub clothed: bool,
    /// Residual at which a match loses three quarters of its weight (m).
    pub robust: f32,
}

/// A posed body before a picture, and which of its samples the picture shows.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub cast: &'a Cast,
    pub figure: &'a Figure,
    pub view: &'a View,
    pub matching: &'a Matching,
}

/// Adds up what the picture and the ground say of a posed body.
pub(super) fn gather(equations: &mut Equations, scene: Scene, known: &Known) {
    let Scene { cast, figure, matching, .. } = scene;
    equations.clear();
    for (i, found) in matching.of.iter().enumerate() {
        if found.count > 0.0 {
            let normal = figure.normals[i];
            let residual = found.outside(figure.points[i], normal);
            let pull = if cast.samples[i].hairy { HAIR_PULL } else { CLOTH_PULL };
            let weight = found.count * trust(residual, known, pull) / (CELL_SIGMA * CELL_SIGMA);
            equations.add(&figure.row(cast, i, normal), residual, weight);
        } else if found.faces {
            outline(equations, scene, i, known);
        }
    }
    if let Some(ground) = known.ground {
        soles(equations, scene, ground, known);
    }
}

/// Weight of a match: less the farther off, and less where cloth may lie between.
fn trust(residual: f32, known: &Known, pull: f32) -> f32 {
    let share = residual / known.robust;
    let robust = (1.0 + share * share).powi(-2);
    if known.clothed && residual < 0.0 { pull * robust } else { robust }
}

fn outline(equations: &mut Equations, Scene { cast, figure, view, matching }: Scene, i: usize, known: &Known) {
    if known.ground.is_some_and(|g| figure.points[i].y < g + FLOOR_ZONE) {
        return;
    }
    let found = &matching.of[i];
    // Where there may be hair, the outline is that of the hair.
    let play = if known.clothed && cast.samples[i].hairy { 0.0 } else { OUTLINE_PLAY };
    if let Some((off, along)) = view.outside(found.seen, found.z)
        && off > play
    {
        let residual = (off - play).min(OUTLINE_REACH);
        equations.add(&figure.row(cast, i, along), residual, 1.0 / (OUTLINE_SIGMA * OUTLINE_SIGMA));
    }
}

fn soles(equations: &mut Equations, Scene { cast, figure, .. }: Scene, ground: f32, known: &Known) {
    for (i, _) in cast.samples.iter().enumerate().filter(|(_, s)| s.sole) {
        let residual = figure.above_rest(i) - ground;
        if residual.abs() < STANDING {
            let share = if known.clothed && residual > 0.0 { SHOE_PULL } else { 1.0 };
            equations.add(&figure.row_above_rest(cast, i), residual, share / (SOLE_SIGMA * SOLE_SIGMA));
        }
    }
}

/// Adds what people do with their joints: habit, limits, and that nobody moves at once.
pub(super) fn habits(equations: &mut Equations, cast: &Cast, state: &State, before: Option<&State>) {
    for (t, turn) in cast.turns.iter().enumerate() {
        let now = angle(&state.local, turn);
        equations.add_one(3 + t, now - turn.usual, turn.spread.powi(-2));
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

/// Most that the root moves in a step (m), and that a joint turns (rad).
const STRIDE: [f64; 2] = [0.25, 0.5];

/// The step, cut where it is longer than a linearisation holds.
pub(super) fn bounded(mut step: [f64; UNKNOWNS]) -> [f64; UNKNOWNS] {
    for (i, s) in step.iter_mut().enumerate().take(UNKNOWNS - SHAPES) {
        let most = STRIDE[usize::from(i >= 3)];
        *s = s.clamp(-most, most);
    }
    step
}

/// Mean of the residuals of the matches (m), root mean square over the cells.
pub(super) fn rms(figure: &Figure, matching: &Matching) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0);
    for (i, m) in matching.of.iter().enumerate().filter(|(_, m)| m.count > 0.0) {
        sum += m.count * m.outside(figure.points[i], figure.normals[i]).powi(2);
        count += m.count;
    }
    (sum / f32::max(count, 1.0)).sqrt()
}
