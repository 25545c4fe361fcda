//! `toile body --colliders`: the distance of the collision body from the skin.

use std::f32::consts::{FRAC_PI_2, PI};
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;

use glam::Vec3;
use serde::Serialize;
use toile_assets::people;
use toile_assets::rig::{MEAN_GOAL_MM, P95_GOAL_MM};
use toile_base::body::Body;
use toile_base::numeric::statistics::quantile;
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFolder};
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Paint, Tone, Words};
use toile_view::contact_sheet;
use toile_view::image::Size;
use toile_view::scene::{Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

use crate::commands::body::{self, BodyArgs};
use crate::report::Followed;

/// A picture of one side.
const STILL: Size = Size::new(480, 580);

/// Views of a body: turns of the camera.
const VIEWS: [f32; 3] = [0.0, FRAC_PI_2, PI];

/// Distance from the skin at which the picture's colour is full (m).
const FULL: f32 = 0.02;

/// Linear RGB of skin that the capsules follow, that stands out of them, and that lies below them.
const CLOSE: Vec3 = Vec3::new(0.72, 0.70, 0.66);
const PROUD: Vec3 = Vec3::new(0.75, 0.12, 0.06);
const BELOW: Vec3 = Vec3::new(0.05, 0.20, 0.62);

/// Colours of the capsules, in turn: left and right alike.
const CAPSULES: [Vec3; 6] = [
    Vec3::new(0.55, 0.42, 0.30),
    Vec3::new(0.30, 0.45, 0.48),
    Vec3::new(0.60, 0.55, 0.35),
    Vec3::new(0.45, 0.32, 0.42),
    Vec3::new(0.38, 0.50, 0.34),
    Vec3::new(0.50, 0.50, 0.55),
];

/// One body and its fit.
#[derive(Debug, Serialize)]
struct FittedColliders {
    name: String,
    /// Stature, chest, waist and hip girth as the tape reads them (mm).
    measures_mm: [f64; 4],
    fit_ms: f64,
    zones: Vec<Followed>,
    #[serde(skip)]
    stranger: bool,
}

/// What the command says as JSON.
#[derive(Debug, Serialize)]
struct CollidersReport {
    spheres: usize,
    capsules: usize,
    mean_goal_mm: f32,
    p95_goal_mm: f32,
    bodies: Vec<FittedColliders>,
    /// Bodies and zones that miss the goal.
    missed: Vec<[String; 2]>,
    files: Vec<PathBuf>,
}

/// Runs `toile body --colliders`.
///
/// # Errors
/// A file that does not become a body; [`AppError::Threshold`] where a body that is no stranger misses the goal, after
/// the table.
pub fn run(args: &BodyArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let out = args.pictures.then(|| OutputFolder::prepare(&args.out)).transpose()?;
    let mut out = out.map(|out| out.sparing(Inputs::new(&args.file)));
    let (bodies, shown) = match &args.file {
        Some(_) => {
            let body = body::import(args)?.0.body;
            let name = body::file_name(args);
            (vec![fitted(name.clone(), &body, false)], vec![(name, body)])
        }
        None => ours(args, &words)?,
    };
    if let Some(out) = &mut out {
        let bar = words.bar(shown.len() as u64, "drawing");
        for (name, body) in &shown {
            let file = format!("colliders-{}.png", name.replace(|c: char| !c.is_ascii_alphanumeric(), "-"));
            write_png(out, &file, &drawn(body))?;
            bar.inc(1);
        }
        bar.finish_and_clear();
    }
    let files = out.as_ref().map_or_else(Vec::new, OutputFolder::files);
    let report = report(bodies, files);
    if let Some(out) = out {
        out.commit()?;
    }
    let verdict = verdict(&report);
    if args.printing.json {
        terminal::print_json(&Document::new("body-colliders", report))?;
    } else {
        terminal::print(&table(&report, Paint::for_stdout()))?;
    }
    verdict
}

/// Bodies with names, to be shown.
type Shown = Vec<(String, Body)>;

/// Our own bodies of all sizes and the strangers; the middle sizes are shown.
fn ours(args: &BodyArgs, words: &Words) -> Result<(Vec<FittedColliders>, Shown), AppError> {
    let (sizes, strangers) = (people::sizes(), people::strangers(args.strangers, args.seed));
    let bar = words.bar((sizes.len() + strangers.len()) as u64, "fitting");
    let (mut bodies, mut shown) = (Vec::new(), Vec::new());
    for (person, stranger) in sizes.iter().map(|p| (p, false)).chain(strangers.iter().map(|p| (p, true))) {
        let body = person.body().map_err(AppError::internal)?;
        bodies.push(fitted(person.name.clone(), &body, stranger));
        if ["women 42", "men 52"].contains(&person.name.as_str()) {
            shown.push((person.name.clone(), body));
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok((bodies, shown))
}

fn fitted(name: String, body: &Body, stranger: bool) -> FittedColliders {
    let begun = Instant::now();
    let rig = toile_assets::rig::fit(body);
    let fit_ms = (begun.elapsed().as_secs_f64() * 1e5).round() / 100.0;
    let m = &body.measures;
    let measures_mm =
        [m.stature, m.chest_girth, m.waist_girth, m.hip_girth].map(|m| (f64::from(m) * 1e4).round() / 10.0);
    FittedColliders { name, measures_mm, fit_ms, zones: Followed::of(&toile_assets::rig::report(&rig, body)), stranger }
}

fn report(bodies: Vec<FittedColliders>, files: Vec<PathBuf>) -> CollidersReport {
    let zones = bodies.iter().flat_map(|b| b.zones.iter().map(move |z| (b, z)));
    let missed = zones.filter(|(_, z)| z.meets == Some(false)).map(|(b, z)| [b.name.clone(), z.zone.to_owned()]);
    CollidersReport {
        spheres: toile_base::rig::SPHERES,
        capsules: toile_base::limits::MAX_CAPSULES,
        mean_goal_mm: MEAN_GOAL_MM,
        p95_goal_mm: P95_GOAL_MM,
        missed: missed.collect(),
        bodies,
        files,
    }
}

fn verdict(report: &CollidersReport) -> Result<(), AppError> {
    let sized = |name: &String| report.bodies.iter().any(|b| b.name == *name && !b.stranger);
    let missed: Vec<String> = report
        .missed
        .iter()
        .filter(|[name, _]| sized(name))
        .map(|[name, zone]| format!("{name} at the {zone}"))
        .collect();
    match missed[..] {
        [] => Ok(()),
        _ => Err(AppError::Threshold(format!("the collision body misses its goal: {}", missed.join(", ")))),
    }
}

/// The table as people read it.
fn table(report: &CollidersReport, paint: Paint) -> String {
    let mut text = String::new();
    let (mean, p95) = (report.mean_goal_mm, report.p95_goal_mm);
    let head =
        format!("{} spheres, {} capsules; skin to their union, mean and 95 % (mm)", report.spheres, report.capsules);
    let _ = writeln!(text, "{}", paint.tone(&head, Tone::Strong));
    let sized: Vec<&FittedColliders> = report.bodies.iter().filter(|b| !b.stranger).collect();
    let _ = write!(text, "{:10}", "");
    let names: String = sized.iter().map(|b| format!(" {:>12}", b.name)).collect();
    let _ = writeln!(text, "{names}");
    for (i, zone) in sized.first().map_or(&[][..], |b| &b.zones).iter().enumerate() {
        let _ = write!(text, "{:10}", zone.zone);
        for body in &sized {
            let z = &body.zones[i];
            let cell = format!(" {:>12}", format!("{:.1} {:5.1}", z.mean_mm, z.p95_mm));
            let tone = if z.meets == Some(true) { Tone::Good } else { Tone::Warn };
            text += &if z.meets.is_some() { paint.tone(&cell, tone).into_owned() } else { cell };
        }
        let _ = writeln!(text, "{}", if zone.meets.is_some() { format!("  goal {mean} {p95}") } else { String::new() });
    }
    worst(&mut text, report, paint);
    text
}

/// Of all bodies, zone by zone.
fn worst(text: &mut String, report: &CollidersReport, paint: Paint) {
    let count = report.bodies.len();
    let title = format!("All {count} bodies: mean of the means, else the worst (mm)");
    let _ = writeln!(text, "\n{}", paint.tone(&title, Tone::Strong));
    let names = ["signed", "mean", "95 %", "outside", "inside", "mean", "95 %", "above", "below"];
    let _ = writeln!(text, "{:10} {:-^39} {:-^31}", "", " skin to union ", " union to skin ");
    let names: String = names.iter().map(|name| format!("{name:>8}")).collect();
    let _ = writeln!(text, "{:10}{names}", "");
    for (i, zone) in report.bodies.first().map_or(&[][..], |b| &b.zones).iter().enumerate() {
        let all = |of: &dyn Fn(&Followed) -> f64| report.bodies.iter().map(|b| of(&b.zones[i])).collect::<Vec<_>>();
        let mean = |of: &dyn Fn(&Followed) -> f64| all(of).iter().sum::<f64>() / count as f64;
        let most = |of: &dyn Fn(&Followed) -> f64| all(of).into_iter().fold(0.0, f64::max);
        let figures = [
            mean(&|z| z.signed_mean_mm),
            mean(&|z| z.mean_mm),
            most(&|z| z.p95_mm),
            most(&|z| z.max_outside_mm),
            most(&|z| z.max_inside_mm),
            mean(&|z| z.cloth_mean_mm),
            most(&|z| z.cloth_p95_mm),
            most(&|z| z.cloth_max_above_mm),
            most(&|z| z.cloth_max_below_mm),
        ];
        let figures: String = figures.iter().map(|figure| format!("{figure:8.1}")).collect();
        let _ = writeln!(text, "{:10}{figures}", zone.zone);
    }
    let mut times: Vec<f64> = report.bodies.iter().map(|b| b.fit_ms).collect();
    let [median, longest] = [0.5, 1.0].map(|share| quantile(&mut times, share).unwrap_or(0.0));
    let _ = writeln!(text, "a fit takes {median:.0} ms (median), {longest:.0} ms (max), once a body");
    for [name, zone] in &report.missed {
        let _ = writeln!(text, "{}", paint.tone(&format!("{name} misses the goal at the {zone}"), Tone::Warn));
    }
}

/// Above, the skin by its distance from the union: red stands out of it, blue lies below. Below, the capsules.
fn drawn(body: &Body) -> toile_view::image::Image {
    let rig = toile_assets::rig::fit(body);
    let towards = |d: f32| CLOSE.lerp(if d > 0.0 { PROUD } else { BELOW }, (d.abs() / FULL).min(1.0));
    let skin: Vec<Vec3> = body.mesh.positions.iter().map(|p| towards(rig.distance(body, *p))).collect();
    let shell = toile_assets::rig::shell(&rig, body);
    let painted: Vec<Vec3> = shell.capsules.iter().map(|c| CAPSULES[usize::from(*c) / 2 % CAPSULES.len()]).collect();
    let surfaces = [
        PictureSurface {
            positions: &body.mesh.positions,
            normals: &body.normals,
            triangles: &body.mesh.triangles,
            colours: Colours::PerVertex(&skin),
            material: Material::Skin,
            look: None,
        },
        PictureSurface {
            positions: &shell.positions,
            normals: &shell.normals,
            triangles: &shell.triangles,
            colours: Colours::PerVertex(&painted),
            material: Material::Skin,
            look: None,
        },
    ];
    let stages = [0, 1].map(|i| TracedScene::build(PictureScene { surfaces: &surfaces[i..=i], floor: true }));
    let bounds = stages[0].bounds();
    let aspect = STILL.width as f32 / STILL.height as f32;
    let images: Vec<_> = stages
        .iter()
        .flat_map(|stage| {
            VIEWS.map(|turn| stage.render(&OrbitCamera::framing(&bounds, turn, aspect), STILL, TraceQuality::Still))
        })
        .collect();
    let captions = ["skin: red stands out by 20 mm", "blue lies below by 20 mm", "", "capsules", "", ""];
    contact_sheet::contact_sheet(&images.iter().collect::<Vec<_>>(), VIEWS.len(), &captions)
}
