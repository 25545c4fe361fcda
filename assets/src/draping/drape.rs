//! The levels of draping, from panels around the body to cloth that hangs.

use std::time::Instant;

use glam::Vec3;

use super::arrange::{Arrangement, arrange};
use super::carry::{carry, carry_over};
use super::error::DrapeError;
use super::legs::free_loops;
use super::limits::{LEVELS_M, MAX_OPEN_MM, MAX_STRETCH};
use super::outlines::coordinates;
use super::panels::Around;
use super::place::Placer;
use super::quality::{self, DrapeQuality};
use super::relax::{RelaxRun, Relaxation};
use super::skin_field::SkinField;
use super::springs::{Springs, panel_starts, shape, unsewn_shape};
use crate::pattern::Pattern;
use crate::tailor::{SewnMesh, sew};
use toile_bake::Shape;
use toile_base::body::Body;
use toile_base::fabric::Fabric;

/// What a level took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrapeLevel {
    /// Spacing of its mesh (m).
    pub spacing: f64,
    /// Time that it took (s).
    pub seconds: f64,
}

/// A pattern as it hangs on a body.
#[derive(Debug, Clone)]
pub struct DrapedPattern {
    /// The mesh of the final spacing.
    pub sewn: SewnMesh,
    /// Where its vertices lie on the body at rest (m) `[vertices]`.
    pub at: Vec<Vec3>,
    /// The panels around the body before they were sewn, at the first level.
    pub placed: Shape,
    /// The levels in their order.
    pub levels: Vec<DrapeLevel>,
    /// How well it was draped.
    pub quality: DrapeQuality,
    /// How the panels lie around the body.
    pub(super) arranged: Arrangement,
    /// What holds it up: vertices of the upper edge of a garment without shoulders `[vertices]`.
    pub(super) held: Vec<bool>,
}

impl DrapedPattern {
    /// The final mesh as it hangs, nothing held, for pictures.
    pub fn hanging(&self) -> Shape {
        shape(&self.sewn, self.at.clone())
    }
}

/// Steps without gravity in which the seams of the first level close.
const CLOSING: RelaxRun =
    RelaxRun { steps: 500, step_s: 1.0 / 500.0, gravity: 0.0, kept: 0.6, seam: 0.6, shear: 60.0, exact: false };

/// Steps without gravity in which sewn cloth takes its lengths.
const SMOOTHING: RelaxRun =
    RelaxRun { steps: 250, step_s: 1.0 / 500.0, gravity: 0.0, kept: 0.7, seam: 0.0, shear: 30.0, exact: false };

/// Steps in which cloth comes down. Short ones: a sweep of a longer step leaves threads stretched by their weight, and what springs
/// back from there is crumpled (a flared dress at 1/900 s: strain 20 % at the 99th percentile, at 1/4000 s under 1 %). Calm ones:
/// cloth that swings goes through itself.
const HANGING: RelaxRun =
    RelaxRun { steps: 1600, step_s: 1.0 / 4000.0, gravity: 9.81, kept: 0.98, seam: 0.0, shear: 20.0, exact: false };

/// Steps in which it comes to rest, out of the skin exactly: so short that its weight stretches it no more than the fabric lets it.
const RESTING: RelaxRun =
    RelaxRun { steps: 500, step_s: 1.0 / 9000.0, gravity: 9.81, kept: 0.9, seam: 0.0, shear: 20.0, exact: true };

/// Steps in which cloth comes down that was carried over from another body, where it hung already.
const HANGING_ON: RelaxRun = RelaxRun { steps: 400, ..HANGING };

/// Lays a pattern around a body, sews it and lets it hang, at a spacing (m).
///
/// # Errors
/// One sentence: the panel or seam, what is wrong, and the cure.
pub fn drape(pattern: &Pattern, body: &Body, fabric: &Fabric, spacing: f64) -> Result<DrapedPattern, DrapeError> {
    drape_around(pattern, (body, &SkinField::new(body)), fabric, spacing)
}

/// The same with the skin's field at hand.
pub(super) fn drape_around(
    pattern: &Pattern,
    (body, field): (&Body, &SkinField),
    fabric: &Fabric,
    spacing: f64,
) -> Result<DrapedPattern, DrapeError> {
    let mut spacings: Vec<f64> = LEVELS_M.into_iter().filter(|s| *s > 1.25 * spacing).collect();
    spacings.push(spacing);
    let mut start = Instant::now();
    let mut sewn = sew(pattern, spacings[0])?;
    let arranged = arrange(pattern, &sewn, body)?;
    let first = FirstLevel::new(&sewn, &arranged, body, fabric);
    let (mut at, open) = first.close(pattern, &sewn, field)?;
    let mut levels = Vec::new();
    let last = spacings.len() - 1;
    let mut held = Vec::new();
    let mut springs = None;
    for (k, &spacing) in spacings.iter().enumerate() {
        if k > 0 {
            let finer = sew(pattern, spacing)?;
            at = carry(&sewn, &at, &finer);
            sewn = finer;
        }
        let own = Springs::new(&shape(&sewn, at.clone()), fabric, Vec::new());
        let smoothing = if k == 0 || k < last { SMOOTHING.steps } else { SMOOTHING.steps / 3 };
        let hanging: &[RelaxRun] = match last - k {
            0 => &[HANGING, RESTING],
            1 => &[HANGING],
            _ => &[],
        };
        (at, held) = come_down((&sewn, &arranged), at, (&own, field), smoothing, hanging);
        springs = Some(own);
        levels.push(DrapeLevel { spacing, seconds: start.elapsed().as_secs_f64() });
        start = Instant::now();
    }
    let springs = springs.ok_or(DrapeError::NoSeams)?;
    let quality = judged(body, field, &sewn, &springs, &at, open);
    let placed = first.placed;
    let draped = DrapedPattern { sewn, at, placed, levels, quality, arranged, held };
    check(pattern, &draped, &springs)?;
    Ok(draped)
}

/// Lets a pattern hang on a body that hangs on another one already: it is carried over with the skin and comes to rest.
/// Where it lies differs from that by folds that could lie either way.
///
/// # Errors
/// As [`drape`].
pub(super) fn drape_on(
    (hung, from): (&DrapedPattern, &Body),
    pattern: &Pattern,
    (body, field): (&Body, &SkinField),
    fabric: &Fabric,
) -> Result<DrapedPattern, DrapeError> {
    let start = Instant::now();
    let sewn = hung.sewn.clone();
    let arranged = arrange(pattern, &sewn, body)?;
    let at = carry_over(from, body, &hung.at);
    let springs = Springs::new(&shape(&sewn, at.clone()), fabric, Vec::new());
    let smoothing = SMOOTHING.steps / 8;
    let (at, held) = come_down((&sewn, &arranged), at, (&springs, field), smoothing, &[HANGING_ON, RESTING]);
    let spacing = hung.levels.last().map_or(0.0, |level| level.spacing);
    let levels = vec![DrapeLevel { spacing, seconds: start.elapsed().as_secs_f64() }];
    let quality = judged(body, field, &sewn, &springs, &at, hung.quality.seams_open);
    let draped = DrapedPattern { sewn, at, placed: hung.placed.clone(), levels, quality, arranged, held };
    check(pattern, &draped, &springs)?;
    Ok(draped)
}

/// Cloth takes its lengths in so many steps, nothing held; then it comes down in runs of steps, by its upper edge where it has no
/// shoulders. Where it lies then (m), and what is held `[vertices]`.
fn come_down(
    (sewn, arranged): (&SewnMesh, &Arrangement),
    at: Vec<Vec3>,
    (springs, field): (&Springs, &SkinField),
    smoothing: usize,
    hanging: &[RelaxRun],
) -> (Vec<Vec3>, Vec<bool>) {
    let sides = sides(sewn, arranged);
    let free = vec![false; at.len()];
    let held = if arranged.shoulders { free.clone() } else { upper_edge(sewn, arranged) };
    let mut relaxed = Relaxation { at, springs, field, sides: &sides, held: &free };
    relaxed.run(&RelaxRun { steps: smoothing, ..SMOOTHING });
    relaxed.held = &held;
    hanging.iter().for_each(|run| relaxed.run(run));
    (relaxed.at, held)
}

/// How well a pattern hangs whose seams were so far open (m).
fn judged(
    body: &Body,
    field: &SkinField,
    sewn: &SewnMesh,
    springs: &Springs,
    at: &[Vec3],
    seams_open: f64,
) -> DrapeQuality {
    let [strain_mean, strain_p99, strain_max] = quality::strain(springs, at);
    DrapeQuality {
        strain_mean,
        strain_p99,
        strain_max,
        seams_open,
        crossings: quality::crossings(body, at, &shape(sewn, at.to_vec()).triangles()),
        penetration: quality::penetration(field, at),
    }
}

/// Panels around the body, each with vertices of its own.
struct FirstLevel {
    placed: Shape,
    springs: Springs,
}

impl FirstLevel {
    fn new(sewn: &SewnMesh, arranged: &Arrangement, body: &Body, fabric: &Fabric) -> Self {
        let placer = Placer::new(sewn, arranged, body);
        let points = sewn.panels.iter().enumerate().flat_map(|(i, p)| p.points.iter().map(move |q| (i, *q)));
        let at: Vec<Vec3> = points.map(|(panel, point)| placer.place(panel, point)).collect();
        let placed = unsewn_shape(sewn, at);
        let first = panel_starts(sewn);
        let own = |m: &[u32; 2]| first[m[0] as usize] as u32 + m[1];
        let pairs =
            sewn.members.iter().flat_map(|m| m.windows(2).map(|w| [own(&w[0]), own(&w[1])]).collect::<Vec<_>>());
        let springs = Springs::new(&placed, fabric, pairs.collect());
        Self { placed, springs }
    }

    /// Closes the seams: the places of the sewn vertices, and the widest gap that was left (m).
    fn close(&self, pattern: &Pattern, sewn: &SewnMesh, field: &SkinField) -> Result<(Vec<Vec3>, f64), DrapeError> {
        let count = self.placed.cut.len();
        let (sides, held) = (vec![None; count], vec![false; count]);
        let mut relaxed =
            Relaxation { at: self.placed.worn.clone(), springs: &self.springs, field, sides: &sides, held: &held };
        let first = panel_starts(sewn);
        relaxed.run(&CLOSING);
        let place = |m: &[u32; 2]| relaxed.at[first[m[0] as usize] + m[1] as usize];
        let widest = widest_gap(pattern, sewn, place)?;
        let mean = |m: &Vec<[u32; 2]>| m.iter().map(place).sum::<Vec3>() / m.len() as f32;
        Ok((sewn.members.iter().map(mean).collect(), widest))
    }
}

/// The widest gap of all seams (m).
///
/// # Errors
/// [`DrapeError::Open`]: a seam that stays too far open.
fn widest_gap(pattern: &Pattern, sewn: &SewnMesh, place: impl Fn(&[u32; 2]) -> Vec3) -> Result<f64, DrapeError> {
    let spread = |v: usize| {
        let members = &sewn.members[v];
        members.iter().flat_map(|a| members.iter().map(move |b| (a, b))).map(|(a, b)| place(a).distance(place(b)))
    };
    let gap = |v: &u32| f64::from(spread(*v as usize).fold(0.0, f32::max));
    let mut widest = 0.0f64;
    for (seam, points) in pattern.seams().iter().zip(&sewn.seams) {
        let open = points.iter().map(gap).fold(0.0, f64::max);
        if open * 1e3 > MAX_OPEN_MM {
            return Err(DrapeError::Open { seam: seam.name.clone(), open_mm: open * 1e3 });
        }
        widest = widest.max(open);
    }
    Ok(widest)
}

/// The side of the middle that vertices of legs belong to, below the crotch.
fn sides(sewn: &SewnMesh, arranged: &Arrangement) -> Vec<Option<bool>> {
    let Some(legs) = &arranged.legs else { return vec![None; sewn.members.len()] };
    let one = |members: &Vec<[u32; 2]>| {
        let low = |m: &[u32; 2]| coordinates(sewn, &arranged.panels, *m).y < legs.crotch - 1e-3;
        let side = legs.left[members[0][0] as usize];
        let all = members.iter().all(|m| legs.left[m[0] as usize] == side && low(m));
        if all { side } else { None }
    };
    sewn.members.iter().map(one).collect()
}

/// How far below a panel's highest point its upper edge is held (m): less than a waistband is broad.
const HELD_M: f64 = 0.04;

/// The vertices of the highest free edge: what a garment without shoulders hangs by.
fn upper_edge(sewn: &SewnMesh, arranged: &Arrangement) -> Vec<bool> {
    let height = |v: &u32| {
        let hung = sewn.members[*v as usize].iter().filter(|m| arranged.panels[m[0] as usize].around == Around::Trunk);
        hung.map(|m| coordinates(sewn, &arranged.panels, *m).y).fold(f64::MIN, f64::max)
    };
    let mut held = vec![false; sewn.members.len()];
    let loops = free_loops(sewn);
    let mean = |l: &Vec<u32>| l.iter().map(height).sum::<f64>() / l.len() as f64;
    let highest = loops.iter().max_by(|a, b| mean(a).total_cmp(&mean(b)));
    // A band that is open at its ends has one edge above and below: of each panel the upper part holds.
    if let Some(edge) = highest {
        let on = |v: &u32, panel: u32| sewn.members[*v as usize].iter().any(|m| m[0] == panel);
        for panel in 0..sewn.panels.len() as u32 {
            let own: Vec<u32> = edge.iter().copied().filter(|v| on(v, panel)).collect();
            let top = own.iter().map(height).fold(f64::MIN, f64::max);
            own.iter().filter(|v| height(v) > top - HELD_M).for_each(|v| held[*v as usize] = true);
        }
    }
    held
}

/// What no customer is shown: panels on the wrong side of the body, or far too tight ones.
fn check(pattern: &Pattern, draped: &DrapedPattern, springs: &Springs) -> Result<(), DrapeError> {
    let DrapedPattern { sewn, at, arranged, .. } = draped;
    let hung: Vec<usize> = (0..arranged.panels.len()).filter(|&i| arranged.panels[i].around == Around::Trunk).collect();
    let middle = |panel: usize| {
        sewn.number[panel].iter().map(|v| at[*v as usize]).sum::<Vec3>() / sewn.number[panel].len() as f32
    };
    let centre = hung.iter().map(|&i| middle(i)).sum::<Vec3>() / hung.len().max(1) as f32;
    for &i in &hung {
        let angle = arranged.panels[i].angle;
        let out = Vec3::new(angle.sin() as f32, 0.0, angle.cos() as f32);
        let off = f64::from((middle(i) - centre).dot(out));
        if hung.len() > 1 && arranged.legs.is_none() && off < -0.02 {
            return Err(DrapeError::WrongSide { panel: pattern.panels()[i].name.clone(), off_mm: -off * 1e3 });
        }
    }
    let mut stretch = vec![(0.0f64, 0.0f64); pattern.panels().len()];
    for link in springs.links.iter().filter(|l| l.thread) {
        let panel = sewn.members[link.ends[0] as usize][0][0] as usize;
        let [a, b] = link.ends.map(|v| at[v as usize]);
        stretch[panel].0 += f64::from(a.distance(b) / link.rest - 1.0);
        stretch[panel].1 += 1.0;
    }
    let worst = stretch.iter().enumerate().map(|(i, s)| (i, s.0 / s.1.max(1.0))).max_by(|a, b| a.1.total_cmp(&b.1));
    match worst {
        Some((i, mean)) if mean > MAX_STRETCH => {
            Err(DrapeError::Tight { panel: pattern.panels()[i].name.clone(), percent: mean * 100.0 })
        }
        _ => Ok(()),
    }
}
