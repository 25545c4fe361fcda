//! `toile bake`: bakes a garment's mesh, and warns about its faults.

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use serde::Serialize;
use toile_assets::adapt::{AdaptError, dress as own};
use toile_assets::drafting;
use toile_assets::draping::PatternPackage;
use toile_assets::file::{self, FileKind};
use toile_bake;
use toile_bake::Shape;
use toile_bake::survey::{MeshSurvey, survey};
use toile_base::body::{Measures, Sex};
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::terminal::{self, Paint, Tone};
use toile_fitting::dress::garment_source::{GarmentSource, SourceKind};

/// Bake a garment, and report what its mesh becomes: fibers, solvers, bending, memory.
///
/// Bakes one garment in one size, on the body that the size is cut for, and reports what the cloth will step over: how many
/// edges the fibers of each direction cover, which solver they get, tethers and bending stencils, memory, time and substeps,
/// and what in the mesh gives reason to worry.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: see whether a mesh of your own makes good cloth\n  toile bake my-skirt.obj --fabric \
                        linen-twill")]
pub struct BakeArgs {
    /// Garment of the wardrobe, an OBJ file, a sewn pattern or a garment package
    #[arg(value_name = "GARMENT")]
    pub garment: String,
    /// Size, as the garment's table names it (default: the middle of the table)
    #[arg(long, value_name = "S")]
    pub size: Option<String>,
    /// Fabric that is built in, or a fabric file (.toml) (default: the garment's own)
    #[arg(long, value_name = "F")]
    pub fabric: Option<String>,
    /// Print one JSON object, and nothing else, on stdout
    #[arg(long)]
    pub json: bool,
}

/// A fabric file: a dozen lines.
const FABRIC_FILE: FileKind = FileKind { name: "a fabric file", max_bytes: 1 << 16, cure: "give one fabric a file" };

/// The body of `toile bake`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BakeReport {
    /// The garment, or the file of the mesh.
    pub garment: String,
    /// Code of the size.
    pub size: String,
    /// Name of the fabric.
    pub fabric: String,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Triangles; a quad counts as two.
    pub triangles: usize,
    /// Vertices that do not move.
    pub fixed: usize,
    /// How many edges the fibers of each kind cover.
    pub edges: EdgeCounts,
    /// How many fibers of two edges or more there are.
    pub fibers: FiberCounts,
    /// How the cloth hangs.
    pub hanging: HangingCounts,
    /// How many fibers each solver has.
    pub solvers: Vec<SolverCounts>,
    /// Sets in which the constraints are solved.
    pub sets: SetCounts,
    /// Tethers of the garment.
    pub tethers: usize,
    /// Bending stencils by direction.
    pub stencils: StencilCounts,
    /// Memory of the baked garment (bytes).
    pub bytes: usize,
    /// Time that baking took, drafting and this survey left out (ms).
    pub bake_ms: f64,
    /// Substeps of a step of 1/120 s that the garment asks for.
    pub substeps: u32,
    /// What is likely to look or to run worse than it could.
    pub warnings: Vec<String>,
    /// Remarks that are no warnings, one sentence each.
    pub notes: Vec<String>,
}

/// Edges by what covers them.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct EdgeCounts {
    /// All edges of the mesh.
    pub all: usize,
    /// In fibers down the warp.
    pub warp: usize,
    /// In open fibers along the weft.
    pub weft: usize,
    /// In closed hoops of weft.
    pub hoops: usize,
    /// In fibers along the bias.
    pub bias: usize,
    /// In no fiber of two edges or more.
    pub loose: usize,
}

/// Fibers by direction.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct FiberCounts {
    /// Fibers along the warp.
    pub warp: usize,
    /// Along the weft, open or closed.
    pub weft: usize,
    /// Fibers along the bias.
    pub bias: usize,
    /// Edges of the longest.
    pub longest: usize,
}

/// How the cloth hangs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct HangingCounts {
    /// Vertices that can move.
    pub free: usize,
    /// Those of them that one warp fiber joins to a fixed vertex.
    pub by_one_fiber: usize,
    /// Those that hang by several, one from another.
    pub by_several: usize,
    /// Share of both (0..1).
    pub share: f64,
}

/// What one solver has to do.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SolverCounts {
    /// Its name, as garment files call it.
    pub solver: &'static str,
    /// Fibers; edges alone count as one each.
    pub fibers: usize,
    /// Edges of these fibers.
    pub edges: usize,
}

/// Sets in which nothing shares a particle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct SetCounts {
    /// Families of fibers along the bias that are solved directly.
    pub diagonals: usize,
    /// Edges of these families.
    pub diagonal_edges: usize,
    /// Of links along the bias that lie in none.
    pub shear: usize,
    /// Edges of these links.
    pub shear_edges: usize,
    /// Sets of links along the weft.
    pub weft: usize,
    /// Bundles of fibers side by side.
    pub bundles: usize,
    /// Sets of fibers by index list.
    pub crossing: usize,
}

/// Bending stencils by direction.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct StencilCounts {
    /// Stencils along the warp.
    pub warp: usize,
    /// Stencils along the weft.
    pub weft: usize,
    /// Stencils along the bias.
    pub bias: usize,
}

/// Runs `toile bake`.
///
/// # Errors
/// A garment, size, fabric or mesh that cannot be used, or a closed stdout.
pub fn run(args: &BakeArgs) -> Result<(), AppError> {
    let report = bake(args)?;
    if args.json {
        return terminal::print_json(&Document::new("bake", report));
    }
    terminal::print(&summary(&report, Paint::for_stdout()))
}

/// A shape with the names that it goes by.
struct DraftedShape {
    name: String,
    size: String,
    fabric: Fabric,
    shape: Shape,
    /// What became of a mesh of the user's own.
    notes: Vec<String>,
}

fn bake(args: &BakeArgs) -> Result<BakeReport, AppError> {
    let named = args.fabric.as_deref().map(fabric).transpose()?;
    let drafted = draft(args)?;
    let fabric = named.unwrap_or_else(|| drafted.fabric.clone());
    let start = Instant::now();
    let garment = toile_bake::bake(&drafted.name, &drafted.size, &drafted.shape, &fabric)
        .map_err(|source| AppError::input(AdaptError::Cloth { path: drafted.name.clone(), source }))?;
    let bake_ms = start.elapsed().as_secs_f64() * 1e3;
    let mut report = report(&garment, survey(&drafted.shape, &fabric), bake_ms);
    report.notes.splice(0..0, drafted.notes);
    Ok(report)
}

/// Cuts the garment on the body of its size, or lays the mesh on the body that it is made for.
fn draft(args: &BakeArgs) -> Result<DraftedShape, AppError> {
    let source = GarmentSource::find(&args.garment)?;
    let fabric = source.fabric()?;
    let own = match source.kind {
        SourceKind::Mesh(own) => own,
        SourceKind::Pattern(package) => {
            // A garment of the wardrobe is shown in the size that its own draft is for.
            let built_in = drafting::style(&args.garment).is_some();
            let size = args.size.clone().or_else(|| built_in.then(|| package.own_size().to_owned()));
            return draft_pattern(*package, size, fabric);
        }
    };
    if let Some(size) = &args.size {
        return Err(AppError::input(AdaptError::NoSizes { path: own.path.clone(), size: size.clone() }));
    }
    let sex = own.sex.unwrap_or(Sex::Female);
    let body = toile_assets::body::build(sex, &Measures::average(sex)).map_err(AppError::internal)?;
    let drafted = own::draft(&own, None, &body).map_err(AppError::input)?;
    let notes = drafted.worn.report.lines();
    Ok(DraftedShape { name: own.path, size: own::UNKNOWN.into(), fabric, shape: drafted.worn.shape, notes })
}

/// Drapes a pattern or a package on the average woman, or in a size on the body that it is for.
fn draft_pattern(package: PatternPackage, size: Option<String>, fabric: Fabric) -> Result<DraftedShape, AppError> {
    let average =
        toile_assets::body::build(Sex::Female, &Measures::average(Sex::Female)).map_err(AppError::internal)?;
    let (size, body) = match size {
        None => (package.own_size().to_owned(), average),
        Some(size) => {
            let body = package.body_of(&size).map_err(AppError::input)?.unwrap_or(average);
            (size, body)
        }
    };
    let shape = package.draft(&size, &body, &fabric).map_err(AppError::input)?;
    Ok(DraftedShape { name: package.name, size, fabric, shape, notes: Vec::new() })
}

/// A fabric by its name, or from a file.
fn fabric(name: &str) -> Result<Fabric, AppError> {
    let path = Path::new(name);
    if !path.exists() && !name.to_lowercase().ends_with(".toml") {
        return toile_assets::fabric::built_in(name).map_err(AppError::input);
    }
    let text = file::read_text(path, &FABRIC_FILE).map_err(AppError::input)?;
    toile_assets::fabric::parse(name, &text).map_err(AppError::input)
}

fn report(garment: &Garment, found: MeshSurvey, bake_ms: f64) -> BakeReport {
    let covered = &found.coverage;
    let layout = garment.layout();
    let solver = |s: &toile_bake::survey::SolverCount| SolverCounts {
        solver: s.solver.name(),
        fibers: s.fibers,
        edges: s.edges,
    };
    BakeReport {
        garment: garment.name.clone(),
        size: garment.size.clone(),
        fabric: garment.fabric.name.clone(),
        vertices: found.vertices,
        triangles: found.triangles,
        fixed: found.fixed,
        edges: EdgeCounts {
            all: covered.edges,
            warp: covered.warp,
            weft: covered.weft,
            hoops: covered.hoops,
            bias: covered.bias,
            loose: covered.loose,
        },
        fibers: FiberCounts {
            warp: covered.fibers[0],
            weft: covered.fibers[1],
            bias: covered.fibers[2],
            longest: covered.longest,
        },
        hanging: HangingCounts {
            free: covered.free,
            by_one_fiber: covered.hanging,
            by_several: covered.hanging_on,
            share: covered.hanging_share(),
        },
        solvers: found.solvers.iter().map(solver).collect(),
        sets: SetCounts {
            diagonals: layout.diagonals.families.len(),
            diagonal_edges: layout.diagonals.count(),
            shear: layout.shear.tuples.sets.len(),
            shear_edges: layout.shear.tuples.count,
            weft: layout.weft.tuples.sets.len(),
            bundles: layout.fibers.bundles.len(),
            crossing: layout.crossing.sets.len(),
        },
        tethers: found.tethers,
        stencils: StencilCounts { warp: found.stencils[0], weft: found.stencils[1], bias: found.stencils[2] },
        bytes: garment.bytes(),
        bake_ms,
        substeps: garment.substeps,
        warnings: found.warnings,
        notes: found.notes,
    }
}

/// The report for a person.
fn summary(report: &BakeReport, paint: Paint) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let mut line = |words: String| _ = writeln!(text, "{words}");
    let BakeReport { garment, size, fabric, vertices, triangles, fixed, edges, fibers, .. } = report;
    line(paint.tone(&format!("{garment}, size {size}, {fabric}"), Tone::Strong).into_owned());
    line(format!("  {vertices} vertices ({fixed} fixed), {triangles} triangles, {} edges", edges.all));
    let share = |count: usize| 100.0 * count as f64 / edges.all.max(1) as f64;
    let covered = |count: usize, what: String| format!("  {:5.1} %  {count:7} {what}", share(count));
    line(paint.tone("Edges", Tone::Strong).into_owned());
    line(covered(edges.warp, format!("in {} fibers down the warp", fibers.warp)));
    line(covered(
        edges.weft + edges.hoops,
        format!("in {} along the weft, {} of them in closed hoops", fibers.weft, edges.hoops),
    ));
    line(covered(edges.bias, format!("in {} along the bias", fibers.bias)));
    line(covered(edges.loose, "alone".into()));
    let hanging = report.hanging;
    line(format!(
        "  {:.1} % of the free vertices hang by fibers, {} of {} by a single one; the longest has {} edges",
        100.0 * hanging.share,
        hanging.by_one_fiber,
        hanging.free,
        fibers.longest
    ));
    line(paint.tone("Solved", Tone::Strong).into_owned());
    for solver in report.solvers.iter().filter(|s| s.fibers > 0) {
        line(format!("  {:14} {} fibers of {} edges", solver.solver, solver.fibers, solver.edges));
    }
    let (sets, stencils) = (report.sets, report.stencils);
    line(format!(
        "  {} edges along the bias side by side in {} families, {} alone in {} sets of shear",
        sets.diagonal_edges, sets.diagonals, sets.shear_edges, sets.shear,
    ));
    line(format!("  {} sets of weft, {} bundles, {} sets by index", sets.weft, sets.bundles, sets.crossing));
    line(format!(
        "  {} tethers; bending: {} stencils along the warp, {} the weft, {} the bias",
        report.tethers, stencils.warp, stencils.weft, stencils.bias
    ));
    line(format!(
        "  {:.2} MB, baked in {:.0} ms, {} substeps a step",
        report.bytes as f64 * 1e-6,
        report.bake_ms,
        report.substeps
    ));
    report.notes.iter().for_each(|note| line(format!("  {note}")));
    report.warnings.iter().for_each(|warning| line(format!("  {}", paint.tone(warning, Tone::Warn))));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(garment: &str) -> BakeArgs {
        BakeArgs { garment: garment.into(), size: None, fabric: None, json: false }
    }

    /// Garments of each kind, and those that hang otherwise than most.
    const GARMENTS: [&str; 7] =
        ["circle-skirt", "wide-leg-trousers", "shirt", "strap-dress", "blazer", "poncho", "scarf"];

    #[test]
    fn garments_of_the_wardrobe_are_covered_and_hang() {
        for name in GARMENTS {
            let report = bake(&args(name)).unwrap();
            let EdgeCounts { all, warp, weft, hoops, bias, loose } = report.edges;
            assert_eq!(warp + weft + hoops + bias + loose, all, "{name}");
            assert_eq!(report.hanging.free + report.fixed, report.vertices, "{name}");
            let hung = if name == "scarf" { 0 } else { report.hanging.free };
            assert_eq!(report.tethers, hung, "{name}: something hangs from nothing");
            // A circle and a poncho hang along the bias for the most part; a scarf lies on others by its weight.
            let least = match name {
                "circle-skirt" => 0.25,
                "poncho" => 0.45,
                "scarf" => 0.0,
                _ => 0.5,
            };
            assert!(loose * 50 < all && report.hanging.share >= least, "{name}: {}", report.hanging.share);
            let known = |w: &str| {
                w.contains("hang by fibers") && least < 0.5 || w.contains("nothing is fixed") && name == "scarf"
            };
            let wrong = report.warnings.iter().find(|w| !known(w));
            assert_eq!(wrong, None, "{name}");
            let text = summary(&report, Paint::none());
            for expected in [name, "vertices", "down the warp", "semi-implicit", "tethers", "substeps"] {
                assert!(text.contains(expected), "{expected} is not in: {text}");
            }
        }
    }

    #[test]
    fn size_and_fabric_can_be_chosen() {
        let mut chosen = args("strap-dress");
        (chosen.size, chosen.fabric) = (Some("40".into()), Some("linen-twill".into()));
        let report = bake(&chosen).unwrap();
        assert_eq!((report.size.as_str(), report.fabric.as_str()), ("40", "linen-twill"));
    }
}
