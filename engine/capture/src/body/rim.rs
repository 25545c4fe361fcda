//! The rim of a posed body in a camera: the places of its surface along the outline of its drawing, and the outline of the silhouette
//! that each belongs to.

use glam::{DVec2, DVec3};

use super::view::{CameraSilhouette, TangentPlane};
use toile_pose::depth_buffer::DepthBuffer;

/// Least cosine between the ways out of a body's rim and of an outline that belong together.
const ALIKE: f64 = 0.6;

/// A place on the rim of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RimPoint {
    /// The face that it is on.
    pub face: usize,
    /// Where it is (m, world).
    pub place: DVec3,
    /// Where it is seen, as by a lens that bends nothing (px).
    pub at: DVec2,
    /// The way out in the picture.
    pub out: DVec2,
    /// Its depth (m).
    pub depth: f64,
}

/// An outline and the place of the rim that belongs to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RimMatch {
    /// The face.
    pub face: usize,
    /// How far the rim lies outside of the outline's plane (m).
    pub outside: f64,
    /// The plane's normal.
    pub normal: DVec3,
    /// Whether the outline found the place; else the place found the outline, which may be another part's.
    pub by_outline: bool,
}

/// A body's surface as it is drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct DrawnSurface<'a> {
    /// Positions of its vertices (m, world).
    pub positions: &'a [DVec3],
    /// Outward normals of its vertices.
    pub normals: &'a [DVec3],
    /// Corners of its faces; two triangles each.
    pub faces: &'a [[u32; 4]],
    /// The same as triangles.
    pub triangles: &'a [[u32; 3]],
}

/// How far beyond the rim a drawing has to be empty (px of it).
const BEYOND: f64 = 1.6;

/// Draws a body and collects its rim: for each face on which the surface turns away from the camera the place where it does
/// (Hertzmann 1999), where nothing of the drawing lies beyond it.
pub(super) fn rim(view: &CameraSilhouette, surface: &DrawnSurface, buffer: &mut DepthBuffer) -> Vec<RimPoint> {
    buffer.draw(&view.camera, surface.positions, surface.triangles);
    let away: Vec<f64> = surface.positions.iter().zip(surface.normals).map(|(p, n)| n.dot(*p - view.from)).collect();
    let mut found = Vec::new();
    for (face, corners) in surface.faces.iter().enumerate() {
        let signs = corners.map(|v| away[v as usize] > 0.0);
        if signs.iter().any(|s| *s) && signs.iter().any(|s| !*s) {
            found.extend(turning_place(view, surface, &away, face).filter(|p| is_outermost(view, buffer, p)));
        }
    }
    found
}

/// The middle of the line on a face along which the surface turns away.
fn turning_place(view: &CameraSilhouette, surface: &DrawnSurface, away: &[f64], face: usize) -> Option<RimPoint> {
    let corners = surface.faces[face];
    let (mut place, mut normal, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for k in 0..4 {
        let [a, b] = [corners[k], corners[(k + 1) % 4]].map(|v| v as usize);
        if (away[a] > 0.0) != (away[b] > 0.0) {
            let share = away[a] / (away[a] - away[b]);
            place += surface.positions[a].lerp(surface.positions[b], share);
            normal += surface.normals[a].lerp(surface.normals[b], share);
            count += 1.0;
        }
    }
    let place = place / count;
    let p = view.camera.to_camera(place);
    let out = (view.camera.rotation() * normal).truncate().normalize_or_zero();
    let at = p.truncate() / p.z * view.camera.focal() + view.camera.centre();
    (p.z > 0.05 && out != DVec2::ZERO).then_some(RimPoint { face, place, at, out, depth: p.z })
}

/// Whether the drawing ends at a place of its rim.
fn is_outermost(view: &CameraSilhouette, buffer: &DepthBuffer, point: &RimPoint) -> bool {
    let at = (point.at + 0.5) * view.scale - 0.5 + point.out * BEYOND;
    let (x, y) = (at.x.round(), at.y.round());
    let inside = x >= 0.0 && y >= 0.0 && x < buffer.width as f64 && y < buffer.height as f64;
    !inside || buffer.triangle[y as usize * buffer.width + x as usize] == u32::MAX
}

/// Which outlines belong to which places of the rim: for each outline the nearest place that faces its way, and for each place that
/// no outline has, the nearest outline. `gate` is the largest distance (m).
pub(super) fn matches(view: &CameraSilhouette, rim: &[RimPoint], gate: f64) -> Vec<RimMatch> {
    let focal = view.camera.focal().x;
    let mut found = Vec::new();
    let mut taken = vec![false; rim.len()];
    let outside = |point: &RimPoint, plane: &TangentPlane, by_outline: bool| RimMatch {
        face: point.face,
        outside: plane.normal.dot(point.place - view.from),
        normal: plane.normal,
        by_outline,
    };
    for plane in &view.planes {
        let mut best: Option<(f64, usize)> = None;
        for (i, p) in rim.iter().enumerate() {
            let off = p.at.distance_squared(plane.at);
            if best.is_none_or(|(least, _)| off < least) && p.out.dot(plane.out) > ALIKE {
                best = Some((off, i));
            }
        }
        if let Some((_, i)) = best.filter(|(off, i)| off.sqrt() * rim[*i].depth < gate * focal) {
            taken[i] = true;
            found.push(outside(&rim[i], plane, true));
        }
    }
    // A place a stretch: a finger has as many faces as a thigh.
    let cell = |at: DVec2| ((at.x / view.step).floor() as i64, (at.y / view.step).floor() as i64);
    let mut done: std::collections::BTreeSet<(i64, i64)> =
        rim.iter().zip(&taken).filter(|(_, t)| **t).map(|(p, _)| cell(p.at)).collect();
    for p in rim {
        if !done.insert(cell(p.at)) {
            continue;
        }
        let alike = view.planes.iter().filter(|plane| p.out.dot(plane.out) > ALIKE);
        let near = alike.map(|plane| (p.at.distance_squared(plane.at), plane)).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((off, plane)) = near
            && off.sqrt() * p.depth < gate * focal
        {
            found.push(outside(p, plane, false));
        }
    }
    found
}

/// Pixels that drawing and silhouette share, and that either has.
pub(super) fn overlap(view: &CameraSilhouette, buffer: &DepthBuffer) -> [usize; 2] {
    let pairs = view.covered.iter().zip(&buffer.triangle);
    pairs.fold([0, 0], |[both, either], (seen, t)| {
        let drawn = *t != u32::MAX;
        [both + usize::from(*seen && drawn), either + usize::from(*seen || drawn)]
    })
}
