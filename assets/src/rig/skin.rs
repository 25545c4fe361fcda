//! The skin as the fit and its report look things up in it: what is nearest to a point.

use glam::Vec3;

use toile_base::body::{Body, Region};
use toile_base::skeleton::Joint;

/// Nearer than this (m) to the skin of an arm and of the trunk, cloth lies in the hollow of an armpit.
const HOLLOW_M: f32 = 0.045;

/// Farther than this (m) from a shoulder's joint is no armpit.
const ARMPIT_M: f32 = 0.22;

/// Skins whose normals have less than this in common (cosine) face each other: before and behind an armpit they look the same way.
const FACES: f32 = 0.3;

/// A body's vertices by height, and the triangles around each.
pub(crate) struct SkinByHeight<'a> {
    body: &'a Body,
    /// Vertices, lowest first.
    order: Vec<u32>,
    /// Start of each vertex's triangles in `around`, and the end `[vertices + 1]`.
    start: Vec<u32>,
    around: Vec<u32>,
}

impl<'a> SkinByHeight<'a> {
    pub(crate) fn new(body: &'a Body) -> Self {
        let mesh = &body.mesh;
        let at = |v: &u32| mesh.positions[*v as usize].y;
        let mut order: Vec<u32> = (0..mesh.positions.len() as u32).collect();
        order.sort_by(|a, b| at(a).total_cmp(&at(b)));
        let mut corners: Vec<(u32, u32)> = Vec::with_capacity(3 * mesh.triangles.len());
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            corners.extend(triangle.iter().map(|v| (*v, t as u32)));
        }
        corners.sort_unstable();
        let start = (0..=order.len() as u32).map(|v| corners.partition_point(|c| c.0 < v) as u32).collect();
        Self { body, order, start, around: corners.into_iter().map(|c| c.1).collect() }
    }

    /// The vertex nearest to a point, and how far it is (m). Looks down and up from the point's height for as long as
    /// height alone leaves room for a nearer one.
    pub(super) fn nearest(&self, p: Vec3) -> Option<(usize, f32)> {
        self.nearest_of(p, |_| true)
    }

    /// The same among the vertices that `admits` names.
    fn nearest_of(&self, p: Vec3, admits: impl Fn(usize) -> bool) -> Option<(usize, f32)> {
        let at = |v: u32| self.body.mesh.positions[v as usize];
        let (down, up) = self.order.split_at(self.order.partition_point(|v| at(*v).y < p.y));
        let mut best = (None, f32::INFINITY);
        for v in down.iter().rev() {
            if (p.y - at(*v).y).powi(2) >= best.1 {
                break;
            }
            if admits(*v as usize) {
                best = nearer(best, *v, at(*v).distance_squared(p));
            }
        }
        for v in up {
            if (at(*v).y - p.y).powi(2) >= best.1 {
                break;
            }
            if admits(*v as usize) {
                best = nearer(best, *v, at(*v).distance_squared(p));
            }
        }
        best.0.map(|v: u32| (v as usize, best.1.sqrt()))
    }

    /// The vertex nearest to a point, and the distance to the triangles around it (m), positive outside.
    pub(super) fn distance(&self, p: Vec3) -> Option<(usize, f32)> {
        self.distance_of(p, |_| true)
    }

    /// The skin's normal at a vertex, outwards.
    pub(crate) fn normal(&self, vertex: usize) -> Vec3 {
        self.body.normals[vertex]
    }

    /// Whether a point lies in the hollow of an armpit, where an arm that comes down meets the trunk.
    pub(crate) fn in_armpit(&self, p: Vec3) -> bool {
        let near = |region: Region| {
            self.distance_of(p, |v| self.body.regions[v] == region).is_some_and(|(_, far)| far < HOLLOW_M)
        };
        let arms = [(Joint::LeftShoulder, Region::LeftArm), (Joint::RightShoulder, Region::RightArm)];
        arms.into_iter().any(|(shoulder, arm)| {
            let shoulder = self.body.skeleton.at(shoulder);
            p.y < shoulder.y && p.distance(shoulder) < ARMPIT_M && near(arm) && near(Region::Torso)
        })
    }

    /// Whether an arm is the nearest of the skin.
    pub(crate) fn is_over_arm(&self, p: Vec3) -> bool {
        let far = |admits: &dyn Fn(Region) -> bool| {
            self.distance_of(p, |v| admits(self.body.regions[v])).map_or(f32::INFINITY, |(_, far)| far.abs())
        };
        far(&|region| matches!(region, Region::LeftArm | Region::RightArm)) < far(&|region| region == Region::Torso)
    }

    /// Whether a point in the hollow of an armpit lies between arm and trunk, whose skins face each other there, rather than before or
    /// behind both.
    pub(crate) fn is_pinched(&self, p: Vec3) -> bool {
        let normal =
            |region: Region| self.nearest_of(p, |v| self.body.regions[v] == region).map(|(v, _)| self.normal(v));
        let [trunk, left, right] = [Region::Torso, Region::LeftArm, Region::RightArm].map(normal);
        let arm = if p.x > 0.0 { left } else { right };
        trunk.zip(arm).is_some_and(|(a, b)| a.dot(b) < FACES)
    }

    /// The same among the vertices that `admits` names.
    pub(crate) fn distance_of(&self, p: Vec3, admits: impl Fn(usize) -> bool) -> Option<(usize, f32)> {
        let (v, far) = self.nearest_of(p, admits)?;
        let outside = (p - self.body.mesh.positions[v]).dot(self.body.normals[v]) >= 0.0;
        let triangles = &self.around[self.start[v] as usize..self.start[v + 1] as usize];
        let to = |t: &u32| {
            let corners = self.body.mesh.triangles[*t as usize].map(|i| self.body.mesh.positions[i as usize]);
            p.distance(closest(p, corners))
        };
        let d = triangles.iter().map(to).fold(far, f32::min);
        Some((v, if outside { d } else { -d }))
    }
}

fn nearer(best: (Option<u32>, f32), v: u32, square: f32) -> (Option<u32>, f32) {
    if square < best.1 { (Some(v), square) } else { best }
}

/// The point of a triangle that is closest to `p`: its foot on the plane if that lies inside, else on the nearest side.
pub(crate) fn closest(p: Vec3, [a, b, c]: [Vec3; 3]) -> Vec3 {
    let normal = (b - a).cross(c - a);
    let foot = p - normal * ((p - a).dot(normal) / normal.length_squared().max(f32::MIN_POSITIVE));
    let sides = [(a, b), (b, c), (c, a)];
    if sides.iter().all(|(u, v)| (*v - *u).cross(foot - *u).dot(normal) >= 0.0) {
        return foot;
    }
    let on = |(u, v): (Vec3, Vec3)| {
        let way = v - u;
        u + way * ((p - u).dot(way) / way.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0)
    };
    let [x, y, z] = sides.map(on);
    let xy = if p.distance_squared(x) <= p.distance_squared(y) { x } else { y };
    if p.distance_squared(xy) <= p.distance_squared(z) { xy } else { z }
}

/// A third of the area of the triangles around each vertex (m^2).
pub(super) fn vertex_areas(body: &Body) -> Vec<f32> {
    let mut areas = vec![0.0; body.mesh.positions.len()];
    for t in &body.mesh.triangles {
        let [a, b, c] = t.map(|v| body.mesh.positions[v as usize]);
        let share = (b - a).cross(c - a).length() / 6.0;
        t.iter().for_each(|&v| areas[v as usize] += share);
    }
    areas
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::body::{Measures, Sex};

    #[test]
    fn nearest_vertex_is_that_of_brute_force_and_triangles_are_no_farther() {
        let body = crate::body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
        let skin = SkinByHeight::new(&body);
        for i in 0..200 {
            let spread = |k: f32| (i as f32 * k).fract() - 0.5;
            let p = Vec3::new(spread(0.618_034), 0.8, 0.0) + Vec3::new(0.0, spread(0.414_2) * 2.2, spread(0.732_05));
            let all = body.mesh.positions.iter().map(|q| q.distance(p)).fold(f32::MAX, f32::min);
            let (v, far) = skin.nearest(p).unwrap();
            assert!(far == all && body.mesh.positions[v].distance(p) == far, "{p}");
            let (same, d) = skin.distance(p).unwrap();
            assert!(same == v && d.abs() <= far && d.abs() > far - 0.02, "{p} {d} {far}");
        }
    }

    #[test]
    fn closest_point_of_a_triangle_beats_all_others_of_it() {
        let corners = [Vec3::ZERO, Vec3::new(0.02, 0.0, 0.003), Vec3::new(0.004, 0.015, 0.0)];
        for i in 0..60 {
            let spread = |k: f32| ((i as f32 * k).fract() - 0.4) * 0.06;
            let p = Vec3::new(spread(0.618_034), spread(0.414_2), spread(0.732_05));
            let on = closest(p, corners);
            let mut least = f32::MAX;
            for j in 0..=100 {
                for k in 0..=100 - j {
                    let (u, v) = (j as f32 * 0.01, k as f32 * 0.01);
                    least = least.min(p.distance(corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v));
                }
            }
            assert!(p.distance(on) <= least + 1e-6 && p.distance(on) > least - 2e-4, "{p}");
        }
    }
}
