//! Dressing: outer garments are laid outside of inner ones, and what is tucked in inside. At load.

use glam::{Vec3, Vec3A};
use toile_base::garment::Garment;

use super::garment_surface::GarmentSurface;
use super::order::wearing_order;
use super::thickness::thickness;
use crate::lanes::{ReadColumn, Width};
use crate::surface::{ClusterBoxes, Feature, FillBoxes, FindNearest, NearestPoint, NearestVertex, SurfaceMesh};

/// Farthest that a particle may lie inside of what it is worn over and still be brought out (m).
const INSIDE_M: f32 = 0.05;

/// Times that all of an outer garment is looked at: what one push leaves in another fold the next brings out.
const ROUNDS: usize = 12;

/// Moves where outer garments start to the outside of inner ones, a thickness away. What is pushed is the outer garment's
/// particle, or the corners of its face that an inner particle looks through. What is tucked in is laid inside instead, a thickness
/// away as well, and gathered to the width that it has there.
pub fn lay_outside(garments: &mut [Garment]) {
    let order = wearing_order(garments);
    for (k, &outer) in order.iter().enumerate() {
        for _ in 0..ROUNDS {
            let mut moved = false;
            for &inner in &order[..k] {
                let apart = thickness(&garments[outer].fabric, &garments[inner].fabric);
                moved |= particles_out(garments, outer, inner, apart);
                moved |= faces_out(garments, outer, inner, apart);
            }
            if !moved {
                break;
            }
        }
        garments[outer].gather();
    }
}

/// The nearest points of one garment's surface to another's particles that are within [`INSIDE_M`], with the normal and how
/// far in front of it the particle is (m).
fn near(surface: &GarmentSurface, start: &[Vec3], points: &[Vec3]) -> Vec<(u32, NearestPoint, Vec3A, f32)> {
    let columns = |at: &[Vec3]| [0, 1, 2].map(|axis| at.iter().map(|p| p[axis]).collect::<Vec<f32>>());
    let (of, asking) = (columns(start), columns(points));
    let (of, asking) = (of.each_ref().map(|c| ReadColumn::new(c)), asking.each_ref().map(|c| ReadColumn::new(c)));
    let (GarmentSurface { mesh, clusters, .. }, width) = (surface, Width::widest());
    let mut boxes = ClusterBoxes::new(clusters);
    width.run(FillBoxes { clusters, surface: of, boxes: &mut boxes });
    let (mut list, mut found) = (Vec::new(), Vec::new());
    for (i, p) in points.iter().enumerate() {
        let within2 = 4.0 * INSIDE_M * INSIDE_M;
        let vertex = width.run(NearestVertex { clusters, boxes: &boxes, surface: of, point: p.to_array(), within2 });
        if let Some(&triangle) = vertex.and_then(|v| mesh.fan(v).first()) {
            list.push(i as u32);
            found.push(NearestPoint { triangle, ..NearestPoint::default() });
        }
    }
    width.run(FindNearest { mesh, surface: of, points: asking, list: &list, found: &mut found });
    let mut out = Vec::new();
    for (i, found) in list.into_iter().zip(found) {
        let feature = SurfaceMesh::feature(found.shares);
        let normal = mesh.normal(found.triangle, feature, |v| start[v as usize].into());
        let corners = mesh.corners(found.triangle);
        let q: Vec3 = (0..3).map(|k| start[corners[k] as usize] * found.shares[k]).sum();
        let away = Vec3A::from(points[i as usize] - q);
        let front = away.dot(normal);
        let beside = (away - normal * front).length() > 0.1 * INSIDE_M && mesh.on_border(found.triangle, feature);
        if found.distance2 < INSIDE_M * INSIDE_M && !beside {
            out.push((i, found, normal, front));
        }
    }
    out
}

/// Brings particles of the outer garment out of the inner one; says whether any was in it.
fn particles_out(garments: &mut [Garment], outer: usize, inner: usize, apart: f32) -> bool {
    let near = near(&GarmentSurface::new(&garments[inner]), &garments[inner].start, &garments[outer].start);
    let mut moved = false;
    let tuck = garments[outer].tuck.clone().filter(|tuck| tuck.into == inner);
    let start = garments[outer].start_mut();
    for (i, _, normal, front) in near {
        // Where it belongs is in front, of what is tucked in behind.
        let side = if tuck.as_ref().is_some_and(|tuck| tuck.particles[i as usize]) { -1.0 } else { 1.0 };
        if side * front < apart {
            start[i as usize] += Vec3::from(normal * (side * apart - front));
            moved |= side * front < 0.5 * apart;
        }
    }
    moved
}

/// Brings faces of the outer garment out over particles of the inner one; says whether any had to be.
fn faces_out(garments: &mut [Garment], outer: usize, inner: usize, apart: f32) -> bool {
    let of = GarmentSurface::new(&garments[outer]);
    let own = GarmentSurface::new(&garments[inner]);
    let near = near(&of, &garments[outer].start, &garments[inner].start);
    let mut moved = false;
    let at = |v: u32| Vec3A::from(garments[inner].start[v as usize]);
    let mut pushes = Vec::new();
    let tuck = garments[outer].tuck.as_ref().filter(|tuck| tuck.into == inner);
    for (i, found, normal, front) in near {
        let front_of_inner = own.mesh.fan(i).iter().map(|&t| own.mesh.normal(t, Feature::Face, at)).sum::<Vec3A>();
        let corners = of.mesh.corners(found.triangle);
        // Where the inner particle belongs is behind, of what is tucked in in front.
        let side = if tuck.is_some_and(|tuck| tuck.holds(corners)) { -1.0 } else { 1.0 };
        if front_of_inner.dot(normal) > 0.0 && side * front > -apart {
            moved |= side * front > -0.5 * apart;
            let square = found.shares.iter().map(|s| s * s).sum::<f32>();
            (0..3)
                .for_each(|k| pushes.push((corners[k], normal * ((side * apart + front) * found.shares[k] / square))));
        }
    }
    // Of several pushes the longest: they are for the same way out.
    let mut longest = vec![Vec3A::ZERO; garments[outer].start.len()];
    for (v, push) in pushes {
        let kept = &mut longest[v as usize];
        *kept = if push.length_squared() > kept.length_squared() { push } else { *kept };
    }
    garments[outer].start_mut().iter_mut().zip(longest).for_each(|(p, push)| *p += Vec3::from(push));
    moved
}
