//! Scalar reference: contact of one particle and one capsule in f64, written for reading.

use glam::{DVec3, Vec4, Vec4Swizzles};

/// A tapered capsule between two spheres.
#[derive(Clone, Copy)]
pub struct Cone {
    pub a: DVec3,
    pub ra: f64,
    pub b: DVec3,
    pub rb: f64,
}

impl Cone {
    /// Between two moving spheres at `t`.
    pub fn at(from: [Vec4; 2], to: [Vec4; 2], t: f64) -> Self {
        let centre = |i: usize| from[i].xyz().as_dvec3().lerp(to[i].xyz().as_dvec3(), t);
        let radius = |i: usize| f64::from(from[i].w) + f64::from(to[i].w - from[i].w) * t;
        Self { a: centre(0), ra: radius(0), b: centre(1), rb: radius(1) }
    }

    /// Signed distance, normal, place along the axis.
    pub fn contact(&self, p: DVec3) -> (f64, DVec3, f64) {
        let (gap, d) = (self.b - self.a, self.ra - self.rb);
        let length = gap.length();
        if length <= d.abs() * 1.000_01 || length < 1e-9 {
            let (centre, radius, along) =
                if self.ra >= self.rb { (self.a, self.ra, 0.0) } else { (self.b, self.rb, 1.0) };
            let out = p - centre;
            return (out.length() - radius, out.normalize_or(DVec3::Y), along);
        }
        let axis = gap / length;
        let sine = d / length;
        let cosine = (1.0 - sine * sine).sqrt();
        let y = (p - self.a).dot(axis);
        let x = (p - self.a - axis * y).length();
        let along = ((y * cosine - x * sine) / (length * cosine)).clamp(0.0, 1.0);
        let out = p - self.a - gap * along;
        (out.length() - self.ra - (self.rb - self.ra) * along, out.normalize_or(axis.any_orthonormal_vector()), along)
    }

    pub fn distance(&self, p: DVec3) -> f64 {
        self.contact(p).0
    }
}

/// What one push does: position and start of the substep afterwards.
pub fn push(
    x: DVec3,
    previous: DVec3,
    normal: DVec3,
    depth: f64,
    carried: DVec3,
    friction: [f64; 2],
) -> (DVec3, DVec3) {
    let relative = x - previous - carried;
    let approach = (-relative.dot(normal)).max(0.0);
    let load = depth.min(approach);
    let sliding = relative - normal * relative.dot(normal);
    let kept = if sliding.length() < friction[0] * load {
        DVec3::ZERO
    } else {
        sliding - sliding.normalize_or_zero() * (friction[1] * load).min(sliding.length())
    };
    (x + normal * depth - sliding + kept, previous + normal * (depth - approach).max(0.0))
}

/// One capsule against one particle at the end of a substep of which `from` and `to` are the ends.
pub fn solve(
    x: DVec3,
    previous: DVec3,
    from: [Vec4; 2],
    to: [Vec4; 2],
    offset: f64,
    friction: [f64; 2],
) -> (DVec3, DVec3) {
    let cone = Cone::at(from, to, 1.0);
    let (distance, normal, along) = cone.contact(x);
    if distance >= offset {
        return (x, previous);
    }
    let travel = |i: usize| to[i].xyz().as_dvec3() - from[i].xyz().as_dvec3();
    let length = (cone.b - cone.a).length();
    let radius = cone.ra + (cone.rb - cone.ra) * along + offset;
    let mut carried = travel(0).lerp(travel(1), along);
    if length > (cone.ra - cone.rb).abs() * 1.000_01 {
        let axis = (cone.b - cone.a) / length;
        let turn = axis.cross(travel(1) - travel(0)) / length;
        carried += turn.cross(normal * radius);
    }
    push(x, previous, normal, offset - distance, carried, friction)
}
