//! Panels fitted to each other, and together to the body: no coordinate is stretched, whole panels are shifted.
//!
//! The formats place panels around bodies of their own, with origins of their own (the floor, or some height of the
//! trunk). What is taken from them is the side of each panel; heights follow from the seams, and the whole is hung where
//! the body carries it: from the shoulders, or where the trunk is as wide as the upper edge.

use std::f64::consts::TAU;

use glam::DVec2;

use super::error::DrapeError;
use super::legs::{Legs, legs};
use super::limits::CLEARANCE_M;
use super::outlines::{coordinates, outline, width};
use super::panels::{Around, ArrangedPanel, faces, panels};
use super::sleeves;
use crate::body::tape::girth;
use crate::pattern::Pattern;
use crate::tailor::SewnMesh;
use toile_base::body::{Body, Region};

/// The panels of a pattern around a body.
#[derive(Debug, Clone)]
pub struct Arrangement {
    /// Each panel `[panels]`.
    pub panels: Vec<ArrangedPanel>,
    /// What is added to a height of the coordinates to give one of the body (m), where nothing flares.
    pub lift: f64,
    /// The highest coordinate of the trunk's panels (m).
    pub top: f64,
    /// How wide its panels are together just below that (m).
    pub upper_edge: f64,
    /// The highest coordinate of the seams that join front and back at the sides (m), if there are any.
    pub underarm: Option<f64>,
    /// Whether it hangs from the shoulders.
    pub shoulders: bool,
    /// Its legs, if it has any.
    pub legs: Option<Legs>,
    /// Whether the panels' outsides lie inwards.
    pub inside_out: bool,
}

/// The arrangement of a pattern that was meshed coarsely.
///
/// # Errors
/// [`DrapeError::NoPlace`], [`DrapeError::NoSeams`].
pub fn arrange(pattern: &Pattern, sewn: &SewnMesh, body: &Body) -> Result<Arrangement, DrapeError> {
    if pattern.seams().is_empty() {
        return Err(DrapeError::NoSeams);
    }
    let mut all = panels(pattern, sewn)?;
    let inside_out = inside_out(pattern, &all);
    sleeves::unroll(pattern, sewn, &mut all);
    align(pattern, sewn, &mut all);
    let runs = front_to_back(pattern, sewn, &all);
    let shoulder = shoulder(&runs, sewn, &all);
    for (i, panel) in all.iter_mut().enumerate() {
        let lowest = outline(sewn, i).map(|p| panel.at(p).y).fold(f64::MAX, f64::min);
        if panel.around == Around::Trunk
            && faces(panel.angle).is_none()
            && shoulder.is_some_and(|s| lowest > s.y - 0.25)
        {
            panel.around = Around::Head;
        }
    }
    let trunk = |i: &usize| all[*i].around == Around::Trunk;
    let heights =
        (0..all.len()).filter(trunk).flat_map(|i| outline(sewn, i).map(|p| all[i].at(p).y).collect::<Vec<_>>());
    let top = heights.fold(f64::MIN, f64::max);
    let upper_edge = upper_edge(sewn, &all, top);
    let legs = legs(sewn, &all);
    let lift = match shoulder {
        Some(seam) => shoulder_height(body, seam.x) + f64::from(CLEARANCE_M) - seam.y,
        None => {
            // Just below the edge, where its panels are as wide as it is.
            let at = |drop: f64| width(sewn, &all, top - drop.max(BELOW_EDGE_M), |_| true);
            let hung = hanging_height(body, at) - top;
            // Trousers are not pulled up into the body.
            legs.as_ref().map_or(hung, |l| hung.min(f64::from(body.levels.crotch) - 0.01 - l.crotch))
        }
    };
    let underarm = underarm(&runs, shoulder);
    Ok(Arrangement { panels: all, lift, top, upper_edge, underarm, shoulders: shoulder.is_some(), legs, inside_out })
}

/// Whether most panels show their inside outwards: then so do all.
fn inside_out(pattern: &Pattern, all: &[ArrangedPanel]) -> bool {
    let outwards = |(i, panel): (usize, &ArrangedPanel)| {
        let place = pattern.panels()[i].placement.map_or(glam::DVec3::Z, |p| p.rotation * glam::DVec3::Z);
        let shown = if pattern.shows_inside(i) { -place } else { place };
        shown.dot(glam::DVec3::new(panel.angle.sin(), 0.0, panel.angle.cos()))
    };
    all.iter().enumerate().map(outwards).sum::<f64>() < 0.0
}

/// Shifts panels so that their seams meet: heights in any case, and what is around the body where no source placed it.
fn align(pattern: &Pattern, sewn: &SewnMesh, all: &mut [ArrangedPanel]) {
    let unplaced = |i: usize| pattern.panels()[i].placement.is_none_or(|p| p.translation == glam::DVec3::ZERO);
    let hung: Vec<usize> = (0..all.len()).filter(|&i| all[i].around == Around::Trunk).collect();
    for &i in hung.iter().filter(|&&i| unplaced(i)) {
        let around = outline(sewn, i).map(|p| all[i].at(p).x);
        let (low, high) = around.fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
        all[i].shift.x -= 0.5 * (low + high);
    }
    let area = |i: &usize| pattern.panels()[*i].signed_area().abs();
    let Some(first) = hung.iter().copied().max_by(|a, b| area(a).total_cmp(&area(b))) else { return };
    let mut placed = vec![false; all.len()];
    placed[first] = true;
    // The panel with the most common points to what is placed comes next.
    loop {
        let mut best: Option<(usize, usize, DVec2, usize)> = None;
        for &i in hung.iter().filter(|&&i| !placed[i]) {
            let (mut off, mut count, mut along, mut same) = (0.0, 0, 0.0, 0);
            for members in &sewn.members {
                for a in members.iter().filter(|a| a[0] as usize == i) {
                    for b in members.iter().filter(|b| placed[b[0] as usize]) {
                        let (p, q) = (coordinates(sewn, all, *a), coordinates(sewn, all, *b));
                        off += q.y - p.y;
                        count += 1;
                        if (all[i].angle - all[b[0] as usize].angle).abs() < 1e-3 {
                            along += q.x - p.x;
                            same += 1;
                        }
                    }
                }
            }
            if count > 0 && best.as_ref().is_none_or(|b| count > b.1) {
                let along = if same > 0 { along / f64::from(same) } else { 0.0 };
                best = Some((i, count, DVec2::new(along, off / count as f64), same as usize));
            }
        }
        let Some((i, _, by, _)) = best else { return };
        all[i].shift.y += by.y;
        if unplaced(i) {
            all[i].shift.x += by.x;
        }
        placed[i] = true;
    }
}

/// Seams of shoulders lie in the upper part of the panels that they join (part of their height).
const UPPER: f64 = 0.55;

/// A run of a seam that joins front and back of the trunk: the panel of this side, and its course there (m).
type FrontToBack = (usize, Vec<DVec2>);

/// Both sides of every seam that joins front and back of the trunk.
fn front_to_back(pattern: &Pattern, sewn: &SewnMesh, all: &[ArrangedPanel]) -> Vec<FrontToBack> {
    let mut runs = Vec::new();
    for (seam, points) in pattern.seams().iter().zip(&sewn.seams) {
        let sides = seam.sides.map(|s| s.panel);
        let facing = sides.map(|p| (all[p].around == Around::Trunk).then(|| faces(all[p].angle)).flatten());
        let (Some(a), Some(b)) = (facing[0], facing[1]) else { continue };
        if a == b {
            continue;
        }
        for panel in sides {
            let of = |v: &u32| sewn.members[*v as usize].iter().find(|m| m[0] as usize == panel).copied();
            let run: Vec<DVec2> = points.iter().filter_map(of).map(|m| coordinates(sewn, all, m)).collect();
            if run.len() > 1 {
                runs.push((panel, run));
            }
        }
    }
    runs
}

/// Whether a run goes across rather than down.
fn goes_across(run: &[DVec2]) -> bool {
    let way = run[run.len() - 1] - run[0];
    way.x.abs() > way.y.abs()
}

/// The middle of the shoulder seams, if there are any: how far from the middle of the body, and how high. They join front
/// and back, run across rather than down, and lie near the top.
fn shoulder(runs: &[FrontToBack], sewn: &SewnMesh, all: &[ArrangedPanel]) -> Option<DVec2> {
    let (mut sum, mut count) = (DVec2::ZERO, 0.0);
    for (panel, run) in runs {
        let span = outline(sewn, *panel).map(|p| all[*panel].at(p).y);
        let (low, high) = span.fold((f64::MAX, f64::MIN), |(l, h), y| (l.min(y), h.max(y)));
        let middle = 0.5 * (run[0] + run[run.len() - 1]);
        if goes_across(run) && middle.y > low + UPPER * (high - low) && middle.x.abs() > 0.02 {
            sum += DVec2::new(middle.x.abs(), middle.y);
            count += 1.0;
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// Where the side seams end above, at the armpits (m): below it the panels go all around. What joins front and back above the
/// shoulders is a collar.
fn underarm(runs: &[FrontToBack], shoulder: Option<DVec2>) -> Option<f64> {
    let side = |run: &[DVec2]| !goes_across(run) && shoulder.is_none_or(|s| run.iter().all(|p| p.y < s.y));
    let down = runs.iter().filter(|(_, run)| side(run)).flat_map(|(_, run)| run.iter().map(|p| p.y));
    down.reduce(f64::max)
}

/// Height of the shoulder at a distance from the middle (m).
fn shoulder_height(body: &Body, x: f64) -> f64 {
    let near = |i: &usize| {
        let p = body.mesh.positions[*i];
        let region = matches!(body.regions[*i], Region::Torso | Region::LeftArm);
        region && (f64::from(p.x) - x).abs() < 0.015
    };
    let heights = (0..body.mesh.positions.len()).filter(near).map(|i| f64::from(body.mesh.positions[i].y));
    heights.fold(f64::MIN, f64::max).max(f64::from(body.levels.shoulder))
}

/// How far below its upper edge the edge's length is taken (m).
const BELOW_EDGE_M: f64 = 0.015;

/// Length of the upper edge of a garment without shoulders (m): how wide its panels are just below it.
fn upper_edge(sewn: &SewnMesh, all: &[ArrangedPanel], top: f64) -> f64 {
    width(sewn, all, top - BELOW_EDGE_M, |_| true)
}

/// The height at which a garment hangs by its upper edge (m): the lowest, between the waist and half of the way to the hip,
/// at which it is wider than the trunk all the way down to the hip; where it is nowhere, that at which least is missing.
fn hanging_height(body: &Body, width: impl Fn(f64) -> f64) -> f64 {
    let (waist, hip) = (f64::from(body.levels.waist), f64::from(body.levels.hip));
    let steps = (0.5 * (waist - hip) / STEP_M) as usize;
    let trunk: Vec<f64> = (0..=2 * steps).map(|i| f64::from(girth(body, (waist - i as f64 * STEP_M) as f32))).collect();
    let garment: Vec<f64> = (0..=2 * steps).map(|i| width(i as f64 * STEP_M)).collect();
    let missing = |edge: usize| {
        let levels = trunk[edge..].iter().zip(&garment).filter(|(_, width)| **width > 0.0);
        levels.map(|(trunk, width)| (trunk + TAU * 0.002 - width).max(0.0)).fold(0.0, f64::max)
    };
    let best = (0..=steps).rev().min_by(|a, b| missing(*a).total_cmp(&missing(*b))).unwrap_or(0);
    waist - best as f64 * STEP_M
}

/// Steps in which a garment's height is looked for (m).
const STEP_M: f64 = 0.005;
