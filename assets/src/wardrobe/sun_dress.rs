//! The sun dress: rings from bust to hem, and two straps over the shoulders.

use glam::Vec3;

use super::drape::{DrapeBody, join};
use super::section::resample;
use super::style::{Cut, Style};
use crate::sizes::Girth;
use toile_bake::Shape;
use toile_base::body::Body;
use toile_base::garment::Part;

/// Where a strap begins, as a share of the ring from the front centre: over the middle of the breast.
const STRAP_SHARE: f32 = 0.105;

/// Ease of the upper edge (m): it lies on the skin.
const EDGE_EASE_M: f32 = 0.004;

struct SunDressDraft {
    columns: usize,
    bodice_rows: usize,
    /// Girth of every ring as cut (m), from the upper edge to the hem.
    girths: Vec<f32>,
    neckline: f32,
    skirt: f32,
    strap: std::ops::RangeInclusive<usize>,
    strap_rows: usize,
}

/// Drafts the dress for the body of its size and lays it on the shopper.
pub fn draft(style: &Style, cut: &Body, shopper: &Body) -> Shape {
    let plan = plan(style, cut);
    let cut_at = lay(&plan, DrapeBody::cut(cut));
    let worn_at = lay(&plan, DrapeBody::shopper(shopper));
    let mut shape = Shape::default();
    let n = plan.columns;
    let rings = plan.girths.len();
    for (i, (c, w)) in cut_at.into_iter().zip(worn_at).enumerate() {
        let row = i / n;
        shape.push(c, w, row <= plan.bodice_rows || row >= rings, Part::All);
    }
    let ring = |r: usize| (r * n..(r + 1) * n).map(|i| i as u32).collect::<Vec<_>>();
    for r in 1..rings {
        join(&mut shape, &ring(r - 1), &ring(r), true);
    }
    let first = (rings * n) as u32;
    for side in 0..2u32 {
        let strap = StrapEnds::new(&plan, side == 1);
        let width = strap.front.len();
        let base = first + side * (width * plan.strap_rows) as u32;
        let row = |r: usize| (0..width).map(|c| base + (r * width + c) as u32).collect::<Vec<_>>();
        join(&mut shape, &row(0), &strap.front, false);
        for r in 1..plan.strap_rows {
            join(&mut shape, &row(r), &row(r - 1), false);
        }
        join(&mut shape, &strap.back, &row(plan.strap_rows - 1), false);
    }
    shape
}

/// The ring vertices that a strap joins, in the order in which a ring runs at the front.
struct StrapEnds {
    front: Vec<u32>,
    back: Vec<u32>,
}

impl StrapEnds {
    fn new(plan: &SunDressDraft, right: bool) -> Self {
        let n = plan.columns as u32;
        let columns = plan.strap.clone().map(|c| c as u32);
        if right {
            Self {
                front: columns.clone().rev().map(|c| n - c).collect(),
                back: columns.rev().map(|c| n / 2 + c).collect(),
            }
        } else {
            Self { front: columns.clone().collect(), back: columns.map(|c| n / 2 - c).collect() }
        }
    }
}

fn plan(style: &Style, cut: &Body) -> SunDressDraft {
    let Cut::SunDress { neckline_mm, skirt_mm, hem_mm, strap_mm } = style.cut else {
        unreachable!("the wardrobe drafts each style by its own cut")
    };
    let form = DrapeBody::cut(cut);
    let (neckline, skirt, spacing) = (neckline_mm * 1e-3, skirt_mm * 1e-3, style.spacing_mm * 1e-3);
    let levels = &cut.levels;
    let ease = |zone| style.ease_mm.at(zone).unwrap_or(0.0);
    let columns = style.columns / 4 * 4;
    let bodice = levels.chest + neckline - levels.waist;
    let bodice_rows = (bodice / spacing).round().max(4.0) as usize;
    let mut girths = Vec::new();
    for r in 0..=bodice_rows {
        let y = levels.chest + neckline - bodice * r as f32 / bodice_rows as f32;
        let above = ((y - levels.chest) / neckline).max(0.0);
        let down = ((levels.chest - y) / (levels.chest - levels.waist)).max(0.0);
        let chest = ease(Girth::Chest) + (EDGE_EASE_M - ease(Girth::Chest)) * above;
        girths.push(form.girth(y) + chest + (ease(Girth::Waist) - ease(Girth::Chest)) * down);
    }
    let (waist, hip) = (girths[bodice_rows], form.girth(levels.hip) + ease(Girth::Hip));
    let to_hip = levels.waist - levels.hip;
    let skirt_rows = (skirt / spacing).round() as usize;
    for r in 1..=skirt_rows {
        let s = skirt * r as f32 / skirt_rows as f32;
        girths.push(if s < to_hip {
            waist + (hip - waist) * s / to_hip
        } else {
            hip + (hem_mm * 1e-3 - hip) * (s - to_hip) / (skirt - to_hip)
        });
    }
    let first = (columns as f32 * STRAP_SHARE) as usize;
    let width = (strap_mm * 1e-3 / (girths[0] / columns as f32)).round().max(1.0) as usize;
    let strap_rows = (2.4 * (levels.shoulder - levels.chest) / spacing).round().max(6.0) as usize;
    SunDressDraft { columns, bodice_rows, girths, neckline, skirt, strap: first..=first + width, strap_rows }
}

fn lay(plan: &SunDressDraft, form: DrapeBody<'_>) -> Vec<Vec3> {
    let levels = &form.body.levels;
    let top = levels.chest + plan.neckline;
    let skirt_rows = plan.girths.len() - 1 - plan.bodice_rows;
    let mut points = Vec::new();
    for (r, &girth) in plan.girths.iter().enumerate() {
        let y = if r <= plan.bodice_rows {
            top + (levels.waist - top) * r as f32 / plan.bodice_rows as f32
        } else {
            levels.waist - plan.skirt * (r - plan.bodice_rows) as f32 / skirt_rows as f32
        };
        points.extend(form.ring(y, girth, plan.columns));
    }
    for right in [false, true] {
        let ends = StrapEnds::new(plan, right);
        let pairs = ends.front.iter().zip(&ends.back).map(|(&f, &b)| (points[f as usize], points[b as usize]));
        let lines: Vec<Vec<Vec3>> =
            pairs.map(|(f, b)| resample(&form.over_shoulder(f, b, 0.5 * (f.x + b.x)), plan.strap_rows + 2)).collect();
        for r in 1..=plan.strap_rows {
            points.extend(lines.iter().map(|line| line[r]));
        }
    }
    points
}
