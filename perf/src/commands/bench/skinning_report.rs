//! The JSON of `toile bench skinning`, and the same in words.

use serde::Serialize;
use toile_assets::put_line;
use toile_cli::terminal::{Paint, Tone};
use toile_engine::skin::{Blend, Padding};
use toile_fitting::scene::reference_time;
use toile_perf::skinning::{Skinning, SkinningSubject, Timing};

/// The body of `toile bench skinning`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SkinningReport {
    /// The blend that the next four figures are of.
    pub blend: &'static str,
    /// Time of one pass over all vertices (us, median).
    pub us: f64,
    /// The same for one vertex (ns).
    pub ns_per_vertex: f64,
    /// The same over the reference time of as many vertices.
    pub y_ratio: f64,
    /// Largest distance from an f64 oracle (m).
    pub max_error_m: f64,
    /// Vertices of the plain scalar loop, always the same.
    pub yardstick_verts: usize,
    /// What was skinned, its lanes, and the figures of both blends.
    #[serde(flatten)]
    pub found: SkinningRow,
}

/// The figures of both blends, with what was skinned.
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

impl SkinningReport {
    /// What was found, with the figures of one blend first.
    pub fn new(found: Skinning, blend: Blend) -> Self {
        let Timing { us, ns_per_vertex, y_ratio, max_error_m, .. } = match blend {
            Blend::Linear => found.linear,
            Blend::Dual => found.dual,
        };
        let yardstick_verts = reference_time::VERTICES;
        Self { blend: blend.name(), us, ns_per_vertex, y_ratio, max_error_m, yardstick_verts, found: found.into() }
    }
}

/// The summary of a skinning benchmark.
pub fn summary(report: &SkinningReport, paint: Paint) -> String {
    let SkinningReport { blend, ns_per_vertex, y_ratio, yardstick_verts, max_error_m, found, .. } = report;
    let plain = found.yardstick_us * 1e3 / *yardstick_verts as f64;
    let mut text = String::new();
    let title = format!("Skinning {} vertices, positions and normals: {blend}", found.verts);
    put_line!(text, "{}", paint.tone(&title, Tone::Strong));
    let error = max_error_m * 1e6;
    put_line!(
        text,
        "  the engine    {ns_per_vertex:.2} ns a vertex, {y_ratio:.3} of a plain loop, error {error:.3} um"
    );
    put_line!(text, "  a plain loop  {plain:.2} ns a vertex ({:.1} us for {yardstick_verts})", found.yardstick_us);
    for (name, t) in [("linear", &found.linear), ("dual", &found.dual)] {
        let error = t.max_error_m * 1e6;
        put_line!(text, "  {name:<13} {:.1} us, {:.1} in mesh order, error {error:.3} um", t.us, t.mesh_order_us);
    }
    let empty = found.padding * 100.0;
    put_line!(
        text,
        "  {} thread(s), {} lanes, {} joint sets, {empty:.1} % of the lanes empty",
        found.threads,
        found.lanes,
        found.sets
    );
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_skinning_summary_compares_vertex_with_vertex() {
        let timing = Timing { us: 5.0, ns_per_vertex: 5.0, max_error_m: 2.5e-7, ..Timing::default() };
        let padding = Padding { vertices: 1000, lanes: 1010, blocks: 64, runs: 9, influences: 2000, blended: 2100 };
        let found = Skinning {
            subject: SkinningSubject::Body,
            verts: 1000,
            threads: 1,
            lanes: 16,
            yardstick_us: 120.0,
            padding,
            linear: timing,
            dual: timing,
        };
        let report = SkinningReport::new(found, Blend::Linear);
        let text = summary(&report, Paint::none());
        for said in ["1000 vertices", "linear", "5.00 ns", "8.00 ns", "0.250 um", "1.0 % of the lanes"] {
            assert!(text.contains(said), "{said} is not in: {text}");
        }
    }
}
