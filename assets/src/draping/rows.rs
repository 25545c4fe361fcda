//! Rows of cloth around the body: at each height of a pattern, how long the line is on which its panels lie.

use std::f64::consts::TAU;

use glam::{Vec2, Vec3};

use super::arrange::Arrangement;
use super::limits::CLEARANCE_M;
use super::outlines::{outline, width};
use super::panels::Around;
use super::section::{BodySection, RingFit, SectionPlane};
use crate::tailor::SewnMesh;
use toile_base::body::Body;

/// Height between two rows (m), half of the finest cloth's spacing above which folds are seen.
const STEP_M: f64 = 0.01;

/// Points of a ring.
const COLUMNS: usize = 96;

/// Lowest height at which a trunk or leg has an outline worth following (m): above the ankles.
const LOWEST_M: f32 = 0.12;

/// Flared cloth comes down by at least this part of its length (1): a circle skirt starts nearly level.
const LEAST_FALL: f64 = 0.3;

/// Where the armpit lies between the bust points and the shoulders (1).
const ARMPIT: f32 = 0.4;

/// How far above its lowest point the width of cloth at its hem is taken (m): chords of a curved hem end a little above it.
const ABOVE_HEM_M: f64 = 0.005;

/// A closed line around the body.
#[derive(Debug, Clone)]
pub struct RowRing {
    /// Points at equal distances, from the front over the left side (m).
    points: Vec<Vec3>,
    /// Its length (m).
    pub length: f32,
}

impl RowRing {
    fn new(section: Option<BodySection>, height: f32, girth: f32) -> Self {
        let level = SectionPlane::level(height);
        let points = match section {
            Some(section) => {
                let fit = RingFit { girth, gap: CLEARANCE_M };
                BodySection { plane: level, ..section }.ring(fit, COLUMNS, Vec2::Y, 0.0)
            }
            None => vec![Vec3::new(0.0, height, 0.0); COLUMNS],
        };
        let length = (0..COLUMNS).map(|i| points[i].distance(points[(i + 1) % COLUMNS])).sum();
        Self { points, length }
    }

    /// The point at a distance along the line from the front (m).
    pub fn at(&self, distance: f32) -> Vec3 {
        let place = (distance / self.length.max(f32::MIN_POSITIVE)).rem_euclid(1.0) * COLUMNS as f32;
        let first = (place as usize).min(COLUMNS - 1);
        self.points[first].lerp(self.points[(first + 1) % COLUMNS], place - first as f32)
    }
}

/// One height of the pattern.
#[derive(Debug, Clone)]
pub struct GarmentRow {
    /// Around the trunk, or both legs.
    pub trunk: RowRing,
    /// Around the left leg; the right one's is its mirror image.
    pub leg: Option<RowRing>,
}

/// All heights of a pattern, from its highest point down.
#[derive(Debug, Clone)]
pub struct Rows {
    top: f64,
    rows: Vec<GarmentRow>,
    /// Height of the armpits (m).
    pub armpit: f32,
    /// How far in front of the body and behind it panels hang above the armpits (m).
    pub planes: [f32; 2],
}

impl Rows {
    /// The rows of an arrangement.
    pub fn new(sewn: &SewnMesh, arranged: &Arrangement, body: &Body) -> Self {
        let levels = &body.levels;
        let armpit = levels.chest + ARMPIT * (levels.shoulder - levels.chest);
        let hung = |i: &usize| arranged.panels[*i].around == Around::Trunk;
        let all: Vec<usize> = (0..arranged.panels.len()).filter(hung).collect();
        let heights = all.iter().flat_map(|&i| outline(sewn, i).map(move |p| arranged.panels[i].at(p).y));
        let lowest = heights.fold(arranged.top, f64::min);
        let count = ((arranged.top - lowest) / STEP_M).ceil() as usize + 2;
        let mut out = Self { top: arranged.top, rows: Vec::with_capacity(count), armpit, planes: planes(body, armpit) };
        let mut y = arranged.top + arranged.lift;
        let mut radius = 0.0f64;
        for k in 0..count {
            // Below the hem there is no cloth whose width could be asked for: what lies between the last rows is as wide as it.
            let height = (arranged.top - STEP_M * k as f64).max(lowest + ABOVE_HEM_M);
            let wide = width(sewn, &arranged.panels, height, |_| true);
            let level = (y as f32).clamp(LOWEST_M, armpit);
            let trunk = RowRing::new(BodySection::trunk(body, level), y as f32, wide as f32);
            let leg = arranged.legs.as_ref().filter(|l| height < l.crotch + BLEND_M).map(|legs| {
                let wide = width(sewn, &arranged.panels, height, |i| legs.left[i] == Some(true));
                RowRing::new(BodySection::left_leg(body, level), y as f32, wide as f32)
            });
            // Cloth wider than the body flares: it comes down by less than its length.
            let free = wide > f64::from(trunk.length) - 1e-3 && y < f64::from(armpit);
            let own = if free { wide / TAU } else { radius };
            let out_by = if free && radius > 0.0 { (own - radius).max(0.0) } else { 0.0 };
            let fall = (STEP_M * STEP_M - out_by * out_by).max(0.0).sqrt().max(LEAST_FALL * STEP_M);
            radius = own;
            out.rows.push(GarmentRow { trunk, leg });
            y -= fall;
        }
        out
    }

    /// The rows above and below a height of the pattern (m), and how far it lies below the upper one (0 to 1).
    pub fn beside(&self, height: f64) -> (&GarmentRow, &GarmentRow, f32) {
        let place = ((self.top - height) / STEP_M).clamp(0.0, (self.rows.len() - 1) as f64);
        let first = (place as usize).min(self.rows.len() - 2);
        (&self.rows[first], &self.rows[first + 1], (place - first as f64) as f32)
    }
}

/// Height over the crotch in which cloth passes from the trunk to the legs (m).
pub const BLEND_M: f64 = 0.1;

/// Planes in front of the body and behind it, from the armpits up.
fn planes(body: &Body, armpit: f32) -> [f32; 2] {
    let near = body.mesh.positions.iter().filter(|p| (armpit - 0.05..body.levels.shoulder).contains(&p.y));
    let near = near.filter(|p| p.x.abs() < 0.25).map(|p| p.z);
    let [low, high] = near.fold([f32::MAX, f32::MIN], |[l, h], z| [l.min(z), h.max(z)]);
    [high + CLEARANCE_M, low - CLEARANCE_M]
}
