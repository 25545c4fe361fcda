//! Upper body: rings from hem to underarm, columns from there over the shoulders, and sleeves set into the armholes. What a T-shirt
//! and a jacket have in common.

use glam::{Vec2, Vec3};

use super::drape::{DrapeBody, below, flip, join, rows_after, split_at_top};
use super::section::{BodySection, SectionPlane};
use super::style::Style;
use crate::sizes::Girth;
use toile_bake::Shape;
use toile_base::body::{Body, Region};
use toile_base::garment::Part;
use toile_base::skeleton::Joint;

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

/// Parameters of a garment of the upper body, all lengths in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UpperBodyCut {
    /// Length from waist to hem (m).
    pub below_waist: f32,
    /// Length of the sleeve from the shoulder point (m).
    pub sleeve: f32,
    /// Ease of the sleeve's hem over the arm (m).
    pub sleeve_ease: f32,
    /// Half the width of the neck opening (m).
    pub neck: f32,
    /// Depth of the front neckline below the side of the neck (m).
    pub front_neck: f32,
    /// How round the neckline is: 2 is a parabola, more is flatter below and steeper at the sides, 1 is a V.
    pub neck_round: f32,
    /// How far apart the front edges lie when it is put on (m); `None` is closed in front.
    pub opening: Option<f32>,
    /// Where the underarm seam lies between the chest level (0) and the shoulders (1).
    pub underarm: f32,
    /// Share of the sleeve's length over which its rings turn from the armhole's plane to the arm's (1). Where they turn fast,
    /// those below the arm lie so close that the mesh has needles.
    pub sleeve_turn: f32,
    /// Share of the sleeve's length over which it narrows from the armhole to the girth of its hem (1).
    pub sleeve_narrows: f32,
    /// Room left for what is worn under it (m).
    pub room: f32,
}

struct UpperBodyDraft {
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
    cut: UpperBodyCut,
}

impl UpperBodyDraft {
    /// 1 where the front centre is two edges, 0 where it is one column.
    fn open(&self) -> usize {
        usize::from(self.cut.opening.is_some())
    }

    /// Vertices of a ring.
    fn ring_length(&self) -> usize {
        self.columns + self.open()
    }

    /// Vertices of a row of the front panel: from the right armhole to the left one, with both edges where it is open.
    fn front_width(&self) -> usize {
        2 * self.front + 1 + self.open()
    }

    /// Column of a vertex of a front row, counted from the front centre, positive towards the left. Of an open front both edges
    /// are column 0, the right one first.
    fn column_of(&self, place: usize) -> isize {
        let c = place as isize - self.front as isize;
        if c > 0 { c - self.open() as isize } else { c }
    }

    /// The rows of the front panel without a gap: one, or the right half and the left.
    fn front_pieces(&self) -> Vec<std::ops::Range<usize>> {
        let width = self.front_width();
        let middle = if self.open() == 1 { self.front + 1 } else { width };
        [0..middle, middle..width].into_iter().filter(|piece| !piece.is_empty()).collect()
    }

    /// How far from the middle a column of the front lies on the shoulder or at the neckline (m); `half` is how far the armhole
    /// does. Of an open front the edges run straight up.
    fn front_top(&self, place: usize, half: f32) -> f32 {
        let c = self.column_of(place);
        let even = |c: isize| half * c as f32 / self.front as f32;
        match self.cut.opening {
            Some(opening) if c.unsigned_abs() < self.neck => {
                let (edge, side) = (0.5 * opening, even(self.neck as isize));
                let top = edge + (side - edge) * c.unsigned_abs() as f32 / self.neck as f32;
                if place <= self.front { -top } else { top }
            }
            _ => even(c),
        }
    }
}

/// Drafts a garment of the upper body for the body of its size and lays it on the shopper.
pub fn draft(style: &Style, own: UpperBodyCut, cut: &Body, shopper: &Body) -> Shape {
    let plan = plan(style, own, cut);
    let mut shape = Shape::default();
    let index = VertexIndex::new(&plan);
    let [cut_at, worn_at] =
        [DrapeBody::cut(cut), DrapeBody::shopper(shopper)].map(|form| lay(&plan, form.over(own.room)));
    for (i, (c, w)) in cut_at.into_iter().zip(worn_at).enumerate() {
        shape.push(c, w, index.is_yoke(&plan, i), index.part(&plan, i));
    }
    connect(&mut shape, &plan, &index);
    shape
}

fn plan(style: &Style, own: UpperBodyCut, cut: &Body) -> UpperBodyDraft {
    let form = DrapeBody::cut(cut).over(own.room);
    let levels = &cut.levels;
    let spacing = style.spacing_mm * 1e-3;
    let columns = style.columns / 4 * 4;
    let chest = form.girth(levels.chest) + style.ease_mm.at(Girth::Chest).unwrap_or(0.0);
    let hip = style.ease_mm.at(Girth::Hip).map_or(chest, |ease| form.girth(levels.hip) + ease);
    let underarm = underarm(own, cut);
    let length = underarm - levels.waist + own.below_waist;
    let rows = (length / spacing).round() as usize;
    let to_hip = levels.chest - levels.hip;
    let rings = (0..=rows).map(|r| {
        let fallen = length * r as f32 / rows as f32;
        let down = ((fallen + levels.chest - underarm) / to_hip).clamp(0.0, 1.0);
        // Shoulder blades may need more than the chest: no row is cut tighter than the body.
        (chest + (hip - chest) * down).max(form.girth(underarm - fallen) + LEAST_EASE_M)
    });
    let front = columns / 4 - (columns as f32 * ARMHOLE_SHARE).round() as usize;
    let top = ring(own, form, underarm, chest, columns);
    let neck = ((own.neck / top[front].x * front as f32).round() as usize).max(2).min(front - 1);
    let shoulder_rows = (1.15 * (levels.shoulder - underarm) / spacing).round().max(6.0) as usize;
    let sleeve_rows = (own.sleeve / spacing).round().max(4.0) as usize;
    let armhole = (columns / 2 - 2 * front) as f32 * chest / columns as f32 + 2.0 * shoulder_rows as f32 * spacing;
    let hem = arm_girth(cut, own.sleeve) + own.sleeve_ease;
    let narrow = |k: usize| (k as f32 / (own.sleeve_narrows * sleeve_rows as f32)).min(1.0);
    let sleeve = (1..=sleeve_rows).map(|k| armhole + (hem - armhole) * narrow(k)).collect();
    UpperBodyDraft { columns, front, neck, rings: rings.collect(), shoulder_rows, sleeve, cut: own }
}

/// A ring around the trunk, closed or open in front as the garment is.
fn ring(own: UpperBodyCut, form: DrapeBody<'_>, height: f32, girth: f32, columns: usize) -> Vec<Vec3> {
    match own.opening {
        Some(opening) => form.open_ring(height, girth, opening, columns),
        None => form.ring(height, girth, columns),
    }
}

/// Height of the underarm seam (m).
fn underarm(own: UpperBodyCut, body: &Body) -> f32 {
    let levels = &body.levels;
    levels.chest + own.underarm * (levels.shoulder - levels.chest)
}

/// Where each part's vertices begin. Front and back columns run from the right armhole to the left one as seen by the
/// ring; the seam row belongs to the front.
struct VertexIndex {
    ring: usize,
    front: usize,
    back: usize,
    sleeves: [usize; 2],
}

impl VertexIndex {
    fn new(plan: &UpperBodyDraft) -> Self {
        let front = plan.rings.len() * plan.ring_length();
        let back = front + plan.front_width() * plan.shoulder_rows;
        let left = back + Self::back_width(plan) * plan.shoulder_rows;
        let loop_length = armhole_length(plan);
        Self { ring: 0, front, back, sleeves: [left, left + loop_length * plan.sleeve.len()] }
    }

    fn back_width(plan: &UpperBodyDraft) -> usize {
        2 * plan.front + 1
    }

    /// Ring vertex of a column counted from the front centre, positive towards the left; of an open front's the left edge.
    fn column(plan: &UpperBodyDraft, c: isize) -> u32 {
        c.rem_euclid(plan.columns as isize) as u32
    }

    /// Place in a row of the front panel of a column that is no open edge.
    fn place(plan: &UpperBodyDraft, c: isize) -> usize {
        let place = (c + plan.front as isize) as usize;
        place + if c > 0 { plan.open() } else { 0 }
    }

    /// Vertex of the front panel by its place in the row; row 0 is the underarm ring, the last row the shoulder seam or the
    /// neckline.
    fn front_at(&self, plan: &UpperBodyDraft, row: usize, place: usize) -> u32 {
        match row {
            0 if plan.open() == 1 && place == plan.front => plan.columns as u32, // the right edge ends the ring
            0 => Self::column(plan, plan.column_of(place)),
            _ => (self.front + (row - 1) * plan.front_width() + place) as u32,
        }
    }

    /// Vertex of the back panel in the column behind front column `c`.
    fn back_at(&self, plan: &UpperBodyDraft, row: usize, c: isize) -> u32 {
        if row == 0 {
            return Self::column(plan, plan.columns as isize / 2 - c);
        }
        if row == plan.shoulder_rows && c.unsigned_abs() >= plan.neck {
            return self.front_at(plan, row, Self::place(plan, c));
        }
        (self.back + (row - 1) * Self::back_width(plan)) as u32 + (c + plan.front as isize) as u32
    }

    /// The yoke sticks to the shoulders: the last rows of the panels, but not beside the armholes, where the arm pulls, nor
    /// beside an open front, which hangs.
    fn is_yoke(&self, plan: &UpperBodyDraft, i: usize) -> bool {
        if i >= self.sleeves[0] || i < self.front {
            return false;
        }
        let in_front = i < self.back;
        let (first, width) =
            if in_front { (self.front, plan.front_width()) } else { (self.back, Self::back_width(plan)) };
        let place = (i - first) % width;
        let hangs = in_front && plan.open() == 1 && plan.column_of(place).unsigned_abs() < plan.neck;
        let from_armhole = place.min(width - 1 - place);
        (i - first) / width + 1 + YOKE_ROWS > plan.shoulder_rows && from_armhole >= FREE_COLUMNS && !hangs
    }

    /// What a vertex lies on. Around the lowest point of the armhole that is nothing.
    fn part(&self, plan: &UpperBodyDraft, i: usize) -> Part {
        let (n, loop_length) = (plan.columns, armhole_length(plan));
        let half_hole = n / 4 - plan.front;
        if i < self.sleeves[0] {
            let column = i % plan.ring_length();
            let from_side = column.abs_diff(n / 4).min(column.abs_diff(3 * n / 4));
            let hollow = i < HOLLOW_ROWS * plan.ring_length() && from_side <= half_hole;
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
    fn armhole(&self, plan: &UpperBodyDraft, left: bool) -> Vec<u32> {
        let sign = if left { 1 } else { -1 };
        let edge = plan.front as isize;
        let quarter = plan.columns as isize / 4;
        let mut ring: Vec<u32> = (edge..quarter).rev().map(|c| Self::column(plan, sign * c)).collect();
        ring.insert(0, Self::column(plan, sign * quarter));
        ring.extend((1..=plan.shoulder_rows).map(|r| self.front_at(plan, r, Self::place(plan, sign * edge))));
        ring.extend((1..plan.shoulder_rows).rev().map(|r| self.back_at(plan, r, sign * edge)));
        let half = plan.columns as isize / 2;
        ring.extend((quarter + 1..=half - edge).rev().map(|c| Self::column(plan, sign * c)));
        ring
    }
}

fn armhole_length(plan: &UpperBodyDraft) -> usize {
    plan.columns / 2 - 2 * plan.front + 2 * plan.shoulder_rows
}

/// All positions in the order of [`VertexIndex`]. Vertices of the back's seam row are in the list but no face names them;
/// [`connect`] drops them.
fn lay(plan: &UpperBodyDraft, form: DrapeBody<'_>) -> Vec<Vec3> {
    let levels = &form.body.levels;
    let (top, hem) = (underarm(plan.cut, form.body), levels.waist - plan.cut.below_waist);
    let last = (plan.rings.len() - 1) as f32;
    let mut points = Vec::new();
    for (r, &girth) in plan.rings.iter().enumerate() {
        points.extend(ring(plan.cut, form, top + (hem - top) * r as f32 / last, girth, plan.columns));
    }
    let index = VertexIndex::new(plan);
    let [front_width, back_width] = [plan.front_width(), VertexIndex::back_width(plan)];
    let mut front = vec![Vec3::ZERO; front_width * plan.shoulder_rows];
    let mut back = vec![Vec3::ZERO; back_width * plan.shoulder_rows];
    let neck_height = shoulder_line(plan, form, &points);
    for place in 0..front_width {
        let (up, down) = panel_column(plan, form, &points, neck_height, place);
        let behind = (plan.column_of(place) + plan.front as isize) as usize;
        for r in 0..plan.shoulder_rows {
            front[r * front_width + place] = up[r];
            back[r * back_width + behind] = down[r];
        }
    }
    points.extend(front);
    points.extend(back);
    let hole: Vec<Vec3> = index.armhole(plan, true).iter().map(|&i| points[i as usize]).collect();
    let left: Vec<Vec3> = (0..plan.sleeve.len()).flat_map(|k| sleeve_ring(plan, form, &hole, k)).collect();
    let right = left.iter().map(|p| Vec3::new(-p.x, p.y, p.z)).collect::<Vec<_>>();
    points.extend(left);
    points.extend(right);
    points
}

/// Height of the side of the neck (m): where the column beside it crosses the shoulder.
fn shoulder_line(plan: &UpperBodyDraft, form: DrapeBody<'_>, ring: &[Vec3]) -> f32 {
    let place = VertexIndex::place(plan, plan.neck as isize);
    over_shoulder(plan, form, ring, place).0.last().map_or(0.0, |p| p.y)
}

/// The ways of one column from the underarm ring up to the shoulder, over the front and over the back. On the shoulder the
/// columns lie evenly between the middle and the armhole; on the ring those at the side lie behind each other.
fn over_shoulder(plan: &UpperBodyDraft, form: DrapeBody<'_>, ring: &[Vec3], place: usize) -> (Vec<Vec3>, Vec<Vec3>) {
    let c = plan.column_of(place);
    let index = VertexIndex::new(plan);
    let front = ring[index.front_at(plan, 0, place) as usize];
    let back = ring[index.back_at(plan, 0, c) as usize];
    // The shopper's trunk may be broader or narrower there than the body of the size.
    let half = ring[plan.front].x;
    let (top, back_top) = (plan.front_top(place, half), half * c as f32 / plan.front as f32);
    let (mut up, mut down) = split_at_top(&form.over_shoulder(front, back, top));
    down.reverse();
    lean(&mut up, front.x, top);
    lean(&mut down, back.x, back_top);
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
    plan: &UpperBodyDraft,
    form: DrapeBody<'_>,
    ring: &[Vec3],
    neck_height: f32,
    place: usize,
) -> (Vec<Vec3>, Vec<Vec3>) {
    let c = plan.column_of(place);
    let (mut up, mut down) = over_shoulder(plan, form, ring, place);
    if c.unsigned_abs() < plan.neck {
        // A round neckline from the sides of the neck down to the middle of the front, a flat one behind. Not an ellipse, whose
        // steep sides would leave a few columns with links of half the neck's depth.
        let dip = 1.0 - (c as f32 / plan.neck as f32).abs().powf(plan.cut.neck_round);
        up = below(&up, neck_height - plan.cut.front_neck * dip);
        down = below(&down, neck_height - BACK_NECK_SHARE * plan.cut.front_neck * dip);
    }
    (rows_after(&up, plan.shoulder_rows), rows_after(&down, plan.shoulder_rows))
}

/// The back neckline is this share of the front's depth.
const BACK_NECK_SHARE: f32 = 0.3;

/// Girth of the left arm at a distance from the shoulder (m).
fn arm_girth(body: &Body, along: f32) -> f32 {
    arm_section(body, along, 1.0).map_or(0.3, |s| s.girth())
}

/// Nothing farther from the middle of an arm belongs to it (m).
const ARM_REACH_M: f32 = 0.14;

/// The middle of the left arm at a distance from the shoulder (m), and the direction in which the arm goes on from there.
fn along_arm(body: &Body, along: f32) -> (Vec3, Vec3) {
    let [shoulder, elbow, wrist] =
        [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist].map(|joint| body.skeleton.at(joint));
    let upper = (elbow - shoulder).normalize_or_zero();
    let beyond = along - shoulder.distance(elbow);
    if beyond <= 0.0 {
        return (shoulder + upper * along, upper);
    }
    let forearm = (wrist - elbow).normalize_or_zero();
    (elbow + forearm * beyond, upper.lerp(forearm, (beyond / ELBOW_M).min(1.0)).normalize_or_zero())
}

/// Length below the elbow over which the sleeve's rings turn into the forearm's direction (m).
const ELBOW_M: f32 = 0.08;

/// Outline of the left arm, in a plane that turns from the armhole's (0) to the arm's own (1).
fn arm_section(body: &Body, along: f32, turn: f32) -> Option<BodySection> {
    let (origin, axis) = along_arm(body, along);
    let normal = Vec3::X.lerp(axis, turn).normalize_or_zero();
    // A ring begins below the arm and runs over its front.
    let below = (Vec3::NEG_Y - normal * normal.dot(Vec3::NEG_Y)).normalize_or_zero();
    let plane = SectionPlane { origin, u: below.cross(normal), v: below };
    BodySection::of(body, &[Region::LeftArm, Region::Torso], plane, |p| p.distance(plane.origin) < ARM_REACH_M)
}

fn sleeve_ring(plan: &UpperBodyDraft, form: DrapeBody<'_>, hole: &[Vec3], k: usize) -> Vec<Vec3> {
    let share = (k + 1) as f32 / plan.sleeve.len() as f32;
    let turn = (share / plan.cut.sleeve_turn).min(1.0);
    let fit = form.fit(plan.sleeve[k]);
    let count = hole.len();
    let ring = arm_section(form.body, plan.cut.sleeve * share, turn).map(|s| s.ring(fit, count, Vec2::Y, 0.0));
    // Where the arm has no outline of its own yet, the armhole is carried along.
    let shift = Vec3::X * plan.cut.sleeve * share;
    let ring = ring.unwrap_or_else(|| hole.iter().map(|p| *p + shift).collect());
    ring.iter().zip(hole).map(|(r, h)| (*h + shift).lerp(*r, turn)).collect()
}

fn connect(shape: &mut Shape, plan: &UpperBodyDraft, index: &VertexIndex) {
    let n = plan.ring_length();
    let ring = |r: usize| (index.ring + r * n..index.ring + (r + 1) * n).map(|i| i as u32).collect::<Vec<_>>();
    for r in 1..plan.rings.len() {
        join(shape, &ring(r - 1), &ring(r), plan.open() == 0);
    }
    let edge = plan.front as isize;
    for r in 1..=plan.shoulder_rows {
        for piece in plan.front_pieces() {
            let row = |r| piece.clone().map(|place| index.front_at(plan, r, place)).collect::<Vec<_>>();
            join(shape, &row(r), &row(r - 1), false);
        }
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
mod tests;
