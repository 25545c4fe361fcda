//! Wide trousers: rings from the waistband to the crotch, where a line of vertices between the legs closes each half
//! ring into a leg.

use glam::{Vec2, Vec3};

use super::drape::{DrapeBody, flip, join};
use super::section::{BodySection, RingFit};
use super::style::{Cut, Style};
use crate::sizes::Girth;
use toile_bake::Shape;
use toile_base::body::Body;
use toile_base::garment::Part;

/// Height of the skinned waistband (m).
const WAISTBAND_M: f32 = 0.04;

/// Length of the crotch line as a share of the girth at the hip: the usual crotch extension of trousers.
const CROTCH_SHARE: f32 = 0.13;

/// The leg's inner side keeps this far from the middle when it starts on the shopper (m).
const MIDDLE_GAP_M: f32 = 0.004;

struct TrousersDraft {
    /// Columns around the hip, even.
    columns: usize,
    /// Vertices of the crotch line between front and back centre.
    crotch: usize,
    /// Girth of each ring from waistband to crotch (m).
    rings: Vec<f32>,
    /// Girth of each row of a leg (m).
    legs: Vec<f32>,
    waistband: f32,
    drop: f32,
    inseam: f32,
}

/// Drafts the trousers for the body of their size and lays them on the shopper.
pub fn draft(style: &Style, cut: &Body, shopper: &Body) -> Shape {
    let plan = plan(style, cut);
    let spacing = style.spacing_mm * 1e-3;
    let fixed_rows = (WAISTBAND_M / spacing).round().max(1.0) as usize;
    let mut shape = Shape::default();
    for (i, (c, w)) in
        lay(&plan, DrapeBody::cut(cut)).into_iter().zip(lay(&plan, DrapeBody::shopper(shopper))).enumerate()
    {
        shape.push(c, w, i / plan.columns <= fixed_rows, part(&plan, i));
    }
    connect(&mut shape, &plan);
    shape
}

/// Vertices are in the order of [`lay`].
fn part(plan: &TrousersDraft, i: usize) -> Part {
    let left = plan.rings.len() * plan.columns + plan.crotch;
    let leg = (plan.columns / 2 + 1 + plan.crotch) * plan.legs.len();
    if i < left {
        Part::Trunk
    } else if i < left + leg {
        Part::LeftLeg
    } else {
        Part::RightLeg
    }
}

fn plan(style: &Style, cut: &Body) -> TrousersDraft {
    let Cut::WideTrousers { waistband_mm, inseam_mm, hem_mm, crotch_drop_mm } = style.cut else {
        unreachable!("the wardrobe drafts each style by its own cut")
    };
    let form = DrapeBody::cut(cut);
    let levels = &cut.levels;
    let ease = |zone| style.ease_mm.at(zone).unwrap_or(0.0);
    let (waistband, drop, inseam) = (waistband_mm * 1e-3, crotch_drop_mm * 1e-3, inseam_mm * 1e-3);
    let spacing = style.spacing_mm * 1e-3;
    let (top, bottom) = (levels.waist + waistband, levels.crotch - drop);
    let columns = style.columns / 4 * 4;
    let rows = ((top - bottom) / spacing).round() as usize;
    let (waist, hip) = (form.girth(levels.waist) + ease(Girth::Waist), form.girth(levels.hip) + ease(Girth::Hip));
    let rings = (0..=rows).map(|r| {
        let y = top + (bottom - top) * r as f32 / rows as f32;
        let down = ((levels.waist - y) / (levels.waist - levels.hip)).clamp(0.0, 1.0);
        if y >= levels.waist { form.girth(y) + ease(Girth::Waist) } else { waist + (hip - waist) * down }
    });
    let rings: Vec<f32> = rings.collect();
    let cell = hip / columns as f32;
    let crotch = (CROTCH_SHARE * hip / cell).round().max(3.0) as usize;
    let thigh = (columns / 2 + 1 + crotch) as f32 * cell;
    let leg_rows = (inseam / spacing).round() as usize;
    let hem = hem_mm * 1e-3;
    let legs = (1..=leg_rows).map(|r| thigh + (hem - thigh) * r as f32 / leg_rows as f32).collect();
    TrousersDraft { columns, crotch, rings, legs, waistband, drop, inseam }
}

/// Positions: the rings, the crotch line, the left leg, the right leg.
fn lay(plan: &TrousersDraft, form: DrapeBody<'_>) -> Vec<Vec3> {
    let levels = &form.body.levels;
    let (top, bottom) = (levels.waist + plan.waistband, levels.crotch - plan.drop);
    let last = (plan.rings.len() - 1) as f32;
    let mut points = Vec::new();
    for (r, &girth) in plan.rings.iter().enumerate() {
        points.extend(form.ring(top + (bottom - top) * r as f32 / last, girth, plan.columns));
    }
    let base = points.len() - plan.columns;
    let (front, back) = (points[base], points[base + plan.columns / 2]);
    for k in 1..=plan.crotch {
        points.push(back.lerp(front, k as f32 / (plan.crotch + 1) as f32));
    }
    let left: Vec<Vec3> = (0..plan.legs.len()).flat_map(|r| leg_ring(plan, form, bottom, r)).collect();
    let right = left.iter().map(|p| Vec3::new(-p.x, p.y, p.z)).collect::<Vec<_>>();
    points.extend(left);
    points.extend(right);
    points
}

/// One row of the left leg: from the front centre over the outside to the back centre, then along the inside.
fn leg_ring(plan: &TrousersDraft, form: DrapeBody<'_>, bottom: f32, row: usize) -> Vec<Vec3> {
    let columns = plan.columns / 2 + 1 + plan.crotch;
    let down = plan.inseam * (row + 1) as f32 / plan.legs.len() as f32;
    let height = bottom - down;
    let fit = RingFit { girth: plan.legs[row], gap: form.gap };
    let section = BodySection::left_leg(form.body, height.max(0.12));
    let Some(section) = section else { return vec![Vec3::new(0.1, height, 0.0); columns] };
    // The outer side is the middle of the first half ring, so its first column lies a quarter of the hip before it.
    let ring = section.ring(fit, columns, Vec2::X, plan.columns as f32 / 4.0);
    let inner = if form.gap > 0.0 { MIDDLE_GAP_M } else { f32::NEG_INFINITY };
    ring.into_iter().map(|p| Vec3::new(p.x.max(inner), height, p.z)).collect()
}

fn connect(shape: &mut Shape, plan: &TrousersDraft) {
    let n = plan.columns;
    let rings = plan.rings.len();
    let ring = |r: usize| (r * n..(r + 1) * n).map(|i| i as u32).collect::<Vec<_>>();
    for r in 1..rings {
        join(shape, &ring(r - 1), &ring(r), true);
    }
    let columns = n / 2 + 1 + plan.crotch;
    let crotch = (rings * n) as u32;
    let lowest = ring(rings - 1);
    for side in 0..2 {
        let first = rings * n + plan.crotch + side * columns * plan.legs.len();
        let row = |r: usize| (first + r * columns..first + (r + 1) * columns).map(|i| i as u32).collect::<Vec<_>>();
        let outer = (0..=n / 2).map(|k| lowest[if side == 0 { k } else { (n - k) % n }]);
        let top: Vec<u32> = outer.chain((0..plan.crotch).map(|k| crotch + k as u32)).collect();
        let from = shape.faces.len();
        join(shape, &top, &row(0), true);
        for r in 1..plan.legs.len() {
            join(shape, &row(r - 1), &row(r), true);
        }
        if side == 1 {
            flip(&mut shape.faces[from..]);
        }
    }
}
