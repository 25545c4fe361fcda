//! The T-shirt: rings from hem to underarm, columns from there over the shoulders, and sleeves set into the armholes.

use glam::{Vec2, Vec3};

use super::drape::{DrapeBody, below, flip, join, rows_after, split_at_top};
use super::section::{BodySection, RingFit, SectionPlane};
use super::style::{Cut, Style};
use crate::body::{Body, Region};
use crate::garment::{Part, Shape};
use crate::sizes::Girth;
use crate::skeleton::Joint;

/// Where the underarm seam lies between the chest level and the shoulders: just below the armpit.
const UNDERARM_SHARE: f32 = 0.34;

/// Least ease of any row (m).
const LEAST_EASE_M: f32 = 0.02;

/// Half of the columns that an armhole cuts out of the ring, as a share of the ring.
const ARMHOLE_SHARE: f32 = 0.055;

/// Rows next to the shoulder seam and the neckline that are skinned.
const YOKE_ROWS: usize = 3;

/// Columns beside an armhole that are not skinned.
const FREE_COLUMNS: usize = 3;

/// Rows from the armhole's seam that lie in the hollow of the armpit.
const HOLLOW_ROWS: usize = 3;

/// The sleeve's rings turn from the armhole's plane to the arm's over this share of its rows. Over all but the hem's: where they
/// turn faster, those below the arm lie so close that the mesh has needles.
const SLEEVE_TURN: f32 = 0.9;

struct TShirtDraft {
    /// Columns around the body, a multiple of 4.
    columns: usize,
    /// Columns from the front centre to the armhole.
    front: usize,
    /// Columns from the front centre to the side of the neck.
    neck: usize,
    /// Girth of the rings from the underarm to the hem (m).
    rings: Vec<f32>,
    /// Rows from the underarm to the shoulder seam.
    shoulder_rows: usize,
    /// Girth of each ring of a sleeve (m).
    sleeve: Vec<f32>,
    below_waist: f32,
    sleeve_length: f32,
    front_neck: f32,
}

/// Drafts the T-shirt for the body of its size and lays it on the shopper.
pub fn draft(style: &Style, cut: &Body, shopper: &Body) -> Shape {
    let plan = plan(style, cut);
    let mut shape = Shape::default();
    let index = VertexIndex::new(&plan);
    for (i, (c, w)) in
        lay(&plan, DrapeBody::cut(cut)).into_iter().zip(lay(&plan, DrapeBody::shopper(shopper))).enumerate()
    {
        shape.push(c, w, index.is_yoke(&plan, i), index.part(&plan, i));
    }
    connect(&mut shape, &plan, &index);
    shape
}

fn plan(style: &Style, cut: &Body) -> TShirtDraft {
    let Cut::TShirt { below_waist_mm, sleeve_mm, sleeve_ease_mm, neck_mm, front_neck_mm } = style.cut else {
        unreachable!("the wardrobe drafts each style by its own cut")
    };
    let form = DrapeBody::cut(cut);
    let levels = &cut.levels;
    let spacing = style.spacing_mm * 1e-3;
    let columns = style.columns / 4 * 4;
    let chest = form.girth(levels.chest) + style.ease_mm.at(Girth::Chest).unwrap_or(0.0);
    let hip = style.ease_mm.at(Girth::Hip).map_or(chest, |ease| form.girth(levels.hip) + ease);
    let below_waist = below_waist_mm * 1e-3;
    let underarm = underarm(cut);
    let length = underarm - levels.waist + below_waist;
    let rows = (length / spacing).round() as usize;
    let to_hip = levels.chest - levels.hip;
    let rings = (0..=rows).map(|r| {
        let fallen = length * r as f32 / rows as f32;
        let down = ((fallen + levels.chest - underarm) / to_hip).clamp(0.0, 1.0);
        // Shoulder blades may need more than the chest: no row is cut tighter than the body.
        (chest + (hip - chest) * down).max(form.girth(underarm - fallen) + LEAST_EASE_M)
    });
    let front = columns / 4 - (columns as f32 * ARMHOLE_SHARE).round() as usize;
    let top = form.ring(underarm, chest, columns);
    let neck = ((neck_mm * 1e-3 / top[front].x * front as f32).round() as usize).max(2).min(front - 1);
    let shoulder_rows = (1.15 * (levels.shoulder - underarm) / spacing).round().max(6.0) as usize;
    let sleeve_length = sleeve_mm * 1e-3;
    let sleeve_rows = (sleeve_length / spacing).round().max(4.0) as usize;
    let armhole = (columns / 2 - 2 * front) as f32 * chest / columns as f32 + 2.0 * shoulder_rows as f32 * spacing;
    let hem = arm_girth(cut, sleeve_length) + sleeve_ease_mm * 1e-3;
    let narrow = |k: usize| (k as f32 / (0.6 * sleeve_rows as f32)).min(1.0);
    let sleeve = (1..=sleeve_rows).map(|k| armhole + (hem - armhole) * narrow(k)).collect();
    let rings = rings.collect();
    let front_neck = front_neck_mm * 1e-3;
    TShirtDraft { columns, front, neck, rings, shoulder_rows, sleeve, below_waist, sleeve_length, front_neck }
}

/// Height of the underarm seam (m).
fn underarm(body: &Body) -> f32 {
    let levels = &body.levels;
    levels.chest + UNDERARM_SHARE * (levels.shoulder - levels.chest)
}

/// Where each part's vertices begin. Front and back columns run from the right armhole to the left one as seen by the
/// ring; the seam row belongs to the front.
struct VertexIndex {
    ring: usize,
    front: usize,
    back: usize,
    sleeves: [usize; 2],
    width: usize,
}

impl VertexIndex {
    fn new(plan: &TShirtDraft) -> Self {
        let width = 2 * plan.front + 1;
        let front = plan.rings.len() * plan.columns;
        let back = front + width * plan.shoulder_rows;
        let left = back + width * plan.shoulder_rows;
        let loop_length = armhole_length(plan);
        Self { ring: 0, front, back, sleeves: [left, left + loop_length * plan.sleeve.len()], width }
    }

    /// Ring vertex of a column counted from the front centre, positive towards the left.
    fn column(plan: &TShirtDraft, c: isize) -> u32 {
        c.rem_euclid(plan.columns as isize) as u32
    }

    /// Vertex of the front panel; row 0 is the underarm ring, the last row the shoulder seam or the neckline.
    fn front_at(&self, plan: &TShirtDraft, row: usize, c: isize) -> u32 {
        if row == 0 {
            return Self::column(plan, c);
        }
        (self.front + (row - 1) * self.width) as u32 + (c + plan.front as isize) as u32
    }

    /// Vertex of the back panel in the column behind front column `c`.
    fn back_at(&self, plan: &TShirtDraft, row: usize, c: isize) -> u32 {
        if row == 0 {
            return Self::column(plan, plan.columns as isize / 2 - c);
        }
        if row == plan.shoulder_rows && c.unsigned_abs() >= plan.neck {
            return self.front_at(plan, row, c);
        }
        (self.back + (row - 1) * self.width) as u32 + (c + plan.front as isize) as u32
    }

    /// The yoke sticks to the shoulders: the last rows of the panels, but not beside the armholes, where the arm pulls.
    fn is_yoke(&self, plan: &TShirtDraft, i: usize) -> bool {
        if i >= self.sleeves[0] || i < self.front {
            return false;
        }
        let place = i - if i >= self.back { self.back } else { self.front };
        let from_armhole = (place % self.width).min(self.width - 1 - place % self.width);
        place / self.width + 1 + YOKE_ROWS > plan.shoulder_rows && from_armhole >= FREE_COLUMNS
    }

    /// What a vertex lies on. Around the lowest point of the armhole that is nothing.
    fn part(&self, plan: &TShirtDraft, i: usize) -> Part {
        let (n, loop_length) = (plan.columns, armhole_length(plan));
        let half_hole = n / 4 - plan.front;
        if i < self.sleeves[0] {
            let from_side = (i % n).abs_diff(n / 4).min((i % n).abs_diff(3 * n / 4));
            let hollow = i < HOLLOW_ROWS * n && from_side <= half_hole;
            return if hollow { Part::Hollow } else { Part::Trunk };
        }
        let right = i >= self.sleeves[1];
        let place = i - self.sleeves[usize::from(right)];
        let from_bottom = (place % loop_length).min(loop_length - place % loop_length);
        match right {
            _ if place / loop_length < HOLLOW_ROWS && from_bottom <= half_hole + HOLLOW_ROWS => Part::Hollow,
            false => Part::LeftArm,
            true => Part::RightArm,
        }
    }

    /// The armhole from the lowest column over the front, the shoulder point and the back: one side's sleeve begins here.
    fn armhole(&self, plan: &TShirtDraft, left: bool) -> Vec<u32> {
        let sign = if left { 1 } else { -1 };
        let edge = plan.front as isize;
        let quarter = plan.columns as isize / 4;
        let mut ring: Vec<u32> = (edge..quarter).rev().map(|c| Self::column(plan, sign * c)).collect();
        ring.insert(0, Self::column(plan, sign * quarter));
        ring.extend((1..=plan.shoulder_rows).map(|r| self.front_at(plan, r, sign * edge)));
        ring.extend((1..plan.shoulder_rows).rev().map(|r| self.back_at(plan, r, sign * edge)));
        let half = plan.columns as isize / 2;
        ring.extend((quarter + 1..=half - edge).rev().map(|c| Self::column(plan, sign * c)));
        ring
    }
}

fn armhole_length(plan: &TShirtDraft) -> usize {
    plan.columns / 2 - 2 * plan.front + 2 * plan.shoulder_rows
}

/// All positions in the order of [`VertexIndex`]. Vertices of the back's seam row are in the list but no face names them;
/// [`connect`] drops them.
fn lay(plan: &TShirtDraft, form: DrapeBody<'_>) -> Vec<Vec3> {
    let levels = &form.body.levels;
    let (top, hem) = (underarm(form.body), levels.waist - plan.below_waist);
    let last = (plan.rings.len() - 1) as f32;
    let mut points = Vec::new();
    for (r, &girth) in plan.rings.iter().enumerate() {
        points.extend(form.ring(top + (hem - top) * r as f32 / last, girth, plan.columns));
    }
    let width = 2 * plan.front + 1;
    let mut front = vec![Vec3::ZERO; width * plan.shoulder_rows];
    let mut back = front.clone();
    let edge = plan.front as isize;
    let neck_height = shoulder_line(plan, form, &points);
    for c in -edge..=edge {
        let (up, down) = panel_column(plan, form, &points, neck_height, c);
        let place = (c + edge) as usize;
        for r in 0..plan.shoulder_rows {
            front[r * width + place] = up[r];
            back[r * width + place] = down[r];
        }
    }
    points.extend(front);
    points.extend(back);
    let index = VertexIndex::new(plan);
    let hole: Vec<Vec3> = index.armhole(plan, true).iter().map(|&i| points[i as usize]).collect();
    let left: Vec<Vec3> = (0..plan.sleeve.len()).flat_map(|k| sleeve_ring(plan, form, &hole, k)).collect();
    let right = left.iter().map(|p| Vec3::new(-p.x, p.y, p.z)).collect::<Vec<_>>();
    points.extend(left);
    points.extend(right);
    points
}

/// Height of the side of the neck (m): where the column beside it crosses the shoulder.
fn shoulder_line(plan: &TShirtDraft, form: DrapeBody<'_>, ring: &[Vec3]) -> f32 {
    over_shoulder(plan, form, ring, plan.neck as isize).0.last().map_or(0.0, |p| p.y)
}

/// The ways of one column from the underarm ring up to the shoulder, over the front and over the back. On the shoulder the
/// columns lie evenly between the middle and the armhole; on the ring those at the side lie behind each other.
fn over_shoulder(plan: &TShirtDraft, form: DrapeBody<'_>, ring: &[Vec3], c: isize) -> (Vec<Vec3>, Vec<Vec3>) {
    let front = ring[VertexIndex::column(plan, c) as usize];
    let back = ring[VertexIndex::column(plan, plan.columns as isize / 2 - c) as usize];
    // The shopper's trunk may be broader or narrower there than the body of the size.
    let half = ring[plan.front].x;
    let top = half * c as f32 / plan.front as f32;
    let (mut up, mut down) = split_at_top(&form.over_shoulder(front, back, top));
    down.reverse();
    lean(&mut up, front.x, top);
    lean(&mut down, back.x, top);
    (up, down)
}

/// Moves a rising line sideways, by its height: from one x below to another at its top (m).
fn lean(line: &mut [Vec3], from: f32, to: f32) {
    let (Some(low), Some(high)) = (line.first().map(|p| p.y), line.last().map(|p| p.y)) else { return };
    for p in line {
        p.x = from + (to - from) * ((p.y - low) / (high - low).max(1e-3)).clamp(0.0, 1.0);
    }
}

/// Rows 1.. of the front and of the back panel in one column: up to the shoulder, or to the neckline.
fn panel_column(
    plan: &TShirtDraft,
    form: DrapeBody<'_>,
    ring: &[Vec3],
    neck_height: f32,
    c: isize,
) -> (Vec<Vec3>, Vec<Vec3>) {
    let (mut up, mut down) = over_shoulder(plan, form, ring, c);
    if c.unsigned_abs() < plan.neck {
        // A round neckline from the sides of the neck down to the middle of the front, a flat one behind. Not an ellipse, whose
        // steep sides would leave a few columns with links of half the neck's depth.
        let dip = 1.0 - (c as f32 / plan.neck as f32).abs().powf(NECK_POWER);
        up = below(&up, neck_height - plan.front_neck * dip);
        down = below(&down, neck_height - BACK_NECK_SHARE * plan.front_neck * dip);
    }
    (rows_after(&up, plan.shoulder_rows), rows_after(&down, plan.shoulder_rows))
}

/// How round the neckline is: 2 is a parabola, more is flatter below and steeper at the sides.
const NECK_POWER: f32 = 2.5;

/// The back neckline is this share of the front's depth.
const BACK_NECK_SHARE: f32 = 0.3;

/// Girth of the left arm at a distance from the shoulder (m).
fn arm_girth(body: &Body, along: f32) -> f32 {
    arm_section(body, along, 1.0).map_or(0.3, |s| s.girth())
}

/// Nothing farther from the middle of an arm belongs to it (m).
const ARM_REACH_M: f32 = 0.14;

/// Outline of the left arm, in a plane that turns from the armhole's (0) to the arm's own (1).
fn arm_section(body: &Body, along: f32, turn: f32) -> Option<BodySection> {
    let shoulder = body.skeleton.at(Joint::LeftShoulder);
    let axis = (body.skeleton.at(Joint::LeftElbow) - shoulder).normalize_or_zero();
    let normal = Vec3::X.lerp(axis, turn).normalize_or_zero();
    // A ring begins below the arm and runs over its front.
    let below = (Vec3::NEG_Y - normal * normal.dot(Vec3::NEG_Y)).normalize_or_zero();
    let plane = SectionPlane { origin: shoulder + axis * along, u: below.cross(normal), v: below };
    BodySection::of(body, &[Region::LeftArm, Region::Torso], plane, |p| p.distance(plane.origin) < ARM_REACH_M)
}

fn sleeve_ring(plan: &TShirtDraft, form: DrapeBody<'_>, hole: &[Vec3], k: usize) -> Vec<Vec3> {
    let share = (k + 1) as f32 / plan.sleeve.len() as f32;
    let turn = (share / SLEEVE_TURN).min(1.0);
    let fit = RingFit { girth: plan.sleeve[k], gap: form.gap };
    let count = hole.len();
    let ring = arm_section(form.body, plan.sleeve_length * share, turn).map(|s| s.ring(fit, count, Vec2::Y, 0.0));
    // Where the arm has no outline of its own yet, the armhole is carried along.
    let shift = Vec3::X * plan.sleeve_length * share;
    let ring = ring.unwrap_or_else(|| hole.iter().map(|p| *p + shift).collect());
    let blend = (share / SLEEVE_TURN).min(1.0);
    ring.iter().zip(hole).map(|(r, h)| (*h + shift).lerp(*r, blend)).collect()
}

fn connect(shape: &mut Shape, plan: &TShirtDraft, index: &VertexIndex) {
    let n = plan.columns;
    let ring = |r: usize| (index.ring + r * n..index.ring + (r + 1) * n).map(|i| i as u32).collect::<Vec<_>>();
    for r in 1..plan.rings.len() {
        join(shape, &ring(r - 1), &ring(r), true);
    }
    let edge = plan.front as isize;
    for r in 1..=plan.shoulder_rows {
        let row = |r| (-edge..=edge).map(|c| index.front_at(plan, r, c)).collect::<Vec<_>>();
        join(shape, &row(r), &row(r - 1), false);
        let row = |r| (-edge..=edge).rev().map(|c| index.back_at(plan, r, c)).collect::<Vec<_>>();
        join(shape, &row(r), &row(r - 1), false);
    }
    let count = armhole_length(plan);
    for (side, &first) in index.sleeves.iter().enumerate() {
        let row = |k: usize| (first + k * count..first + (k + 1) * count).map(|i| i as u32).collect::<Vec<_>>();
        let from = shape.faces.len();
        join(shape, &index.armhole(plan, side == 0), &row(0), true);
        for k in 1..plan.sleeve.len() {
            join(shape, &row(k - 1), &row(k), true);
        }
        if side == 1 {
            flip(&mut shape.faces[from..]);
        }
    }
    drop_loose(shape);
}

/// Removes the vertices that no face names.
fn drop_loose(shape: &mut Shape) {
    let mut used = vec![false; shape.cut.len()];
    shape.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    let mut place = vec![0u32; used.len()];
    let mut next = 0;
    for (i, &u) in used.iter().enumerate() {
        place[i] = next;
        next += u32::from(u);
    }
    shape.faces.iter_mut().flatten().for_each(|v| *v = place[*v as usize]);
    let kept = |i: &usize| used[*i];
    shape.cut = (0..used.len()).filter(kept).map(|i| shape.cut[i]).collect();
    shape.worn = (0..used.len()).filter(kept).map(|i| shape.worn[i]).collect();
    shape.fixed = (0..used.len()).filter(kept).map(|i| shape.fixed[i]).collect();
    shape.parts = (0..used.len()).filter(kept).map(|i| shape.parts[i]).collect();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Measures, Sex};
    use crate::garment::shape::NO_VERTEX;
    use crate::wardrobe;

    #[test]
    fn the_coarsest_mesh_that_a_file_may_ask_for_is_drafted() {
        let shopper = Body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
        let style = Style { columns: 16, spacing_mm: 60.0, ..wardrobe::style("t-shirt").unwrap() };
        assert!(style.draft("M", &shopper).unwrap().faces.len() > 100);
    }

    #[test]
    fn no_size_has_needles_or_gaps() {
        let style = wardrobe::style("t-shirt").unwrap();
        let spacing = style.spacing_mm * 1e-3;
        for sex in [Sex::Female, Sex::Male] {
            let shopper = Body::build(sex, &Measures::average(sex)).unwrap();
            for size in ["S", "M", "XL"] {
                let shape = style.draft(size, &shopper).unwrap();
                let corner = |v: u32| shape.cut[v as usize];
                let edges = shape.faces.iter().flat_map(|face| {
                    let ring: Vec<u32> = face.iter().copied().filter(|v| *v != NO_VERTEX).collect();
                    (0..ring.len()).map(move |k| (ring[k], ring[(k + 1) % ring.len()])).collect::<Vec<_>>()
                });
                let lengths: Vec<f32> = edges.map(|(a, b)| corner(a).distance(corner(b))).collect();
                let shortest = lengths.iter().copied().fold(f32::MAX, f32::min);
                let longest = lengths.iter().copied().fold(0.0, f32::max);
                // Where the neckline turns up, columns are as steep as it is.
                assert!(shortest > 0.35 * spacing && longest < 5.5 * spacing, "{sex:?} {size}: {shortest} {longest}");
            }
        }
    }
}
