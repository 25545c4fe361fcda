//! `toile fabric`: lists fabrics, shows one, and makes one from a laboratory's sheet.

mod loops;

use std::path::{Path, PathBuf};

use serde::Serialize;
use toile_assets::fabric::sheet::MeasuredSheet;
use toile_assets::file::{self, FileKind};
use toile_assets::put_line;
use toile_base::fabric::Fabric;
use toile_cli::arguments::Printing;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFile};
use toile_cli::terminal;

/// Fabrics: list them, show one with its loops, make one of a laboratory's sheet.
// The help of a command is the doc of its arguments, which a doc of the variant would replace.
#[derive(Debug, Clone, PartialEq, clap::Subcommand)]
#[command(
    after_help = "Example: the loop of a cotton poplin as a picture\n  toile fabric show cotton-broad --picture loop.png"
)]
pub(crate) enum FabricCommand {
    List(ListArgs),
    Show(ShowArgs),
    Import(ImportArgs),
}

/// List the built-in fabrics with their weight, bending and the curvature that they keep.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: all fabrics\n  toile fabric list")]
pub(crate) struct ListArgs {
    /// What is printed.
    #[command(flatten)]
    pub printing: Printing,
}

/// Show a fabric: its figures, where they are from, and its loops.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: the loop of a cotton poplin as a picture\n  toile fabric show cotton-broad --picture loop.png"
)]
pub(crate) struct ShowArgs {
    /// Name of a built-in fabric, or a fabric's file (.toml)
    #[arg(value_name = "FABRIC")]
    pub fabric: String,
    /// Picture of its loops to write, ending in .png: moment against curvature, force against shear angle and strain
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// What is printed.
    #[command(flatten)]
    pub printing: Printing,
}

/// Make a fabric's file of a sheet of measured values: KES, FAST or Cusick. docs/fabrics.md says what is in one.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: a fabric of a Kawabata sheet\n  toile fabric import sheet.csv --name poplin --base cotton-lawn --out poplin.toml"
)]
pub(crate) struct ImportArgs {
    /// The sheet: a line a value, its name and one figure, or that of warp and weft
    #[arg(value_name = "SHEET")]
    pub sheet: PathBuf,
    /// Name of the fabric
    #[arg(long, value_name = "NAME")]
    pub name: String,
    /// Its name for shoppers (default: the name)
    #[arg(long, value_name = "TITLE")]
    pub title: Option<String>,
    /// Built-in fabric that has what the sheet does not say
    #[arg(long, value_name = "FABRIC", default_value = "cotton-lawn")]
    pub base: String,
    /// Where the sheet is from (default: the name of its file)
    #[arg(long, value_name = "WORDS")]
    pub source: Option<String>,
    /// File to write, ending in .toml
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// What is printed.
    #[command(flatten)]
    pub printing: Printing,
}

/// A fabric as it is reported.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct FabricReport {
    name: String,
    title: String,
    source: Option<String>,
    density_kg_m2: f32,
    /// Warp, weft; null is inextensible (N/m).
    stretch_n_m: [f32; 2],
    shear_n_m: f32,
    /// Warp, weft (uN m).
    bend_un_m: [f32; 2],
    bend_bias_un_m: Option<f32>,
    /// 2HB of warp and weft (mN), 2HG (N/m).
    hysteresis: [f32; 3],
    /// Curvature that warp and weft keep (1/m).
    residual_curvature_per_m: [f32; 2],
    /// Curves of stretch of warp and weft: strain (%) and load (N/m) at the knee, slope behind it, width of the loop (N/m).
    stretch_curves: [Option<[f32; 4]>; 2],
    /// Angle at which shear locks (degrees), and the slope behind it (N/m).
    shear_lock: Option<[f32; 2]>,
    /// Whether threads that are pushed together give way.
    buckling: bool,
    drape_percent: Option<f32>,
}

impl From<&Fabric> for FabricReport {
    fn from(fabric: &Fabric) -> Self {
        let bend_un_m = [fabric.bend_warp_un_m, fabric.bend_weft_un_m];
        Self {
            name: fabric.name.clone(),
            title: fabric.title.clone(),
            source: fabric.source.clone(),
            density_kg_m2: fabric.density_kg_m2,
            stretch_n_m: [fabric.stretch_warp_n_m, fabric.stretch_weft_n_m],
            shear_n_m: fabric.shear_n_m,
            bend_un_m,
            bend_bias_un_m: fabric.bend_bias_un_m,
            hysteresis: fabric.hysteresis.figures(),
            residual_curvature_per_m: fabric.hysteresis.residual_curvatures(bend_un_m),
            stretch_curves: [fabric.stretch.warp, fabric.stretch.weft].map(|c| c.map(|c| c.figures())),
            shear_lock: fabric.shear_lock.map(|lock| [lock.degrees, lock.beyond_n_m]),
            buckling: fabric.buckling,
            drape_percent: fabric.drape_percent,
        }
    }
}

impl FabricReport {
    fn lines(&self) -> String {
        let mut out = String::new();
        let [warp, weft] = self.bend_un_m;
        put_line!(out, "{} ({})", self.name, self.title);
        put_line!(out, "source           {}", self.source.as_deref().unwrap_or("none stated"));
        put_line!(out, "weight           {:.3} kg/m2", self.density_kg_m2);
        put_line!(out, "stretch          warp {:.0}, weft {:.0} N/m", self.stretch_n_m[0], self.stretch_n_m[1]);
        put_line!(out, "shear            {:.1} N/m a radian", self.shear_n_m);
        let bias = self.bend_bias_un_m.map_or_else(String::new, |b| format!(", bias {b:.1}"));
        put_line!(out, "bending          warp {warp:.2}, weft {weft:.2}{bias} uN m");
        match self.hysteresis {
            [0.0, 0.0, 0.0] => put_line!(out, "loops            none measured: nothing of it rubs"),
            [warp, weft, shear] => {
                put_line!(
                    out,
                    "loops            bending 2HB warp {warp:.3}, weft {weft:.3} mN; shear 2HG {shear:.2} N/m"
                );
                let [warp, weft] = self.residual_curvature_per_m;
                put_line!(out, "stays bent at    warp {warp:.1}, weft {weft:.1} 1/m");
            }
        }
        for (way, curve) in ["warp", "weft"].iter().zip(self.stretch_curves) {
            if let Some([knee, load, beyond, width]) = curve {
                put_line!(
                    out,
                    "stretch curve    {way}: {load:.1} N/m at {knee:.2} %, {beyond:.0} N/m behind it; loop {width:.1} N/m"
                );
            }
        }
        if let Some([degrees, slope]) = self.shear_lock {
            put_line!(out, "shear locks      at {degrees:.1} degrees, {slope:.0} N/m a radian behind it");
        }
        if self.buckling {
            put_line!(out, "buckling         threads that are pushed together give way as arcs");
        }
        if let Some(drape) = self.drape_percent {
            put_line!(out, "drape            {drape:.1} % measured; reported, not fitted to");
        }
        out
    }
}

/// The body of `list`.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct FabricList {
    fabrics: Vec<FabricReport>,
}

/// The body of `show` and `import`.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct ShownFabric {
    fabric: FabricReport,
    /// Loops computed from the file's curves, read as the Kawabata system does.
    loops: Vec<loops::LoopReport>,
    files: Vec<PathBuf>,
}

/// Runs `toile fabric`.
///
/// # Errors
/// A fabric or a sheet that cannot be read, a file that cannot be written.
pub(crate) fn run(command: &FabricCommand) -> Result<(), AppError> {
    match command {
        FabricCommand::List(args) => list(args.printing),
        FabricCommand::Show(args) => show(args),
        FabricCommand::Import(args) => import(args),
    }
}

fn list(printing: Printing) -> Result<(), AppError> {
    let fabrics: Vec<FabricReport> =
        toile_assets::fabric::all().map_err(AppError::internal)?.iter().map(FabricReport::from).collect();
    if printing.json {
        return terminal::print_json(&Document::new("fabric", FabricList { fabrics }));
    }
    let mut out = String::new();
    put_line!(out, "{:<20} {:>7} {:>15} {:>15}  source", "fabric", "kg/m2", "bending uN m", "stays at 1/m");
    for f in &fabrics {
        let pair = |[a, b]: [f32; 2]| format!("{a:.1} {b:.1}");
        let source = f.source.as_deref().unwrap_or("");
        let rubs = f.residual_curvature_per_m != [0.0; 2];
        let (bend, stays) = (pair(f.bend_un_m), if rubs { pair(f.residual_curvature_per_m) } else { "-".into() });
        put_line!(out, "{:<20} {:>7.3} {bend:>15} {stays:>15}  {source}", f.name, f.density_kg_m2);
    }
    terminal::print(&out)
}

/// A built-in fabric, or one of a file.
fn fabric(name: &str) -> Result<Fabric, AppError> {
    if !Path::new(name).extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) {
        return toile_assets::fabric::built_in(name).map_err(AppError::input);
    }
    toile_assets::fabric::parse(name, &text_of(Path::new(name))?).map_err(AppError::input)
}

/// What is read as a fabric's file or a sheet.
const FABRIC_TEXT: FileKind = FileKind {
    name: "a fabric's file or a sheet of measured values",
    max_bytes: 1 << 20,
    cure: "leave out all but the figures of one fabric",
};

fn text_of(path: &Path) -> Result<String, AppError> {
    file::read_text(path, &FABRIC_TEXT).map_err(AppError::input)
}

fn show(args: &ShowArgs) -> Result<(), AppError> {
    let fabric = fabric(&args.fabric)?;
    let files = match &args.picture {
        Some(_) if !loops::any(&fabric) => {
            return Err(AppError::Input(format!(
                "{} has no measured loops and curves to draw; leave `--picture` out",
                fabric.name
            )));
        }
        Some(path) => {
            let picture = OutputFile::prepare(path, Inputs::new([&args.fabric]))?;
            picture.write(&loops::png(&fabric)?)?
        }
        None => Vec::new(),
    };
    finish(&fabric, files, args.printing)
}

fn import(args: &ImportArgs) -> Result<(), AppError> {
    let wrong = |e: &dyn std::fmt::Display| AppError::Input(format!("{}: {e}", args.sheet.display()));
    let sheet = MeasuredSheet::parse(&text_of(&args.sheet)?).map_err(|e| wrong(&e))?;
    let of_file = args.sheet.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let source = args.source.as_deref().unwrap_or(&of_file);
    let text = sheet.file(&args.name, args.title.as_deref().unwrap_or(&args.name), &args.base, source);
    let fabric = toile_assets::fabric::parse(&args.name, &text).map_err(|e| wrong(&e))?;
    let files = OutputFile::prepare(&args.out, Inputs::new([&args.sheet]))?.write(text.as_bytes())?;
    finish(&fabric, files, args.printing)
}

fn finish(fabric: &Fabric, files: Vec<PathBuf>, printing: Printing) -> Result<(), AppError> {
    let body = ShownFabric { fabric: fabric.into(), loops: loops::readings(fabric), files };
    if printing.json {
        return terminal::print_json(&Document::new("fabric", body));
    }
    let mut out = body.fabric.lines();
    for l in &body.loops {
        put_line!(out, "read off the curve {}", l.line());
    }
    terminal::print(&out)?;
    body.files.iter().for_each(|f| printing.words().print_line(&format!("{} written", f.display())));
    Ok(())
}
