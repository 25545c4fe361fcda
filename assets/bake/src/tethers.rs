//! Tethers: from each free vertex to the fixed one that is nearest along the cloth, and how far away that is.
//!
//! Distances spread from the fixed vertices over the triangles in order of their length, as Dijkstra's do, but across
//! faces too (Novotni and Klein 2002, "Computing geodesic distances on triangular meshes"): with the two triangles beside an
//! edge laid flat, the distances of the edge's ends place the source in the plane, and the third corner is as far from
//! it as the straight line through the edge is long. That is exact on whatever can be laid flat, be it meshed as it may.
//! Each vertex keeps its few nearest sources, because a line can only be followed through vertices that know its source.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::Vec3;

use crate::shape::Shape;

/// Sources that each vertex keeps: among a row of pins as far apart as the vertices are, the nearest of a vertex is one of
/// the five nearest of its neighbours even where they lie irregularly.
const SOURCES: usize = 6;

/// A way must be shorter by this much (m) to replace another: nothing that cloth would notice, but an end to rounding.
const SHORTER_M: f64 = 1e-7;

/// How far a free vertex can get from where it hangs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tether {
    /// The free vertex.
    pub vertex: u32,
    /// The fixed vertex nearest to it along the cloth.
    pub anchor: u32,
    /// Length of the way between them as cut (m).
    pub length: f32,
}

/// One tether for each free vertex, in order; none for what no fixed vertex is sewn to.
pub fn tethers(shape: &Shape) -> Vec<Tether> {
    let triangles = shape.triangles();
    let laid = shape.triangles_as_cut();
    let mut march = FrontMarch::new(shape.cut.len(), &triangles, &laid);
    march.run((0..shape.cut.len() as u32).filter(|&v| shape.fixed[v as usize]));
    let nearest = |(v, known): (usize, &Vec<NearAnchor>)| {
        let best = known.first().filter(|_| !shape.fixed[v])?;
        Some(Tether { vertex: v as u32, anchor: best.anchor, length: best.length as f32 })
    };
    march.known.iter().enumerate().filter_map(nearest).collect()
}

/// A source as a vertex knows it.
#[derive(Debug, Clone, Copy)]
struct NearAnchor {
    anchor: u32,
    length: f64,
}

/// Distances under way.
struct FrontMarch<'a> {
    triangles: &'a [[u32; 3]],
    /// Their corners as cut (m).
    laid: &'a [[Vec3; 3]],
    /// The triangles at each vertex.
    around: Vec<Vec<u32>>,
    /// The nearest sources of each vertex, nearest first.
    known: Vec<Vec<NearAnchor>>,
    /// What is still to be passed to neighbours: length (its bits, which sort as it does), vertex, anchor.
    queue: BinaryHeap<Reverse<(u64, u32, u32)>>,
}

impl<'a> FrontMarch<'a> {
    fn new(vertices: usize, triangles: &'a [[u32; 3]], laid: &'a [[Vec3; 3]]) -> Self {
        let mut around = vec![Vec::new(); vertices];
        for (i, t) in triangles.iter().enumerate() {
            t.iter().for_each(|&v| around[v as usize].push(i as u32));
        }
        let known = vec![Vec::with_capacity(SOURCES + 1); vertices];
        Self { triangles, laid, around, known, queue: BinaryHeap::new() }
    }

    fn run(&mut self, sources: impl Iterator<Item = u32>) {
        sources.for_each(|v| self.receive(v, v, 0.0));
        while let Some(Reverse((bits, v, anchor))) = self.queue.pop() {
            let length = f64::from_bits(bits);
            // A shorter way may have been found since.
            if self.length(v, anchor) != Some(length) {
                continue;
            }
            for k in 0..self.around[v as usize].len() {
                let i = self.around[v as usize][k] as usize;
                let (t, laid) = (self.triangles[i], self.laid[i]);
                let at = t.iter().position(|&i| i == v).unwrap_or(0);
                let corner = |k: usize| ((at + k) % 3, t[(at + k) % 3]);
                let side = |i: usize, j: usize| f64::from(laid[i].distance(laid[j]));
                let ((v, _), (i, p), (j, q)) = (corner(0), corner(1), corner(2));
                self.cross([p, q], [side(v, j), side(v, i), side(i, j)], anchor, length);
                self.cross([q, p], [side(v, i), side(v, j), side(j, i)], anchor, length);
            }
        }
    }

    /// Passes a source that a vertex has just received on to `to`: along the edge between them, and through the edge from the
    /// vertex to `beside`, if that end knows the source too. Sides: from the vertex to `to` and to `beside`, and between these.
    fn cross(&mut self, [beside, to]: [u32; 2], [direct, base, other]: [f64; 3], anchor: u32, length: f64) {
        let straight = self.length(beside, anchor).and_then(|second| through([length, second], base, [direct, other]));
        self.receive(to, anchor, straight.map_or(length + direct, |s| s.min(length + direct)));
    }

    fn length(&self, v: u32, anchor: u32) -> Option<f64> {
        self.known[v as usize].iter().find(|s| s.anchor == anchor).map(|s| s.length)
    }

    /// Keeps a way if it is among the shortest, and queues it to be passed on.
    fn receive(&mut self, v: u32, anchor: u32, length: f64) {
        let known = &mut self.known[v as usize];
        match known.iter().position(|s| s.anchor == anchor) {
            Some(k) if known[k].length <= length + SHORTER_M => return,
            Some(k) => _ = known.remove(k),
            None => {}
        }
        let place = known.partition_point(|s| (s.length, s.anchor) < (length, anchor));
        if place < SOURCES {
            known.insert(place, NearAnchor { anchor, length });
            known.truncate(SOURCES);
            self.queue.push(Reverse((length.to_bits(), v, anchor)));
        }
    }
}

/// Length of the straight line from a source to the corner of a triangle through its base, if it passes between the
/// base's ends. `from`: the source's distance to either end; `sides`: the corner's.
fn through(from: [f64; 2], base: f64, sides: [f64; 2]) -> Option<f64> {
    // Both lie on circles around the ends: the source below the base, the corner above.
    let place = |d: [f64; 2]| {
        let x = (d[0] * d[0] - d[1] * d[1] + base * base) / (2.0 * base);
        let square = d[0] * d[0] - x * x;
        (square > -1e-9 * base * base).then_some((x, square.max(0.0).sqrt()))
    };
    let ((sx, sy), (cx, cy)) = (place(from)?, place(sides)?);
    if cy <= 0.0 {
        return None;
    }
    let crossing = sx + (cx - sx) * sy / (sy + cy);
    let slack = 1e-9 * base;
    (-slack..=base + slack).contains(&crossing).then(|| (cx - sx).hypot(cy + sy))
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use super::*;
    use crate::tests::meshes::{TestMesh, rough_sheet, rough_skirt, sheet, split, tube};

    fn shape((positions, faces): &TestMesh, fixed: impl Fn(Vec3) -> bool) -> Shape {
        Shape {
            cut: positions.clone(),
            worn: positions.clone(),
            faces: faces.clone(),
            fixed: positions.iter().map(|&p| fixed(p)).collect(),
            ..Shape::default()
        }
    }

    #[test]
    fn on_a_flat_sheet_a_tether_is_the_straight_line() {
        let meshes =
            [sheet(20, 17, 0.05, 0.03), split(sheet(20, 17, 0.02, 0.05), true), rough_sheet(1.0, 0.8, 0.05, 9)];
        for mesh in meshes {
            let origin = mesh.0[0];
            let shape = shape(&mesh, |p| p == origin);
            let found = tethers(&shape);
            assert_eq!(found.len(), mesh.0.len() - 1);
            for t in found {
                let straight = shape.cut[t.vertex as usize].distance(origin);
                assert!((t.length / straight - 1.0).abs() < 1e-4, "{t:?}, straight {straight}");
            }
        }
    }

    #[test]
    fn each_vertex_of_a_curtain_hangs_from_the_nearest_of_its_rings() {
        for mesh in [sheet(30, 25, 0.03, 0.03), rough_sheet(0.8, 0.6, 0.04, 11)] {
            let shape = shape(&mesh, |p| p.y > -1e-4);
            for t in tethers(&shape) {
                let p = shape.cut[t.vertex as usize];
                let pins = shape.cut.iter().zip(&shape.fixed).filter(|(_, fixed)| **fixed);
                let nearest = pins.map(|(q, _)| p.distance(*q)).fold(f32::MAX, f32::min);
                assert!((t.length / nearest - 1.0).abs() < 0.002, "{t:?}, nearest {nearest}");
                assert!((shape.cut[t.anchor as usize].distance(p) / t.length - 1.0).abs() < 0.002);
            }
        }
    }

    #[test]
    fn around_a_tube_a_tether_follows_the_arc() {
        let columns = 96;
        let (positions, faces) = tube(columns, 40);
        let shape = shape(&(positions, faces), |p| p == Vec3::Z);
        for t in tethers(&shape) {
            let p = shape.cut[t.vertex as usize];
            let arc = p.x.atan2(p.z).abs();
            let expected = arc.hypot(p.y);
            assert!((t.length / expected - 1.0).abs() < 0.005, "{t:?}, expected {expected}");
        }
    }

    #[test]
    fn down_a_cone_a_tether_is_the_slant_and_around_it_the_chord_of_the_sector() {
        let mesh = rough_skirt(0.04, 12);
        let slope = 0.24f32.hypot(0.78) / 0.24;
        let sector = |p: Vec3| (p.x.hypot(p.z) * slope, p.z.atan2(p.x) / slope);
        let chord = |p: Vec3, q: Vec3| {
            let ((r, a), (s, b)) = (sector(p), sector(q));
            let turn = (a - b + 0.5 * TAU / slope).rem_euclid(TAU / slope) - 0.5 * TAU / slope;
            // The straight line, where it leaves the waist outwards.
            (r * turn.cos() > s).then(|| (r * turn.cos() - s).hypot(r * turn.sin()))
        };
        let waist = shape(&mesh, |p| p.y > -1e-4);
        let pins: Vec<Vec3> = waist.cut.iter().copied().filter(|p| p.y > -1e-4).collect();
        for t in tethers(&waist) {
            let p = waist.cut[t.vertex as usize];
            let nearest = pins.iter().filter_map(|&q| chord(p, q)).fold(f32::MAX, f32::min);
            assert!((t.length / nearest - 1.0).abs() < 0.02, "{t:?}, chord {nearest}");
        }
        // From one pin at the waist.
        let pin = mesh.0[0];
        let shape = shape(&mesh, |p| p == pin);
        let mut checked = 0;
        for t in tethers(&shape) {
            if let Some(chord) = chord(shape.cut[t.vertex as usize], pin) {
                assert!((t.length / chord - 1.0).abs() < 0.02, "{t:?}, chord {chord}");
                checked += 1;
            }
        }
        assert!(checked > 500, "{checked}");
    }

    #[test]
    fn cloth_that_no_pin_is_sewn_to_has_no_tether() {
        let (mut positions, mut faces) = sheet(3, 3, 0.1, 0.1);
        let count = positions.len() as u32;
        positions.extend(positions.clone().iter().map(|p| *p + Vec3::Z));
        faces.extend(faces.clone().iter().map(|f| f.map(|v| v + count)));
        let shape = shape(&(positions, faces), |p| p == Vec3::ZERO);
        assert_eq!(tethers(&shape).len(), count as usize - 1);
    }
}
