//! The rows of a crossover, and where the curves cross.

use std::time::{Duration, Instant};
use toile_assets::put_line;

use serde::Serialize;
use toile_base::numeric::statistics::median;
use toile_fitting::heap::HeapProbe;
use toile_gpu::backend::{Backend, Backends};

use crate::backend::SteppedBy;
use crate::skirt::options::SkirtOptions;
use crate::skirt::{Gauge, SkirtError, SkirtScene};

/// Vertices of a single skirt.
const SIZES: [usize; 5] = [1_024, 4_096, 16_384, 65_536, 262_144];

/// Numbers of skirts at once.
const COUNTS: [usize; 4] = [1, 4, 16, 64];

/// Vertices of each of several skirts.
pub(super) const EACH: usize = 4_096;

/// What one side may take for the steps of a row; the slowest decides how many there are, because all take the same ones.
const PATIENCE: Duration = Duration::from_secs(4);

/// The fewest and the most steps of a row, of which a third warms up.
const STEPS: [usize; 2] = [6, 240];

/// What a side has to say of one row.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct SideFigures {
    /// Median time of a step of all skirts, until the result is there (us).
    pub step_us: f64,
    /// Mean strain over those steps (1).
    pub strain_mean: f64,
    /// Mean of the frames' 99th percentiles (1).
    pub strain_p99: f64,
    /// Mean distance of the particles from those of one thread at the end (mm).
    pub apart_mm: f64,
}

/// One size or number of skirts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CrossoverRow {
    /// Vertices of a skirt.
    pub verts: usize,
    /// Number of skirts.
    pub garments: usize,
    /// Steps that were taken, a third of them to warm up.
    pub steps: usize,
    /// Times of a step by one thread.
    pub one: SideFigures,
    /// Times of a step by two threads.
    pub two: SideFigures,
    /// The device; none where it cannot step them, which `missing` then says.
    pub device: Option<SideFigures>,
    /// Time of a step by the device's own clock, from its first kernel to its last (us): of steps that are metered, which go in a pass a
    /// stage; a plain step is a little shorter.
    pub device_us: Option<f64>,
    /// Dispatches of a step on the device, one after the other.
    pub dispatches: Option<u64>,
    /// Bytes that its kernels ask for in a step, counted as if there were no cache.
    pub bytes: Option<u64>,
    /// Why there is no device.
    pub missing: Option<String>,
}

/// Times of processor and graphics device by size and by number of skirts.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Crossover {
    /// What the device is.
    pub stepped_by: SteppedBy,
    /// `draft`, `shop` or `fine`.
    pub quality: &'static str,
    /// A row a size, then a row a number of skirts.
    pub rows: Vec<CrossoverRow>,
    /// Vertices from which on the device is faster than one thread, and than two; none where it never is, 0 where it always is.
    pub from_vertices: [Option<f64>; 2],
    /// Skirts from which on it is.
    pub from_garments: [Option<f64>; 2],
}

/// Runs the rows that have no more vertices in all than `most`; `progress` is given what is being run.
///
/// # Errors
/// Where the options cannot be met.
pub fn run(base: &SkirtOptions, most: usize, progress: &mut dyn FnMut(&str)) -> Result<Crossover, SkirtError> {
    // Of `auto` both sides are wanted just so.
    let backends = Backends::open(Backend::Gpu);
    let sizes = SIZES.into_iter().map(|verts| (verts, 1));
    let counts = COUNTS.into_iter().map(|garments| (EACH, garments)).filter(|(_, n)| *n > 1);
    let mut rows: Vec<CrossoverRow> = Vec::new();
    for (verts, garments) in sizes.chain(counts).filter(|(verts, n)| verts * n <= most) {
        progress(&format!("{garments} x {verts} vertices"));
        rows.push(row(&SkirtOptions { verts, garments, ..*base }, &backends)?);
    }
    let single = |row: &&CrossoverRow| row.garments == 1;
    let sizes: Vec<&CrossoverRow> = rows.iter().filter(single).collect();
    let counts: Vec<&CrossoverRow> = rows.iter().filter(|row| row.verts == EACH).collect();
    let from = |rows: &[&CrossoverRow], x: fn(&CrossoverRow) -> f64, side: fn(&CrossoverRow) -> f64| {
        let both = |row: &&CrossoverRow| Some([x(row), side(row) / row.device?.step_us]);
        crossing(&rows.iter().filter_map(both).collect::<Vec<_>>())
    };
    let sides: [fn(&CrossoverRow) -> f64; 2] = [|row| row.one.step_us, |row| row.two.step_us];
    Ok(Crossover {
        stepped_by: SteppedBy::of(&backends),
        quality: base.quality.unwrap_or_default().name(),
        from_vertices: sides.map(|side| from(&sizes, |row| row.verts as f64, side)),
        from_garments: sides.map(|side| from(&counts, |row| row.garments as f64, side)),
        rows,
    })
}

/// Where the processor's time over the device's comes to 1 for good, between points `[x, ratio]` on a straight line in
/// logarithms: nothing where it is below 1 at the last, 0 where it never is.
fn crossing(points: &[[f64; 2]]) -> Option<f64> {
    let [.., last] = points else { return None };
    if last[1] < 1.0 {
        return None;
    }
    let Some(below) = points.iter().rposition(|p| p[1] < 1.0) else { return Some(0.0) };
    let [[x0, y0], [x1, y1]] = [points[below], points[below + 1]].map(|p| p.map(f64::ln));
    Some((x0 + (x1 - x0) * y0 / (y0 - y1)).exp())
}

/// One row: the device first, which may be the slowest by far.
fn row(options: &SkirtOptions, backends: &Backends) -> Result<CrossoverRow, SkirtError> {
    let scene = |backends: &Backends, threads| {
        SkirtScene::by(backends, &SkirtOptions { threads, ..*options }, &HeapProbe::none(), |_| {})
    };
    let (mut one, mut two) = (scene(&Backends::cpu(), 1)?, scene(&Backends::cpu(), 2)?);
    let mut device = scene(backends, 1)?;
    // A step of each, to know how many there can be, after the first, which lays everything out.
    let second = |scene: &mut SkirtScene| {
        timed(scene);
        timed(scene)
    };
    let slowest = [&mut one, &mut two, &mut device].map(second).into_iter().max();
    let fit = PATIENCE.as_secs_f64() / slowest.unwrap_or_default().as_secs_f64().max(1e-6);
    let steps = (fit as usize).clamp(STEPS[0], STEPS[1]);
    let mut gauge = Gauge::new(&one);
    let mut sides = [&mut one, &mut two, &mut device].map(|scene| watched(scene, steps, &mut gauge));
    for (side, scene) in sides.iter_mut().zip([&one, &two, &device]) {
        side.apart_mm = apart_mm(scene, &one);
    }
    let [first, second, third] = sides;
    let fallen = device.stepper().fallback().map(str::to_owned);
    let device_us = fallen.is_none().then(|| device.metered_stages(3).device_us).flatten();
    let work = device.stepper().work();
    Ok(CrossoverRow {
        verts: options.verts,
        garments: options.garments,
        steps: steps + 2,
        one: first,
        two: second,
        device: fallen.is_none().then_some(third),
        device_us,
        dispatches: work.map(|w| w.dispatches),
        bytes: work.map(|w| w.bytes),
        missing: fallen,
    })
}

fn timed(scene: &mut SkirtScene) -> Duration {
    scene.prepare();
    let begun = Instant::now();
    scene.step();
    begun.elapsed()
}

/// Some steps, and what was seen in them.
fn watched(scene: &mut SkirtScene, steps: usize, gauge: &mut Gauge) -> SideFigures {
    let (mut times, mut sums, mut frames) = (Vec::new(), [0.0; 2], 0);
    for step in 0..steps {
        let time = timed(scene);
        if 3 * step < steps {
            continue;
        }
        times.push(time.as_secs_f64() * 1e6);
        for cloth in &scene.cloths {
            let frame = gauge.read(&cloth.positions, &scene.spheres);
            sums = [sums[0] + frame.strain_mean, sums[1] + frame.strain_p99];
            frames += 1;
        }
    }
    let [strain_mean, strain_p99] = sums.map(|sum| sum / f64::from(frames.max(1)));
    SideFigures { step_us: median(&mut times).unwrap_or(0.0), strain_mean, strain_p99, apart_mm: 0.0 }
}

/// Mean distance of the particles of all skirts (mm).
fn apart_mm(scene: &SkirtScene, other: &SkirtScene) -> f64 {
    let pairs = scene.cloths.iter().zip(&other.cloths).flat_map(|(a, b)| a.positions.iter().zip(&b.positions));
    let (sum, count) = pairs.fold((0.0, 0.0), |(sum, n), (a, b)| (sum + f64::from(a.distance(*b)), n + 1.0));
    sum / f64::max(count, 1.0) * 1e3
}

impl Crossover {
    /// The study as a table in Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::from(
            "| Skirts x vertices | steps | one thread us | two threads us | device us, its own clock | dispatches | MB asked for, GB/s | strain one, device % mean | \
             apart mm |\n|---|---|---|---|---|---|---|---|---|\n",
        );
        for row in &self.rows {
            let of = |value: Option<f64>, digits: usize| value.map_or("-".into(), |v| format!("{v:.digits$}"));
            let device = [row.device.map(|d| d.step_us), row.device_us].map(|us| of(us, 0)).join(", ");
            let dispatches = row.dispatches.map_or("-".into(), |n| n.to_string());
            let rate = row.bytes.zip(row.device_us).map(|(bytes, us)| bytes as f64 * 1e-3 / us);
            let asked = [of(row.bytes.map(|b| b as f64 * 1e-6), 1), of(rate, 1)].join(", ");
            let strain = [Some(row.one), row.device].map(|s| of(s.map(|s| s.strain_mean * 100.0), 3)).join(", ");
            let (apart, [one, two]) = (of(row.device.map(|d| d.apart_mm), 4), [row.one, row.two].map(|s| s.step_us));
            let head = format!("{} x {}", row.garments, row.verts);
            put_line!(
                text,
                "| {head} | {} | {one:.0} | {two:.0} | {device} | {dispatches} | {asked} | {strain} | {apart} |",
                row.steps
            );
        }
        let sentence = |of: Option<f64>, what: &str| match of {
            None => "at no size tried".to_owned(),
            Some(0.0) => "at every size tried".to_owned(),
            Some(x) => format!("from {x:.0} {what} on"),
        };
        for (k, threads) in ["one thread", "two threads"].into_iter().enumerate() {
            let (size, count) =
                (sentence(self.from_vertices[k], "vertices"), sentence(self.from_garments[k], "skirts"));
            put_line!(text, "\nThe device is faster than {threads} {size}; with {EACH} vertices each {count}.");
        }
        let by = &self.stepped_by;
        match (&by.adapter, &by.fallen) {
            (Some(a), fallen) => {
                put_line!(text, "\nDevice: {} ({}, {}), quality {}.", a.name, a.kind, a.driver, self.quality);
                if a.kind == "software" {
                    put_line!(text, "It computes on the processor: its times say nothing about a graphics card.");
                }
                if let Some(reason) = fallen {
                    put_line!(text, "Some rows have no device: {reason}.");
                }
            }
            (None, reason) => {
                put_line!(text, "\nNo device: {}.", reason.as_deref().unwrap_or("none was asked for"));
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_cross_where_the_ratio_comes_to_one_for_good() {
        // From half as fast at 100 to twice as fast at 10,000: equal at 1,000.
        let at = crossing(&[[100.0, 0.5], [10_000.0, 2.0]]).unwrap();
        assert!((at - 1_000.0).abs() < 1e-6, "{at}");
        assert_eq!(crossing(&[[100.0, 1.5], [1_000.0, 2.0]]), Some(0.0), "always");
        assert_eq!(crossing(&[[100.0, 1.5], [1_000.0, 0.9]]), None, "not for good");
        assert_eq!(crossing(&[]), None);
        let late = crossing(&[[1.0, 2.0], [10.0, 0.5], [100.0, 2.0]]).unwrap();
        assert!((late - 1_000f64.sqrt()).abs() < 1e-6, "{late}");
    }

    #[test]
    fn a_small_study_has_its_rows_and_a_chart() {
        let study = run(&SkirtOptions::default(), 1_024, &mut |_| {}).unwrap();
        let [row] = &study.rows[..] else { panic!("{study:?}") };
        assert_eq!((row.verts, row.garments, row.two.apart_mm), (1_024, 1, 0.0), "two threads give the same bits");
        assert!(row.one.step_us > 0.0 && row.one.strain_mean > 0.0);
        assert_eq!(row.device.is_none(), row.missing.is_some());
        let text = study.markdown();
        assert!(text.contains("| 1 x 1024 |") && text.contains("evice"), "{text}");
        assert!(crate::plot::svg::text(&super::super::chart(&study)).contains("one thread"));
    }
}
