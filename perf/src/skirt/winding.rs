//! Whether the hem still goes around each leg: a leg that came out through the cloth is not found by any distance.

use glam::DVec3;

/// How far a leg's line is continued above the hip and below the ankle (m): farther than any cloth.
const FAR: f64 = 10.0;

/// How often a closed loop goes around a leg: the linking number of the loop with the line from far above the hip
/// through knee and ankle to far below. It changes only where the loop passes through the line, so a hem that was once
/// around a leg and has not been torn through it has the same number for ever; 1 here for a loop that runs as the hem does.
pub fn around(hem: &[DVec3], hip: DVec3, knee: DVec3, ankle: DVec3) -> i32 {
    let line = [hip + DVec3::Y * FAR, hip, knee, ankle, ankle - DVec3::Y * FAR];
    let centre = hem.iter().sum::<DVec3>() / hem.len() as f64;
    // Any surface that the loop bounds will do; its crossings with the line, by their sense, are the linking number.
    let edges = hem.iter().zip(hem.iter().cycle().skip(1));
    edges.map(|(&a, &b)| line.windows(2).map(|s| crossing(s[0], s[1], [centre, a, b])).sum::<i32>()).sum()
}

/// 1 or -1 where a segment crosses a triangle, by the side it comes from, 0 where it does not. What lies exactly on an
/// edge or in the plane belongs to one side, so that two triangles of a surface never both claim or both miss it.
fn crossing(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> i32 {
    let above = |p: DVec3| volume(a, b, c, p) > 0.0;
    if above(from) == above(to) {
        return 0;
    }
    let sense = if above(from) { -1 } else { 1 };
    let side = |p: DVec3, q: DVec3| edge_side(from, to, p, q);
    let [ab, bc, ca] = [side(a, b), side(b, c), side(c, a)];
    if ab == bc && bc == ca { sense } else { 0 }
}

/// On which side of a segment's line an edge passes: the opposite for the edge run backwards.
fn edge_side(from: DVec3, to: DVec3, p: DVec3, q: DVec3) -> bool {
    // The same arithmetic whichever way the edge is named, so that both triangles at it agree to the last bit.
    let forth = (p.x, p.y, p.z) < (q.x, q.y, q.z);
    let positive = if forth { volume(from, to, p, q) } else { volume(from, to, q, p) } > 0.0;
    positive == forth
}

/// Six times the volume of a tetrahedron, positive where `d` lies on the side that a, b, c turn counter-clockwise to.
fn volume(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    (b - a).cross(c - a).dot(d - a)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A wavy loop of radius `r` about the y axis at height 0.3, running as the hem does, `turns` times around.
    fn hem(r: f64, centre: DVec3, turns: f64) -> Vec<DVec3> {
        (0..64)
            .map(|j| {
                let a = TAU * turns * f64::from(j) / 64.0;
                centre + DVec3::new(r * a.cos(), 0.3 + 0.05 * (5.0 * a).sin(), r * a.sin())
            })
            .collect()
    }

    const LEG: [DVec3; 3] = [DVec3::new(0.1, 0.95, 0.0), DVec3::new(0.11, 0.52, 0.0), DVec3::new(0.11, 0.1, 0.0)];

    fn number(hem: &[DVec3]) -> i32 {
        around(hem, LEG[0], LEG[1], LEG[2])
    }

    #[test]
    fn a_hem_around_a_leg_counts_once() {
        assert_eq!(number(&hem(0.42, DVec3::ZERO, 1.0)), 1);
        // Aside, so that the leg stands near the loop but within it, and then without.
        assert_eq!(number(&hem(0.42, DVec3::X * 0.5, 1.0)), 1);
        assert_eq!(number(&hem(0.42, DVec3::X * 0.6, 1.0)), 0);
        assert_eq!(number(&hem(0.42, DVec3::ZERO, 2.0)), 2);
        let mut back = hem(0.42, DVec3::ZERO, 1.0);
        back.reverse();
        assert_eq!(number(&back), -1);
    }

    #[test]
    fn one_vertex_through_the_leg_is_no_matter_and_all_of_it_is() {
        let mut pulled = hem(0.42, DVec3::ZERO, 1.0);
        // A dent towards the leg from in front, not past it.
        pulled[16] = DVec3::new(0.11, 0.3, 0.02);
        assert_eq!(number(&pulled), 1);
        // The dent past the leg: the leg now stands outside of it.
        pulled[16] = DVec3::new(0.11, 0.3, -0.02);
        let through = pulled.iter().map(|p| if p.z > -0.02 { p.with_z(-0.02) } else { *p }).collect::<Vec<_>>();
        assert_eq!(number(&through), 0);
    }

    #[test]
    fn a_leg_exactly_on_the_fans_edges_is_counted_once() {
        // A square loop about the origin and a leg along the y axis: it passes through the centre that all triangles share.
        let square = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(|[x, z]| DVec3::new(x, 0.3, z));
        for offset in [DVec3::ZERO, DVec3::X * 0.25, DVec3::Z * 0.25, DVec3::NEG_X * 0.25] {
            let at = |y: f64| offset + DVec3::Y * y;
            assert_eq!(around(&square, at(0.95), at(0.52), at(0.1)), 1, "{offset}");
        }
    }
}
