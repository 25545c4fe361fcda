//! Curves along a head's outline in its photographs, and the places of the head's rim that belong to them.
//!
//! A curve is cut into stretches; each belongs to the place of the rim that is nearest across it and faces its way. Rim: where the
//! surface turns away from the camera (Hertzmann 1999) and nothing, or only something much deeper, lies beyond.

use glam::{DVec2, DVec3};
use toile_base::numeric::statistics::median_of;

use super::head_mesh::{HeadMesh, normals};
use super::sighting::{HeadPose, ROBUST, Sighting};
use super::view::FaceView;
use crate::depth_buffer::DepthBuffer;

/// Stretches of the curves of one photograph, about; fewer where they would be shorter than [`SHORTEST`] (px).
const STRETCHES: f64 = 60.0;
const SHORTEST: f64 = 4.0;

/// Length over which the way of a curve is taken (stretches).
const TANGENT: f64 = 3.0;

/// Least cosine between the ways out of a rim and of an outline that belong together.
const ALIKE: f64 = 0.8;

/// Farthest that a rim may lie from its outline (m), and how much more a way along the outline counts.
const GATE: f64 = 0.025;
const ALONG: f64 = 4.0;

/// Robust distance of an outline, in medians of how far all of them are off: at first all are far.
const MEDIANS: f64 = 3.0;

/// How far beyond the rim the head has to end (px of the drawing), and how much deeper what goes on there has to be (m).
const BEYOND: f64 = 1.6;
const DEEPER: f64 = 0.015;

/// Longer side of the drawing (px).
const DRAWING: f64 = 900.0;

/// A stretch of an outline.
#[derive(Debug, Clone, Copy)]
pub(super) struct OutlineStretch {
    /// Its middle, as by a lens that bends nothing (px, from the principal point).
    at: DVec2,
    /// The way out of the head.
    out: DVec2,
}

/// A place on the rim of a head.
#[derive(Debug, Clone, Copy)]
struct HeadRimPlace {
    drawn: DVec3,
    own: DVec3,
    /// Where it is seen (px, from the principal point), the way out there, and its depth (m).
    at: DVec2,
    out: DVec2,
    depth: f64,
}

/// The stretches of a photograph's curves; out is away from its points.
pub(super) fn stretches(view: &FaceView) -> Vec<OutlineStretch> {
    let flat = |p: &DVec2| view.camera.ray(*p) * view.camera.focal();
    let points: Vec<DVec2> = view.points.iter().flatten().map(flat).collect();
    let middle = points.iter().sum::<DVec2>() / points.len().max(1) as f64;
    let curves: Vec<Vec<DVec2>> = view.outlines.iter().map(|c| c.iter().map(flat).collect()).collect();
    let length = |c: &[DVec2]| c.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
    let step = (curves.iter().map(|c| length(c)).sum::<f64>() / STRETCHES).max(SHORTEST);
    let mut found = Vec::new();
    for curve in &curves {
        let whole = length(curve);
        for k in 0..(whole / step) as usize {
            let s = (k as f64 + 0.5) * step;
            let at = along(curve, s);
            let half = 0.5 * TANGENT * step;
            let way = along(curve, (s + half).min(whole)) - along(curve, (s - half).max(0.0));
            let out = way.perp().normalize_or_zero();
            let out = if out.dot(at - middle) < 0.0 { -out } else { out };
            if out != DVec2::ZERO {
                found.push(OutlineStretch { at, out });
            }
        }
    }
    found
}

/// The point of a curve after a length of it.
fn along(curve: &[DVec2], mut length: f64) -> DVec2 {
    for w in curve.windows(2) {
        let piece = w[0].distance(w[1]);
        if length <= piece && piece > 0.0 {
            return w[0].lerp(w[1], length / piece);
        }
        length -= piece;
    }
    curve.last().copied().unwrap_or_default()
}

/// What the stretches of all photographs show of a head whose vertices are here (m, from its middle).
pub(super) fn seen_outlines(
    views: &[FaceView],
    stretches: &[Vec<OutlineStretch>],
    mesh: &HeadMesh,
    own: &[DVec3],
    pose: HeadPose,
) -> Vec<Sighting> {
    let placed: Vec<DVec3> = own.iter().map(|p| pose.to_world(*p)).collect();
    let mut found = Vec::new();
    for (view, (v, stretches)) in views.iter().zip(stretches).enumerate().filter(|(_, (_, s))| !s.is_empty()) {
        let rim = rim(v, mesh, own, &placed);
        let matched = stretches.iter().filter_map(|s| Some((s, nearest(s, &rim, v.camera.focal().x)?)));
        found.extend(matched.map(|(s, place)| Sighting {
            view,
            drawn: place.drawn,
            own: place.own,
            by: DVec3::ZERO,
            at: s.at,
            across: Some(s.out),
            sigma: v.sigma_px,
            robust: (place.at - s.at).dot(s.out).abs(),
        }));
    }
    let median = median_of(found.iter().map(|s| s.robust)).unwrap_or(0.0);
    found.iter_mut().for_each(|s| s.robust = (ROBUST * s.sigma).max(MEDIANS * median));
    found
}

/// The place of a rim that a stretch belongs to.
fn nearest<'a>(stretch: &OutlineStretch, rim: &'a [HeadRimPlace], focal: f64) -> Option<&'a HeadRimPlace> {
    let far = |p: &HeadRimPlace| {
        let off = p.at - stretch.at;
        off.dot(stretch.out).hypot(ALONG * off.perp_dot(stretch.out)) * p.depth / focal
    };
    let alike = rim.iter().filter(|p| p.out.dot(stretch.out) > ALIKE);
    alike.map(|p| (far(p), p)).filter(|(far, _)| *far < GATE).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, p)| p)
}

/// The rim of a head in a photograph, the neck left out.
fn rim(view: &FaceView, mesh: &HeadMesh, own: &[DVec3], placed: &[DVec3]) -> Vec<HeadRimPlace> {
    let camera = view.camera.straightened();
    let longer = f64::from(camera.size[0].max(camera.size[1]));
    let mut buffer = DepthBuffer::new(camera.size, (DRAWING / longer).min(1.0));
    buffer.draw(&camera, placed, &mesh.triangles);
    let normals = normals(placed, &mesh.triangles);
    let from = camera.position();
    let mut found = Vec::new();
    for t in mesh.triangles.iter().filter(|t| t.iter().all(|v| mesh.share[*v as usize] >= 1.0)) {
        let corners = t.map(|v| v as usize);
        let Some(shares) = turning_place(corners.map(|v| normals[v].dot(placed[v] - from))) else { continue };
        let of = |values: &[DVec3]| corners.iter().zip(shares).map(|(v, s)| values[*v] * s).sum::<DVec3>();
        let p = camera.to_camera(of(placed));
        let out = (camera.rotation() * of(&normals)).truncate().normalize_or_zero();
        if p.z > 0.0 && out != DVec2::ZERO && ends(&buffer, buffer.project(&camera, of(placed)), out) {
            let at = p.truncate() / p.z * camera.focal();
            found.push(HeadRimPlace { drawn: of(&mesh.positions), own: of(own), at, out, depth: p.z });
        }
    }
    found
}

/// Shares of a triangle's corners in the middle of the line along which its surface turns away, where it does: where a value changes sign.
fn turning_place(away: [f64; 3]) -> Option<[f64; 3]> {
    let mut shares = [0.0; 3];
    let mut count = 0.0;
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        if (away[a] > 0.0) != (away[b] > 0.0) {
            let share = away[a] / (away[a] - away[b]);
            shares[a] += 0.5 * (1.0 - share);
            shares[b] += 0.5 * share;
            count += 1.0;
        }
    }
    (count == 2.0).then_some(shares)
}

/// Whether the head is seen at a place of the drawing (px, depth in m) and ends beyond it.
fn ends(buffer: &DepthBuffer, place: DVec3, out: DVec2) -> bool {
    let beyond = place.truncate() + out * BEYOND;
    let (x, y) = (beyond.x.round(), beyond.y.round());
    let inside = x >= 0.0 && y >= 0.0 && x < buffer.width as f64 && y < buffer.height as f64;
    let depth = if inside { buffer.depth[y as usize * buffer.width + x as usize] } else { f32::INFINITY };
    let nearest = f64::from(buffer.nearest_around(place.truncate()));
    f64::from(depth) > place.z + DEEPER && nearest > place.z - DEEPER
}
