//! The place of each panel: its part of the body, its angle around that part, and its coordinates there.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::error::DrapeError;
use crate::pattern::Pattern;
use crate::tailor::SewnMesh;

/// The part of the body that a panel is laid around.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Around {
    /// The trunk, and the legs below it.
    Trunk,
    /// The head, of hoods.
    Head,
    /// The left arm.
    LeftArm,
    /// The right arm.
    RightArm,
}

/// How a point of a panel's drawing becomes coordinates around the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unrolled {
    /// Straight: along the drawing's two directions (unit).
    Straight {
        /// The direction around the body.
        along: DVec2,
        /// The direction up.
        up: DVec2,
    },
    /// A sector of a ring, such as a circle skirt: by its angle and its radius.
    Sector {
        /// The ring's middle (m).
        centre: DVec2,
        /// Direction from the middle through the sector's middle (unit).
        middle: DVec2,
        /// True where the sector's angle grows with the drawing's.
        forward: bool,
    },
}

/// A panel as it is laid around a part of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArrangedPanel {
    /// What it goes around.
    pub around: Around,
    /// Where its middle lies around that part (rad): 0 in front, a quarter turn at the wearer's left.
    pub angle: f64,
    /// Coordinates from its drawing.
    pub unrolled: Unrolled,
    /// What is added to them (m).
    pub shift: DVec2,
}

impl ArrangedPanel {
    /// Coordinates of a point of the drawing (m): around the body, from the panel's angle towards larger angles, and up.
    pub fn at(&self, p: DVec2) -> DVec2 {
        let own = match self.unrolled {
            Unrolled::Straight { along, up } => DVec2::new(along.dot(p), up.dot(p)),
            Unrolled::Sector { centre, middle, forward } => {
                let out = p - centre;
                let turn = middle.angle_to(out) * if forward { 1.0 } else { -1.0 };
                DVec2::new(turn * out.length(), -out.length())
            }
        };
        own + self.shift
    }

    /// Horizontal direction of growing coordinates around the body (unit).
    pub fn tangent(&self) -> DVec3 {
        DVec3::new(self.angle.cos(), 0.0, -self.angle.sin())
    }
}

/// Normals steeper than this (sine) belong to nothing that hangs.
const LEVEL_SINE: f64 = 0.95;

/// What reaches no nearer to the middle than this (m) goes around an arm: half of the narrowest chest.
const BESIDE_M: f64 = 0.13;

/// The panels of a pattern before they are fitted to each other and to the body.
///
/// # Errors
/// [`DrapeError::NoPlace`].
pub fn panels(pattern: &Pattern, sewn: &SewnMesh) -> Result<Vec<ArrangedPanel>, DrapeError> {
    let one = |(i, panel): (usize, &crate::pattern::Panel)| {
        let place = panel.placement.ok_or_else(|| DrapeError::NoPlace { panel: panel.name.clone() })?;
        let points = &sewn.panels[i].points[..sewn.panels[i].boundary.points.len()];
        let spread = |p: &DVec2| place.rotation * p.extend(0.0) + place.translation;
        let normal = place.rotation * DVec3::Z;
        let middle = points.iter().map(spread).sum::<DVec3>() / points.len() as f64;
        // Outwards is away from the body's axis; a panel placed on the axis itself is seen from outside.
        let flat = DVec2::new(normal.x, normal.z);
        let outside = flat.dot(DVec2::new(middle.x, middle.z));
        let outwards = if outside < -1e-3 { -normal } else { normal };
        if normal.y.abs() > LEVEL_SINE {
            return Err(DrapeError::NoPlace { panel: panel.name.clone() });
        }
        let angle = outwards.x.atan2(outwards.z);
        let nearest = points.iter().map(|p| spread(p).x.abs()).fold(f64::MAX, f64::min);
        let faces_front = outwards.z.abs() > outwards.x.abs();
        let label = panel.label.as_deref().unwrap_or_default();
        let arm = label == "arm" || (label.is_empty() && faces_front && nearest > BESIDE_M);
        let around = match (arm, middle.x + outwards.x > 0.0) {
            (false, _) => Around::Trunk,
            (true, true) => Around::LeftArm,
            (true, false) => Around::RightArm,
        };
        let unrolled = unrolled(points, angle, &place);
        let mut arranged = ArrangedPanel { around, angle, unrolled, shift: DVec2::ZERO };
        let highest = points.iter().max_by(|a, b| spread(a).y.total_cmp(&spread(b).y)).copied().unwrap_or_default();
        let own = arranged.at(highest);
        arranged.shift.y = spread(&highest).y - own.y;
        if !matches!(unrolled, Unrolled::Sector { .. }) {
            arranged.shift.x = spread(&highest).dot(arranged.tangent()) - own.x;
        }
        Ok(arranged)
    };
    pattern.panels().iter().enumerate().map(one).collect()
}

/// The straight coordinates of a placed panel, or a sector's.
fn unrolled(points: &[DVec2], angle: f64, place: &crate::pattern::PanelPlacement) -> Unrolled {
    let tangent = DVec3::new(angle.cos(), 0.0, -angle.sin());
    let back = place.rotation.inverse();
    let up = (back * DVec3::Y).truncate().normalize_or(DVec2::Y);
    // Growing coordinates go where the tangent does.
    let along = if up.perp().dot((back * tangent).truncate()) < 0.0 { -up.perp() } else { up.perp() };
    match sector(points) {
        Some((centre, middle)) => {
            let forward = middle.perp().dot(along) > 0.0;
            Unrolled::Sector { centre, middle, forward }
        }
        None => Unrolled::Straight { along, up },
    }
}

/// Least angle of a sector that is worth unrolling (rad): a flared panel of less is as good straight.
const LEAST_SECTOR: f64 = 0.12 * PI;

/// How far points of an outline may lie from the border of the ring that it is a sector of (part of its outer radius).
const OFF_RING: f64 = 0.02;

/// Share of the points that must lie on the border: a corner that was digitised badly is no reason to give up.
const ON_RING: f64 = 0.95;

/// A ring that an outline may be a sector of.
struct RingSector {
    centre: DVec2,
    /// Direction through the sector's middle (unit).
    middle: DVec2,
    /// Inner and outer radius (m).
    radii: [f64; 2],
    /// First and last angle from the middle (rad).
    turns: [f64; 2],
}

impl RingSector {
    /// The least sector around a centre that holds all points.
    fn around(centre: DVec2, points: &[DVec2]) -> Option<Self> {
        let spread = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::MAX, f64::MIN], |[low, high], v| [low.min(v), high.max(v)])
        };
        let sum: DVec2 = points.iter().map(|p| (*p - centre).normalize_or_zero()).sum();
        let middle = sum.try_normalize()?;
        let radii = spread(&mut points.iter().map(|p| p.distance(centre)));
        let turns = spread(&mut points.iter().map(|p| middle.angle_to(*p - centre)));
        Some(Self { centre, middle, radii, turns })
    }

    /// How many points lie on its border: on one of the arcs or of the straight ends.
    fn on_border(&self, points: &[DVec2]) -> usize {
        let near = OFF_RING * self.radii[1];
        let on = |p: &&DVec2| {
            let out = **p - self.centre;
            let (far, turn) = (out.length(), self.middle.angle_to(out));
            self.radii.iter().any(|r| (far - r).abs() < near)
                || self.turns.iter().any(|t| (turn - t).abs() * far < near)
        };
        points.iter().filter(on).count()
    }

    fn area(&self) -> f64 {
        let [inner, outer] = self.radii;
        0.5 * (self.turns[1] - self.turns[0]) * (outer * outer - inner * inner)
    }
}

/// The middle of the ring that an outline is a sector of, and the direction through the sector's middle.
fn sector(points: &[DVec2]) -> Option<(DVec2, DVec2)> {
    let n = points.len();
    // Of a sector some three points lie on one of its arcs, near each other or far apart.
    let triples = [3, n / 10, n / 5].into_iter().flat_map(|step| (0..n).map(move |i| [i, i + step, i + 2 * step]));
    let centres = triples.filter_map(|t| {
        let [a, b, c] = t.map(|i| points[i % n]);
        circle(a, b, c)
    });
    let rings = centres.filter_map(|centre| RingSector::around(centre, points));
    let best = rings.map(|ring| (ring.on_border(points), ring)).max_by_key(|(count, _)| *count);
    let (count, ring) = best?;
    let area = 0.5 * (0..n).map(|i| points[i].perp_dot(points[(i + 1) % n])).sum::<f64>().abs();
    let like = (area / ring.area() - 1.0).abs() < 0.05
        && ring.turns[1] - ring.turns[0] > LEAST_SECTOR
        && ring.radii[0] > 0.05 * ring.radii[1]
        && count as f64 > ON_RING * n as f64;
    like.then_some((ring.centre, ring.middle))
}

/// The middle of the circle through three points.
fn circle(a: DVec2, b: DVec2, c: DVec2) -> Option<DVec2> {
    let (p, q) = (b - a, c - a);
    let twice = 2.0 * p.perp_dot(q);
    if twice.abs() < 1e-3 * p.length() * q.length() {
        return None;
    }
    let (pp, qq) = (p.length_squared(), q.length_squared());
    Some(a + DVec2::new(q.y * pp - p.y * qq, p.x * qq - q.x * pp) / twice)
}

/// Whether an angle lies in front (true) or behind (false); `None` at the sides.
pub fn faces(angle: f64) -> Option<bool> {
    let turned = angle.cos();
    if turned > (FRAC_PI_2 * 0.5).cos() - 1e-9 {
        Some(true)
    } else if turned < -(FRAC_PI_2 * 0.5).cos() + 1e-9 {
        Some(false)
    } else {
        None
    }
}
