//! The visual hull: all places that every silhouette covers (Laurentini 1994), carved as an octree, and the person's shape by it.

use glam::{DMat3, DVec3};

use super::view::CameraSilhouette;
use crate::error::CaptureError;

/// Side of the cube in which the person is looked for (m), and how often it is halved: to 16 mm.
const SIDE: f64 = 4.0;
const LEVELS: usize = 8;

/// Heights between which shoulders and arms are, as shares of the hull's.
const SHOULDERS: [f64; 2] = [0.72, 0.86];

/// Heights between which the pelvis is.
const HIPS: [f64; 2] = [0.44, 0.60];

/// Share of the cells left out at each end of the height: a hull has tips that no body has.
const TIPS: usize = 1_000;

/// Shape of the person by the hull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct HullShape {
    /// Lowest and highest place (m).
    pub heights: [f64; 2],
    /// The middle of the pelvis' height (m).
    pub middle: DVec3,
    /// The horizontal direction along which shoulders and arms are spread.
    pub across: DVec3,
    /// Its volume (m3).
    pub volume: f64,
}

/// Carves the hull.
///
/// # Errors
/// One sentence where the silhouettes meet in no place.
pub(super) fn carve(views: &[CameraSilhouette]) -> Result<HullShape, CaptureError> {
    let nowhere = || {
        CaptureError::unfit(
            "the silhouettes",
            "there is no place that all cameras see within them",
            "check that pictures and cameras are in the same order, and that all were taken at one moment",
        )
    };
    let mut cells = vec![nearest_to_rays(views).ok_or_else(nowhere)?];
    let mut half = SIDE / 2.0;
    for _ in 0..LEVELS {
        half /= 2.0;
        let mut next = Vec::with_capacity(cells.len() * 2);
        for cell in &cells {
            for k in 0..8 {
                let corner = DVec3::new(side(k & 1), side(k & 2), side(k & 4));
                let at = *cell + corner * half;
                if views.iter().all(|v| may_hold(v, at, half)) {
                    next.push(at);
                }
            }
        }
        cells = next;
    }
    // What is left holds the middle of every cell within all silhouettes.
    cells.retain(|at| views.iter().all(|v| is_covered(v, *at)));
    if cells.is_empty() {
        return Err(nowhere());
    }
    Ok(shape(&mut cells, half))
}

fn side(bit: usize) -> f64 {
    if bit == 0 { -1.0 } else { 1.0 }
}

/// The place nearest to the rays through the middles of all silhouettes.
fn nearest_to_rays(views: &[CameraSilhouette]) -> Option<DVec3> {
    let (mut a, mut b) = (DMat3::ZERO, DVec3::ZERO);
    for view in views {
        let width = (f64::from(view.camera.size[0]) * view.scale).ceil().max(1.0) as usize;
        let inside = view.covered.iter().enumerate().filter(|(_, c)| **c).map(|(i, _)| (i % width, i / width));
        let (mut sum, mut count) = (glam::DVec2::ZERO, 0.0);
        for (x, y) in inside {
            sum += glam::DVec2::new(x as f64, y as f64);
            count += 1.0;
        }
        if count == 0.0 {
            return None;
        }
        let pixel = (sum / count + 0.5) / view.scale - 0.5;
        let ray = ((pixel - view.camera.centre()) / view.camera.focal()).extend(1.0);
        let along = (view.camera.rotation().transpose() * ray).normalize();
        let square = DMat3::IDENTITY - DMat3::from_cols(along * along.x, along * along.y, along * along.z);
        a += square;
        b += square * view.from;
    }
    let at = a.inverse() * b;
    at.is_finite().then_some(at)
}

/// Whether a cube may reach into a silhouette.
fn may_hold(view: &CameraSilhouette, at: DVec3, half: f64) -> bool {
    let seen = view.small(at);
    let radius = half * 3f64.sqrt();
    if seen.z < radius + 0.05 {
        return true;
    }
    let reach = radius * view.camera.focal().max_element() * view.scale / (seen.z - radius);
    view.field.at(seen.x, seen.y) <= reach + 1.0
}

fn is_covered(view: &CameraSilhouette, at: DVec3) -> bool {
    let seen = view.small(at);
    seen.z > 0.05 && view.field.at(seen.x, seen.y) < 0.5
}

fn shape(cells: &mut [DVec3], half: f64) -> HullShape {
    cells.sort_unstable_by(|a, b| a.y.total_cmp(&b.y));
    let skipped = cells.len() / TIPS;
    let heights = [cells[skipped].y - half, cells[cells.len() - 1 - skipped].y + half];
    let height = heights[1] - heights[0];
    let band = |[low, high]: [f64; 2]| {
        let within = (heights[0] + low * height)..(heights[0] + high * height);
        cells.iter().copied().filter(move |c| within.contains(&c.y))
    };
    let mean = |of: &mut dyn Iterator<Item = DVec3>| {
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        of.for_each(|p| (sum, count) = (sum + p, count + 1.0));
        sum / f64::max(count, 1.0)
    };
    let middle = mean(&mut band(HIPS));
    let centre = mean(&mut band(SHOULDERS));
    let (mut xx, mut xz, mut zz) = (0.0, 0.0, 0.0);
    for c in band(SHOULDERS) {
        let d = c - centre;
        (xx, xz, zz) = (xx + d.x * d.x, xz + d.x * d.z, zz + d.z * d.z);
    }
    let angle = 0.5 * (2.0 * xz).atan2(xx - zz);
    let across = DVec3::new(angle.cos(), 0.0, angle.sin());
    HullShape { heights, middle, across, volume: cells.len() as f64 * (2.0 * half).powi(3) }
}
