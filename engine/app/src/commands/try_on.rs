//! `toile try-on`: one whole try-on, from a session to pictures and a report.

mod animated;
mod physics;
mod worn;

use clap::builder::RangedI64ValueParser;
use clap::{ArgAction, value_parser};
use std::path::Path;
use std::path::PathBuf;
use toile_base::body::Sex;
use toile_engine::cloth::Quality;

use glam::Affine3A;
use toile_assets::adapt::MeshReport;
use toile_assets::drafting;
use toile_assets::export::{self, glb};
use toile_assets::import::avatar::MovingBody;
use toile_base::body::Body;
use toile_base::limits::STEP_SECONDS;
use toile_base::skeleton::{BONES, Joint};
use toile_cli::arguments::{Printing, TapeArgs, one_of, quality};
use toile_cli::document::{Document, hash_text};
use toile_cli::exit::AppError;
use toile_cli::output::Inputs;
use toile_cli::output::OutputFolder;
use toile_cli::terminal::{self, Paint, Progress, Words};
use toile_engine::body::palette;
use toile_engine::frame_loop::quality_control::QUALITY_LEVELS;
use toile_engine::lines::{CAPACITY, Kind, Lines};
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World};
use toile_fitting::dress::measured::{self, MeasuredSubject, ShopperFacts};
use toile_fitting::dress::motion::{self, SessionMotion};
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::TryOn;
use toile_fitting::wearing;
use toile_view::drawn_frame::DrawnFrame;
use toile_view::figure::{Appearance, Figure};
use toile_view::fit_map::{self, JudgedTightness};
use toile_view::video::VideoWriter;

use crate::arguments::{AppearanceArgs, ExportArgs};
use crate::commands::crossings::CrossingCount;
use crate::pictures::{FinalState, Pictures, ROWS, STILL_ROWS, WorstMoment};
use crate::renderer::{PictureRenderer, RendererChoice};
use crate::report::{self, RecommendationReport, ZoneFitReport};
use crate::session_export::DressedExport;
use crate::summary;
use crate::video::Video;

/// Measure a shopper, dress them, and write pictures and a report.
///
/// Watches a session, measures the shopper, recommends a size zone by zone, lets the garment move on a body of that size
/// for the whole session, and writes pictures and a report.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: see how a recorded shopper moves in wide trousers\n  toile try-on --session shopper.csv \
                        --garment wide-leg-trousers --out fitting"
)]
pub struct TryOnArgs {
    /// Recording to watch: .mcap, Kinect CSV, Kinectron JSON or BVH (default: the embedded session)
    #[arg(long, value_name = "F")]
    pub session: Option<PathBuf>,
    /// Garment of the wardrobe, a mesh (.obj, .glb), a sewn pattern (.json, .dxf) or a garment package, with a fabric behind a
    /// colon if another than its own is wanted (tee:jersey-breton); repeat it to dress in layers, inner first
    #[arg(long = "garment", value_name = "G")]
    pub garments: Vec<String>,
    /// Size to wear, as the garment's table names it (default: the one that fits)
    #[arg(long, value_name = "S")]
    pub size: Option<String>,
    /// Garment that is tucked into the next one under it that has a waistband; repeat it for more
    #[arg(long = "tuck", value_name = "G")]
    pub tuck: Vec<String>,
    /// Body to show: female, male, or a file (.glb, .gltf, .vrm) (default: by the garment)
    #[arg(long, value_name = "B", value_parser = Wearer::parse)]
    pub body: Option<Wearer>,
    /// Animation of the file of --body that moves it, in place of a session
    #[arg(long, value_name = "NAME", requires = "body", conflicts_with = "session")]
    pub animation: Option<String>,
    #[command(flatten)]
    look: AppearanceArgs,
    /// Measures taken by tape
    #[command(flatten)]
    pub tape: TapeArgs,
    /// Tested settings of the cloth: draft, shop or fine
    #[arg(long, value_name = "Q", value_parser = quality(), default_value = Quality::default().name())]
    pub quality: Quality,
    /// Hold the quality on a level, to see its error: 0 is all of it
    #[arg(long, alias = "rung", value_name = "L", value_parser = value_parser!(u8).range(0..QUALITY_LEVELS.len() as i64), default_value = "0")]
    pub level: u8,
    /// Folder for the files; it is made if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Write the dressed body at the session's end as dressed.glb too
    #[arg(long)]
    pub glb: bool,
    /// What is written for other tools
    #[command(flatten)]
    pub export: ExportArgs,
    /// Try the outfit with arms raised and sitting too, and say where it pulls
    #[arg(long)]
    pub poses: bool,
    /// Make no pictures: only the report and the physics
    #[arg(long = "no-pictures", action = ArgAction::SetFalse)]
    pub pictures: bool,
    /// Rows of each still of look.png, fit.png and worst.png
    #[arg(long, value_name = "N", value_parser = rows(), default_value_t = STILL_ROWS)]
    pub rows: u16,
    /// What draws: cpu, or gpu in a build with the feature `view`
    #[arg(
        long,
        value_name = "R",
        value_parser = one_of(RendererChoice::ALL, RendererChoice::name),
        default_value = RendererChoice::default().name()
    )]
    pub renderer: RendererChoice,
    /// Film of the session: .mp4 or .webm by ffmpeg, or .png, which every build makes itself
    #[arg(long, value_name = "FILE")]
    pub video: Option<PathBuf>,
    /// Lines over the gpu's pictures: fibers, colliders, contacts, tethers or velocity; repeat it
    #[arg(long, value_name = "KIND", value_parser = one_of(Kind::ALL, Kind::name))]
    pub lines: Vec<Kind>,
    #[command(flatten)]
    printing: Printing,
}

impl TryOnArgs {
    /// The files that are written.
    fn names(&self) -> Vec<&'static str> {
        let pictures = ["session.png", "contact-sheet.png", "worst.png", "look.png", "fit.png"];
        let pictures = pictures.into_iter().filter(|_| self.pictures);
        pictures.chain(self.glb.then_some("dressed.glb")).chain(["report.json"]).collect()
    }

    /// How the body looks.
    fn appearance(&self) -> Result<Appearance, AppError> {
        match &self.body {
            Some(Wearer::File(file)) => self.look.on_body_of(file),
            _ => Ok(self.look.appearance()),
        }
    }

    /// The file of the body, where it is one.
    fn body_file(&self) -> Option<&Path> {
        if let Some(Wearer::File(file)) = &self.body { Some(file.as_path()) } else { None }
    }

    /// Files that are read, and so must not be overwritten.
    pub fn inputs(&self) -> Inputs {
        let body = self.body_file();
        // A garment that is built in is no file, also where a folder has its name.
        let is_built_in = |name: &str| drafting::style(name).is_some();
        let garments = self.garments.iter().filter(|name| !is_built_in(name)).map(Path::new);
        Inputs::new(self.session.as_deref().into_iter().chain(body).chain(garments))
    }
}

/// The body that wears the garments.
#[derive(Debug, Clone, PartialEq)]
pub enum Wearer {
    /// One of ours, of the measured size.
    Ours(Sex),
    /// An imported body, by the path of its file.
    File(PathBuf),
}

impl Wearer {
    /// What `--body` means: a word, or a file that is there or has an extension.
    fn parse(word: &str) -> Result<Self, String> {
        let path = Path::new(word);
        match word {
            "female" => Ok(Self::Ours(Sex::Female)),
            "male" => Ok(Self::Ours(Sex::Male)),
            _ if path.extension().is_some() || path.exists() => Ok(Self::File(path.into())),
            _ => Err("it is neither female nor male nor a file".to_owned()),
        }
    }
}

/// Rows of a still, as `--rows` reads them.
fn rows() -> RangedI64ValueParser<u16> {
    let (least, most) = (i64::from(*ROWS.start()), i64::from(*ROWS.end()));
    RangedI64ValueParser::new().range(least..=most)
}

/// Runs `toile try-on`.
///
/// # Errors
/// Bad input, an output folder that cannot be written, or a closed stdout.
pub fn run(args: &TryOnArgs) -> Result<(), AppError> {
    if args.renderer == RendererChoice::Cpu && !args.lines.is_empty() {
        return Err(AppError::Usage("lines are drawn by the GPU alone; add `--renderer gpu`".to_owned()));
    }
    args.appearance()?;
    let mut renderer = PictureRenderer::open(args.renderer)?;
    let words = args.printing.words();
    let inputs = args.inputs();
    // Without ffmpeg a video becomes an animated PNG beside it.
    let films = args.video.iter().flat_map(|film| [film.clone(), film.with_extension("png")]);
    films.into_iter().try_for_each(|film| inputs.check(&film))?;
    args.video.iter().try_for_each(|film| VideoWriter::check(film)).map_err(AppError::input)?;
    let mut out = OutputFolder::prepare(&args.out)?.sparing(inputs);
    out.check(&args.names())?;
    let request = request(args)?.open()?;
    let animation = args.animation.as_deref();
    let moving = animation.map(|name| animated::body(args.body_file(), name, &request)).transpose()?;
    let mut session = match &moving {
        Some(moving) => motion::session_of(moving),
        None => session::open(args.session.as_deref(), None)?,
    };
    let still = moving.as_ref().map(motion::standing_still);
    let mut measured = measured::measure(still.as_ref().unwrap_or(&session), request.facts())?;
    if session.joints.is_empty() {
        words.print_line("there are no joints: the fitted body is followed through the depth");
    }
    measured::add_joints(&mut session, &measured)?;
    let track = session::standing(&session)?;
    let (body, note) = worn_body(args, &mut measured, &request, moving.as_ref())?;
    let notes: Vec<String> = note.into_iter().chain(measured.best.notes.iter().cloned()).collect();
    let dressed = request.put_on(body, &measured.best)?;
    let (recommendations, judged) = (worn::recommendations(&dressed.fitted), dressed.tightness());
    let meshes: Vec<MeshReport> = dressed.fitted.iter().filter_map(|fitted| fitted.mesh.clone()).collect();
    meshes.iter().flat_map(MeshReport::lines).for_each(|line| words.print_line(&line));
    let settings = QUALITY_LEVELS[usize::from(args.level)].of(&request.settings());
    let poses = if args.poses { wearing::in_poses(&dressed, &settings)? } else { Vec::new() };
    let (mut world, mut reader) = dressed.build(settings).map_err(AppError::internal)?;
    let title = title(&recommendations);
    let motion =
        moving.as_ref().map_or_else(|| SessionMotion::of_joints(&track), |m| SessionMotion::of_poses(&m.poses));
    let played = play((args, &words, &title, &judged), &mut out, &mut renderer, (&mut world, &mut reader), motion)?;

    if args.glb {
        out.write("dressed.glb", &dressed_glb(&world, reader.latest()))?;
    }
    // The report names itself as well.
    out.stage("report.json")?;
    let files = out.files().into_iter().chain(played.film).collect();
    let mut recommendations = recommendations.into_iter();
    let document = Document::new(
        "try-on",
        report::TryOn {
            session: report::measures::session(&session, &notes),
            measurements: report::measures::measurements(&measured.best, measured.population),
            recommendation: recommendations.next().unwrap_or_default(),
            others: recommendations.collect(),
            physics: physics::physics(&world),
            crossings: played.crossings,
            contact: physics::contact(&world),
            meshes,
            hidden_mm: played.hidden_mm.map(|max| report::Penetration { max }),
            poses,
            animation: moving.as_ref().map(animated::report).transpose()?,
            export: played.export,
            state_hash: hash_text(world.state_hash()),
            renderer: played.renderer,
            files,
        },
    );
    let text = serde_json::to_string_pretty(&document).map_err(AppError::internal)?;
    out.write("report.json", format!("{text}\n").as_bytes())?;
    out.commit()?;
    if args.printing.json {
        terminal::print_json(&document)
    } else {
        terminal::print(&summary::try_on(&document.body, Paint::for_stdout()))
    }
}

fn request(args: &TryOnArgs) -> Result<TryOn, AppError> {
    let sex = if let Some(Wearer::Ours(sex)) = args.body { Some(sex) } else { None };
    let shopper = ShopperFacts { sex, tape: args.tape.readings()?, ..ShopperFacts::default() };
    let request = TryOn::of_shopper(&args.garments, args.size.as_deref(), shopper).in_quality(args.quality);
    Ok(TryOn { tuck: args.tuck.clone(), ..request })
}

/// The body to dress, and a sentence about it where there is one: the body of a file, whose measures then count, or the shopper's.
fn worn_body(
    args: &TryOnArgs,
    measured: &mut MeasuredSubject,
    request: &TryOn,
    moving: Option<&MovingBody>,
) -> Result<(Body, Option<String>), AppError> {
    let made_for = request.population()?;
    if let Some(Wearer::File(file)) = &args.body {
        let shown = match moving {
            Some(moving) => moving.imported.body.clone(),
            None => crate::commands::body::wearer(file, measured.sex(made_for))?.body,
        };
        measured.best = measured::read_off(measured.best.clone(), &shown);
        let note = format!("the body shown is {}, and the measures are read off it", file.display());
        return Ok((shown, Some(note)));
    }
    Ok(measured.wearer(made_for)?)
}

/// What playing a session left behind.
struct Played {
    /// Name of the renderer; none where no picture was asked for.
    renderer: Option<String>,
    film: Option<PathBuf>,
    export: Option<report::ExportReport>,
    crossings: report::CrossingReport,
    /// What the pictures hid at most (mm); none where there are none.
    hidden_mm: Option<f64>,
}

/// Plays the session through the world, 120 steps a second, and draws it.
fn play(
    (args, words, title, judged): (&TryOnArgs, &Words, &str, &[JudgedTightness]),
    out: &mut OutputFolder,
    renderer: &mut PictureRenderer,
    (world, reader): (&mut World, &mut Reader<Snapshot>),
    mut motion: SessionMotion<'_>,
) -> Result<Played, AppError> {
    let steps = motion.steps();
    let appearance = args.appearance()?;
    renderer.prepare(&Figure::of(world.body(), appearance), world.garments());
    let mut pictures = None;
    if args.pictures {
        let bar = words.bar(Pictures::work(steps), "drawing");
        pictures = Some(Pictures::begin(out, DrawnFrame::new(world, appearance), (steps, args.rows), bar)?);
    }
    let film = |path: &PathBuf| {
        let bar = words.bar(Video::work(steps), "filming");
        Video::begin(path, DrawnFrame::new(world, appearance), steps, bar)
    };
    let mut video = args.video.as_ref().map(film).transpose()?;
    let mut export = export(args, out, world, steps)?;
    let playing = (pictures.is_none() && video.is_none()).then(|| words.bar(steps, "playing"));
    let mut lines = Lines::new(if args.lines.is_empty() { 0 } else { CAPACITY });
    let mut crossings = CrossingCount::new(world.garments(), f64::from(STEP_SECONDS));
    let mut worst = None;
    motion.dress(world);
    for tick in 0..steps {
        motion.step(world);
        playing.iter().for_each(|bar| bar.inc(1));
        if crossings.after(tick, world.cloths()) && args.pictures {
            worst = Some(worst_moment(world, reader.latest(), &crossings.report()));
        }
        if let Some(export) = &mut export {
            export.after(tick, world, reader.latest(), out)?;
        }
        if let Some(pictures) = pictures.as_mut().filter(|p| p.wants(tick)) {
            draw_lines(&mut lines, &args.lines, world);
            pictures.add(renderer, reader.latest(), lines.as_slice())?;
        }
        if let Some(video) = video.as_mut().filter(|_| Video::wants(tick)) {
            draw_lines(&mut lines, &args.lines, world);
            video.add(renderer, reader.latest(), lines.as_slice())?;
        }
    }
    playing.iter().for_each(Progress::finish_and_clear);
    let drew = pictures.is_some() || video.is_some();
    let mut hidden_m = 0.0f32;
    if let Some(pictures) = pictures {
        let tightness = fit_map::of_world(world, judged);
        draw_lines(&mut lines, &args.lines, world);
        let (facing, worst) = (facing(world), worst.as_ref());
        let ending = FinalState { tightness: &tightness, facing, title, lines: lines.as_slice(), worst };
        hidden_m = pictures.finish(out, renderer, reader.latest(), &ending)?;
    }
    let film = video.map(Video::finish).transpose()?;
    hidden_m = film.iter().map(|(_, hidden)| *hidden).fold(hidden_m, f32::max);
    let exported = |frames| report::ExportReport {
        formats: args.export.formats.iter().map(|f| f.name()).collect(),
        frames,
        rate_hz: args.export.rate_hz,
    };
    let export = export.map(|export| export.finish(out)).transpose()?.map(exported);
    Ok(Played {
        export,
        renderer: drew.then(|| renderer.describe()),
        film: film.map(|(path, _)| path),
        crossings: crossings.report(),
        hidden_mm: drew.then_some(f64::from(hidden_m) * 1e3),
    })
}

/// The files of the motion, where any are asked for.
fn export(
    args: &TryOnArgs,
    out: &mut OutputFolder,
    world: &World,
    steps: u64,
) -> Result<Option<DressedExport>, AppError> {
    let ExportArgs { formats, rate_hz } = &args.export;
    if formats.is_empty() {
        return Ok(None);
    }
    let timing = (steps, args.export.stride(), f64::from(*rate_hz));
    let skin = args.appearance()?.skin.colour().to_array();
    DressedExport::begin(out, world, skin, formats, timing).map(Some)
}

/// The direction in which the shopper looks (rad from +z towards +x).
fn facing(world: &World) -> f32 {
    let ahead = world.pose().local[Joint::Pelvis.index()] * glam::Vec3::Z;
    ahead.x.atan2(ahead.z)
}

/// The world as it is, with the crossings that were just counted.
fn worst_moment(world: &World, snapshot: &Snapshot, seen: &report::CrossingReport) -> WorstMoment {
    WorstMoment {
        seconds: seen.worst_s.unwrap_or_default(),
        crossings: seen.max,
        garments: snapshot.garments.clone(),
        skin: snapshot.skin.clone(),
        facing: facing(world),
    }
}

/// Fills in the lines that were asked for, of the world as it is.
fn draw_lines(lines: &mut Lines, kinds: &[Kind], world: &World) {
    lines.clear();
    for &kind in kinds {
        if kind == Kind::Colliders {
            lines.add_colliders(world.colliders());
        }
        for (cloth, garment) in world.cloths().iter().zip(world.garments()) {
            lines.add_garment(kind, cloth, garment, world.colliders());
        }
    }
}

/// The dressed body as it is drawn last: the body on its skeleton in that pose, the garments as they lie.
fn dressed_glb(world: &World, snapshot: &Snapshot) -> Vec<u8> {
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(&world.body().skeleton, world.pose(), &mut bones);
    let worn = world.garments().iter().zip(&snapshot.garments).map(|(garment, positions)| export::WornGarment {
        name: &garment.name,
        positions,
        triangles: &garment.triangles,
        srgb: garment.fabric.colour,
    });
    let worn: Vec<export::WornGarment<'_>> = worn.collect();
    glb(&export::DressedBody { body: world.body(), palette: Some(&bones), worn: &worn })
}

/// Words over the stills: the first garment and its size, then each zone.
fn title(recommendations: &[RecommendationReport]) -> String {
    let line = |r: &RecommendationReport| {
        let zone = |z: &ZoneFitReport| {
            format!("{} {} ({:+.0} mm)", z.zone, z.feel.as_deref().unwrap_or(&z.verdict), z.ease_mm)
        };
        let zones = r.zones.iter().map(zone);
        format!("{}, size {}\n{}", r.garment, r.size, zones.collect::<Vec<_>>().join("   "))
    };
    recommendations.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_is_a_word_or_a_file() {
        assert_eq!(Wearer::parse("male").unwrap(), Wearer::Ours(Sex::Male));
        assert_eq!(Wearer::parse("a.vrm").unwrap(), Wearer::File("a.vrm".into()));
        assert!(Wearer::parse("tall").is_err());
    }
}
