//! The table of targets: every row run on one machine in one go, each with what was asked, what was got, and what the
//! peers reach. A row that is missed, or cannot be run, stops nothing.

use std::fmt::Write;

use serde::Serialize;
use toile_assets::scene::skirt::{SkirtMotion, Stretch};
use toile_bake::Shape;
use toile_engine::lanes::Width;
use toile_fitting::heap::HeapProbe;
use toile_gpu::backend::Backends;

use super::claim::{Claim, TargetRow};
use super::error::SkirtError;
use super::hard::{self, SkirtFault, SkirtRecovery};
use super::measure::measure_with;
use super::options::{SkirtMesh, SkirtOptions};
use super::report::SkirtReport;

/// All cases with their targets.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TargetTable {
    /// Targets that were met, and how many there are.
    pub met: [usize; 2],
    /// A row a target.
    pub rows: Vec<TargetRow>,
    /// The runs they come from.
    pub runs: Vec<CaseFigures<SkirtReport>>,
    /// The faults they come from.
    pub faults: Vec<CaseFigures<SkirtRecovery>>,
}

/// Figures and what they are of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseFigures<T> {
    /// Name of the case.
    pub case: String,
    /// The figures of the case.
    #[serde(flatten)]
    pub figures: T,
}

/// Runs all rows with the runs, steps, quality and substeps of `base`; `progress` is given what is being run.
pub fn run(base: &SkirtOptions, heap: &HeapProbe, progress: &mut dyn FnMut(&str)) -> TargetTable {
    let mut maker = TableRun { base: *base, heap, progress, rows: Vec::new(), runs: Vec::new(), faults: Vec::new() };
    maker.one_thread();
    maker.sizes();
    maker.threads();
    maker.settled();
    maker.contact_and_memory();
    maker.physical();
    maker.faults();
    maker.stable();
    let met = maker.rows.iter().filter(|r| r.met).count();
    TargetTable { met: [met, maker.rows.len()], rows: maker.rows, runs: maker.runs, faults: maker.faults }
}

type RowResult<T> = Result<T, String>;

struct TableRun<'a> {
    base: SkirtOptions,
    heap: &'a HeapProbe,
    progress: &'a mut dyn FnMut(&str),
    rows: Vec<TargetRow>,
    runs: Vec<CaseFigures<SkirtReport>>,
    faults: Vec<CaseFigures<SkirtRecovery>>,
}

impl TableRun<'_> {
    /// A run of the case, or the one made before.
    fn measured(&mut self, case: &str, change: impl FnOnce(&mut SkirtOptions)) -> RowResult<SkirtReport> {
        self.measured_with(case, change, |_| {})
    }

    fn measured_with(
        &mut self,
        case: &str,
        change: impl FnOnce(&mut SkirtOptions),
        reshape: impl FnOnce(&mut Shape),
    ) -> RowResult<SkirtReport> {
        if let Some(run) = self.runs.iter().find(|r| r.case == case) {
            return Ok(run.figures.clone());
        }
        (self.progress)(case);
        let mut options = self.base;
        change(&mut options);
        let report = measure_with(&Backends::open(options.backend), &options, self.heap, reshape)
            .map_err(|e: SkirtError| e.to_string())?;
        self.runs.push(CaseFigures { case: case.into(), figures: report.clone() });
        Ok(report)
    }

    fn walk(&mut self) -> RowResult<SkirtReport> {
        self.measured("walk", |_| {})
    }

    fn fast(&mut self) -> RowResult<SkirtReport> {
        self.measured("fast", |o| o.motion = SkirtMotion::Fast)
    }

    fn row<T>(&mut self, case: &str, peers: &str, of: &RowResult<T>, claims: impl Fn(&T) -> Vec<Claim>) {
        self.rows.push(TargetRow::new(case, peers, of.as_ref().map(claims)));
    }

    fn one_thread(&mut self) {
        let widths = [(16, 0.7, Width::Sixteen), (8, 1.0, Width::Eight), (4, 2.0, Width::Four)];
        for (lanes, most, width) in widths {
            let run = self.measured(&format!("walk, {lanes} lanes"), |o| o.lanes = Some(width));
            let peers = "NvCloth 1.15 Y at 5.1 / 47 %, 5.3 Y at 1.2 / 9.9 %";
            self.row(&format!("4,096 vertices, walk, one thread, {lanes} lanes"), peers, &run, |r| {
                timed(r, most, [0.2, 2.0])
            });
        }
        let run = self.measured("walk with wind", |o| o.wind = true);
        self.row("the same with wind", "NvCloth 2.4 Y and 12 Y", &run, |r| timed(r, 0.9, [0.2, 2.0]));
        let run = self.measured("walk, irregular", |o| o.mesh = SkirtMesh::Irregular);
        self.row("a skirt of as many vertices meshed irregularly", "", &run, |r| timed(r, 1.2, [0.4, 4.0]));
        let run = self.fast();
        self.row("fast motion", "NvCloth 5.0 / 38 % at 7.2 Y", &run, |r| {
            let mut claims = timed(r, 1.0, [1.0, 10.0]);
            claims.push(Claim::count("frames in which the hem is not around each leg", r.hem_winding_wrong));
            claims
        });
    }

    fn sizes(&mut self) {
        let sizes = [1_024, 4_096, 16_384].map(|verts| {
            self.measured(&if verts == 4_096 { "walk".into() } else { format!("walk, {verts} vertices") }, |o| {
                o.verts = verts;
            })
        });
        let sizes: RowResult<Vec<SkirtReport>> = sizes.into_iter().collect();
        let peers = "NvCloth: strain grows 4 times";
        self.row("1,024 to 16,384 vertices, substeps chosen by the bake", peers, &sizes, |runs| {
            let strain = |r: &SkirtReport| Claim::percent(&format!("strain mean at {}", r.verts), r.strain.mean, 0.2);
            let times = runs.iter().map(|r| r.ns_per_vertex);
            let (most, least) = (times.clone().fold(0.0, f64::max), times.fold(f64::MAX, f64::min));
            let spread = Claim::most("time a vertex, greatest over least", most / least, 1.6, "");
            runs.iter().map(strain).chain([spread]).collect()
        });
    }

    fn threads(&mut self) {
        let alone = self.measured("walk, 16384 vertices", |o| o.verts = 16_384);
        let both = self.measured("walk, 16384 vertices, two threads", |o| (o.verts, o.threads) = (16_384, 2));
        self.row("16,384 vertices on two threads", "NvCloth cannot; Jolt .58", &pair(alone, both), |r| {
            part_of(r, 0.65)
        });
        let alone = self.measured("walk, two skirts", |o| o.garments = 2);
        let both = self.measured("walk, two skirts, two threads", |o| (o.garments, o.threads) = (2, 2));
        self.row("two garments on two threads", "NvCloth .52", &pair(alone, both), |r| part_of(r, 0.52));
    }

    fn settled(&mut self) {
        for (name, stretch) in [("inextensible", Stretch::Inextensible), ("2,000 N/m", Stretch::Physical)] {
            let run =
                self.measured(&format!("settled, {name}"), |o| (o.motion, o.stretch) = (SkirtMotion::Settled, stretch));
            self.row(&format!("settled, {name}"), "NvCloth .14 / 4.3 %", &run, |r| {
                let mean = Claim::percent("strain mean beyond the exact elastic", r.strain.beyond_elastic_mean, 0.05);
                vec![mean, Claim::percent("max", r.strain.beyond_elastic_max, 0.5)]
            });
        }
        let energies = [2, 4, 8, 16, 32].map(|substeps| {
            self.measured(&format!("settled, {substeps} substeps"), |o| {
                (o.motion, o.substeps) = (SkirtMotion::Settled, Some(substeps));
            })
        });
        let energies: RowResult<Vec<SkirtReport>> = energies.into_iter().collect();
        self.row("settled: energy of motion at any substep count", "", &energies, |runs| {
            let claim =
                |r: &SkirtReport| Claim::most(&format!("{} substeps", r.substeps), r.kinetic_energy_max_mj, 1.0, " mJ");
            runs.iter().map(claim).collect()
        });
    }

    fn contact_and_memory(&mut self) {
        let runs = pair(self.walk(), self.fast());
        self.row("penetration, walk and fast", "Bullet: 20-35 % of vertices inside", &runs, |runs| {
            let of = |r: &SkirtReport| {
                let depth = Claim::most(&format!("{}: deepest", r.motion), r.penetration_mm.max, 1.0, " mm");
                [depth, Claim::count("left inside at the end of a run", r.penetration_mm.left_inside)]
            };
            runs.iter().flat_map(of).collect()
        });
        let run = self.walk();
        self.row("memory and allocations, 4,096 vertices", "NvCloth .40 MB, 0", &run, |r| {
            let memory = r.memory_bytes.map_or(f64::NAN, |b| b as f64 * 1e-6);
            let allocations = Claim::most("allocations a step", r.allocations_per_step.unwrap_or(f64::NAN), 0.0, "");
            vec![Claim::most("memory", memory, 0.5, " MB"), allocations]
        });
    }

    fn physical(&mut self) {
        let physical = |o: &mut SkirtOptions| o.stretch = Stretch::Physical;
        let run = self.measured("walk, 2,000 N/m", physical);
        self.row("walk with 2,000 N/m", "", &run, |r| timed(r, 0.7, [0.2, 2.0]));
        let run = self.measured("fast, 2,000 N/m", |o| (o.motion, o.stretch) = (SkirtMotion::Fast, Stretch::Physical));
        self.row("fast with 2,000 N/m", "", &run, |r| timed(r, 1.0, [1.0, 10.0]));
    }

    fn faults(&mut self) {
        let mut recovered = |case: &str, fault| {
            (self.progress)(case);
            let found = hard::recover(&self.base, fault, self.heap).map_err(|e| e.to_string())?;
            self.faults.push(CaseFigures { case: case.into(), figures: found });
            Ok(found)
        };
        let jump = recovered("a leg jumps 1 m and back", SkirtFault::Jump);
        let kinds = [
            ("collider", SkirtFault::Collider as fn(f32) -> SkirtFault),
            ("particle", SkirtFault::Particle),
            ("pin", SkirtFault::Pin),
        ];
        let values = [("NaN", f32::NAN), ("infinite", f32::INFINITY)];
        let mut found = Vec::new();
        for (kind, fault) in kinds {
            for (name, value) in values {
                let case = format!("one {name} {kind} for a frame");
                found.push((recovered(&case, fault(value)), case));
            }
        }
        let peers = "NvCloth 7,366 % that frame, 1,031 % two seconds later";
        self.row("a leg that jumps 1 m in one frame and back", peers, &jump, |r| {
            let time = Claim::most("back at its baseline after", r.recovered_steps as f64 / 120.0, 0.5, " s");
            vec![time, Claim::percent("worst stretch", r.worst_stretch, 100.0)]
        });
        for (outcome, case) in found {
            self.row(&case, "NvCloth: 43 % of the vertices for good; Jolt 100 %", &outcome, |r| {
                let steps = Claim::most("recovered after", r.recovered_steps as f64, 2.0, " steps");
                vec![Claim::count("vertices not finite", r.nonfinite as u64), steps]
            });
        }
    }

    fn stable(&mut self) {
        let run = self.measured("walk, 30 Hz", |o| o.step_s = 1.0 / 30.0);
        self.row("dt = 1/30", "", &run, steady);
        let run = self.measured_with("walk, patches 1:1000", |_| {}, hard::patches);
        self.row("mass patches 1:1000", "", &run, steady);
        let run = self.measured_with("walk, hem 1000 times heavier", |_| {}, hard::heavy_hem);
        self.row("a hem 1,000 times heavier", "", &run, steady);
    }
}

fn pair(a: RowResult<SkirtReport>, b: RowResult<SkirtReport>) -> RowResult<[SkirtReport; 2]> {
    Ok([a?, b?])
}

/// Time, strain mean and 99th percentile (%) at most.
fn timed(r: &SkirtReport, y: f64, [mean, p99]: [f64; 2]) -> Vec<Claim> {
    let time = Claim::most("time", r.y_ratio, y, " Y");
    vec![time, Claim::percent("strain mean", r.strain.mean, mean), Claim::percent("p99", r.strain.p99, p99)]
}

fn part_of([alone, both]: &[SkirtReport; 2], most: f64) -> Vec<Claim> {
    vec![Claim::most("of the time on one", both.step_us.p50 / alone.step_us.p50, most, "")]
}

/// Stable: nothing is lost, and strain does not grow from the first run to the last; the figures are reported.
fn steady(r: &SkirtReport) -> Vec<Claim> {
    let [first, last] = [r.strain.run_mean.first(), r.strain.run_mean.last()].map(|x| x.copied().unwrap_or(f64::NAN));
    let unbounded = |what, got| Claim::percent(what, got, f64::INFINITY);
    vec![
        Claim::count("vertices not finite", r.nonfinite),
        Claim::count("steps taken back", r.events.rolled_back),
        Claim::most("strain of the last run over the first's", last / first, 1.5, ""),
        unbounded("strain mean", r.strain.mean),
        unbounded("p99", r.strain.p99),
        unbounded("worst stretch", r.strain.max),
    ]
}

impl TargetTable {
    /// The table as Markdown, and below it the figures of each run.
    pub fn markdown(&self) -> String {
        let mut text = String::from("| case | target | got | met | peers |\n|---|---|---|---|---|\n");
        // Writing to a string cannot fail.
        for TargetRow { case, target, got, met, peers } in &self.rows {
            let met = if *met { "yes" } else { "**no**" };
            let _ = writeln!(text, "| {case} | {target} | {got} | {met} | {peers} |");
        }
        text.push_str(
            "\n| run | us p50 / p99 | Y | substeps, lanes | strain mean / p99 / max % | deepest mm | MB | hash |\n",
        );
        text.push_str("|---|---|---|---|---|---|---|---|\n");
        for CaseFigures { case, figures: r } in &self.runs {
            let [mean, p99, max] = [r.strain.mean, r.strain.p99, r.strain.max].map(|s| s * 100.0);
            let memory = r.memory_bytes.map_or_else(String::new, |b| format!("{:.3}", b as f64 * 1e-6));
            let _ = writeln!(
                text,
                "| {case} | {:.1} / {:.1} | {:.2} | {}, {} | {mean:.3} / {p99:.2} / {max:.1} | {:.2} | {memory} | {} |",
                r.step_us.p50, r.step_us.p99, r.y_ratio, r.substeps, r.lanes, r.penetration_mm.max, r.state_hash
            );
        }
        let _ = writeln!(text, "\n{} of {} targets are met.", self.met[0], self.met[1]);
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_there_whatever_fails() {
        // Nine vertices are no scene: every run is refused, and every row says so.
        let base = SkirtOptions { verts: 9, runs: 1, steps: 1, ..SkirtOptions::default() };
        let mut reported = 0;
        let mut maker = TableRun {
            base,
            heap: &HeapProbe::none(),
            progress: &mut |_| reported += 1,
            rows: Vec::new(),
            runs: Vec::new(),
            faults: Vec::new(),
        };
        maker.one_thread();
        maker.contact_and_memory();
        maker.faults();
        assert_eq!(maker.rows.len(), 6 + 2 + 7);
        assert!(maker.rows.iter().all(|r| !r.met && r.got.contains("9 vertices")), "{:#?}", maker.rows);
        assert!(reported > 0);
    }
}
