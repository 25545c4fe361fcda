//! A tablecloth over a rectangular table, at five samplings, with and without the models of links and of friction.
//!
//! As in the MIRAGES report (INRIA 2006, 5.3.3): cloth laid level and out of the middle on a rectangular table is let go; e is the
//! mean distance of each particle to the same point of the cloth in another sampling. There it was a real cloth, whose sheet is not
//! published; here it is this engine's finest. The engine's solids are planes without end and cones, so the table's edge is a frame of
//! four capsules, and what lies within the frame is held, as weight and friction would hold it.

use glam::{DVec2, DVec3, Vec3};
use serde::Serialize;
use toile_base::fabric::Fabric;
use toile_engine::cloth::Quality;
use toile_engine::colliders::{Colliders, RestSphere};
use toile_view::image::{Image, Size};
use toile_view::scene::OrbitCamera;

use super::cloth::{DrapeError, DrapedCloth, SpecimenPiece};

/// Distances of particles (cm) with the published distance to a real cloth (cm); the last is what the others are held against.
const SAMPLINGS: [(f64, f64); 5] = [(5.0, 3.01), (2.0, 1.42), (1.0, 0.90), (0.5, 0.82), (0.4, 0.79)];

/// Corners of the cloth, and of what lies on the table (m): no two sides hang equally far.
const CLOTH_M: [DVec2; 2] = [DVec2::new(-0.5, -0.4), DVec2::new(0.6, 0.5)];
const TABLE_M: [DVec2; 2] = [DVec2::new(-0.3, -0.2), DVec2::new(0.3, 0.2)];

/// Radius of the table's edge (m).
const EDGE_M: f64 = 0.02;

/// Damping of the cloth's motion, for it to come to rest (1/s).
const DAMPING_PER_S: f32 = 6.0;

/// How long the published run was, and when this one rests (s).
const SEEN_S: [f64; 2] = [1.92, 6.0];

/// What a run has of friction and buckling.
pub const VARIANTS: [&str; 4] = ["plain", "friction", "buckling", "both"];

/// A sampling of a variant.
#[derive(Debug, Clone, Serialize)]
pub struct TableclothRow {
    /// Which of [`VARIANTS`] it is.
    pub variant: &'static str,
    /// Distance of its particles (cm).
    pub spacing_cm: f64,
    /// Particles of the cloth.
    pub particles: usize,
    /// e after the published time and at rest: mean over all its particles (cm).
    pub error_cm: [f64; 2],
    /// The same over those that hang (cm).
    pub hanging_cm: [f64; 2],
    /// Largest at rest (cm).
    pub max_cm: f64,
    /// The published e, to a real cloth (cm).
    pub published_cm: f64,
    /// Speed of the fastest particle at rest (mm/s).
    pub fastest_mm_s: f64,
    /// Median time of a step (us), and of the whole run (s).
    pub step_us: f64,
    /// Time of the run (s).
    pub seconds: f64,
    /// From above and before, at rest.
    #[serde(skip)]
    pub picture: Option<Image>,
}

/// A run of all samplings.
#[derive(Debug, Clone, Serialize)]
pub struct TableclothStudy {
    /// What cloth on what table.
    pub setup: String,
    /// Rows, variant after variant, coarsest first.
    pub rows: Vec<TableclothRow>,
}

/// A sampling as it was seen.
struct Run {
    cells: [usize; 2],
    seen: [Vec<DVec3>; 2],
    row: TableclothRow,
}

/// Runs the samplings not finer than `finest_cm` in some variants of a fabric, and calls `each` with each as it is done.
///
/// # Errors
/// A cloth that cannot be baked.
pub fn tablecloth(
    fabric: &Fabric,
    variants: &[&'static str],
    finest_cm: f64,
    each: &mut dyn FnMut(&str),
) -> Result<TableclothStudy, DrapeError> {
    let mut rows = Vec::new();
    for &variant in variants {
        let mut runs = Vec::new();
        for (spacing_cm, published_cm) in SAMPLINGS.into_iter().filter(|s| s.0 >= finest_cm - 1e-9) {
            runs.push(run(&of_variant(fabric, variant), variant, spacing_cm, published_cm)?);
            each(&format!("{variant}, {spacing_cm} cm"));
        }
        let Some(finest) = runs.last().map(|run| (run.cells, run.seen.clone())) else { continue };
        rows.extend(runs.into_iter().map(|run| measured(run, &finest)));
    }
    let setup = format!(
        "{} of 1.1 m x .9 m on a table of {:.2} m x {:.2} m, {EDGE_M} m of edge radius, out of the middle; quality shop. e: \
         mean distance to the finest sampling of the same variant. The published figures are to a real cloth.",
        fabric.title,
        TABLE_M[1].x - TABLE_M[0].x + 2.0 * EDGE_M,
        TABLE_M[1].y - TABLE_M[0].y + 2.0 * EDGE_M
    );
    Ok(TableclothStudy { setup, rows })
}

/// The fabric with what a variant has of friction in bending, shear and stretch, and of buckling.
fn of_variant(fabric: &Fabric, variant: &str) -> Fabric {
    let mut fabric = fabric.clone();
    fabric.damping_per_s = DAMPING_PER_S;
    fabric.buckling = matches!(variant, "buckling" | "both");
    if !matches!(variant, "friction" | "both") {
        fabric.hysteresis = Default::default();
    }
    fabric
}

fn run(fabric: &Fabric, variant: &'static str, spacing_cm: f64, published_cm: f64) -> Result<Run, DrapeError> {
    let spacing = 0.01 * spacing_cm;
    let size = CLOTH_M[1] - CLOTH_M[0];
    let cells = [size.x, size.y].map(|side| (side / spacing).round() as usize);
    let mut cloth = DrapedCloth::new(&piece(cells, spacing), fabric, table(fabric)?, Quality::Shop)?;
    let begun = std::time::Instant::now();
    let seen = SEEN_S.map(|seconds| {
        cloth.run_to(seconds);
        cloth.places()
    });
    let seconds = begun.elapsed().as_secs_f64();
    let camera =
        OrbitCamera { target: Vec3::new(0.05, -0.1, 0.05), yaw: 0.6, height: 0.75, distance: 2.6, fov_y: 0.42 };
    let row = TableclothRow {
        variant,
        spacing_cm,
        particles: cloth.garment.particles(),
        error_cm: [0.0; 2],
        hanging_cm: [0.0; 2],
        max_cm: 0.0,
        published_cm,
        fastest_mm_s: 1e3 * cloth.fastest(),
        step_us: cloth.step_us(),
        seconds,
        picture: Some(cloth.picture(&camera, Size::new(560, 400))),
    };
    Ok(Run { cells, seen, row })
}

/// The cloth as cut, row after row.
fn piece([columns, rows]: [usize; 2], spacing: f64) -> SpecimenPiece {
    let (mut points, mut held) = (Vec::new(), Vec::new());
    for (r, c) in (0..=rows).flat_map(|r| (0..=columns).map(move |c| (r, c))) {
        let p = CLOTH_M[0] + DVec2::new(c as f64, r as f64) * spacing;
        let near = DVec2::splat(1e-6);
        held.push(p.cmpge(TABLE_M[0] - near).all() && p.cmple(TABLE_M[1] + near).all());
        points.push(p);
    }
    let at = |r: usize, c: usize| (r * (columns + 1) + c) as u32;
    let cell = |(r, c): (usize, usize)| [at(r + 1, c), at(r + 1, c + 1), at(r, c + 1), at(r, c)];
    let faces = (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))).map(cell).collect();
    SpecimenPiece { points, held, faces }
}

/// The table's edge.
fn table(fabric: &Fabric) -> Result<Colliders, DrapeError> {
    let below = -(EDGE_M as f32 + fabric.contact_offset_mm * 1e-3);
    let [low, high] = TABLE_M.map(DVec2::as_vec2);
    let corners = [[low.x, low.y], [high.x, low.y], [high.x, high.y], [low.x, high.y]];
    let spheres = corners.map(|[x, z]| RestSphere { bone: 0, centre: Vec3::new(x, below, z), radius: EDGE_M as f32 });
    let mut colliders = Colliders::new(&spheres, &[[0, 1], [1, 2], [2, 3], [3, 0]], false)?;
    colliders.place_spheres(&spheres.map(|s| s.centre.extend(s.radius)));
    Ok(colliders)
}

/// The row with its distances to the finest sampling.
fn measured(run: Run, (finest, fine): &([usize; 2], [Vec<DVec3>; 2])) -> TableclothRow {
    let Run { cells: [columns, rows], seen, mut row } = run;
    for (k, (x, fine)) in seen.iter().zip(fine).enumerate() {
        let (mut all, mut hanging, mut count, mut max) = (0.0, 0.0, 0usize, 0.0f64);
        for (i, x) in x.iter().enumerate() {
            let part =
                DVec2::new((i % (columns + 1)) as f64 / columns as f64, (i / (columns + 1)) as f64 / rows as f64);
            let d = 100.0 * x.distance(between(*finest, fine, part));
            let p = CLOTH_M[0] + part * (CLOTH_M[1] - CLOTH_M[0]);
            all += d;
            max = max.max(d);
            if p.cmplt(TABLE_M[0]).any() || p.cmpgt(TABLE_M[1]).any() {
                (hanging, count) = (hanging + d, count + 1);
            }
        }
        row.error_cm[k] = all / x.len().max(1) as f64;
        row.hanging_cm[k] = hanging / count.max(1) as f64;
        row.max_cm = max;
    }
    row
}

/// Where a point of the cloth, given as parts of its sides, is in a sampling: between the four nearest particles.
fn between([columns, rows]: [usize; 2], x: &[DVec3], part: DVec2) -> DVec3 {
    let at = part * DVec2::new(columns as f64, rows as f64);
    let low = at.floor().min(DVec2::new(columns as f64 - 1.0, rows as f64 - 1.0));
    let (c, r, t) = (low.x as usize, low.y as usize, at - low);
    let p = |r: usize, c: usize| x[r * (columns + 1) + c];
    p(r, c).lerp(p(r, c + 1), t.x).lerp(p(r + 1, c).lerp(p(r + 1, c + 1), t.x), t.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_between_four_is_between_them_and_the_finest_is_no_way_from_itself() {
        let x: Vec<DVec3> = (0..12).map(|i| DVec3::new(f64::from(i % 4), f64::from(i / 4), 0.0)).collect();
        assert!(between([3, 2], &x, DVec2::new(0.5, 0.25)).distance(DVec3::new(1.5, 0.5, 0.0)) < 1e-12);
        assert_eq!(between([3, 2], &x, DVec2::ONE), DVec3::new(3.0, 2.0, 0.0));
    }

    #[test]
    fn a_coarse_tablecloth_hangs_over_its_table() {
        let fabric = toile_assets::fabric::built_in("cotton-broad").unwrap();
        let study = tablecloth(&fabric, &["plain", "both"], 5.0, &mut |_| ()).unwrap();
        assert_eq!(study.rows.len(), 2);
        for row in study.rows {
            assert!(row.error_cm.iter().all(|e| *e < 1e-9) && row.fastest_mm_s.is_finite(), "{row:?}");
        }
    }
}
