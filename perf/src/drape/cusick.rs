//! Cusick's drape test: a round specimen of 30 cm on a disc of 18 cm, and the share of the ring that its shadow covers.
//!
//! The mesh is a grid of quads, the warp along one side of it, with rings of points where the disc ends and where the specimen ends;
//! triangles join the two. What lies on the disc is held, as the upper disc of the apparatus holds it. DC = (shadow - disc) /
//! (specimen - disc) (BS 5058; Cusick 1968). The cloth is let go level; nothing is fitted.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::{DVec2, Vec3};
use serde::Serialize;
use toile_assets::delaunay::delaunay;
use toile_bake::shape::NO_VERTEX;
use toile_base::fabric::Fabric;
use toile_engine::cloth::Quality;
use toile_engine::colliders::Colliders;
use toile_view::image::{Image, Size};
use toile_view::scene::OrbitCamera;

use super::cloth::{DrapeError, DrapedCloth, SpecimenPiece};
use super::shadow;

/// Radii of the disc and of the specimen (m).
const DISC_M: f64 = 0.09;
const SPECIMEN_M: f64 = 0.15;

/// When the coefficient is read (s): as the figure, and before it, to see whether it creeps.
const READ_S: [f64; 2] = [3.0, 5.0];

/// Damping of the cloth's motion, for it to come to rest (1/s): a specimen is let down slowly.
const DAMPING_PER_S: f32 = 6.0;

/// Distances of particles that are tried (mm), coarsest first.
pub const SPACINGS_MM: [f64; 3] = [20.0, 10.0, 5.0];

/// A fabric at a spacing.
#[derive(Debug, Clone, Serialize)]
pub struct CusickRow {
    /// Name of the fabric.
    pub fabric: String,
    /// Distance of its particles (mm).
    pub spacing_mm: f64,
    /// Particles of the specimen.
    pub particles: usize,
    /// Drape coefficient after five seconds (%).
    pub drape_percent: f64,
    /// What it changed by in the last two seconds (%).
    pub crept: f64,
    /// As measured, where the fabric's file says (%).
    pub measured: Option<f32>,
    /// Band of its kind (%), where one is published.
    pub band: Option<[f64; 2]>,
    /// Speed of its fastest particle at the end (mm/s).
    pub fastest_mm_s: f64,
    /// Median time of a step (us).
    pub step_us: f64,
    /// From above and before.
    #[serde(skip)]
    pub picture: Option<Image>,
}

/// Settled bands of REFERENCES by what a fabric is called (%): reported, not fitted to.
pub fn published_band(name: &str) -> Option<[f64; 2]> {
    let kinds = [
        (&["silk", "faille", "chiffon"][..], [20.0, 40.0]),
        (&["denim"], [70.0, 90.0]),
        (&["wool"], [40.0, 70.0]),
        (&["cotton", "lawn", "shirting"], [60.0, 76.0]),
    ];
    kinds.into_iter().find(|(words, _)| words.iter().any(|w| name.contains(w))).map(|(_, band)| band)
}

/// Drapes a fabric at a spacing (mm) in a quality; draws it where that is asked for.
///
/// # Errors
/// A specimen that cannot be baked.
pub fn cusick(fabric: &Fabric, spacing_mm: f64, quality: Quality, drawn: bool) -> Result<CusickRow, DrapeError> {
    let piece = specimen(1e-3 * spacing_mm);
    let damped = Fabric { damping_per_s: DAMPING_PER_S, ..fabric.clone() };
    let mut cloth = DrapedCloth::new(&piece, &damped, Colliders::new(&[], &[], false)?, quality)?;
    let [before, after] = READ_S.map(|seconds| {
        cloth.run_to(seconds);
        coefficient(&piece, &cloth)
    });
    let camera =
        OrbitCamera { target: Vec3::new(0.0, -0.03, 0.0), yaw: 0.5, height: 0.42, distance: 0.62, fov_y: 0.42 };
    Ok(CusickRow {
        fabric: fabric.name.clone(),
        spacing_mm,
        particles: piece.points.len(),
        drape_percent: after,
        crept: after - before,
        measured: fabric.drape_percent,
        band: published_band(&fabric.name),
        fastest_mm_s: 1e3 * cloth.fastest(),
        step_us: cloth.step_us(),
        picture: drawn.then(|| cloth.picture(&camera, Size::new(420, 320))),
    })
}

/// DC (%).
fn coefficient(piece: &SpecimenPiece, cloth: &DrapedCloth) -> f64 {
    let area = |places: &[glam::DVec3]| {
        let all = piece.faces.iter().flat_map(|f| {
            let [a, b, c, d] = f.map(|i| i as usize);
            let second = (f[3] != NO_VERTEX).then_some([a, c, d]);
            [Some([a, b, c]), second].into_iter().flatten()
        });
        shadow::area(places, all)
    };
    let flat: Vec<glam::DVec3> = piece.points.iter().map(|p| glam::DVec3::new(p.x, 0.0, p.y)).collect();
    let held: Vec<glam::DVec3> =
        piece.points.iter().map(|p| p.clamp_length_max(DISC_M)).map(|p| glam::DVec3::new(p.x, 0.0, p.y)).collect();
    let (disc, whole) = (area(&held), area(&flat));
    100.0 * (area(&cloth.places()) - disc) / (whole - disc)
}

/// The specimen at a spacing (m).
fn specimen(spacing: f64) -> SpecimenPiece {
    let (mut points, mut cells) = (Vec::new(), HashMap::new());
    let reach = (SPECIMEN_M / spacing).ceil() as i32;
    // So far from a ring that no triangle there is a sliver.
    let clear = |r: f64| [DISC_M - spacing, DISC_M, SPECIMEN_M].iter().all(|ring| (r - ring).abs() > 0.45 * spacing);
    for (i, j) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j))) {
        // Half a cell off the middle, so that the mesh is no mirror image of itself along a thread.
        let p = DVec2::new(f64::from(i) + 0.37, f64::from(j) + 0.21) * spacing;
        if p.length() < SPECIMEN_M && clear(p.length()) {
            cells.insert((i, j), points.len() as u32);
            points.push(p);
        }
    }
    for ring in [DISC_M - spacing, DISC_M, SPECIMEN_M] {
        let count = (TAU * ring / spacing).round();
        points.extend((0..count as u32).map(|k| DVec2::from_angle(TAU * f64::from(k) / count) * ring));
    }
    let held = points.iter().map(|p| p.length() < DISC_M + 1e-6).collect();
    let faces = faces(&points, &cells);
    SpecimenPiece { points, held, faces }
}

/// Quads where a cell has all its corners and no ring passes through it, Delaunay triangles elsewhere.
fn faces(points: &[DVec2], cells: &HashMap<(i32, i32), u32>) -> Vec<[u32; 4]> {
    let through = |corners: [u32; 4]| {
        let r = corners.map(|i| points[i as usize].length());
        let (least, most) = r.iter().fold((f64::MAX, 0.0), |(a, b): (f64, f64), r| (a.min(*r), b.max(*r)));
        [DISC_M, SPECIMEN_M].iter().any(|ring| least < *ring && *ring < most)
    };
    let corner = |i: i32, j: i32| cells.get(&(i, j)).copied();
    let mut quads = Vec::new();
    let mut keys: Vec<_> = cells.keys().copied().collect();
    keys.sort_unstable();
    let mut of_quad = std::collections::HashSet::new();
    for (i, j) in keys {
        let all = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        if let [Some(a), Some(b), Some(c), Some(d)] = all
            && !through([a, b, c, d])
        {
            // Cut down along -z: counter-clockwise seen from the front is clockwise in (x, z).
            quads.push([a, d, c, b]);
            let mut sorted = [a, b, c, d];
            sorted.sort_unstable();
            for left_out in 0..4 {
                let mut three: Vec<u32> = sorted.to_vec();
                three.remove(left_out);
                of_quad.insert([three[0], three[1], three[2]]);
            }
        }
    }
    for [a, b, c] in delaunay(points) {
        let mut sorted = [a, b, c];
        sorted.sort_unstable();
        let [pa, pb, pc] = [a, b, c].map(|i| points[i as usize]);
        if (pb - pa).perp_dot(pc - pa) > 1e-9 && !of_quad.contains(&sorted) {
            quads.push([a, c, b, NO_VERTEX]);
        }
    }
    quads
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_specimen_covers_its_circle_and_its_disc_is_held() {
        for spacing in [0.02, 0.01] {
            let piece = specimen(spacing);
            let places: Vec<glam::DVec3> = piece.points.iter().map(|p| glam::DVec3::new(p.x, 0.0, p.y)).collect();
            let all = piece.faces.iter().flat_map(|f| {
                let [a, b, c, d] = f.map(|i| i as usize);
                [Some([a, b, c]), (f[3] != NO_VERTEX).then_some([a, c, d])].into_iter().flatten()
            });
            let whole = std::f64::consts::PI * SPECIMEN_M * SPECIMEN_M;
            assert!((shadow::area(&places, all) / whole - 1.0).abs() < 0.01, "{spacing}");
            let on_disc = piece.points.iter().zip(&piece.held).filter(|(p, _)| p.length() < DISC_M + 1e-9);
            assert!(on_disc.clone().count() > 20 && on_disc.into_iter().all(|(_, held)| *held));
        }
    }

    #[test]
    fn cloth_that_does_not_bend_drapes_little_and_paper_hardly_at_all() {
        let of = |bend: f32| {
            let mut fabric = toile_assets::fabric::built_in("cotton-lawn").unwrap();
            (fabric.bend_warp_un_m, fabric.bend_weft_un_m) = (bend, bend);
            cusick(&fabric, 20.0, Quality::Shop, false).unwrap().drape_percent
        };
        let (limp, stiff) = (of(0.5), of(2_000.0));
        assert!(limp < 40.0 && stiff > 90.0, "{limp} and {stiff} %");
    }
}
