//! The table of skinning: both surfaces, one thread and two, each lane width, and what becomes of limbs.

use serde::Serialize;
use toile_assets::put_line;
use toile_engine::lanes::Width;
use toile_engine::skin::Padding;
use toile_fitting::scene::reference_time;

use super::{
    Shapes, Skinning, SkinningError, SkinningOptions, SkinningSubject, SweepTiming, Timing, measure, shapes,
    sweep_timing,
};

/// Largest share of the reference time that a thread may take for as many vertices: linear, dual.
pub const TARGETS: [f64; 2] = [0.12, 0.2];

/// One measurement as the table has it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SkinningRow {
    /// The skin that was measured.
    pub subject: SkinningSubject,
    /// Vertices that were skinned.
    pub verts: usize,
    /// Number of workers.
    pub threads: usize,
    /// Number of lanes.
    pub lanes: usize,
    /// Blocks of 16 lanes.
    pub blocks: usize,
    /// Joint sets that lie apart.
    pub sets: usize,
    /// Share of the lanes that carries no vertex (0..1).
    pub padding: f64,
    /// Influences of a vertex, mean.
    pub influences: f64,
    /// Influences that a vertex' block is blended from, mean, padding included.
    pub blended: f64,
    /// Reference time (us).
    pub yardstick_us: f64,
    /// Time of linear blending.
    pub linear: Timing,
    /// Time of dual quaternions.
    pub dual: Timing,
}

impl From<Skinning> for SkinningRow {
    fn from(found: Skinning) -> Self {
        let Padding { vertices, blocks, runs, influences, blended, .. } = found.padding;
        let of_each = |count: usize| count as f64 / vertices.max(1) as f64;
        Self {
            subject: found.subject,
            verts: found.verts,
            threads: found.threads,
            lanes: found.lanes,
            blocks,
            sets: runs,
            padding: found.padding.share(),
            influences: of_each(influences),
            blended: of_each(blended),
            yardstick_us: found.yardstick_us,
            linear: found.linear,
            dual: found.dual,
        }
    }
}

/// All measurements with the shapes that came out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SkinningTable {
    /// One row a measurement.
    pub rows: Vec<SkinningRow>,
    /// Volumes and bulges.
    #[serde(flatten)]
    pub shapes: Shapes,
    /// The sweep around elbows and knees: its time and its errors.
    pub sweep: SweepTiming,
}

/// Measures all rows; `progress` is given what is being run.
///
/// # Errors
/// Where the scene's shopper or the workers cannot be made.
pub fn run(progress: &mut dyn FnMut(&str)) -> Result<SkinningTable, SkinningError> {
    let mut rows = Vec::new();
    let mut add = |options: SkinningOptions| -> Result<(), SkinningError> {
        progress(&format!("{:?}, {} thread(s), lanes {:?}", options.subject, options.threads, options.lanes));
        rows.push(measure(&options)?.into());
        Ok(())
    };
    for (subject, verts) in [
        (SkinningSubject::Four, Some(reference_time::VERTICES)),
        (SkinningSubject::Body, Some(reference_time::VERTICES)),
        (SkinningSubject::Body, None),
    ] {
        for threads in [1, 2] {
            add(SkinningOptions { subject, verts, threads, lanes: None })?;
        }
    }
    for width in Width::ALL.into_iter().rev().skip(1).filter(|w| w.available()) {
        add(SkinningOptions { lanes: Some(width), ..SkinningOptions::default() })?;
    }
    progress("the sweep of the body's elbows and knees");
    Ok(SkinningTable { rows, shapes: shapes()?, sweep: sweep_timing()? })
}

impl SkinningTable {
    /// The table as Markdown.
    pub fn markdown(&self) -> String {
        let mut text = String::new();
        self.times(&mut text);
        self.limbs(&mut text);
        text
    }

    fn times(&self, text: &mut String) {
        put_line!(
            text,
            "| surface | vertices | threads | lanes | sets | empty lanes | influences, blended | linear: us, Y, error \
             | in mesh order | dual: us, Y, error | in mesh order | Y (us) |"
        );
        put_line!(text, "|---|---|---|---|---|---|---|---|---|---|---|---|");
        for r in &self.rows {
            let timing = |t: &Timing| {
                format!("{:.1}, **{:.3}**, {:.2} um | {:.1}", t.us, t.y_ratio, t.max_error_m * 1e6, t.mesh_order_us)
            };
            let surface =
                if r.subject == SkinningSubject::Four { "four influences each" } else { "the body's own weights" };
            put_line!(
                text,
                "| {surface} | {} | {} | {} | {} | {:.1} % | {:.2}, {:.2} | {} | {} | {:.0} |",
                r.verts,
                r.threads,
                r.lanes,
                r.sets,
                r.padding * 100.0,
                r.influences,
                r.blended,
                timing(&r.linear),
                timing(&r.dual),
                r.yardstick_us,
            );
        }
        let [linear, dual] = TARGETS;
        put_line!(
            text,
            "\nTargets, one thread, as shares of the reference time Y: linear {linear}, dual quaternions {dual}. Peers on four \
             influences, linear: ozz-animation 0.45, OGRE 0.47; the least memory traffic alone takes 0.05.\n"
        );
    }

    fn limbs(&self, text: &mut String) {
        put_line!(
            text,
            "| volume kept under twist | theory, two bones, linear | linear, two bones | linear, split | dual, two bones \
             | dual, split |"
        );
        put_line!(text, "|---|---|---|---|---|---|");
        for t in &self.shapes.twists {
            put_line!(
                text,
                "| {} {:.0} degrees | {:.3} | {:.3} | {:.3} | {:.3} | {:.3} |",
                t.of,
                t.degrees,
                t.theory,
                t.linear_one_bone,
                t.linear_split,
                t.dual_one_bone,
                t.dual_split,
            );
        }
        put_line!(text, "\n| bent joint: linear, dual, swept | volume | bulge | thinnest place |");
        put_line!(text, "|---|---|---|---|");
        for h in &self.shapes.hinges {
            let bulge = |k: usize| format!("{:+.1} % ({:.1} mm)", h.bulge[k] * 100.0, h.bulge_mm[k]);
            let thin = |k: usize| format!("{:+.1} %", h.thinnest[k] * 100.0);
            put_line!(
                text,
                "| {} {:.0} degrees | {:.3}, {:.3}, {:.3} | {}, {}, {} | {}, {}, {} |",
                h.of,
                h.degrees,
                h.volume[0],
                h.volume[1],
                h.volume[2],
                bulge(0),
                bulge(1),
                bulge(2),
                thin(0),
                thin(1),
                thin(2),
            );
        }
        let s = &self.sweep;
        put_line!(
            text,
            "\n| sweep over dual quaternions, {} of {} vertices | {:.1} us on top of {:.1} us | {:.2} Y | error {:.2} um by the sections in f64, \
             {:.1} um by exact sections |",
            s.swept,
            s.verts,
            s.us,
            s.dual_us,
            s.y_ratio,
            s.max_error_m * 1e6,
            s.section_error_m * 1e6
        );
        put_line!(
            text,
            "\n| linear and dual apart, the scene's ten seconds | mean | largest | least volume of the body: linear, dual |"
        );
        put_line!(text, "|---|---|---|---|");
        for a in &self.shapes.apart {
            let [linear, dual] = a.body_volume;
            put_line!(text, "| {} | {:.2} mm | {:.1} mm | {linear:.4}, {dual:.4} |", a.of, a.mean_mm, a.max_mm);
        }
    }
}
