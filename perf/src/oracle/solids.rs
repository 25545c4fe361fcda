//! What the cloth lies on: round cones between two balls, and planes, with distance, normal and curvature in f64.
//!
//! In the half plane through the axis, y along it from the first centre and r away from it, the slanted side of a round
//! cone has the normal (cosine, sine) with sine = (ra - rb) / length. Where the foot y cosine - r sine lies between 0 and
//! length cosine the distance is r cosine + y sine - ra, and beyond it that to one of the balls. All three are convex
//! functions of the point, and they meet with equal gradients.

use glam::{DMat3, DVec3};

/// A ball that cloth can lie on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Centre (m).
    pub centre: DVec3,
    /// Radius (m).
    pub radius: f64,
}

/// What is behind it is pushed out: outside is where `normal . p >= offset_m`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit normal, towards the outside.
    pub normal: DVec3,
    /// Offset along it (m).
    pub offset_m: f64,
}

/// All that the cloth can lie on at one moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Solids {
    /// The convex hulls of two balls each; a ball alone is twice the same.
    pub cones: Vec<[Ball; 2]>,
    /// Planes, the floor among them.
    pub planes: Vec<Plane>,
}

impl Solids {
    /// How many there are: cones first, then planes.
    pub fn len(&self) -> usize {
        self.cones.len() + self.planes.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether every figure is finite.
    pub(super) fn is_sound(&self) -> bool {
        let ball = |b: &Ball| b.centre.is_finite() && b.radius.is_finite() && b.radius >= 0.0;
        let plane = |p: &Plane| (p.normal.length() - 1.0).abs() < 1e-3 && p.offset_m.is_finite();
        self.cones.iter().flatten().all(ball) && self.planes.iter().all(plane)
    }

    /// All of them ready to be asked.
    pub(super) fn shapes(&self) -> Vec<SolidSurface> {
        let cones = self.cones.iter().map(|[a, b]| SolidSurface::Cone(Cone::new(*a, *b)));
        cones.chain(self.planes.iter().map(|p| SolidSurface::Plane(*p))).collect()
    }
}

/// A point seen from a solid.
#[derive(Debug, Clone, Copy)]
pub struct SolidDistance {
    /// Its gradient, the unit outward normal.
    pub normal: DVec3,
    /// Its second derivative (1/m): positive semi-definite.
    pub curvature: DMat3,
    /// Place of the point's foot along the axis, 0 at the first ball to 1 at the second.
    pub along: f64,
    /// Radius there (m).
    pub radius: f64,
}

/// One solid, ready to be asked.
#[derive(Debug, Clone, Copy)]
pub enum SolidSurface {
    /// A round cone.
    Cone(Cone),
    /// A plane; the side of its normal is outside.
    Plane(Plane),
}

impl SolidSurface {
    /// Distance only (m).
    pub fn distance(&self, p: DVec3) -> f64 {
        match self {
            Self::Cone(cone) => cone.foot(p).distance,
            Self::Plane(plane) => plane.normal.dot(p) - plane.offset_m,
        }
    }

    /// Distance with its derivatives.
    pub fn sight(&self, p: DVec3) -> SolidDistance {
        match self {
            Self::Cone(cone) => cone.sight(p),
            Self::Plane(plane) => {
                SolidDistance { normal: plane.normal, curvature: DMat3::ZERO, along: 0.0, radius: 0.0 }
            }
        }
    }

    /// How far the material point of the surface that is seen so has moved since it was at `before` (m): with the axis,
    /// and around it as the axis turns; to first order in the turn.
    pub fn carried(&self, before: &Self, sight: &SolidDistance) -> DVec3 {
        let (Self::Cone(now), Self::Cone(then)) = (self, before) else { return DVec3::ZERO };
        let (moved, turned) =
            (now.a.centre - then.a.centre, (now.b.centre - then.b.centre) - (now.a.centre - then.a.centre));
        let spin = if now.length > 0.0 { now.axis.cross(turned) / now.length } else { DVec3::ZERO };
        moved + turned * sight.along + spin.cross(sight.normal * sight.radius)
    }
}

/// The hull of two balls.
#[derive(Debug, Clone, Copy)]
pub struct Cone {
    a: Ball,
    b: Ball,
    axis: DVec3,
    length: f64,
    cosine: f64,
    sine: f64,
}

/// Which part of a cone a point belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Part {
    First,
    Side,
    Second,
}

struct ConeFoot {
    distance: f64,
    part: Part,
    /// Height along the axis (m).
    y: f64,
    /// From the axis to the point (m).
    out: DVec3,
    /// Its length (m).
    r: f64,
}

impl Cone {
    fn new(a: Ball, b: Ball) -> Self {
        let gap = b.centre - a.centre;
        let length = gap.length();
        if length <= (a.radius - b.radius).abs() * (1.0 + 1e-12) || length < 1e-12 {
            // One ball inside of the other: the larger alone.
            let ball = if a.radius >= b.radius { a } else { b };
            return Self { a: ball, b: ball, axis: DVec3::Y, length: 0.0, cosine: 1.0, sine: 0.0 };
        }
        let sine = (a.radius - b.radius) / length;
        Self { a, b, axis: gap / length, length, cosine: (1.0 - sine * sine).max(0.0).sqrt(), sine }
    }

    fn foot(&self, p: DVec3) -> ConeFoot {
        let v = p - self.a.centre;
        let y = v.dot(self.axis);
        let out = v - self.axis * y;
        let r = out.length();
        let foot = y * self.cosine - r * self.sine;
        let (part, distance) = if self.length == 0.0 || foot <= 0.0 {
            (Part::First, v.length() - self.a.radius)
        } else if foot >= self.length * self.cosine {
            (Part::Second, (p - self.b.centre).length() - self.b.radius)
        } else {
            (Part::Side, r * self.cosine + y * self.sine - self.a.radius)
        };
        ConeFoot { distance, part, y, out, r }
    }

    fn sight(&self, p: DVec3) -> SolidDistance {
        let foot = self.foot(p);
        match foot.part {
            Part::First => self.ball(p, self.a, 0.0),
            Part::Second => self.ball(p, self.b, 1.0),
            Part::Side => {
                let out = if foot.r > 1e-12 { foot.out / foot.r } else { self.axis.any_orthonormal_vector() };
                let around = self.axis.cross(out);
                let bent = self.cosine / foot.r.max(1e-12);
                let along = (foot.y - foot.r * self.sine / self.cosine) / self.length;
                SolidDistance {
                    normal: out * self.cosine + self.axis * self.sine,
                    curvature: outer(around, around) * bent,
                    along,
                    radius: self.a.radius + (self.b.radius - self.a.radius) * along,
                }
            }
        }
    }

    fn ball(&self, p: DVec3, ball: Ball, along: f64) -> SolidDistance {
        let v = p - ball.centre;
        let far = v.length();
        let normal = if far > 1e-12 { v / far } else { self.axis.any_orthonormal_vector() };
        let curvature = (DMat3::IDENTITY - outer(normal, normal)) * far.max(1e-12).recip();
        SolidDistance { normal, curvature, along, radius: ball.radius }
    }
}

/// Outer product a b^T.
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
