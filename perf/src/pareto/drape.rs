//! The drape study: one tablecloth in four samplings, each held against the finest.
//!
//! The engine's solids are planes without end and cones, so the table is a square frame of four capsules, its rounded
//! edge; what lies within the frame is held flat, as weight and friction would hold it. The cloth starts flat and falls.
//! Every coarse particle is one of the fine ones, and distances are between those alone that hang.

use glam::{DVec3, Vec3};
use toile_bake::Shape;
use toile_base::garment::Part;
use toile_base::mesh::SkinWeights;
use toile_engine::cloth::Quality;
use toile_engine::colliders::{Colliders, RestSphere};

use super::error::ParetoError;
use super::meshed_scene::{MeshedScene, ReferenceKind, SceneMotion, SolverChoice};
use super::play::{Setting, play};
use super::report::{Drape, Sampling};

/// Cells a side of the cloth, with the published distance to a real cloth (cm) (INRIA MIRAGES 2006).
const SAMPLINGS: [(usize, f64); 4] = [(20, 3.01), (50, 1.42), (100, 0.90), (200, 0.82)];

/// Side of the cloth, half the side of what lies flat, radius of the table's edge (m).
const CLOTH_M: f64 = 1.0;
const HELD_M: f64 = 0.2;
const EDGE_M: f64 = 0.02;

/// Damping of the cloth's motion, for it to come to rest (1/s), and the time that it gets (s).
const DAMPING_PER_S: f32 = 6.0;
const SECONDS: [f64; 2] = [1.5, 3.0];

/// The study; a quick one leaves the finest sampling out.
pub fn study(quick: bool, progress: &dyn Fn(f64)) -> Result<Drape, ParetoError> {
    let samplings = &SAMPLINGS[..if quick { 3 } else { 4 }];
    // A step costs by its particles and more, so nearly all of the work is the last.
    let work = |upto: usize| samplings[..upto].iter().map(|(n, _)| (n * n) as f64).sum::<f64>();
    let mut runs = Vec::new();
    for (k, (cells, _)) in samplings.iter().enumerate() {
        progress(work(k) / work(samplings.len()));
        let subject = tablecloth(*cells, SECONDS[usize::from(!quick)])?;
        let garment = subject.bake(SolverChoice::Mixed)?;
        let run = play(&subject, &garment, Setting { quality: Quality::Shop, substeps: None, threads: 1 })?;
        runs.push((*cells, run));
    }
    let (finest, fine) = runs.last().map(|(n, run)| (*n, run.frames.last())).unwrap_or_default();
    let samplings = runs.iter().zip(samplings).map(|((cells, run), (_, published))| {
        let [mean_cm, max_cm] = match (run.frames.last(), fine) {
            (Some(x), Some(fine)) => apart_cm((*cells, x), (finest, fine)),
            _ => [0.0; 2],
        };
        Sampling {
            spacing_cm: 100.0 * CLOTH_M / *cells as f64,
            particles: (cells + 1).pow(2),
            mean_cm,
            max_cm,
            published_cm: Some(*published),
            step_us: run.step_us,
            fastest_mm_s: 1e3 * run.fastest_m_s,
        }
    });
    Ok(Drape { setup: setup(finest), samplings: samplings.collect() })
}

fn setup(finest: usize) -> String {
    format!(
        "A cotton lawn of {CLOTH_M} m x {CLOTH_M} m on a square table of {} m x {} m with an edge of {} cm radius, in \
         the quality shop. Its mean is the distance to the same engine's cloth at {} cm; the published figures are \
         distances to a real cloth, which hold a model's error as well: the two columns are not the same measure.",
        2.0 * (HELD_M + EDGE_M),
        2.0 * (HELD_M + EDGE_M),
        100.0 * EDGE_M,
        100.0 * CLOTH_M / finest as f64
    )
}

/// Where a particle of the flat cloth is along one side (m).
fn along(cells: usize, k: usize) -> f64 {
    CLOTH_M * (k as f64 / cells as f64 - 0.5)
}

fn held(cells: usize, row: usize, column: usize) -> bool {
    let within = |k: usize| along(cells, k).abs() <= HELD_M + 1e-6;
    within(row) && within(column)
}

fn tablecloth(cells: usize, seconds: f64) -> Result<MeshedScene, ParetoError> {
    let mut shape = Shape::default();
    for row in 0..=cells {
        for column in 0..=cells {
            let (x, z) = (along(cells, column) as f32, along(cells, row) as f32);
            shape.push(Vec3::new(x, -z, 0.0), Vec3::new(x, 0.0, z), held(cells, row, column), Part::All);
            shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
        }
    }
    let at = |row: usize, column: usize| (row * (cells + 1) + column) as u32;
    for row in 0..cells {
        for column in 0..cells {
            shape.faces.push([at(row + 1, column), at(row + 1, column + 1), at(row, column + 1), at(row, column)]);
        }
    }
    let mut fabric = toile_assets::fabric::built_in("cotton-lawn")?;
    fabric.damping_per_s = DAMPING_PER_S;
    let below = -(EDGE_M as f32 + fabric.contact_offset_mm * 1e-3);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let sphere = |[x, z]: [f64; 2]| RestSphere {
        bone: 0,
        centre: Vec3::new((x * HELD_M) as f32, below, (z * HELD_M) as f32),
        radius: EDGE_M as f32,
    };
    let spheres = corners.map(sphere);
    let mut colliders = Colliders::new(&spheres, &[[0, 1], [1, 2], [2, 3], [3, 0]], false)?;
    let placed = spheres.map(|s| s.centre.extend(s.radius));
    colliders.place_spheres(&placed);
    Ok(MeshedScene {
        scene: "drape",
        mesh: format!("{cells} x {cells}"),
        main: true,
        shape,
        fabric,
        drive: SceneMotion::Still,
        colliders,
        seconds,
        truth: ReferenceKind::Trajectory,
    })
}

/// Mean and largest distance of what hangs of a coarse cloth to the same particles of a fine one (cm).
fn apart_cm((coarse, x): (usize, &Vec<DVec3>), (fine, star): (usize, &Vec<DVec3>)) -> [f64; 2] {
    let every = fine / coarse;
    let (mut sum, mut most, mut count) = (0.0, 0.0f64, 0usize);
    for row in 0..=coarse {
        for column in (0..=coarse).filter(|c| !held(coarse, row, *c)) {
            let there = star[row * every * (fine + 1) + column * every];
            let d = x[row * (coarse + 1) + column].distance(there);
            (sum, most, count) = (sum + d, most.max(d), count + 1);
        }
    }
    [100.0 * sum / count.max(1) as f64, 100.0 * most]
}
