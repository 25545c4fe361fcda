//! The outline of a hand on a small grid: smoothed, holes filled, and compared with its convex hull.

use glam::Vec2;

/// Cells along a side of the grid: a hand's reach each way at the finest pitch, and a margin for growing.
pub(super) const SIDE: usize = 112;

/// Cells at the border that stay empty, so that growing and flooding need no bounds of their own.
pub(super) const MARGIN: usize = 3;

/// Number of cells.
const CELLS: usize = SIDE * SIDE;

/// A set of cells, with what is needed to work on it.
#[derive(Debug, Clone)]
pub(super) struct Mask {
    cells: Box<[bool]>,
    spare: Box<[bool]>,
    stack: Box<[u16]>,
}

/// What the outline shows, in cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outline {
    /// Cells inside of the outline.
    pub area: f32,
    /// Area of its convex hull.
    pub hull: f32,
    /// How deep the outline lies under its hull at most.
    pub gap: f32,
    /// Length over breadth: the ratio of the principal standard deviations of its cells.
    pub aspect: f32,
}

/// The four neighbours of a cell.
const NEXT: [isize; 4] = [1, -1, SIDE as isize, -(SIDE as isize)];

impl Mask {
    pub(super) fn new() -> Self {
        let cells = || vec![false; CELLS].into_boxed_slice();
        Self { cells: cells(), spare: cells(), stack: vec![0; CELLS].into_boxed_slice() }
    }

    /// The cells that can be reached from `seed` by steps of one or two cells (a lost pixel parts no finger) over which
    /// `joined` holds. Cells of the margin are never reached.
    pub(super) fn flood(&mut self, seed: usize, joined: impl Fn(usize, usize) -> bool) {
        self.cells.fill(false);
        // Growing leaves the border of the spare as it finds it.
        self.spare.fill(false);
        self.cells[seed] = true;
        self.stack[0] = seed as u16;
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let cell = self.stack[height] as usize;
            for next in NEXT.iter().flat_map(|n| [*n, 2 * n]) {
                let other = cell.wrapping_add_signed(next);
                if is_inside(other) && !self.cells[other] && joined(cell, other) {
                    self.cells[other] = true;
                    self.stack[height] = other as u16;
                    height += 1;
                }
            }
        }
    }

    /// Grows (`true`) or shrinks the set by one cell all around, corners included.
    pub(super) fn grow(&mut self, grows: bool) {
        for cell in (1..SIDE - 1).flat_map(|row| row * SIDE + 1..(row + 1) * SIDE - 1) {
            let around = [cell - SIDE, cell, cell + SIDE];
            let mut cells = around.iter().flat_map(|c| &self.cells[c - 1..=c + 1]);
            self.spare[cell] = if grows { cells.any(|c| *c) } else { cells.all(|c| *c) };
        }
        std::mem::swap(&mut self.cells, &mut self.spare);
    }

    /// Fills what the set encloses.
    pub(super) fn fill_holes(&mut self) {
        self.spare.fill(false);
        self.spare[0] = true;
        self.stack[0] = 0;
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let cell = self.stack[height] as usize;
            for next in NEXT {
                let other = cell.wrapping_add_signed(next);
                // A step over the end of a row leads to the margin of the next one, which is outside as well.
                if other < CELLS && !self.spare[other] && !self.cells[other] {
                    self.spare[other] = true;
                    self.stack[height] = other as u16;
                    height += 1;
                }
            }
        }
        self.cells.iter_mut().zip(&self.spare).for_each(|(cell, outside)| *cell = !outside);
    }

    /// Square root of the ratio of the eigenvalues of the cells' covariance, a twelfth added for each cell's own size.
    fn aspect(&self, area: f32) -> f32 {
        let cells = || (0..CELLS).filter(|c| self.cells[*c]).map(|c| Vec2::new((c % SIDE) as f32, (c / SIDE) as f32));
        let mean = cells().sum::<Vec2>() / area;
        let (mut square, mut mixed) = (Vec2::ZERO, 0.0);
        for d in cells().map(|c| c - mean) {
            square += d * d;
            mixed += d.x * d.y;
        }
        let (square, mixed) = (square / area + 1.0 / 12.0, mixed / area);
        let middle = 0.5 * (square.x + square.y);
        let half = (0.25 * (square.x - square.y).powi(2) + mixed * mixed).sqrt();
        ((middle + half) / (middle - half).max(1.0 / 12.0)).sqrt()
    }

    /// Holds the outline against its convex hull; `None` for an empty set.
    pub(super) fn outline(&self) -> Option<Outline> {
        let hull = Hull::of(self)?;
        let area = self.cells.iter().filter(|c| **c).count() as f32;
        let mut gap = 0.0f32;
        for cell in (0..CELLS).filter(|c| self.cells[*c]) {
            if NEXT.iter().any(|n| !self.cells[cell.wrapping_add_signed(*n)]) {
                let centre = Vec2::new((cell % SIDE) as f32 + 0.5, (cell / SIDE) as f32 + 0.5);
                gap = gap.max(hull.depth(centre) - 0.5);
            }
        }
        Some(Outline { area, hull: hull.area(), gap, aspect: self.aspect(area) })
    }
}

fn is_inside(cell: usize) -> bool {
    let inside = MARGIN..SIDE - MARGIN;
    inside.contains(&(cell % SIDE)) && inside.contains(&(cell / SIDE))
}

/// The convex hull of a set of cells as squares: a closed polygon.
struct Hull {
    corners: [Vec2; 2 * (SIDE + 1)],
    count: usize,
}

impl Hull {
    /// Two monotone chains (Andrew 1979) over the ends of the rows, which are sorted already.
    fn of(mask: &Mask) -> Option<Self> {
        let mut hull = Self { corners: [Vec2::ZERO; 2 * (SIDE + 1)], count: 0 };
        let row = |y: usize| &mask.cells[y * SIDE..(y + 1) * SIDE];
        let first = |y: usize| row(y).iter().position(|c| *c);
        let last = |y: usize| row(y).iter().rposition(|c| *c).map(|x| x + 1);
        let either = |ends: [Option<usize>; 2], less: bool| match ends {
            [Some(a), Some(b)] => Some(if less { a.min(b) } else { a.max(b) }),
            [a, b] => a.or(b),
        };
        // Corners on the line between two rows; the margin keeps both rows in the grid.
        let lines = || 1..SIDE;
        for y in lines() {
            if let Some(x) = either([first(y - 1), first(y)], true) {
                hull.add(Vec2::new(x as f32, y as f32), 0);
            }
        }
        let turn = hull.count;
        for y in lines().rev() {
            if let Some(x) = either([last(y - 1), last(y)], false) {
                hull.add(Vec2::new(x as f32, y as f32), turn);
            }
        }
        (hull.count > 2).then_some(hull)
    }

    /// Adds a corner to the chain that begins at `start`, taking back corners that it makes concave.
    fn add(&mut self, corner: Vec2, start: usize) {
        while self.count >= start + 2 {
            let [a, b] = [self.corners[self.count - 2], self.corners[self.count - 1]];
            if (b - a).perp_dot(corner - a) < 0.0 {
                break;
            }
            self.count -= 1;
        }
        self.corners[self.count] = corner;
        self.count += 1;
    }

    fn edges(&self) -> impl Iterator<Item = (Vec2, Vec2)> + '_ {
        (0..self.count).map(|i| (self.corners[i], self.corners[(i + 1) % self.count]))
    }

    fn area(&self) -> f32 {
        0.5 * self.edges().map(|(a, b)| a.perp_dot(b)).sum::<f32>().abs()
    }

    /// Distance of a point inside from the nearest edge.
    fn depth(&self, p: Vec2) -> f32 {
        let from = |(a, b): (Vec2, Vec2)| (b - a).perp_dot(p - a).abs() / (b - a).length().max(1e-6);
        self.edges().map(from).fold(f32::INFINITY, f32::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mask drawn in the middle of the grid.
    fn drawn(inside: impl Fn(i32, i32) -> bool) -> Mask {
        let mut mask = Mask::new();
        let half = SIDE as i32 / 2;
        for (i, cell) in mask.cells.iter_mut().enumerate() {
            *cell = inside(i as i32 % SIDE as i32 - half, i as i32 / SIDE as i32 - half);
        }
        mask
    }

    #[test]
    fn a_square_is_its_own_hull() {
        let o = drawn(|x, y| x.abs() <= 10 && y.abs() <= 10).outline().unwrap();
        assert_eq!((o.area, o.hull, o.gap), (441.0, 441.0, 0.0));
        assert!((o.aspect - 1.0).abs() < 1e-3);
        let o = drawn(|x, y| x.abs() <= 20 && y.abs() <= 5).outline().unwrap();
        assert!((o.aspect - 41.0 / 11.0).abs() < 0.01, "{o:?}");
        assert!(drawn(|_, _| false).outline().is_none());
    }

    #[test]
    fn a_disc_is_nearly_its_own_hull_and_a_cross_is_not() {
        let o = drawn(|x, y| x * x + y * y <= 400).outline().unwrap();
        assert!(o.area / o.hull > 0.95 && o.gap < 1.0, "{o:?}");
        // A cross with arms of 5 x 20 cells: the hull is the octagon around it, and the corners lie deep.
        let o = drawn(|x, y| x.abs().min(y.abs()) <= 2 && x.abs().max(y.abs()) <= 20).outline().unwrap();
        assert!((o.hull - (41.0 * 41.0 - 2.0 * 18.0 * 18.0)).abs() < 1.0, "{o:?}");
        assert!((o.gap - 18.0 / 2f32.sqrt() + 0.5).abs() < 1.0, "{o:?}");
    }

    #[test]
    fn holes_are_filled_and_growing_then_shrinking_keeps_a_square() {
        let mut ring = drawn(|x, y| (5..=10).contains(&x.abs().max(y.abs())));
        ring.fill_holes();
        assert_eq!(ring.outline().unwrap().area, 441.0);
        ring.flood(SIDE / 2 * SIDE + SIDE / 2, |_, to| {
            to / SIDE >= 46 && to / SIDE <= 66 && to % SIDE >= 46 && to % SIDE <= 66
        });
        ring.grow(true);
        assert_eq!(ring.outline().unwrap().area, 529.0);
        ring.grow(false);
        assert_eq!(ring.outline().unwrap().area, 441.0);
    }

    #[test]
    fn a_flood_stops_where_cells_are_not_joined_and_at_the_margin() {
        let mut mask = Mask::new();
        mask.flood(SIDE / 2 * SIDE + SIDE / 2, |_, to| to % SIDE > 40);
        assert_eq!(mask.outline().unwrap().area, ((SIDE - MARGIN - 41) * (SIDE - 2 * MARGIN)) as f32);
    }
}
