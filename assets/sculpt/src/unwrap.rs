//! The atlas: each chart flattened with little stretch and without folds, then all packed into the unit square.
//!
//! A chart is pinned to a circle (Tutte 1963: no fold), then the symmetric Dirichlet energy (Smith and Schaefer 2015,
//! "Bijective parameterization with free boundaries": |J|^2 + |J^-1|^2 a triangle, infinite at a fold) is brought down by
//! gradient steps preconditioned with the chart's Laplacian (Kovalsky, Galun and Lipman 2016). The rest shape is the mean
//! of both sexes, so one atlas serves both. The right side's charts are the left ones mirrored.

use glam::{Mat2, Vec2, Vec3};

use crate::draw::Drawn;
use crate::lattice::chart::CHARTS;

/// Steps of the descent; it settles within these.
const STEPS: usize = 240;
/// Rounds of the conjugate gradients within a step.
const INNER: usize = 60;
/// Rounds in which overlapping triangles are made smaller, and by how much a round.
const TIGHTER: usize = 60;
const SMALLER: f32 = 0.93;
/// Size of the squares in which a chart's overlaps are looked for (m).
const SQUARE: f32 = 6e-4;
/// Gap between charts, as a share of the atlas's side.
const GAP: f32 = 0.006;

/// Texture points and the point of each face's corners, for both bodies together.
pub fn unwrap(bodies: &[Drawn; 2]) -> (Vec<Vec2>, Vec<[u32; 4]>) {
    let mean: Vec<Vec3> = bodies[0].positions.iter().zip(&bodies[1].positions).map(|(a, b)| (*a + *b) * 0.5).collect();
    let drawn = &bodies[0];
    let mut sheets: Vec<ChartLayout> = Vec::with_capacity(CHARTS);
    for chart in 0..CHARTS as u8 {
        let faces: Vec<usize> = (0..drawn.quads.len()).filter(|&f| drawn.charts[f].number() == chart).collect();
        let mirrored = chart >= 4 && chart % 2 == 1;
        let sheet = ChartLayout::new(&drawn.quads, faces);
        sheets.push(if mirrored {
            sheet.like(&sheets[usize::from(chart) - 1], &drawn.mirrors)
        } else {
            sheet.flattened(&mean)
        });
    }
    pack(&mut sheets);
    let mut uvs = Vec::new();
    let mut corners = vec![[0; 4]; drawn.quads.len()];
    for sheet in &sheets {
        let first = uvs.len() as u32;
        uvs.extend(&sheet.points);
        for (&f, face) in sheet.faces.iter().zip(&sheet.quads) {
            corners[f] = face.map(|v| first + v);
        }
    }
    (uvs, corners)
}

/// One chart: its faces, its vertices by their own numbers, and where they lie.
struct ChartLayout {
    faces: Vec<usize>,
    quads: Vec<[u32; 4]>,
    /// The body's vertex of each of its own.
    vertices: Vec<u32>,
    points: Vec<Vec2>,
}

impl ChartLayout {
    fn new(quads: &[[u32; 4]], faces: Vec<usize>) -> Self {
        let mut vertices: Vec<u32> = faces.iter().flat_map(|&f| quads[f]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let own = |v: u32| vertices.binary_search(&v).expect("a vertex of the chart") as u32;
        let quads = faces.iter().map(|&f| quads[f].map(own)).collect();
        Self { faces, quads, vertices, points: Vec::new() }
    }

    /// The mirror image of another sheet's layout.
    fn like(mut self, other: &Self, mirrors: &[u32]) -> Self {
        let mirror = |v: &u32| other.vertices.binary_search(&mirrors[*v as usize]).expect("a mirrored chart");
        self.points = self.vertices.iter().map(|v| other.points[mirror(v)] * Vec2::new(-1.0, 1.0)).collect();
        self
    }

    fn flattened(mut self, positions: &[Vec3]) -> Self {
        let rest: Vec<Vec3> = self.vertices.iter().map(|&v| positions[v as usize]).collect();
        let triangles: Vec<[u32; 3]> = self.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let mut flat = Flattening::new(&rest, &triangles);
        self.points = flat.run(flat.circle(&rest, &self.rim()));
        for _ in 0..TIGHTER {
            // Toes laid flat are broader than the gaps between them: where the sheet covers itself they get less room.
            let over = overlapping(&self.points, &triangles);
            if over.is_empty() {
                break;
            }
            flat.tighten(&over);
            self.points = flat.run(std::mem::take(&mut self.points));
        }
        let turn = upright(&self.points, &rest);
        self.points.iter_mut().for_each(|p| *p = turn * *p);
        self
    }

    /// The vertices of the border, in order.
    fn rim(&self) -> Vec<u32> {
        let mut next = std::collections::BTreeMap::new();
        let sides: std::collections::BTreeSet<(u32, u32)> =
            self.quads.iter().flat_map(|q| (0..4).map(|k| (q[k], q[(k + 1) % 4]))).collect();
        for &(a, b) in sides.iter().filter(|&&(a, b)| !sides.contains(&(b, a))) {
            assert!(next.insert(a, b).is_none(), "a chart's border touches itself at {}", self.vertices[a as usize]);
        }
        let first = *next.keys().next().expect("a chart has a border");
        let mut rim = vec![first];
        while next[&rim[rim.len() - 1]] != first {
            rim.push(next[&rim[rim.len() - 1]]);
        }
        assert_eq!(rim.len(), next.len(), "a chart is a disc");
        rim
    }
}

/// Triangles that cover the middle of one square: those that truly overlap, but for less than a square.
fn overlapping(points: &[Vec2], triangles: &[[u32; 3]]) -> Vec<usize> {
    let low = points.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    let size = (points.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max) - low) / SQUARE;
    let columns = size.x as usize + 2;
    let mut taken: Vec<Vec<u32>> = vec![Vec::new(); columns * (size.y as usize + 2)];
    let mut over = std::collections::BTreeSet::new();
    for (t, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|v| (points[v as usize] - low) / SQUARE);
        let least = a.min(b).min(c).max(Vec2::ZERO);
        let most = a.max(b).max(c).min(size);
        for y in least.y as usize..=most.y as usize {
            for x in least.x as usize..=most.x as usize {
                let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                if [(a, b), (b, c), (c, a)].iter().all(|(u, v)| (*v - *u).perp_dot(p - *u) > 0.0) {
                    let here = &mut taken[y * columns + x];
                    over.extend(here.iter().flat_map(|&o| [o as usize, t]));
                    here.push(t as u32);
                }
            }
        }
    }
    over.into_iter().collect()
}

/// The turn that brings the body's up to the sheet's up, as far as it can.
fn upright(points: &[Vec2], rest: &[Vec3]) -> Mat2 {
    let middle = points.iter().sum::<Vec2>() / points.len() as f32;
    let height = rest.iter().map(|p| p.y).sum::<f32>() / rest.len() as f32;
    let up: Vec2 = points.iter().zip(rest).map(|(p, r)| (*p - middle) * (r.y - height)).sum();
    let up = up.normalize_or(Vec2::Y);
    Mat2::from_cols(Vec2::new(up.y, up.x), Vec2::new(-up.x, up.y))
}

/// One triangle at rest: corners, the inverse of its edge matrix, area.
struct RestTriangle {
    corners: [u32; 3],
    inverse: Mat2,
    area: f32,
}

struct Flattening {
    rest: Vec<RestTriangle>,
    /// Neighbours of each vertex with the Laplacian's weight.
    near: Vec<Vec<(u32, f32)>>,
    area: f32,
}

impl Flattening {
    fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut near: Vec<Vec<(u32, f32)>> = vec![Vec::new(); positions.len()];
        let mut add = |a: u32, b: u32, w: f32| match near[a as usize].iter_mut().find(|n| n.0 == b) {
            Some(n) => n.1 += w,
            None => near[a as usize].push((b, w)),
        };
        let mut rest = Vec::with_capacity(triangles.len());
        for &corners in triangles {
            let [a, b, c] = corners.map(|v| positions[v as usize]);
            let (e, f) = (b - a, c - a);
            let along = e.normalize();
            let x = f.dot(along);
            let edges = Mat2::from_cols(Vec2::new(e.length(), 0.0), Vec2::new(x, (f - along * x).length()));
            rest.push(RestTriangle { corners, inverse: edges.inverse(), area: 0.5 * edges.determinant() });
            for k in 0..3 {
                let [o, p, q] = [0, 1, 2].map(|j| positions[corners[(k + j) % 3] as usize]);
                let (u, v) = (p - o, q - o);
                // Half the cotangent of the angle at o, for the edge across; never so small that the system fails.
                let weight = (0.5 * u.dot(v) / u.cross(v).length().max(1e-12)).clamp(0.05, 5.0);
                add(corners[(k + 1) % 3], corners[(k + 2) % 3], weight);
                add(corners[(k + 2) % 3], corners[(k + 1) % 3], weight);
            }
        }
        let area = rest.iter().map(|r| r.area).sum();
        Self { rest, near, area }
    }

    /// The chart on a disc of its own area: the border evenly on the circle, each other vertex amid its neighbours.
    fn circle(&self, positions: &[Vec3], rim: &[u32]) -> Vec<Vec2> {
        let radius = (self.area / std::f32::consts::PI).sqrt();
        let step = |k: usize| positions[rim[k] as usize].distance(positions[rim[(k + 1) % rim.len()] as usize]);
        let total: f32 = (0..rim.len()).map(step).sum();
        let mut points = vec![Vec2::ZERO; positions.len()];
        let mut fixed = vec![false; positions.len()];
        let mut way = 0.0;
        for (k, &v) in rim.iter().enumerate() {
            points[v as usize] = Vec2::from_angle(way / total * std::f32::consts::TAU) * radius;
            fixed[v as usize] = true;
            way += step(k);
        }
        // Over-relaxed Gauss-Seidel with equal weights.
        for _ in 0..3000 {
            for v in 0..points.len() {
                if !fixed[v] {
                    let mean: Vec2 =
                        self.near[v].iter().map(|n| points[n.0 as usize]).sum::<Vec2>() / self.near[v].len() as f32;
                    points[v] = points[v].lerp(mean, 1.7);
                }
            }
        }
        points
    }

    fn run(&self, mut points: Vec<Vec2>) -> Vec<Vec2> {
        let (mut energy, mut slope) = self.energy(&points).expect("Tutte's layout has no fold");
        let mut stride = 1.0f32;
        for _ in 0..STEPS {
            let down = self.solve(&slope);
            let steep: f32 = slope.iter().zip(&down).map(|(g, d)| g.dot(*d)).sum();
            stride = (2.0 * stride).min(1.0);
            let mut moved = None;
            while stride > 1e-7 {
                let tried: Vec<Vec2> = points.iter().zip(&down).map(|(p, d)| *p - *d * stride).collect();
                if let Some((reached, next)) = self.energy(&tried)
                    && reached < energy - 1e-4 * stride * steep
                {
                    moved = Some((tried, reached, next));
                    break;
                }
                stride *= 0.5;
            }
            let Some((tried, reached, next)) = moved else { break };
            let settled = energy - reached < 1e-6 * energy;
            (points, energy, slope) = (tried, reached, next);
            if settled {
                break;
            }
        }
        points
    }

    /// Gives some triangles, and all that share a corner with them, less room.
    fn tighten(&mut self, triangles: &[usize]) {
        let mut near = vec![false; self.near.len()];
        triangles.iter().for_each(|&t| self.rest[t].corners.iter().for_each(|&v| near[v as usize] = true));
        for r in self.rest.iter_mut().filter(|r| r.corners.iter().any(|&v| near[v as usize])) {
            r.inverse *= 1.0 / SMALLER;
            r.area *= SMALLER * SMALLER;
        }
    }

    /// Energy and its gradient; `None` where a triangle is folded.
    fn energy(&self, points: &[Vec2]) -> Option<(f32, Vec<Vec2>)> {
        let mut sum = 0.0f64;
        let mut slope = vec![Vec2::ZERO; points.len()];
        for r in &self.rest {
            let [a, b, c] = r.corners.map(|v| points[v as usize]);
            let j = Mat2::from_cols(b - a, c - a) * r.inverse;
            let det = j.determinant();
            if det <= 1e-6 {
                return None;
            }
            let square = j.x_axis.length_squared() + j.y_axis.length_squared();
            sum += f64::from(r.area * square * (1.0 + 1.0 / (det * det)));
            let cofactor = Mat2::from_cols(Vec2::new(j.y_axis.y, -j.y_axis.x), Vec2::new(-j.x_axis.y, j.x_axis.x));
            let by_j = j * (2.0 * (1.0 + 1.0 / (det * det))) - cofactor * (2.0 * square / (det * det * det));
            let by_edges = by_j * r.inverse.transpose() * r.area;
            slope[r.corners[1] as usize] += by_edges.x_axis;
            slope[r.corners[2] as usize] += by_edges.y_axis;
            slope[r.corners[0] as usize] -= by_edges.x_axis + by_edges.y_axis;
        }
        Some((sum as f32, slope))
    }

    /// Solves the Laplacian, a little stiffened, for a right side: conjugate gradients with the diagonal as guess.
    fn solve(&self, right: &[Vec2]) -> Vec<Vec2> {
        let diagonal: Vec<f32> = self.near.iter().map(|n| 4.0 * n.iter().map(|x| x.1).sum::<f32>() * 1.0005).collect();
        let apply = |x: &[Vec2]| -> Vec<Vec2> {
            let row = |v: usize| {
                let others: Vec2 = self.near[v].iter().map(|n| x[n.0 as usize] * n.1).sum();
                x[v] * diagonal[v] - others * 4.0
            };
            (0..x.len()).map(row).collect()
        };
        let dot = |a: &[Vec2], b: &[Vec2]| a.iter().zip(b).map(|(x, y)| f64::from(x.dot(*y))).sum::<f64>();
        let mut x = vec![Vec2::ZERO; right.len()];
        let mut r = right.to_vec();
        let guess = |r: &[Vec2]| r.iter().zip(&diagonal).map(|(r, d)| *r / *d).collect::<Vec<Vec2>>();
        let mut z = guess(&r);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        for _ in 0..INNER {
            if rz <= 1e-20 {
                break;
            }
            let ap = apply(&p);
            let alpha = (rz / dot(&p, &ap)) as f32;
            for v in 0..x.len() {
                x[v] += p[v] * alpha;
                r[v] -= ap[v] * alpha;
            }
            z = guess(&r);
            let next = dot(&r, &z);
            let beta = (next / rz) as f32;
            rz = next;
            for v in 0..p.len() {
                p[v] = z[v] + p[v] * beta;
            }
        }
        x
    }
}

/// Places the sheets side by side in the unit square, at one scale: rows of falling height.
fn pack(sheets: &mut [ChartLayout]) {
    for sheet in sheets.iter_mut() {
        let low = sheet.points.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        sheet.points.iter_mut().for_each(|p| *p -= low);
    }
    let size = |s: &ChartLayout| s.points.iter().copied().fold(Vec2::ZERO, Vec2::max);
    let sizes: Vec<Vec2> = sheets.iter().map(size).collect();
    let mut order: Vec<usize> = (0..sheets.len()).collect();
    order.sort_by(|&a, &b| sizes[b].y.total_cmp(&sizes[a].y));
    let laid = |side: f32| -> Option<Vec<Vec2>> {
        let gap = GAP * side;
        let mut places = vec![Vec2::ZERO; sizes.len()];
        // Each goes as low as it can above what stands there: a skyline of columns.
        let mut skyline: Vec<(f32, f32)> = vec![(0.0, gap)];
        for &s in &order {
            let (at, spot) = lowest(&skyline, sizes[s] + Vec2::splat(gap), side, gap)?;
            places[s] = at;
            raise(&mut skyline, spot, at.x + sizes[s].x + gap, at.y + sizes[s].y + gap);
        }
        Some(places)
    };
    let area: f32 = sizes.iter().map(|s| s.x * s.y).sum();
    let mut side = area.sqrt();
    let places = loop {
        if let Some(places) = laid(side) {
            break places;
        }
        side *= 1.01;
    };
    for (sheet, place) in sheets.iter_mut().zip(places) {
        sheet.points.iter_mut().for_each(|p| *p = ((*p + place) / side).clamp(Vec2::ZERO, Vec2::ONE));
    }
}

/// The lowest place on the skyline (starts of columns and their heights) for a sheet, and its first x.
fn lowest(skyline: &[(f32, f32)], size: Vec2, side: f32, gap: f32) -> Option<(Vec2, f32)> {
    let mut best: Option<(Vec2, f32)> = None;
    for &(x, _) in skyline {
        let x = x.max(gap);
        if x + size.x > side {
            continue;
        }
        let under = skyline.iter().enumerate().filter(|&(k, c)| {
            let end = skyline.get(k + 1).map_or(side, |n| n.0);
            c.0 < x + size.x && end > x
        });
        let y = under.map(|(_, c)| c.1).fold(gap, f32::max);
        if y + size.y <= side && best.is_none_or(|(b, _)| y < b.y) {
            best = Some((Vec2::new(x, y), x));
        }
    }
    best
}

/// Raises the skyline between two places.
fn raise(skyline: &mut Vec<(f32, f32)>, from: f32, to: f32, height: f32) {
    let after = skyline.iter().rev().find(|c| c.0 <= to).map_or(height, |c| c.1);
    skyline.retain(|c| c.0 < from || c.0 > to);
    skyline.extend([(from, height), (to, after)]);
    skyline.sort_by(|a, b| a.0.total_cmp(&b.0));
}
