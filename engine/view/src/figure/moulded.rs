//! Moulded hair: a cap over the scalp, laid out in polar coordinates about the middle of the head, with a rounded hem.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::Vec3;

use super::egg::ease;
use crate::bvh::{Bvh, Ray};

/// What the directions to a cap start from (mm, of the head's space): inside of every head.
const MIDDLE_MM: Vec3 = Vec3::new(0.0, -95.0, 4.0);

/// Columns around the head; rows from the whorl to the hem; rows of the hem's roll and of the inner side.
const COLUMNS: usize = 120;
const ROWS: usize = 26;
const INNER: usize = 6;

/// Rings and columns of a bun.
const BUN_RINGS: usize = 22;
const BUN_COLUMNS: usize = 44;

/// Passes over the distance of the scalp, whose faces are flat.
const SMOOTHING: usize = 4;

/// The cap's inner side ends so far beneath the skin (mm).
const SUNK_MM: f32 = 3.0;

/// Where no skin is met, the cap's inner side goes down to this (mm).
const HOLLOW_MM: f32 = 30.0;

/// How far hair that hangs is turned in at its hem (0..1).
const TURNED_IN: f32 = 0.15;

/// How hair is cut.
pub struct Cut {
    /// Where the whorl is, from the middle of the head.
    pub whorl: Vec3,
    /// The hem on the left side, from the forehead to the nape (mm, of the head's space).
    pub hem: &'static [Vec3],
    /// Thickness at the sides and behind, and on the top (mm).
    pub thickness: [f32; 2],
    /// Width over which the hem is rounded (mm).
    pub round: f32,
    /// Depth of the combed lines (mm).
    pub combed: f32,
    /// Half width and half depth of what hangs down beside the face, if anything does (mm).
    pub hangs: Option<[f32; 2]>,
    /// Centre and half axes of a bun, if there is one (mm, of the head's space).
    pub bun: Option<[Vec3; 2]>,
}

/// A mesh in the head's space (mm).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Moulded {
    /// Vertex positions (mm).
    pub points: Vec<Vec3>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Directions about a whorl: turn from the face towards the left (rad), and angle from the whorl (rad).
struct Polar {
    axes: [Vec3; 3],
}

impl Polar {
    fn new(whorl: Vec3) -> Self {
        let up = whorl.normalize();
        Self { axes: [Vec3::X, up, Vec3::X.cross(up)] }
    }

    fn toward(&self, turn: f32, angle: f32) -> Vec3 {
        let [left, up, front] = self.axes;
        up * angle.cos() + (front * turn.cos() + left * turn.sin()) * angle.sin()
    }

    fn of(&self, p: Vec3) -> [f32; 2] {
        let d = (p - MIDDLE_MM).normalize();
        let [left, up, front] = self.axes;
        [d.dot(left).atan2(d.dot(front)), d.dot(up).clamp(-1.0, 1.0).acos()]
    }
}

/// A cut laid out on a head: how far the hem is from the whorl, and how far out the skin is.
struct Layout<'a> {
    cut: &'a Cut,
    polar: Polar,
    /// Angle of the hem from the whorl (rad) `[columns]`.
    reach: Vec<f32>,
    /// Distance of the skin from the middle (mm) `[rows + 1][columns]`.
    skin: Vec<Vec<f32>>,
}

impl<'a> Layout<'a> {
    fn new(cut: &'a Cut, faces: impl Iterator<Item = [Vec3; 3]>) -> Self {
        let scalp = Bvh::build(faces);
        let polar = Polar::new(cut.whorl);
        let hem: Vec<[f32; 2]> = cut.hem.iter().map(|p| polar.of(*p)).collect();
        let reach = (0..COLUMNS).map(|c| interpolated(&hem, turn(c).abs())).collect();
        let mut layout = Self { cut, polar, reach, skin: Vec::new() };
        layout.skin = evened(|r, c| {
            let hit = scalp.closest(&Ray::new(MIDDLE_MM, layout.toward(r, c)), f32::MAX);
            hit.map_or(HOLLOW_MM, |hit| hit.distance)
        });
        layout
    }

    fn toward(&self, row: usize, column: usize) -> Vec3 {
        self.polar.toward(turn(column), self.reach[column] * share(row))
    }

    /// Distance of the hair's outer side from the middle (mm).
    fn outer(&self, row: usize, column: usize) -> f32 {
        let Cut { thickness: [side, top], round, combed, hangs, .. } = *self.cut;
        let (toward, share) = (self.toward(row, column), share(row));
        let lines = combed * comb(turn(column)) * ease(share, 0.08, 0.35);
        let worn = self.skin[row][column] + side + (top - side) * ease(toward.y, 0.1, 0.9);
        let hanging = |half| hanging(toward, half) * (1.0 - TURNED_IN * ease(share, 0.6, 1.05));
        let out = lines + hangs.map_or(worn, |half| largest(worn, hanging(half)));
        let from_hem = ((1.0 - share) * self.reach[column] * out / round).min(1.0);
        out - round * (1.0 - (from_hem * (2.0 - from_hem)).sqrt())
    }

    /// The same of its inner side, `inwards` rows from the hem: beneath the skin at last, and where nothing hangs at once.
    fn inner(&self, inwards: usize, column: usize) -> f32 {
        let (row, round) = (ROWS - inwards, self.cut.round);
        let within = (self.outer(ROWS, column) - round).min(self.outer(row, column) - round);
        let beneath = within.min(self.skin[row][column] - SUNK_MM);
        let share = if self.cut.hangs.is_some() { ease(inwards as f32, 0.0, INNER as f32) } else { 1.0 };
        within + (beneath - within) * share
    }
}

impl Moulded {
    /// The hair of a cut, on a head of these faces (mm, of the head's space).
    pub fn of(cut: &Cut, faces: impl Iterator<Item = [Vec3; 3]>) -> Self {
        let layout = Layout::new(cut, faces);
        let mut points = vec![MIDDLE_MM + layout.toward(0, 0) * layout.outer(0, 0)];
        let mut ring = |row: usize, out: &dyn Fn(usize) -> f32| {
            points.extend((0..COLUMNS).map(|c| MIDDLE_MM + layout.toward(row, c) * out(c)));
        };
        (1..=ROWS).for_each(|row| ring(row, &|c| layout.outer(row, c)));
        (1..=INNER).for_each(|inwards| ring(ROWS - inwards, &|c| layout.inner(inwards, c)));
        let mut hair = Self { points, triangles: lattice(ROWS + INNER, COLUMNS) };
        if let Some(bun) = cut.bun {
            hair.add(Self::bun(bun));
        }
        hair
    }

    /// A flattened ball with a twist.
    fn bun([centre, half]: [Vec3; 2]) -> Self {
        let out = (centre - MIDDLE_MM).normalize();
        let (left, up) = (Vec3::X, out.cross(Vec3::X));
        let mut points = vec![centre + out * half.z];
        for (r, c) in (1..=BUN_RINGS).flat_map(|r| (0..BUN_COLUMNS).map(move |c| (r, c))) {
            // Its end, which is open, is within the head.
            let (turn, angle) = (c as f32 / BUN_COLUMNS as f32 * TAU, r as f32 / BUN_RINGS as f32 * 0.98 * PI);
            let twist = 1.0 + 0.035 * (3.0 * turn + 4.0 * angle).cos() * angle.min(FRAC_PI_2).sin();
            let across = left * half.x * turn.cos() - up * half.y * turn.sin();
            points.push(centre + (out * half.z * angle.cos() + across * angle.sin()) * twist);
        }
        Self { points, triangles: lattice(BUN_RINGS, BUN_COLUMNS) }
    }

    fn add(&mut self, other: Self) {
        let first = self.points.len() as u32;
        self.points.extend(other.points);
        self.triangles.extend(other.triangles.into_iter().map(|t| t.map(|v| v + first)));
    }
}

/// The turn of a column (rad), from behind over the right side to the left.
fn turn(column: usize) -> f32 {
    (column as f32 / COLUMNS as f32 - 0.5) * TAU
}

/// The rows' places from the whorl (0) to the hem (1), closer to each other towards the hem.
fn share(row: usize) -> f32 {
    1.0 - (1.0 - row as f32 / ROWS as f32).powf(1.5)
}

/// Lines that a comb leaves, -1 to 1, the same on both sides.
fn comb(turn: f32) -> f32 {
    0.4 * (17.0 * turn).cos() + 0.35 * (29.0 * turn).cos() + 0.25 * (5.0 * turn).cos()
}

/// The larger of two, rounded where they meet.
fn largest(a: f32, b: f32) -> f32 {
    let near = (24.0 - (a - b).abs()).max(0.0) / 24.0;
    a.max(b) + near * near * 24.0 * 0.25
}

/// How far out hair hangs in a direction below the middle of the head (mm).
fn hanging(toward: Vec3, [wide, deep]: [f32; 2]) -> f32 {
    let across = (toward.x / wide).powi(2) + (toward.z / deep).powi(2);
    // Beneath the middle it falls straight down, above it rounds over.
    let down = if toward.y > 0.0 { (toward.y / deep).powi(2) } else { 0.0 };
    1.0 / (across + down).max(1e-6).sqrt()
}

/// The distance of every place of the cap, evened out.
fn evened(of: impl Fn(usize, usize) -> f32) -> Vec<Vec<f32>> {
    let mut all: Vec<Vec<f32>> = (0..=ROWS).map(|r| (0..COLUMNS).map(|c| of(r, c)).collect()).collect();
    for _ in 0..SMOOTHING {
        let before = all.clone();
        for (r, row) in all.iter_mut().enumerate().skip(1) {
            for (c, x) in row.iter_mut().enumerate() {
                let beside = [(c + 1) % COLUMNS, (c + COLUMNS - 1) % COLUMNS].map(|c| before[r][c]);
                let across = [before[r - 1][c], before[(r + 1).min(ROWS)][c]];
                *x = 0.5 * *x + 0.125 * (beside[0] + beside[1] + across[0] + across[1]);
            }
        }
    }
    all
}

/// Between known places, in rising order, of a curve that is level at both ends (Catmull and Rom 1974).
fn interpolated(known: &[[f32; 2]], at: f32) -> f32 {
    let last = known.len() - 1;
    let i = known.iter().rposition(|k| k[0] <= at).unwrap_or(0).min(last - 1);
    let slope = |i: usize| {
        let (a, b) = (known[i.saturating_sub(1)], known[(i + 1).min(last)]);
        if i == 0 || i == last { 0.0 } else { (b[1] - a[1]) / (b[0] - a[0]) }
    };
    let ([x0, y0], [x1, y1]) = (known[i], known[i + 1]);
    let (w, t) = (x1 - x0, ((at - x0) / (x1 - x0)).clamp(0.0, 1.0));
    let (from, to) = (y0 + t * w * slope(i), y1 + (t - 1.0) * w * slope(i + 1));
    // Hermite's cubic.
    let (near, far) = ((1.0 - t) * (1.0 - t), t * t);
    let level = |y: f32, sloped: f32, t: f32| y * (1.0 + 2.0 * t) + (sloped - y);
    near * level(y0, from, t) + far * level(y1, to, 1.0 - t)
}

/// Triangles of a pole and rings of vertices around it.
fn lattice(rings: usize, columns: usize) -> Vec<[u32; 3]> {
    let at = |r: usize, c: usize| if r == 0 { 0 } else { (1 + (r - 1) * columns + c % columns) as u32 };
    let mut all = Vec::new();
    for (r, c) in (0..rings).flat_map(|r| (0..columns).map(move |c| (r, c))) {
        all.push([at(r, c), at(r + 1, c), at(r + 1, c + 1)]);
        if r > 0 {
            all.push([at(r, c), at(r + 1, c + 1), at(r, c + 1)]);
        }
    }
    all
}
