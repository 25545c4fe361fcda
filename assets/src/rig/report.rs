//! Distance between the union of the capsules and the skin, by zone, measured both ways.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::plan::CAPSULES;
use super::skin::{SkinByHeight, vertex_areas};
use super::union::{RestSpheres, nearest};
use super::zones::{self, Zone};
use toile_base::body::Body;

/// Mean distance that the trunk and the thighs are held to (mm).
pub const MEAN_GOAL_MM: f32 = 5.0;
/// 95th percentile of the distance that they are held to (mm).
pub const P95_GOAL_MM: f32 = 12.0;

/// Steps of the way out; each leaves the capsule that is deepest.
const WAY_OUT: usize = 64;

/// Distance between the points that stand for the union's surface (m): a vertex' distance from the next.
const SPACING: f32 = 8e-3;

/// A point of a capsule belongs to the union's surface unless it is deeper than this in another (m).
const ON: f32 = 1e-4;

/// Distances in one zone.
///
/// From the skin to the surface of the union, at every vertex, weighted by its area: how far the skin is from what cloth
/// lies on. Where the union fills a fold of the skin, this is the depth of the fold. From the union to the skin, at
/// points all over the union's surface: how far cloth that lies on it is from the skin, positive above it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ZoneReport {
    /// Skin to union: mean distance, absolute (mm).
    pub mean_mm: f32,
    /// Skin to union: mean with its sign (mm), positive where the union stands out of the skin.
    pub signed_mean_mm: f32,
    /// Skin to union: 95th percentile of the distance, absolute (mm).
    pub p95_mm: f32,
    /// Skin to union: the furthest that the union stands out of the skin (mm).
    pub max_outside_mm: f32,
    /// Skin to union: the furthest that the union stays below the skin (mm).
    pub max_inside_mm: f32,
    /// Union to skin: mean distance, absolute (mm).
    pub cloth_mean_mm: f32,
    /// Union to skin: 95th percentile of the distance, absolute (mm).
    pub cloth_p95_mm: f32,
    /// Union to skin: the highest that cloth lies above the skin (mm).
    pub cloth_max_above_mm: f32,
    /// Union to skin: the deepest that cloth lies below it (mm).
    pub cloth_max_below_mm: f32,
}

impl ZoneReport {
    /// The greatest distance either way (mm).
    pub const fn max_mm(&self) -> f32 {
        self.max_outside_mm.max(self.max_inside_mm)
    }

    /// Whether it keeps to [`MEAN_GOAL_MM`] and [`P95_GOAL_MM`].
    pub const fn meets(&self) -> bool {
        self.mean_mm <= MEAN_GOAL_MM && self.p95_mm <= P95_GOAL_MM
    }
}

/// How closely a rig follows its body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigReport {
    /// Zones in the order of [`Zone::ALL`].
    pub zones: [ZoneReport; Zone::ALL.len()],
    /// Chest, waist, hips and shoulders together.
    pub trunk: ZoneReport,
    /// All zones together.
    pub whole: ZoneReport,
}

impl RigReport {
    /// The report of one zone.
    pub fn of(&self, zone: Zone) -> &ZoneReport {
        &self.zones[zones::place(zone)]
    }

    /// The zones that [`Zone::HELD`] names and that miss the goal.
    pub fn missed(&self) -> Vec<Zone> {
        Zone::HELD.into_iter().filter(|zone| !self.of(*zone).meets()).collect()
    }

    pub(super) fn new(body: &Body, placed: &RestSpheres) -> Self {
        let (skin, cloth) = (from_skin(body, placed), from_union(body, placed));
        let of = |asked: &dyn Fn(Zone) -> bool| summed(&skin, &cloth, asked);
        Self { zones: Zone::ALL.map(|zone| of(&|z| z == zone)), trunk: of(&zones::is_trunk), whole: of(&|_| true) }
    }
}

/// A distance (m), positive where the union is above the skin; where, and what area it stands for (m^2).
struct SurfaceDistance {
    zone: Zone,
    distance: f32,
    area: f32,
}

/// Distances in zones that are asked for.
fn summed(skin: &[SurfaceDistance], cloth: &[SurfaceDistance], asked: &dyn Fn(Zone) -> bool) -> ZoneReport {
    let ([mean_mm, signed_mean_mm, p95_mm], [max_outside_mm, max_inside_mm]) = figures(skin, asked);
    let ([cloth_mean_mm, _, cloth_p95_mm], [cloth_max_above_mm, cloth_max_below_mm]) = figures(cloth, asked);
    ZoneReport {
        mean_mm,
        signed_mean_mm,
        p95_mm,
        max_outside_mm,
        max_inside_mm,
        cloth_mean_mm,
        cloth_p95_mm,
        cloth_max_above_mm,
        cloth_max_below_mm,
    }
}

/// Absolute mean, signed mean, 95th percentile; the greatest above and below (mm).
fn figures(found: &[SurfaceDistance], asked: &dyn Fn(Zone) -> bool) -> ([f32; 3], [f32; 2]) {
    let mut some: Vec<&SurfaceDistance> = found.iter().filter(|f| asked(f.zone)).collect();
    some.sort_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()));
    let total: f64 = some.iter().map(|f| f64::from(f.area)).sum();
    let mean = |value: &dyn Fn(f32) -> f32| {
        let sum: f64 = some.iter().map(|f| f64::from(value(f.distance)) * f64::from(f.area)).sum();
        (sum / total.max(f64::MIN_POSITIVE)) as f32 * 1e3
    };
    let mut passed = 0.0;
    let p95 = some.iter().find(|f| {
        passed += f64::from(f.area);
        passed >= 0.95 * total
    });
    let most = |sign: f32| some.iter().map(|f| sign * f.distance).fold(0.0, f32::max) * 1e3;
    ([mean(&f32::abs), mean(&|d| d), p95.map_or(0.0, |f| f.distance.abs() * 1e3)], [most(1.0), most(-1.0)])
}

/// Every vertex' distance from the surface of the union.
fn from_skin(body: &Body, placed: &RestSpheres) -> Vec<SurfaceDistance> {
    let areas = vertex_areas(body);
    let of = |v: usize| SurfaceDistance {
        zone: Zone::of(body, v),
        distance: -way_out(placed, body.mesh.positions[v], body.normals[v]),
        area: areas[v],
    };
    (0..areas.len()).map(of).collect()
}

/// Signed distance from a point of the skin to the surface of the union (m), negative inside. Inside it is the shorter of
/// two ways that do lead out: along the skin's normal, and always away from the capsule that is deepest; the union's
/// surface is no farther than that.
pub(super) fn way_out(placed: &RestSpheres, p: Vec3, normal: Vec3) -> f32 {
    let (distance, ..) = nearest(placed, p);
    if distance >= 0.0 {
        return distance;
    }
    let along = (0..WAY_OUT).fold(0.0, |way, _| way - nearest(placed, p + normal * way).0.min(0.0));
    let mut at = p;
    for _ in 0..WAY_OUT {
        let (depth, capsule, t) = nearest(placed, at);
        if depth >= 0.0 {
            break;
        }
        let [a, b] = CAPSULES[capsule].map(|s| placed[usize::from(s)].0);
        at += (at - a.lerp(b, t)).normalize_or(normal) * (1e-6 - depth);
    }
    -at.distance(p).min(along)
}

/// Distances from the skin of points all over the surface of the union.
fn from_union(body: &Body, placed: &RestSpheres) -> Vec<SurfaceDistance> {
    let skin = SkinByHeight::new(body);
    let of = |(p, area): (Vec3, f32)| {
        let (v, distance) = skin.distance(p)?;
        Some(SurfaceDistance { zone: Zone::of(body, v), distance, area })
    };
    surface(placed).into_iter().filter_map(of).collect()
}

/// Points of the union's surface and the areas they stand for (m^2).
pub(super) fn surface(placed: &RestSpheres) -> Vec<(Vec3, f32)> {
    let mut points = Vec::new();
    for ends in CAPSULES {
        let [a, b] = ends.map(|s| placed[usize::from(s)]);
        side(a, b, &mut points);
    }
    placed.iter().for_each(|sphere| ball(*sphere, &mut points));
    points.retain(|(p, _)| nearest(placed, *p).0 > -ON);
    points
}

/// The slanted side of a round cone; its normal leans by the slope's sine.
fn side((a, ra): (Vec3, f32), (b, rb): (Vec3, f32), points: &mut Vec<(Vec3, f32)>) {
    let length = a.distance(b);
    if length <= (ra - rb).abs() {
        return;
    }
    let (axis, sine) = ((b - a) / length, (ra - rb) / length);
    let cosine = (1.0 - sine * sine).sqrt();
    let (u, v) = axis.any_orthonormal_pair();
    let rings = (length / SPACING).ceil();
    let around = (TAU * ra.max(rb) / SPACING).ceil();
    for i in 0..rings as usize {
        let t = (i as f32 + 0.5) / rings;
        let (centre, radius) = (a.lerp(b, t), ra + (rb - ra) * t);
        let area = TAU * radius / around * length * cosine * cosine / rings;
        for j in 0..around as usize {
            let (s, c) = (TAU * (j as f32 + 0.5) / around).sin_cos();
            points.push((centre + ((u * c + v * s) * cosine + axis * sine) * radius, area.max(0.0)));
        }
    }
}

/// A sphere, by a spiral of equal areas.
fn ball((centre, radius): (Vec3, f32), points: &mut Vec<(Vec3, f32)>) {
    let area = 4.0 * PI * radius * radius;
    let count = (area / (SPACING * SPACING)).ceil();
    for i in 0..count as usize {
        let z = 1.0 - 2.0 * (i as f32 + 0.5) / count;
        let (s, c) = (i as f32 * PI * (3.0 - 5.0f32.sqrt())).sin_cos();
        let flat = (1.0 - z * z).sqrt();
        points.push((centre + Vec3::new(c * flat, z, s * flat) * radius, area / count));
    }
}
