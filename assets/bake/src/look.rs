//! How a garment shows its cloth, from its shape.

use std::collections::HashMap;

use glam::Vec2;
use toile_base::garment::look::{EDGE_REACH_M, GarmentAppearance, TRIM_SHADOW_M};
use toile_base::garment::trim::{ClothTrim, MAX_TRIMS};

use crate::shape::Shape;

/// How a shape shows its cloth, as drafted or imported.
pub fn look_of(shape: &Shape) -> GarmentAppearance {
    let (cloth, edges) = if shape.flat.len() == shape.faces.len() && !shape.panels.is_empty() {
        let cloth = shape.corners(&shape.flat);
        let edges = edges(shape, &cloth);
        (cloth, edges)
    } else {
        Default::default()
    };
    let trims: Box<[ClothTrim]> =
        if cloth.is_empty() { Box::default() } else { shape.trims.iter().copied().take(MAX_TRIMS).collect() };
    let near = if trims.is_empty() { Box::default() } else { near(shape, &cloth, &trims) };
    GarmentAppearance { cloth: cloth.into(), edges: edges.into(), trims, near, picture: shape.picture.clone() }
}

/// The hems and the seams of a panel, as pieces of line in its plane (m).
#[derive(Default)]
struct PanelEdges {
    hems: Vec<[Vec2; 2]>,
    seams: Vec<[Vec2; 2]>,
}

/// Panel of each triangle.
fn panels(shape: &Shape) -> Vec<u32> {
    let numbers: Vec<[u32; 4]> = shape.panels.iter().map(|p| [*p; 4]).collect();
    shape.corners(&numbers).into_iter().map(|p| p[0]).collect()
}

/// Which trims each triangle may show.
fn near(shape: &Shape, cloth: &[[Vec2; 3]], trims: &[ClothTrim]) -> Box<[u32]> {
    let touches = |corners: &[Vec2; 3], trim: &ClothTrim| {
        let reach = trim.half + TRIM_SHADOW_M;
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let radius = corners.iter().fold(0.0, |r: f32, p| r.max(p.distance(middle)));
        off_line(middle, trim.ends) < radius + reach
    };
    let word = |(corners, panel): (&[Vec2; 3], u32)| {
        let on = trims.iter().enumerate().filter(|(_, trim)| trim.panel == panel && touches(corners, trim));
        on.fold(0, |word, (i, _)| word | 1 << i)
    };
    cloth.iter().zip(panels(shape)).map(word).collect()
}

/// Distance of every corner from hems and seams of its panel.
fn edges(shape: &Shape, cloth: &[[Vec2; 3]]) -> Vec<[Vec2; 3]> {
    let triangles = shape.triangles();
    let panels = panels(shape);
    // Every side of a triangle: the panels on both sides of it, and where it lies in each.
    let mut sides: HashMap<[u32; 2], Vec<(u32, [Vec2; 2])>> = HashMap::new();
    for ((t, flat), panel) in triangles.iter().zip(cloth).zip(&panels) {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            let ends = if a < b { [flat[k], flat[(k + 1) % 3]] } else { [flat[(k + 1) % 3], flat[k]] };
            sides.entry([a.min(b), a.max(b)]).or_default().push((*panel, ends));
        }
    }
    let mut of: HashMap<u32, PanelEdges> = HashMap::new();
    for side in sides.values() {
        let apart = |(panel, ends): &(u32, [Vec2; 2])| {
            let same = ends[0].distance(side[0].1[0]) + ends[1].distance(side[0].1[1]) < SAME_M;
            *panel != side[0].0 || !same
        };
        let sewn = side.iter().any(apart);
        for (panel, ends) in side {
            let own = of.entry(*panel).or_default();
            match (side.len(), sewn) {
                (1, _) => own.hems.push(*ends),
                (_, true) => own.seams.push(*ends),
                _ => {}
            }
        }
    }
    let none = PanelEdges::default();
    let far = |lines: &[[Vec2; 2]], p: Vec2| lines.iter().map(|l| off_line(p, *l)).fold(EDGE_REACH_M, f32::min);
    let corner = |(flat, panel): (&[Vec2; 3], &u32)| {
        let own = of.get(panel).unwrap_or(&none);
        let mut at = flat.map(|p| Vec2::new(far(&own.hems, p), far(&own.seams, p)));
        // A triangle with all corners on seams has no inside to tell them from.
        if at.iter().all(|d| d.y < SAME_M) {
            at.iter_mut().for_each(|d| d.y = EDGE_REACH_M);
        }
        if at.iter().all(|d| d.x < SAME_M) {
            at.iter_mut().for_each(|d| d.x = EDGE_REACH_M);
        }
        at
    };
    cloth.iter().zip(&panels).map(corner).collect()
}

/// Points of the plane that are nearer than this are one (m).
const SAME_M: f32 = 1e-4;

/// Distance of a point from a piece of line.
fn off_line(p: Vec2, [a, b]: [Vec2; 2]) -> f32 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use toile_base::garment::Part;
    use toile_base::garment::trim::TrimKind;

    /// Two squares of 40 mm side by side, sewn along the side that they share, each drawn at an origin of its own.
    fn sewn() -> Shape {
        let mut shape = Shape::default();
        for at in [[0.0, 0.0], [0.04, 0.0], [0.08, 0.0], [0.0, 0.04], [0.04, 0.04], [0.08, 0.04]] {
            let at = Vec3::new(at[0], at[1], 0.0);
            shape.push(at, at, false, Part::All);
        }
        shape.faces = vec![[0, 1, 4, 3], [1, 2, 5, 4]];
        let square = [[0.0, 0.0], [0.04, 0.0], [0.04, 0.04], [0.0, 0.04]].map(Vec2::from);
        shape.flat = vec![square, square];
        shape.panels = vec![0, 1];
        shape
    }

    #[test]
    fn seams_and_hems_are_told_apart() {
        let look = look_of(&sewn());
        assert_eq!((look.cloth.len(), look.edges.len()), (4, 4));
        for (triangle, (places, edges)) in look.cloth.iter().zip(&look.edges).enumerate() {
            for (p, far) in places.iter().zip(edges) {
                let seam = if triangle < 2 { 0.04 - p.x } else { p.x };
                assert!((far.y - seam).abs() < 1e-6, "triangle {triangle} at {p}: {far}");
            }
        }
        // All corners of these squares lie on the outline.
        assert!(look.edges.iter().flatten().all(|far| far.x == EDGE_REACH_M));
    }

    #[test]
    fn triangles_know_the_trims_of_their_own_panel_near_them() {
        let mut shape = sewn();
        let button = |panel, x| ClothTrim {
            panel,
            kind: TrimKind::Button,
            ends: [Vec2::new(x, 0.02); 2],
            half: 0.005,
            colour: [1.0; 3],
        };
        shape.trims = vec![button(0, 0.02), button(1, 0.02), button(1, 0.5)];
        assert_eq!(*look_of(&shape).near, [1, 1, 2, 2]);
        shape.flat.clear();
        assert_eq!(look_of(&shape).trims.len(), 0, "without flat panels nothing says where they are");
    }
}
