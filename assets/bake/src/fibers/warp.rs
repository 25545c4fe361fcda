//! Where the threads run: the direction of the warp within each face.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};

use crate::check::{corners, is_quad};
use crate::shape::Face;

/// A face whose steepest direction rises less than this (sine of 10 degrees) lies flat: noise would choose its warp.
const FLAT_SINE: f32 = 0.17;

/// The warp of each face (unit, downwards): the sides that a quad calls so, the steepest direction of a triangle. Where
/// a face lies flat it goes on as its neighbours do; a mesh that lies flat altogether has its warp towards +z.
pub fn steepest(positions: &[Vec3], faces: &[Face]) -> Vec<Vec3> {
    let found = faces.iter().map(|face| {
        let down = within(positions, face, Vec3::NEG_Y);
        (down.length() > FLAT_SINE).then(|| down.normalize())
    });
    let mut warp: Vec<Option<Vec3>> = found.collect();
    let beside = neighbours(faces);
    spread(positions, faces, &beside, &mut warp);
    while let Some(flat) = warp.iter().position(Option::is_none) {
        warp[flat] = Some(
            along(positions, &faces[flat], Vec3::Z)
                .or_else(|| along(positions, &faces[flat], Vec3::X))
                .unwrap_or(Vec3::Z),
        );
        spread(positions, faces, &beside, &mut warp);
    }
    warp.into_iter().flatten().collect()
}

/// The warp of each face by texture coordinates, one for each corner of each face: patterns are laid out with their
/// warp along v. A face without area in the texture keeps the `fallback`; downwards stays downwards, so that pieces laid
/// out upside down agree with the others.
pub fn from_uvs(positions: &[Vec3], faces: &[Face], uvs: &[[Vec2; 4]], fallback: &[Vec3]) -> Vec<Vec3> {
    let one = |((face, uv), fallback): ((&Face, &[Vec2; 4]), &Vec3)| {
        let [p, q, r] = [0, 1, 2].map(|k| positions[face[k] as usize]);
        let (e, f) = (uv[1] - uv[0], uv[2] - uv[0]);
        // The way along the face on which v grows and u stays.
        let up = ((r - p) * e.x - (q - p) * f.x) * e.perp_dot(f).signum();
        let warp = if e.perp_dot(f) == 0.0 { Vec3::ZERO } else { up.normalize_or_zero() };
        let agrees = if warp.dot(*fallback) < 0.0 { -warp } else { warp };
        if warp == Vec3::ZERO { *fallback } else { along(positions, face, agrees).unwrap_or(*fallback) }
    };
    faces.iter().zip(uvs).zip(fallback).map(one).collect()
}

/// By how much the scale of a pattern may differ from that of its cloth, from place to place and along from across: what
/// fullness and shaping take; textures that were unwrapped to fill a square differ by far more.
const PATTERN_SCALE: f32 = 1.3;

/// Part of the area that must agree.
const PATTERN_SHARE: f32 = 0.9;

/// Whether texture coordinates are a pattern: nearly all of the cloth laid out flat to one scale, undistorted.
pub fn is_pattern(positions: &[Vec3], faces: &[Face], uvs: &[[Vec2; 4]]) -> bool {
    if uvs.len() != faces.len() {
        return false;
    }
    let mut scales: Vec<(f32, f32, f32)> =
        faces.iter().zip(uvs).map(|(face, uv)| scales(positions, face, uv)).collect();
    let whole: f32 = scales.iter().map(|s| s.2).sum();
    // The median by area is the pattern's scale.
    scales.sort_by(|a, b| (a.0 * a.1).total_cmp(&(b.0 * b.1)));
    let mut below = 0.0;
    let middle = scales.iter().find(|s| {
        below += s.2;
        below >= 0.5 * whole
    });
    let Some(scale) = middle.map(|s| (s.0 * s.1).sqrt()).filter(|s| s.is_finite() && *s > 0.0) else { return false };
    let like = |s: f32| s < scale * PATTERN_SCALE && s > scale / PATTERN_SCALE;
    let agrees: f32 = scales.iter().filter(|s| like(s.0) && like(s.1)).map(|s| s.2).sum();
    agrees >= PATTERN_SHARE * whole
}

/// By how much the texture stretches a face at most and at least (1/m), and the face's area (m2): the singular values of
/// the map from its plane, by the trace and determinant of its metric.
fn scales(positions: &[Vec3], face: &Face, uv: &[Vec2; 4]) -> (f32, f32, f32) {
    let at = |k: usize| positions[face[k] as usize] - positions[face[0] as usize];
    let (e, f) = (at(1), at(2));
    let (p, q) = (uv[1] - uv[0], uv[2] - uv[0]);
    let area = 0.5 * e.cross(f).length();
    let (ee, ef, ff) = (e.dot(e), e.dot(f), f.dot(f));
    let inverse = (ee * ff - ef * ef).recip();
    let trace = (p.dot(p) * ff - 2.0 * p.dot(q) * ef + q.dot(q) * ee) * inverse;
    let determinant = p.perp_dot(q) * p.perp_dot(q) * inverse;
    let root = (0.25 * trace * trace - determinant).max(0.0).sqrt();
    ((0.5 * trace + root).sqrt(), (0.5 * trace - root).max(0.0).sqrt(), area)
}

/// A warp that was found on one shape of a mesh, laid into the same faces of another: as they are worn, say, and as they
/// were cut.
pub fn carried(from: &[Vec3], to: &[Vec3], faces: &[Face], warp: &[Vec3]) -> Vec<Vec3> {
    let one = |(face, warp): (&Face, &Vec3)| {
        let at = |p: &[Vec3], k: usize| p[face[k] as usize] - p[face[0] as usize];
        let (e, f) = (at(from, 1), at(from, 2));
        // Least squares for warp = x e + y f.
        let (ee, ef, ff) = (e.dot(e), e.dot(f), f.dot(f));
        let (we, wf) = (warp.dot(e), warp.dot(f));
        let (x, y) = (we * ff - wf * ef, wf * ee - we * ef);
        let laid = at(to, 1) * x + at(to, 2) * y;
        along(to, face, laid).or_else(|| along(to, face, *warp)).unwrap_or(*warp)
    };
    faces.iter().zip(warp).map(one).collect()
}

/// The part of a direction that a face can follow: its projection onto the plane of a triangle, or along the warp sides
/// of a quad.
fn within(positions: &[Vec3], face: &Face, direction: Vec3) -> Vec3 {
    if is_quad(face) {
        let [a, b, c, d] = face.map(|i| positions[i as usize]);
        let axis = ((a - d) + (b - c)).normalize_or_zero();
        axis * axis.dot(direction)
    } else {
        let up = normal(positions, face);
        direction - up * up.dot(direction)
    }
}

/// The same as a unit vector, if there is any.
fn along(positions: &[Vec3], face: &Face, direction: Vec3) -> Option<Vec3> {
    within(positions, face, direction.normalize_or_zero()).try_normalize()
}

/// Unit normal of a face, zero if it has no area.
pub(super) fn normal(positions: &[Vec3], face: &Face) -> Vec3 {
    let p = |k: usize| positions[face[k] as usize];
    let across = if is_quad(face) { (p(2) - p(0)).cross(p(3) - p(1)) } else { (p(1) - p(0)).cross(p(2) - p(0)) };
    across.normalize_or_zero()
}

/// The faces that share a side with each face.
fn neighbours(faces: &[Face]) -> Vec<Vec<u32>> {
    let mut sides: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    let mut beside = vec![Vec::new(); faces.len()];
    for (i, face) in faces.iter().enumerate() {
        let ring = corners(face);
        for (k, &a) in ring.iter().enumerate() {
            let b = ring[(k + 1) % ring.len()];
            if let Some(j) = sides.insert((a.min(b), a.max(b)), i as u32) {
                beside[i].push(j);
                beside[j as usize].push(i as u32);
            }
        }
    }
    beside
}

/// Carries the warp into faces that have none, a ring of faces at a time, so that the order of the faces is no matter.
fn spread(positions: &[Vec3], faces: &[Face], beside: &[Vec<u32>], warp: &mut [Option<Vec3>]) {
    let open = |warp: &[Option<Vec3>], i: u32| warp[i as usize].is_none();
    let all = 0..faces.len() as u32;
    let mut front: Vec<u32> =
        all.filter(|&i| open(warp, i) && beside[i as usize].iter().any(|&j| !open(warp, j))).collect();
    while !front.is_empty() {
        let one = |&i: &u32| {
            let sum: Vec3 = beside[i as usize].iter().filter_map(|&j| warp[j as usize]).sum();
            along(positions, &faces[i as usize], sum)
        };
        let found: Vec<Option<Vec3>> = front.iter().map(one).collect();
        let mut next = Vec::new();
        for (&i, found) in front.iter().zip(&found).filter(|(_, found)| found.is_some()) {
            warp[i as usize] = *found;
            next.extend(beside[i as usize].iter().copied());
        }
        next.retain(|&i| open(warp, i));
        next.sort_unstable();
        next.dedup();
        front = next;
    }
}
