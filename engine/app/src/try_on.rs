//! `toile try-on`: one whole try-on, from a session to pictures and a report.

use std::path::{Path, PathBuf};

use glam::Affine3A;
use toile_assets::body::{Body, Sex};
use toile_assets::export::{self, Dressed, glb};
use toile_assets::garment::Garment;
use toile_assets::limits::STEP_HZ;
use toile_assets::rig::Rig;
use toile_assets::sizes::Population;
use toile_assets::skeleton::{BONES, Joint};
use toile_assets::wardrobe::{self, style::Style};
use toile_engine::body::palette;
use toile_engine::cloth::{Settings, measure};
use toile_engine::frame::{Frame, Snapshot};
use toile_engine::lines::{CAPACITY, Kind, Lines};
use toile_engine::triple_buffer::Reader;
use toile_sensors::clock::{ns_to_ticks, ticks_to_ns};
use toile_sensors::frame::Joints;
use toile_sensors::sample::sample;
use toile_track::measure::Measurements;

use crate::artist::{Artist, Renderer};
use crate::cli::{TryOnArgs, Wearer};
use crate::exit::AppError;
use crate::fit;
use crate::output::OutputFolder;
use crate::pictures::{Ending, Pictures};
use crate::report::{self, Document, TryOn};
use crate::shopper;
use crate::summary;
use crate::terminal::{self, Paint, Progress, Words};
use crate::tracking;
use crate::video::Video;

/// Fabric of a mesh that a user brings without saying what it is made of.
const MESH_FABRIC: &str = "cotton-lawn";

/// Said of a session without joints.
const FROM_DEPTH: &str = "there are no joints: the body was fitted to the depth, and its joints are shown";

/// What a user asked to wear: a garment of the wardrobe, or a mesh.
enum Wanted {
    Style(Box<Style>),
    Mesh(String),
}

/// Runs `toile try-on`.
///
/// # Errors
/// Bad input, an output folder that cannot be written, or a closed stdout.
pub fn run(args: &TryOnArgs) -> Result<(), AppError> {
    if args.renderer == Renderer::Cpu && !args.lines.is_empty() {
        return Err(AppError::Usage("lines are drawn by the GPU alone; add `--renderer gpu`".to_owned()));
    }
    let mut artist = Artist::open(args.renderer)?;
    let words = Words::new(args.quiet || args.json);
    let inputs = args.inputs();
    // Without ffmpeg a video becomes an animated PNG beside it.
    let films = args.video.iter().flat_map(|film| [film.clone(), film.with_extension("png")]);
    films.into_iter().try_for_each(|film| inputs.check(&film))?;
    let mut out = OutputFolder::prepare(&args.out)?.sparing(inputs);
    let wanted = wanted(args)?;
    let mut session = shopper::open(args.session.as_deref(), None)?;
    let (sex, population) = population(args, &wanted)?;
    let mut measured = shopper::measure(&session, population)?;
    let mut fitted = None;
    if session.joints.is_empty() {
        words.say("there are no joints: fitting the body to the depth");
        let (found, joints) = tracking::joints(&session, population)?;
        (session.joints, measured) = (joints, tracking::preferred(measured, &found));
        session.notes.push(FROM_DEPTH.to_owned());
        fitted = Some(found.body.body);
    }
    let Worn { body, measured, note } = worn(args, measured, (sex, population), fitted)?;
    let notes: Vec<String> = note.into_iter().chain(measured.notes.iter().cloned()).collect();
    let (garments, recommendations) = dress(&wanted, args, &measured, &body)?;

    let rig = Rig::fit(&body);
    let settings = Settings { quality: args.quality, ..Settings::default() };
    let (mut frame, mut reader) = Frame::new(body, &rig, garments, settings).map_err(AppError::internal)?;
    let track = shopper::believable(&session);
    let track = &track[shopper::stands_from(&track)..];
    let title = title(&recommendations);
    let played = play((args, &words, &title), &mut out, &mut artist, &mut frame, &mut reader, track)?;

    if args.glb {
        out.write("dressed.glb", &dressed(&frame, reader.latest()))?;
    }
    // The report names itself as well.
    out.stage("report.json")?;
    let files = out.files().into_iter().chain(played.film).collect();
    let mut recommendations = recommendations.into_iter();
    let document = Document::new(
        "try-on",
        TryOn {
            session: shopper::session_report(&session, &notes),
            measurements: shopper::measures_report(&measured, population),
            recommendation: recommendations.next().unwrap_or_default(),
            others: recommendations.collect(),
            physics: physics(&frame),
            state_hash: report::hash_text(frame.state_hash()),
            renderer: played.renderer,
            files,
        },
    );
    let text = serde_json::to_string_pretty(&document).map_err(AppError::internal)?;
    out.write("report.json", format!("{text}\n").as_bytes())?;
    out.commit()?;
    if args.json {
        terminal::print_json(&document)
    } else {
        terminal::print(&summary::try_on(&document.body, Paint::for_stdout()))
    }
}

/// Who wears it.
struct Worn {
    body: Body,
    measured: Measurements,
    note: Option<String>,
}

/// The body to dress: a file's, the one fitted to the depth, or one built to the measures.
fn worn(
    args: &TryOnArgs,
    measured: Measurements,
    (sex, population): (Sex, Population),
    fitted: Option<Body>,
) -> Result<Worn, AppError> {
    if let Some(Wearer::File(file)) = &args.body {
        let imported = crate::commands::body::wearer(file, sex)?;
        let measured = shopper::of_body(measured, &imported.body);
        let note = format!("the body shown is {}, and the measures are read off it", file.display());
        return Ok(Worn { body: imported.body, measured, note: Some(note) });
    }
    let (body, note) = match fitted {
        Some(body) => (body, None),
        None => shopper::build(sex, &measured, population)?,
    };
    Ok(Worn { body, measured, note })
}

/// What to wear; the wardrobe's first garment if nothing is said. A name with a file behind it is a mesh.
fn wanted(args: &TryOnArgs) -> Result<Vec<Wanted>, AppError> {
    let default = [wardrobe::names()[0].to_owned()];
    let names = if args.garments.is_empty() { default.as_slice() } else { &args.garments };
    names
        .iter()
        .map(|name| {
            let is_file = Path::new(name).exists() || name.to_lowercase().ends_with(".obj");
            if is_file && !wardrobe::names().contains(&name.as_str()) {
                return Ok(Wanted::Mesh(name.clone()));
            }
            wardrobe::style(name).map(|s| Wanted::Style(Box::new(s))).map_err(AppError::input)
        })
        .collect()
}

/// Whose body is shown: as asked for, otherwise whom the first garment with sizes is cut for; women for all others.
fn population(args: &TryOnArgs, wanted: &[Wanted]) -> Result<(Sex, Population), AppError> {
    let asked = if let Some(Wearer::Ours(sex)) = args.body { Some(sex) } else { None };
    let mut of = Population::Mixed;
    for style in wanted.iter().filter_map(|w| if let Wanted::Style(s) = w { Some(s) } else { None }) {
        let population = style.sizes().map_err(AppError::input)?.population;
        if population != Population::Mixed {
            of = population;
            break;
        }
    }
    let sex = asked.unwrap_or(if of == Population::Men { Sex::Male } else { Sex::Female });
    let known = asked.map_or(of, |sex| Population::from(Some(sex)));
    Ok((sex, known))
}

/// Sizes and bakes every garment.
fn dress(
    wanted: &[Wanted],
    args: &TryOnArgs,
    measured: &Measurements,
    body: &Body,
) -> Result<(Vec<Garment>, Vec<report::Recommendation>), AppError> {
    let (mut garments, mut recommendations) = (Vec::new(), Vec::new());
    for item in wanted {
        match item {
            Wanted::Style(style) => {
                let fitted = fit::choose(style, args.size.as_deref(), measured)?;
                garments.push(style.dress(&fitted.size, body).map_err(AppError::input)?);
                recommendations.push(fitted);
            }
            Wanted::Mesh(path) => {
                if let Some(size) = &args.size {
                    let (name, size) = (path.clone(), size.clone());
                    return Err(AppError::input(wardrobe::WardrobeError::NoSizes { name, size }));
                }
                let garment = wardrobe::dress_mesh(Path::new(path), MESH_FABRIC, body).map_err(AppError::input)?;
                recommendations.push(report::Recommendation {
                    garment: path.clone(),
                    size: garment.size.clone(),
                    ..Default::default()
                });
                garments.push(garment);
            }
        }
    }
    Ok((garments, recommendations))
}

/// What playing a session left behind.
struct Played {
    /// Who drew; nobody where no picture was asked for.
    renderer: Option<String>,
    film: Option<PathBuf>,
}

/// Plays the session through the frame, 120 steps a second, and draws it.
fn play(
    (args, words, title): (&TryOnArgs, &Words, &str),
    out: &mut OutputFolder,
    artist: &mut Artist,
    frame: &mut Frame,
    reader: &mut Reader<Snapshot>,
    track: &[Joints],
) -> Result<Played, AppError> {
    let (Some(first), Some(last)) = (track.first(), track.last()) else {
        return Err(AppError::internal("a session without joints was let through"));
    };
    let steps = ns_to_ticks(last.time_ns - first.time_ns).max(1);
    artist.prepare(frame.body(), frame.garments());
    let mut pictures = None;
    if args.pictures {
        let bar = words.bar(Pictures::work(steps), "drawing");
        pictures = Some(Pictures::begin(out, frame, steps, bar)?);
    }
    let film = |path: &PathBuf| Video::begin(path, frame, steps, words.bar(Video::work(steps), "filming"));
    let mut video = args.video.as_ref().map(film).transpose()?;
    let playing = (pictures.is_none() && video.is_none()).then(|| words.bar(steps, "playing"));
    let mut lines = Lines::new(if args.lines.is_empty() { 0 } else { CAPACITY });
    frame.dress(first);
    for tick in 0..steps {
        let joints = sample(track, first.time_ns + ticks_to_ns(tick)).unwrap_or(*first);
        frame.step(&joints);
        playing.iter().for_each(|bar| bar.inc(1));
        if let Some(pictures) = pictures.as_mut().filter(|p| p.wants(tick)) {
            draw_lines(&mut lines, &args.lines, frame);
            pictures.add(artist, reader.latest(), lines.as_slice())?;
        }
        if let Some(video) = video.as_mut().filter(|_| Video::wants(tick)) {
            draw_lines(&mut lines, &args.lines, frame);
            video.add(artist, reader.latest(), lines.as_slice())?;
        }
    }
    playing.iter().for_each(Progress::finish_and_clear);
    let drew = pictures.is_some() || video.is_some();
    if let Some(pictures) = pictures {
        let tightness: Vec<Vec<f32>> = frame
            .cloths()
            .iter()
            .zip(frame.garments())
            .map(|(cloth, garment)| measure::tightness(cloth, garment, frame.colliders()))
            .collect();
        let ahead = frame.pose().local[Joint::Pelvis.index()] * glam::Vec3::Z;
        let facing = ahead.x.atan2(ahead.z);
        draw_lines(&mut lines, &args.lines, frame);
        let ending = Ending { tightness: &tightness, facing, title, lines: lines.as_slice() };
        pictures.finish(out, artist, reader.latest(), &ending)?;
    }
    let film = video.map(Video::finish).transpose()?;
    Ok(Played { renderer: drew.then(|| artist.describe()), film })
}

/// Fills in the lines that were asked for, of the frame as it is.
fn draw_lines(lines: &mut Lines, kinds: &[Kind], frame: &Frame) {
    lines.clear();
    for &kind in kinds {
        if kind == Kind::Colliders {
            lines.add_colliders(frame.colliders());
        }
        for (cloth, garment) in frame.cloths().iter().zip(frame.garments()) {
            lines.add_garment(kind, cloth, garment, frame.colliders());
        }
    }
}

/// The dressed body as it is drawn last: the body on its skeleton in that pose, the garments as they lie.
fn dressed(frame: &Frame, snapshot: &Snapshot) -> Vec<u8> {
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(&frame.body().skeleton, frame.pose(), &mut bones);
    let worn = frame.garments().iter().zip(&snapshot.garments).map(|(garment, positions)| export::Worn {
        name: &garment.name,
        positions,
        triangles: &garment.triangles,
        srgb: garment.fabric.colour,
    });
    let worn: Vec<export::Worn<'_>> = worn.collect();
    glb(&Dressed { body: frame.body(), palette: Some(&bones), worn: &worn })
}

/// Words over the stills: the first garment and its size, then each zone.
fn title(recommendations: &[report::Recommendation]) -> String {
    let line = |r: &report::Recommendation| {
        let zones = r.zones.iter().map(|z| format!("{} {} ({:+.0} mm)", z.zone, z.verdict, z.ease_mm));
        format!("{}, size {}\n{}", r.garment, r.size, zones.collect::<Vec<_>>().join("   "))
    };
    recommendations.iter().map(line).collect::<Vec<_>>().join("\n")
}

fn physics(frame: &Frame) -> report::Physics {
    let meters = frame.meters();
    let us = |quantile: f64| meters.step_ns.value_at_quantile(quantile) as f64 * 1e-3;
    let strain = meters.strain();
    let mut warnings = Vec::new();
    for (cloth, garment) in frame.cloths().iter().zip(frame.garments()) {
        let events = cloth.events;
        if events.rolled_back > 0 {
            warnings
                .push(format!("{}: {} steps were not finite and were rolled back", garment.name, events.rolled_back));
        }
        if events.speed_limited > 0 {
            warnings.push(format!(
                "{}: particles were held at the speed limit {} times",
                garment.name, events.speed_limited
            ));
        }
    }
    let held = frame.colliders().held();
    if held > 0 {
        warnings.push(format!("collision spheres jumped or were not finite and were held {held} times"));
    }
    if frame.broken() > 0 {
        warnings.push(format!("{} steps broke off in a worker; the garments kept their last places", frame.broken()));
    }
    report::Physics {
        hz: STEP_HZ,
        quality: frame.settings().quality.name(),
        lanes: frame.settings().width.lanes(),
        workers: frame.settings().workers,
        substeps: frame.cloths().iter().map(|c| c.substeps()).max().unwrap_or(0),
        particles: frame.garments().iter().map(Garment::particles).sum(),
        steps: frame.tick(),
        step_us: report::StepMicros {
            p50: us(0.5),
            p99: us(0.99),
            p999: us(0.999),
            max: meters.step_ns.max() as f64 * 1e-3,
        },
        strain: report::Strain { mean: f64::from(strain.mean), p99: f64::from(strain.p99), max: f64::from(strain.max) },
        penetration_mm: report::Penetration { max: f64::from(meters.penetration_max) * 1e3 },
        nonfinite: frame.cloths().iter().map(|c| c.events.rolled_back).sum(),
        warnings,
    }
}
