//! Cases of masses and stiffnesses far apart, with the two chains and the strand that others have published.

use glam::{Quat, Vec3};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::fabric::Fabric;
use toile_base::garment::{Garment, Part};
use toile_base::mesh::SkinWeights;
use toile_engine::cloth::Settings;

use super::outcome::TrialFindings;
use super::piece::{DAMPING_PER_S, PATCH, Piece, TOP, denim, sheet};
use super::pieces::Pieces;
use super::start::swung;
use super::trial::Trial;
use crate::random::CaseRandom;

/// Half of the decades between the lightest and the heaviest particle.
const HALF_DECADES: f32 = 2.5;

/// Gravity of the published chains (m/s2).
const G: f32 = 10.0;

/// Particles of a published chain.
const NODES: usize = 20;

/// Links of the Small Steps chain (m), and the mass of its particles (kg).
const LINK_M: f32 = 0.01;

/// How far the heavy chain may be from its length (m): what Macklin et al. 2019 reach with 100 substeps.
const PUBLISHED_M: f32 = 3.2;

/// Frame of the publications (s).
const FRAME_S: f32 = 1.0 / 60.0;

/// Weight that hangs from the top of the even chain: 19 particles of 1 kg (N).
const TOP_FORCE_N: f32 = 190.0;

/// Every particle another mass; at least one of the lightest and one of the heaviest.
pub(super) fn mass_ratio(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let mut shape = sheet(PATCH);
    let count = shape.cut.len();
    shape.heavier = (0..count).map(|_| random.decades(-HALF_DECADES, HALF_DECADES)).collect();
    let free = |random: &mut CaseRandom| PATCH[0] + random.below(count - PATCH[0]);
    let ends = [free(random), free(random)];
    shape.heavier[ends[0]] = 10f32.powf(-HALF_DECADES);
    shape.heavier[ends[1]] = 10f32.powf(HALF_DECADES);
    own(pieces, &shape, &denim(), random)
}

/// Threads one way 10,000 times stiffer than the other way.
pub(super) fn stiffness_ratio(pieces: &Pieces, random: &mut CaseRandom, seed: u64) -> TrialFindings {
    let soft = random.decades(1.0, 2.0);
    let stiff = soft * 1e4;
    let [warp, weft] = if seed.is_multiple_of(2) { [soft, stiff] } else { [stiff, soft] };
    let shear_n_m = random.decades(0.5, 3.0);
    let fabric = Fabric { stretch_warp_n_m: warp, stretch_weft_n_m: weft, shear_n_m, ..denim() };
    own(pieces, &sheet(PATCH), &fabric, random)
}

/// Swings a cloth of a seed's own and compares it with where it hangs.
fn own(pieces: &Pieces, shape: &Shape, fabric: &Fabric, random: &mut CaseRandom) -> TrialFindings {
    match Piece::new(shape, fabric, &pieces.settings) {
        Ok(piece) => TrialFindings::back(swung(pieces, &piece, &pieces.settings, random), &piece.rest),
        Err(error) => TrialFindings { miss: Some(error.to_string()), ..TrialFindings::default() },
    }
}

/// A chain as the engine can have it: a ribbon of two equal columns, each with half of every mass, without bending.
struct RibbonChain<'a> {
    /// Length of each link (m).
    links: &'a [f32],
    /// Mass of each particle but the first, which is held (kg).
    masses: &'a [f32],
    /// Force that would double a link (N), the same for all.
    force_n: f32,
    /// Where the chain starts to go from its first particle (unit).
    along: Vec3,
}

/// Width of the ribbons (m).
const RIBBON_M: f32 = 0.01;

impl RibbonChain<'_> {
    /// The garment; vertices row by row, two a row.
    fn garment(&self) -> Garment {
        let mut shape = Shape::default();
        let across = self.along.any_orthonormal_vector() * RIBBON_M;
        let mut reached = TOP;
        for row in 0..=self.links.len() {
            for side in [-0.5, 0.5] {
                let p = reached + across * side;
                shape.push(p, p, row == 0, Part::All);
                shape.weights.push(SkinWeights { bones: [0, 1, 0, 0], weights: [0.5, 0.5, 0.0, 0.0] });
            }
            reached += self.along * self.links.get(row).copied().unwrap_or(0.0);
        }
        let face = |row: u32| [2 * row, 2 * row + 1, 2 * row - 1, 2 * row - 2];
        shape.faces = (1..=self.links.len() as u32).map(face).collect();
        let fabric = Fabric {
            density_kg_m2: 1.0,
            stretch_warp_n_m: self.force_n / RIBBON_M,
            bend_warp_un_m: 0.0,
            bend_weft_un_m: 0.0,
            shear_n_m: 1.0,
            ..denim()
        };
        let even = bake("chain", "one", &shape, &fabric).expect("a straight ribbon can be baked");
        shape.heavier = vec![1.0; shape.cut.len()];
        for (&w, &v) in even.inverse_mass.iter().zip(&even.source).filter(|(w, _)| **w > 0.0) {
            shape.heavier[v as usize] = 0.5 * self.masses[v as usize / 2 - 1] * w;
        }
        bake("chain", "one", &shape, &fabric).expect("the same with other masses")
    }

    /// Where the particles of the garment hang at last: straight down, each link stretched by what hangs from it.
    fn rest(&self, garment: &Garment) -> Vec<Vec3> {
        let mut depth = vec![0.0f64];
        for (i, &link) in self.links.iter().enumerate() {
            let force: f64 = self.masses[i..].iter().map(|m| f64::from(*m) * f64::from(G)).sum();
            depth.push(depth[i] + f64::from(link) * (1.0 + force / f64::from(self.force_n)));
        }
        let top = |v: u32| garment.start[garment.source.iter().position(|s| s % 2 == v % 2 && *s < 2).unwrap_or(0)];
        garment.source.iter().map(|&v| top(v) - Vec3::Y * depth[v as usize / 2] as f32).collect()
    }
}

/// Length of the chain over its length as cut, and that of its first link (1).
fn stretched(trial: &Trial<'_>, links: &[f32]) -> [f32; 2] {
    let at = |row: usize| {
        let of = |(i, v): (usize, &u32)| (*v as usize / 2 == row).then(|| Vec3::from(trial.cloth.positions[i]));
        trial.garment.source.iter().enumerate().filter_map(of).sum::<Vec3>() * 0.5
    };
    let rows: Vec<Vec3> = (0..=links.len()).map(at).collect();
    let lengths: Vec<f32> = rows.windows(2).map(|w| w[0].distance(w[1])).collect();
    [lengths.iter().sum::<f32>() / links.iter().sum::<f32>(), lengths[0] / links[0]]
}

fn settings(pieces: &Pieces, substeps: Option<u32>) -> Settings {
    Settings { gravity: Vec3::new(0.0, -G, 0.0).into(), step_seconds: FRAME_S, substeps, ..pieces.settings }
}

/// The Small Steps chain (Macklin et al. 2019): 100 substeps a frame, the last particle 100,000 times heavier.
pub(super) fn heavy_chain(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let links = [LINK_M; NODES - 1];
    let mut masses = [1.0; NODES - 1];
    masses[NODES - 2] = 1e5;
    let along = Quat::from_axis_angle(random.direction(), random.between(0.0, 0.3)) * Vec3::NEG_Y;
    let chain = RibbonChain { links: &links, masses: &masses, force_n: f32::INFINITY, along };
    let garment = chain.garment();
    let mut trial = Trial::new(pieces, &garment, &settings(pieces, Some(100)));
    let length = LINK_M * links.len() as f32;
    let mut off = 0.0f32;
    // Eight seconds: a free fall of 320 m, which is what 100 iterations come to.
    for _ in 0..(8.0 / FRAME_S) as usize {
        trial.step();
        off = off.max((stretched(&trial, &links)[0] - 1.0).abs() * length);
    }
    let mut found = TrialFindings::back(trial, &chain.rest(&garment));
    found.note = format!("at most {:.3} mm off its length", off * 1e3);
    found.miss = (off >= PUBLISHED_M).then(|| format!("{off:.2} m off its length, {PUBLISHED_M} m are published"));
    found
}

/// The same with particles of 1 kg and links that give 2 % under 190 N: its top link says what it carries.
pub(super) fn even_chain(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    let links = [LINK_M; NODES - 1];
    let along = Quat::from_axis_angle(random.direction(), random.between(0.0, 1.0)) * Vec3::NEG_Y;
    let chain = RibbonChain { links: &links, masses: &[1.0; NODES - 1], force_n: TOP_FORCE_N / 0.02, along };
    let garment = chain.garment();
    let mut trial = Trial::new(pieces, &garment, &settings(pieces, None));
    let recovery = trial.recover(&chain.rest(&garment));
    let force = (stretched(&trial, &links)[1] - 1.0) * chain.force_n;
    let mut found = TrialFindings { recovery: Some(recovery), ..TrialFindings::of(&trial) };
    found.note = format!("{force:.2} N at the top, {TOP_FORCE_N} N expected");
    found.miss = ((force / TOP_FORCE_N - 1.0).abs() > 0.02).then(|| found.note.clone());
    found
}

/// The strand of the TinyVBD experiment, let go 30 degrees above the horizontal: 19 springs of 1e8 N/m, 18 of 5 cm and
/// the last of 10 cm, with 1,000 kg at the end.
pub(super) fn strand(pieces: &Pieces, random: &mut CaseRandom, _: u64) -> TrialFindings {
    const SPRING_N_M: f32 = 1e8;
    /// Greatest mean strain of the first swing, and at rest (1).
    const ALLOWED: [f32; 2] = [0.02, 0.005];
    let mut links = [0.05; NODES - 1];
    links[NODES - 2] = 0.1;
    let mut masses = [1.0; NODES - 1];
    masses[NODES - 2] = 1_000.0;
    let level = Quat::from_rotation_y(random.between(-3.0, 3.0)) * Vec3::X;
    let along = level * 0.75f32.sqrt() + Vec3::Y * 0.5;
    let chain = RibbonChain { links: &links, masses: &masses, force_n: SPRING_N_M * 0.05, along };
    // A spring of twice the length is to be as stiff as the others, not half as stiff.
    let [short, long] = [0.05, 0.1].map(|l| l / (0.5 * chain.force_n));
    let (mut data, mut layout) = chain.garment().into_parts();
    let soft = layout.fibers.compliance.iter_mut().filter(|c| (**c / long - 1.0).abs() < 0.1);
    soft.for_each(|c| *c = short);
    data.fabric.damping_per_s = 0.0;
    let garment = Garment::new(data, layout).expect("a compliance moves no constraint");
    let settings = settings(pieces, None);
    let mut trial = Trial::new(pieces, &garment, &settings);
    let mut peak = 0.0f32;
    for _ in 0..(1.5 / FRAME_S) as usize {
        trial.step();
        peak = peak.max(stretched(&trial, &links)[0] - 1.0);
    }
    let mut calm = garment.clone();
    calm.fabric_mut().damping_per_s = DAMPING_PER_S;
    trial.garment = &calm;
    let mut rest = chain.rest(&calm);
    // The last spring gives half as much as its length would let it.
    let less = 0.1 * G * masses[NODES - 2] / chain.force_n * 0.5;
    rest.iter_mut().zip(&calm.source).filter(|(_, v)| **v as usize / 2 == NODES - 1).for_each(|(p, _)| p.y += less);
    let recovery = trial.recover(&rest);
    let still = stretched(&trial, &links)[0] - 1.0;
    let mut found = TrialFindings { recovery: Some(recovery), ..TrialFindings::of(&trial) };
    found.note = format!("strain {:.2} % in the first swing, {:.3} % at rest", peak * 100.0, still * 100.0);
    found.miss = (peak > ALLOWED[0] || still > ALLOWED[1]).then(|| found.note.clone());
    found
}
