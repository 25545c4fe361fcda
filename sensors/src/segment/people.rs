//! Finds the pieces that are people, and the other pieces of the shopper.

use glam::{Vec2, Vec3};
use toile_base::numeric::statistics::quantile;

use super::floor::sigma;
use super::grid::Grid;
use super::heads::Heads;
use super::pieces::Pieces;

/// Smallest surface of a person worth looking at, half of what one sees from the waist up, and largest, twice that of a
/// large person with arms stretched (m2): walls are larger.
const AREA: std::ops::Range<f32> = 0.10..2.5;

/// Heights of what is seen of a person (m): from the waist up at least.
const TALL: std::ops::Range<f32> = 0.45..2.4;

/// Largest breadth, arms stretched, and largest reach towards the camera, an arm stretched (m).
const BROADEST: f32 = 2.1;
const DEEPEST: f32 = 1.3;

/// Bands below the crown (m) in which a head and a chest are looked for, how far from the axis, and the breadths that
/// hold three quarters of what is seen there.
const HEAD: Band = Band { below: [0.02, 0.16], reach: 0.25, breadth: [0.06, 0.32] };
const CHEST: Band = Band { below: [0.30, 0.45], reach: 0.35, breadth: [0.15, 0.65] };

/// A slim person's chest from the side, which may be narrower than the head: only whose feet are seen as well as the head (m).
const SIDE: Band = Band { below: [0.30, 0.45], reach: 0.35, breadth: [0.07, 0.65] };
const FEET: f32 = 0.35;
const WHOLE: std::ops::Range<f32> = 1.2..2.15;

/// A part without a head is a person's arm up to this surface (m2); a larger one is a person or something else.
const ARM: f32 = 0.12;

/// Pieces smaller than this are noise (cells).
const FEWEST: usize = 6;

/// A piece belongs to the shopper where its distance from them is less than this (m).
const GAP: f32 = 0.10;

/// ... and where it is smaller than this (m2), or lies in their column, nearer than this to their axis (m).
const FRAGMENT: f32 = 0.05;
const COLUMN: f32 = 0.25;

/// A hand stretched towards the camera hides its arm: it lies up to so far before the shopper (m), but beside them in the
/// image (cells).
const STRETCHED: f32 = 0.6;
const BESIDE: isize = 8;

/// A body is not flat: its surface leaves the plane nearest to it by more than this and the noise (m, root mean square).
/// Walls, doors and mirrors do not.
const RELIEF: f32 = 0.008;

/// Deviations of the sensor's noise that count as flat: where neighbours share it, and with its steps, a wall at 4.4 m has one. Beyond
/// the second distance (m) a body's own relief sinks in the noise, too.
const NOISY: [f32; 2] = [1.0, 0.5];
const SEEN: f32 = 4.6;

/// Lower pieces are what is left of the floor (m).
const LITTER: f32 = 0.12;

/// People are looked for up to so far behind the zone, so that they are not taken for the shopper (m).
const BEHIND: f32 = 1.5;

/// No person stands on another: of two that stand as near to one another as this (m), one that lies below all but this share of the
/// other is their lower half, which a hand before the hips parts from the upper one.
const ON_TOP: f32 = 0.35;
const OVERLAP: f32 = 0.30;

/// Legs that a hand before the hips parts from a person seen down to there: they stand in the same column, are no broader than a
/// stance, and hide no more between them and the shopper than a hand and a forearm (m).
const STANCE: f32 = 0.7;
const HIDDEN: f32 = 0.35;

struct Band {
    below: [f32; 2],
    reach: f32,
    breadth: [f32; 2],
}

/// One person as seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    /// Their position (m): to the camera's right, ahead of it.
    pub place: Vec2,
    /// Their highest point above the floor, or above y = 0 where no floor is seen (m).
    pub top: f32,
    /// The surface that is seen (m2).
    pub area: f32,
}

/// The people of a frame.
#[derive(Debug, Clone, Default)]
pub(super) struct PeopleFinder {
    pieces: Pieces,
    heads: Heads,
    people: Vec<Person>,
    /// Cells of each person.
    cells: Vec<Vec<u32>>,
    /// Pieces that are no person, by number.
    rest: Vec<usize>,
    shopper: Vec<u32>,
    numbers: Vec<f32>,
}

impl PeopleFinder {
    /// Finds the people of a grid up to a distance behind `far` (m), the zone's end.
    pub fn find(&mut self, grid: &mut Grid, far: f32) {
        self.people.clear();
        self.cells.clear();
        self.rest.clear();
        self.pieces.find(grid, FEWEST, far + BEHIND);
        for piece in 0..self.pieces.count() {
            let cells = self.pieces.cells(piece);
            let area: f32 = cells.iter().map(|c| grid.area(*c as usize)).sum();
            if !(AREA.start..2.0 * AREA.end).contains(&area) {
                self.rest.push(piece);
                continue;
            }
            let found = self.people.len();
            self.part(grid, piece);
            if self.people.len() == found {
                self.rest.push(piece);
            }
        }
        self.join_halves(grid);
    }

    /// Joins what a hand parts into an upper and a lower half.
    fn join_halves(&mut self, grid: &Grid) {
        let mut upper = 0;
        while upper < self.people.len() {
            let (of, above) = (self.people[upper], &self.cells[upper]);
            let beside = |top: f32| above.iter().filter(|c| grid.height[**c as usize] < top).count();
            let is_lower = |p: &Person| {
                let near = p.top < of.top && p.place.distance(of.place) < ON_TOP;
                near && (beside(p.top) as f32) < OVERLAP * above.len() as f32
            };
            let Some(lower) = self.people.iter().position(is_lower) else {
                upper += 1;
                continue;
            };
            let cells = self.cells.remove(lower);
            let half = self.people.remove(lower);
            upper -= usize::from(lower < upper);
            self.cells[upper].extend_from_slice(&cells);
            self.people[upper].area += half.area;
            self.people[upper].place = place(grid, &self.cells[upper], &mut self.numbers);
        }
    }

    /// All people found.
    pub fn all(&self) -> &[Person] {
        &self.people
    }

    /// The shopper's cells, once gathered.
    pub fn shopper_cells(&self) -> &[u32] {
        &self.shopper
    }

    /// Parts one piece into people. A peak whose part is no person gives it back to the others if it is as small as an
    /// arm; else its cells belong to no person.
    fn part(&mut self, grid: &Grid, piece: usize) {
        let cells = self.pieces.cells(piece);
        let mut peaks = self.heads.peaks(grid, cells);
        loop {
            let parts = self.heads.part(grid, cells, &peaks);
            let arm = (0..parts.len()).rev().find(|i| {
                let area: f32 = parts[*i].iter().map(|c| grid.area(*c as usize)).sum();
                area < ARM && parts.len() > 1
            });
            if let Some(arm) = arm {
                peaks.remove(arm);
                continue;
            }
            let people: Vec<(Person, Vec<u32>)> =
                parts.into_iter().filter_map(|cells| Some((person(grid, &cells, &mut self.numbers)?, cells))).collect();
            // Where no part is a person by itself, the peaks were those of one person: a hand in the hair, a hat.
            if people.is_empty() && peaks.len() > 1 {
                peaks.truncate(1);
                continue;
            }
            for (person, cells) in people {
                self.people.push(person);
                self.cells.push(cells);
            }
            return;
        }
    }

    /// Gathers the cells of the chosen person and of the pieces that belong to them.
    pub fn gather(&mut self, grid: &Grid, chosen: Option<usize>) {
        self.shopper.clear();
        let Some(chosen) = chosen else { return };
        self.shopper.extend_from_slice(&self.cells[chosen]);
        let axis = self.people[chosen].place;
        let mut is_shopper = vec![false; grid.depth.len()];
        self.shopper.iter().for_each(|c| is_shopper[*c as usize] = true);
        // Cells of a piece with people that are not the shopper's belong, or may belong, to another person.
        let mut is_other = vec![false; grid.depth.len()];
        let inhabited = (0..self.pieces.count()).filter(|p| !self.rest.contains(p));
        for cell in inhabited.flat_map(|p| self.pieces.cells(p)) {
            is_other[*cell as usize] = !is_shopper[*cell as usize];
        }
        let heights = self.shopper.iter().map(|c| grid.height[*c as usize]);
        let bottom = heights.fold(f32::MAX, f32::min);
        for &piece in &self.rest {
            let cells = self.pieces.cells(piece);
            let contested = || cells.iter().any(|c| touches(grid, *c as usize, &is_other, false));
            let below = bottom > FEET && are_legs(grid, cells, bottom, axis, &mut self.numbers);
            if (below || belongs(grid, cells, &is_shopper, axis, &mut self.numbers)) && !contested() {
                self.shopper.extend_from_slice(cells);
            }
        }
    }
}

/// Whether a piece that is no person is part of the shopper: a hand behind a strap, legs below a black belt.
fn belongs(grid: &Grid, cells: &[u32], is_shopper: &[bool], axis: Vec2, numbers: &mut Vec<f32>) -> bool {
    let area: f32 = cells.iter().map(|c| grid.area(*c as usize)).sum();
    let top = cells.iter().map(|c| grid.height[*c as usize]).fold(f32::MIN, f32::max);
    if area > AREA.end * 0.5 || top < LITTER {
        return false;
    }
    let column = if area < ARM { 2.0 * BROADEST } else { COLUMN };
    if area > FRAGMENT && place(grid, cells, numbers).distance(axis) > column {
        return false;
    }
    cells.iter().any(|c| touches(grid, *c as usize, is_shopper, area < ARM))
}

/// Whether a piece is the legs of a person who is seen down to a height (m) over a place.
fn are_legs(grid: &Grid, cells: &[u32], bottom: f32, axis: Vec2, numbers: &mut Vec<f32>) -> bool {
    let span = |value: &dyn Fn(usize) -> f32| {
        let all = cells.iter().map(|c| value(*c as usize));
        all.fold([f32::MAX, f32::MIN], |[least, most], v| [least.min(v), most.max(v)])
    };
    let [foot, hip] = span(&|c| grid.height[c]);
    let [left, right] = span(&|c| grid.place(c).x);
    let meets = foot < FEET && hip > bottom - HIDDEN && hip < bottom + HIDDEN && right - left < STANCE;
    meets && place(grid, cells, numbers).distance(axis) < ON_TOP
}

/// Whether the shopper is found near a cell, along its row and column; for what may be a hand, behind it too.
fn touches(grid: &Grid, cell: usize, is_shopper: &[bool], hand: bool) -> bool {
    let (row, column) = ((cell / grid.columns) as isize, (cell % grid.columns) as isize);
    let p = grid.point(cell);
    let reach = (GAP / grid.area(cell).sqrt().max(1e-4)).min(24.0) as isize;
    (1..=reach.max(BESIDE)).any(|d| {
        [(d, 0), (-d, 0), (0, d), (0, -d)].into_iter().any(|(dx, dy)| {
            let (r, c) = (row + dy, column + dx);
            let inside = (0..grid.rows as isize).contains(&r) && (0..grid.columns as isize).contains(&c);
            inside && {
                let other = r as usize * grid.columns + c as usize;
                let behind = grid.depth[other] - p.z;
                let beside = hand && d <= BESIDE && (0.0..STRETCHED).contains(&behind);
                is_shopper[other] && (beside || grid.point(other).distance(p) < GAP)
            }
        })
    })
}

/// Whether some cells lie in one plane, up to the sensor's noise.
fn is_flat(grid: &Grid, cells: &[u32]) -> bool {
    let count = cells.len() as f32;
    let middle = cells.iter().map(|c| grid.point(*c as usize)).sum::<Vec3>() / count;
    // The plane nearest to the points, its depth over the image's two directions.
    let (mut xx, mut xy, mut yy, mut xz, mut yz, mut zz) = (0.0f32, 0.0f32, 0.0f32, 0.0f32, 0.0f32, 0.0f32);
    for cell in cells {
        let d = grid.point(*cell as usize) - middle;
        (xx, xy, yy) = (xx + d.x * d.x, xy + d.x * d.y, yy + d.y * d.y);
        (xz, yz, zz) = (xz + d.x * d.z, yz + d.y * d.z, zz + d.z * d.z);
    }
    let determinant = xx * yy - xy * xy;
    if determinant <= 0.0 {
        return true;
    }
    let (a, b) = ((xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant);
    let variance = (zz - a * xz - b * yz) / count / (1.0 + a * a + b * b);
    let noisy = if middle.z < SEEN { NOISY[0] } else { NOISY[1] };
    variance.max(0.0).sqrt() < RELIEF + noisy * sigma(middle.z)
}

/// The middle of some cells along the floor (m).
fn place(grid: &Grid, cells: &[u32], numbers: &mut Vec<f32>) -> Vec2 {
    let mut median = |axis: usize| {
        numbers.clear();
        numbers.extend(cells.iter().map(|c| grid.place(*c as usize)[axis]));
        quantile(numbers, 0.5).unwrap_or(0.0)
    };
    Vec2::new(median(0), median(1))
}

/// The person that some cells show: upright, of a person's size, with a head narrower than the chest below it.
fn person(grid: &Grid, cells: &[u32], numbers: &mut Vec<f32>) -> Option<Person> {
    let area: f32 = cells.iter().map(|c| grid.area(*c as usize)).sum();
    if !AREA.contains(&area) || is_flat(grid, cells) {
        return None;
    }
    let mut span = |value: &dyn Fn(usize) -> f32| {
        numbers.clear();
        numbers.extend(cells.iter().map(|c| value(*c as usize)));
        [0.01, 0.99].map(|share| quantile(numbers, share).unwrap_or(0.0))
    };
    let [bottom, top] = span(&|c| grid.height[c]);
    let [left, right] = span(&|c| grid.place(c).x);
    let [front, back] = span(&|c| grid.place(c).y);
    if !TALL.contains(&(top - bottom)) || right - left > BROADEST || back - front > DEEPEST {
        return None;
    }
    // Raised hands are higher than the head, so the head is sought above the middle of the lower half; a person half
    // hidden has that elsewhere, and then their highest point is their head.
    numbers.clear();
    let low = cells.iter().filter(|c| grid.height[**c as usize] < 0.5 * (bottom + top));
    numbers.extend(low.map(|c| grid.place(*c as usize).x));
    let axis = quantile(numbers, 0.5)?;
    let near = cells.iter().filter(|c| (grid.place(**c as usize).x - axis).abs() < 0.13);
    let crown = near.map(|c| grid.height[*c as usize]).fold(f32::MIN, f32::max);
    let is_person = [crown, top].into_iter().any(|crown| {
        let [head, chest, side] = [&HEAD, &CHEST, &SIDE].map(|b| b.breadth(grid, cells, axis, crown, numbers));
        let is_whole = bottom < FEET && WHOLE.contains(&top);
        head.is_some_and(|head| chest.is_some_and(|chest| chest > head) || is_whole && side.is_some())
    });
    is_person.then(|| Person { place: place(grid, cells, numbers), top, area })
}

impl Band {
    /// The breadth of three quarters of the cells in this band, where it is that of a body.
    fn breadth(&self, grid: &Grid, cells: &[u32], axis: f32, crown: f32, numbers: &mut Vec<f32>) -> Option<f32> {
        numbers.clear();
        for cell in cells {
            let below = crown - grid.height[*cell as usize];
            let x = grid.place(*cell as usize).x;
            if (self.below[0]..self.below[1]).contains(&below) && (x - axis).abs() < self.reach {
                numbers.push(x);
            }
        }
        if numbers.len() < 8 {
            return None;
        }
        let breadth = quantile(numbers, 0.875)? - quantile(numbers, 0.125)?;
        (self.breadth[0]..self.breadth[1]).contains(&breadth).then_some(breadth)
    }
}
