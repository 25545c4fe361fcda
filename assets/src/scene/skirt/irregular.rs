//! The skirt meshed irregularly: the same cone and as many vertices, but no rows and no columns. A direct solver that
//! depends on the regularity of a grid cannot hide behind it.
//!
//! The cone is developable: unrolled into a sector of a plane, lengths stay what they are. Points of blue noise are
//! sampled there, and the Delaunay triangulation of the sector, repeated left and right of itself, closes around.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::surface::{HEIGHT, RADIUS, hem, point, push};
use crate::delaunay::delaunay;
use toile_bake::Shape;
use toile_bake::shape::NO_VERTEX;
use toile_base::numeric::random::SplitMix64;

/// Part of the spacing of the densest packing at which sampling starts; random points never pack more densely.
const FIRST_SPACING: f64 = 0.85;

/// What the spacing is multiplied by when no candidate finds room.
const RELAX: f64 = 0.97;

/// How far points stay away from the two borders, as a multiple of the spacing.
const BORDER: f64 = 0.5;

/// Candidates tried at each spacing, as a multiple of the points wanted.
const CANDIDATES: usize = 8;

/// A vertex of the cone: `u` (0 ring, 1 hem), angle around (rad).
type ConePlace = [f64; 2];

/// The skirt of `n` x `n` vertices at least 3 x 3: first `n` on the pinned ring, last `n` on the hem, between them blue
/// noise of equal density on the cone, joined by Delaunay triangles. The same seed gives the same mesh.
pub fn irregular(n: usize, seed: u64) -> Shape {
    let n = n.max(3);
    let around = |u: f64| (0..n).map(move |j| [u, TAU * j as f64 / n as f64]);
    let mut places: Vec<ConePlace> = around(0.0).collect();
    let hem: Vec<ConePlace> = around(1.0).collect();
    sample_points(&mut places, &hem, n * n - 2 * n, seed);
    places.extend(hem);
    let mut shape = Shape::default();
    for (i, &[u, angle]) in places.iter().enumerate() {
        push(&mut shape, point(u, angle), i < n);
    }
    shape.faces = triangles(&places, n).into_iter().map(|[a, b, c]| [a, b, c, NO_VERTEX]).collect();
    shape
}

/// A random place on the cone, each square metre as likely as any other.
fn random_place(random: &mut SplitMix64) -> ConePlace {
    let [top, more] = RADIUS;
    let hem2 = (top + more).powi(2);
    let r = (top * top + random.uniform_f64() * (hem2 - top * top)).sqrt();
    [(r - top) / more, TAU * random.uniform_f64()]
}

/// Length of the cone from ring to hem along its side (m).
fn slant() -> f64 {
    RADIUS[1].hypot(HEIGHT[1])
}

/// Poisson-disc sampling by dart throwing (Cook 1986): `count` points that keep a distance from each other and from the
/// two rings, which shrinks as room runs out.
fn sample_points(places: &mut Vec<ConePlace>, hem: &[ConePlace], count: usize, seed: u64) {
    let area = std::f64::consts::PI * (2.0 * RADIUS[0] + RADIUS[1]) * slant();
    // In the densest packing each point has an area of spacing^2 sqrt(3) / 2.
    let mut spacing = FIRST_SPACING * (area / (count + hem.len()) as f64 * 2.0 / 3f64.sqrt()).sqrt();
    let mut grid = SpacingGrid::new(spacing);
    places.iter().chain(hem).for_each(|&place| grid.add(place));
    let mut random = SplitMix64::new(seed);
    let mut left = count;
    while left > 0 {
        for _ in 0..CANDIDATES * count {
            let place = random_place(&mut random);
            // Between two vertices of a ring nothing keeps a point away from the border, where it would leave a sliver.
            let inland = place[0].min(1.0 - place[0]) * slant() > BORDER * spacing;
            if left > 0 && inland && grid.is_free(place, spacing) {
                grid.add(place);
                places.push(place);
                left -= 1;
            }
        }
        spacing *= RELAX;
    }
}

/// The cone in cells at least as wide and high as the largest spacing, so that what is near lies in neighbouring cells.
struct SpacingGrid {
    rows: usize,
    columns: usize,
    cells: Vec<Vec<DVec3>>,
}

impl SpacingGrid {
    fn new(spacing: f64) -> Self {
        let rows = ((slant() / spacing) as usize).max(1);
        let columns = ((TAU * RADIUS[0] / spacing) as usize).max(3);
        Self { rows, columns, cells: vec![Vec::new(); rows * columns] }
    }

    fn cell(&self, [u, angle]: ConePlace) -> [usize; 2] {
        let part = |x: f64, count: usize| ((x * count as f64) as usize).min(count - 1);
        [part(u, self.rows), part(angle / TAU, self.columns)]
    }

    fn add(&mut self, place: ConePlace) {
        let [row, column] = self.cell(place);
        self.cells[row * self.columns + column].push(point(place[0], place[1]));
    }

    fn is_free(&self, place: ConePlace, spacing: f64) -> bool {
        let ([row, column], p) = (self.cell(place), point(place[0], place[1]));
        let rows = row.saturating_sub(1)..=(row + 1).min(self.rows - 1);
        rows.flat_map(|r| [self.columns - 1, 0, 1].map(|c| r * self.columns + (column + c) % self.columns))
            .all(|cell| self.cells[cell].iter().all(|q| p.distance_squared(*q) >= spacing * spacing))
    }
}

/// Delaunay triangles of the unrolled cone, which close around, seen from outside counter-clockwise.
fn triangles(places: &[ConePlace], n: usize) -> Vec<[u32; 3]> {
    // Distance from the apex, and the angle by which the unrolled cone turns while the cone goes once around.
    let shrink = RADIUS[1] / slant();
    let unrolled = |[u, angle]: ConePlace, turn: f64| {
        let (r, angle) = ((RADIUS[0] + RADIUS[1] * u) / shrink, (angle + TAU * turn) * shrink);
        r * DVec2::from_angle(angle)
    };
    let points: Vec<DVec2> =
        [-1.0, 0.0, 1.0].iter().flat_map(|&turn| places.iter().map(move |&place| unrolled(place, turn))).collect();
    let (count, hem) = (places.len(), hem(n));
    let mut found = Vec::new();
    for corners in delaunay(&points) {
        let corners = corners.map(|v| v as usize);
        // What lies between ring and apex, or beyond the hem, is filled with triangles of one ring alone.
        let outside = corners.iter().all(|v| v % count < n) || corners.iter().all(|v| hem.contains(&(v % count)));
        let first = corners.iter().map(|v| v / count).min().unwrap_or(0);
        // Each triangle of the cone appears once with its first corner in each copy: the middle one's are kept.
        if !outside && first == 1 {
            found.push(outwards(places, corners.iter().map(|v| (v % count) as u32)));
        }
    }
    found
}

fn outwards(places: &[ConePlace], corners: impl Iterator<Item = u32>) -> [u32; 3] {
    let mut t = [0; 3];
    corners.zip(&mut t).for_each(|(v, corner)| *corner = v);
    let [a, b, c] = t.map(|v| point(places[v as usize][0], places[v as usize][1]));
    let out = (a + b + c).with_y(0.0);
    if (b - a).cross(c - a).dot(out) < 0.0 { [t[0], t[2], t[1]] } else { t }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use toile_bake::check;
    use toile_bake::check::corners;

    #[test]
    fn it_is_one_closed_band_of_sound_triangles() {
        for n in [32, 64] {
            let shape = irregular(n, 1);
            assert_eq!(shape.cut.len(), n * n);
            assert_eq!(check::check(&shape.cut, &shape.faces), Ok(()));
            let mut sides: BTreeMap<[u32; 2], usize> = BTreeMap::new();
            for face in &shape.faces {
                let ring = corners(face);
                (0..3).for_each(|k| {
                    let (a, b) = (ring[k], ring[(k + 1) % 3]);
                    *sides.entry([a.min(b), a.max(b)]).or_default() += 1;
                });
            }
            // A band has Euler characteristic 0, and its two borders are the ring and the hem alone.
            assert_eq!(shape.cut.len() + shape.faces.len(), sides.len());
            let border: Vec<_> = sides.iter().filter(|(_, count)| **count == 1).map(|(side, _)| *side).collect();
            let on = |v: u32| (v as usize) < n || hem(n).contains(&(v as usize));
            assert_eq!(border.len(), 2 * n);
            assert!(border.iter().flatten().all(|v| on(*v)));
        }
    }

    #[test]
    fn its_vertices_keep_their_distance_and_its_triangles_look_outwards() {
        let (n, shape) = (64, irregular(64, 1));
        // Equal density: the nearest neighbour of each is at least half the spacing of an even lattice away.
        let area = std::f64::consts::PI * 0.6 * slant();
        let even = (area / (n * n) as f64).sqrt() as f32;
        for face in &shape.faces {
            let [a, b, c] = [face[0], face[1], face[2]].map(|v| shape.cut[v as usize]);
            for (p, q) in [(a, b), (b, c), (c, a)] {
                assert!((0.5 * even..3.0 * even).contains(&p.distance(q)), "{p} {q} {even}");
            }
            assert!((b - a).cross(c - a).dot((a + b + c).with_y(0.0)) > 0.0);
        }
        assert!(shape.fixed.iter().enumerate().all(|(v, fixed)| *fixed == (v < n)));
    }

    #[test]
    fn the_seed_decides() {
        assert_eq!(irregular(32, 7), irregular(32, 7));
        assert_ne!(irregular(32, 7).cut, irregular(32, 8).cut);
    }
}
