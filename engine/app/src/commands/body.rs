//! `toile body`: imports a body made by other tools, shows it, and writes it for other tools.

use std::f32::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};

use clap::ArgAction;
use glam::Affine3A;
use toile_assets::export::{DressedBody, glb};
use toile_assets::import::{avatar, makehuman};
use toile_assets::scene;
use toile_base::body::{Body, Measures, Sex};
use toile_base::frame::Joints;
use toile_base::skeleton::BONES;
use toile_cli::arguments::{Printing, count, one_of};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFolder};
use toile_cli::picture::write_png;
use toile_cli::terminal::{self, Paint};
use toile_engine::body::{JointFrames, Poser, palette};
use toile_engine::skin::SkinningJob;
use toile_engine::world::BLEND;
use toile_view::contact_sheet;
use toile_view::figure::SkinTone;
use toile_view::image::Size;
use toile_view::scene::{Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

use crate::arguments::SkinArg;
use crate::report::{BodyReport, Followed, Influences, JointFound, Named, SurfaceReport};
use crate::summary;

/// Most random bodies: some minutes' worth.
const MAX_RANDOM: u64 = 10_000;

/// Import a body that others made, and see what became of it.
///
/// Reads a skinned glTF 2.0 mesh (.glb, .gltf), a VRM avatar (.vrm) or a folder with MakeHuman's hm08 base, makes a body of
/// it, and writes pictures of it at rest and walking, body.glb for other tools and for `toile try-on --body`, and a report of
/// its measures, joints, weights, surface and collision body.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(after_help = "Example: make a body of MakeHuman's files, then dress it\n  toile body hm08 --target \
                        caucasian-female-young --out ada && toile try-on --body ada/body.glb")]
pub struct BodyArgs {
    /// glTF, GLB or VRM file, or MakeHuman folder
    #[arg(value_name = "FILE", required_unless_present = "colliders")]
    pub file: Option<PathBuf>,
    /// Report how closely the collision body follows the skin; without FILE, for our own bodies
    #[arg(long)]
    pub colliders: bool,
    /// Bodies of random measures that --colliders takes besides the sizes
    #[arg(long, value_name = "N", value_parser = count(0..=MAX_RANDOM), default_value = "20")]
    pub strangers: usize,
    /// Which random bodies are taken
    #[arg(long, value_name = "S", default_value = "1")]
    pub seed: u64,
    /// Whose garments it wears: female or male
    #[arg(long, value_name = "S", value_parser = one_of([Sex::Female, Sex::Male], sex_name), default_value = "female")]
    pub sex: Sex,
    /// Mesh to take; repeat it for more (default: all that are skinned)
    #[arg(long = "mesh", value_name = "NAME")]
    pub meshes: Vec<String>,
    /// MakeHuman target to add; repeat it for more
    #[arg(long = "target", value_name = "NAME[=SHARE]", value_parser = target)]
    pub targets: Vec<(String, f32)>,
    /// MakeHuman rig: game_engine or cmu_mb
    #[arg(long, value_name = "NAME", default_value = "game_engine")]
    pub rig: String,
    /// Accept a surface that is open outside of the head
    #[arg(long)]
    pub allow_holes: bool,
    #[command(flatten)]
    skin: SkinArg,
    /// Folder for the files; it is made if missing
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Make no pictures: only body.glb and the report
    #[arg(long = "no-pictures", action = ArgAction::SetFalse)]
    pub pictures: bool,
    /// What is printed.
    #[command(flatten)]
    pub printing: Printing,
}

impl BodyArgs {
    /// The file or folder to read; a line without --colliders has one.
    pub fn input(&self) -> Result<&Path, AppError> {
        let missing = || AppError::Usage("no body is given; see `toile body --help`".to_owned());
        self.file.as_deref().ok_or_else(missing)
    }
}

fn sex_name(sex: Sex) -> &'static str {
    match sex {
        Sex::Female => "female",
        Sex::Male => "male",
    }
}

/// A target with its share, which is all of it where none is given.
fn target(text: &str) -> Result<(String, f32), String> {
    let Some((name, share)) = text.split_once('=') else { return Ok((text.to_owned(), 1.0)) };
    let number = share.parse::<f32>().ok().filter(|s| s.is_finite());
    let share = number.ok_or_else(|| format!("there is no number behind `=`; give one such as --target {name}=0.5"))?;
    Ok((name.to_owned(), share))
}

/// A picture of one side.
const STILL: Size = Size::new(480, 800);

/// The moment of the embedded performance in which the walking body is shown (s).
const WALK_S: f32 = 4.9;

/// Views of a body: turns of the camera.
const VIEWS: [f32; 3] = [0.0, FRAC_PI_2, PI];

/// Runs `toile body`.
///
/// # Errors
/// A file that does not become a body, an output folder that cannot be written, or a closed stdout.
pub fn run(args: &BodyArgs) -> Result<(), AppError> {
    let words = args.printing.words();
    let mut out = OutputFolder::prepare(&args.out)?.sparing(Inputs::new(&args.file));
    out.check(&["body.glb", "body.png", "walking.png", "report.json"])?;
    let (imported, rows) = import(args)?;
    if args.pictures {
        let bar = words.bar(2 * VIEWS.len() as u64, "drawing");
        draw(&mut out, "body.png", (&imported.body, args.skin.tone), &title(args, &imported.body), || bar.inc(1))?;
        let walking = walking(&imported.body)?;
        draw(&mut out, "walking.png", (&walking, args.skin.tone), "walking", || bar.inc(1))?;
        bar.finish_and_clear();
    }
    out.write("body.glb", &glb(&DressedBody { body: &imported.body, palette: None, worn: &[] }))?;
    out.stage("report.json")?;
    let document = Document::new("body", report(args, &imported, rows, out.files()));
    let text = serde_json::to_string_pretty(&document).map_err(AppError::internal)?;
    out.write("report.json", format!("{text}\n").as_bytes())?;
    out.commit()?;
    if args.printing.json {
        return terminal::print_json(&document);
    }
    terminal::print(&summary::body(&document.body, Paint::for_stdout()))
}

/// The body of a glTF file, or of a MakeHuman folder, with that program's own girths.
pub fn import(args: &BodyArgs) -> Result<(avatar::ImportedBody, Option<Vec<Named>>), AppError> {
    let options = avatar::ImportOptions { sex: args.sex, meshes: args.meshes.clone(), allow_holes: args.allow_holes };
    let file = args.input()?;
    if !file.is_dir() {
        if !args.targets.is_empty() {
            let cure = "give the folder of a MakeHuman base or leave out --target";
            return Err(AppError::Usage(format!("{} is no folder, so it has no targets; {cure}", file.display())));
        }
        return Ok((avatar::read(file, &options).map_err(AppError::input)?, None));
    }
    let choice = makehuman::MakehumanOptions { targets: args.targets.clone(), rig: args.rig.clone() };
    let made = makehuman::read(file, &choice, &options).map_err(AppError::input)?;
    let rows = made.girths.named().map(|(name, m)| named(name, m)).to_vec();
    Ok((made.imported, Some(rows)))
}

/// A body of a file, as `toile try-on --body` wears it.
pub fn wearer(file: &Path, sex: Sex) -> Result<avatar::ImportedBody, AppError> {
    let options = avatar::ImportOptions { sex, ..avatar::ImportOptions::default() };
    if file.is_dir() {
        let made = makehuman::read(file, &makehuman::MakehumanOptions::default(), &options).map_err(AppError::input)?;
        return Ok(made.imported);
    }
    avatar::read(file, &options).map_err(AppError::input)
}

/// The five measures with their names.
pub fn measures(m: &Measures) -> [(&'static str, f32); 5] {
    [
        ("stature", m.stature),
        ("shoulder breadth", m.shoulder_breadth),
        ("chest girth", m.chest_girth),
        ("waist girth", m.waist_girth),
        ("hip girth", m.hip_girth),
    ]
}

fn named(name: &'static str, m: f32) -> Named {
    Named { name, value: (f64::from(m) * 1e4).round() / 10.0 }
}

/// The file's own name.
pub fn file_name(args: &BodyArgs) -> String {
    let name = args.file.as_deref().and_then(Path::file_name);
    name.map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn title(args: &BodyArgs, body: &Body) -> String {
    let name = file_name(args);
    let line = measures(&body.measures).map(|(name, m)| format!("{name} {:.0} mm", named(name, m).value)).join("   ");
    format!("{name}\n{line}")
}

/// The body in a pose of the embedded shopper, taken over as from a sensor.
fn walking(body: &Body) -> Result<Body, AppError> {
    let (sex, measures) = scene::SHOPPER;
    let shopper = toile_assets::body::build(sex, &measures).map_err(AppError::internal)?.skeleton;
    let seen = JointFrames::new(&shopper, &scene::shopper(&shopper, WALK_S)).position;
    let joints = Joints::seen(0, seen);
    let pose = Poser::new(&body.skeleton).pose(&joints, 0.0);
    let mut bones = [Affine3A::IDENTITY; BONES];
    palette(&body.skeleton, &pose, &mut bones);
    let mut posed = body.clone();
    let job = SkinningJob::new(&body.mesh.positions, &body.normals, &body.weights).map_err(AppError::input)?;
    let mut skin = job.posed();
    job.run(BLEND, &bones, &mut skin);
    skin.read(&mut posed.mesh.positions, &mut posed.normals);
    Ok(posed)
}

fn draw(
    out: &mut OutputFolder,
    name: &str,
    (body, skin): (&Body, SkinTone),
    title: &str,
    mut done: impl FnMut(),
) -> Result<(), AppError> {
    let surfaces = [PictureSurface {
        positions: &body.mesh.positions,
        normals: &body.normals,
        triangles: &body.mesh.triangles,
        colours: Colours::One(skin.colour()),
        material: Material::Skin,
        look: None,
    }];
    let stage = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    let aspect = STILL.width as f32 / STILL.height as f32;
    let [front, side, back] = VIEWS.map(|turn| {
        let image = stage.render(&OrbitCamera::framing(&stage.bounds(), turn, aspect), STILL, TraceQuality::Still);
        done();
        image
    });
    write_png(out, name, &contact_sheet::triptych(&front, &side, &back, title, None))
}

fn report(
    args: &BodyArgs,
    imported: &avatar::ImportedBody,
    rows: Option<Vec<Named>>,
    files: Vec<PathBuf>,
) -> BodyReport {
    let avatar::ImportedBody { body, report } = imported;
    let l = &body.levels;
    let levels = [
        ("neck", l.neck),
        ("shoulder", l.shoulder),
        ("chest", l.chest),
        ("underbust", l.underbust),
        ("waist", l.waist),
        ("hip", l.hip),
        ("crotch", l.crotch),
        ("knee", l.knee),
        ("ankle", l.ankle),
    ];
    let round = |x: f32| (f64::from(x) * 1e6).round() / 1e6;
    let pruned = &report.pruned;
    BodyReport {
        file: args.file.clone().unwrap_or_default(),
        dialect: report.dialect,
        vertices: body.mesh.positions.len(),
        triangles: body.mesh.triangles.len(),
        texture_coordinates: !body.mesh.uvs.is_empty(),
        measures_mm: measures(&body.measures).map(|(name, m)| named(name, m)).to_vec(),
        levels_mm: levels.map(|(name, m)| named(name, m)).to_vec(),
        joints: report.joints.iter().cloned().map(|(joint, named)| JointFound { joint, named }).collect(),
        influences: Influences {
            most: pruned.most_influences,
            over_four: pruned.over_four,
            pruned: pruned.vertices,
            mean_lost: round(pruned.mean_lost),
            max_lost: round(pruned.max_lost),
        },
        surface: SurfaceReport {
            parts: report.parts,
            boundary_edges: report.boundary_edges,
            crowded_edges: report.crowded_edges,
        },
        makehuman_mm: rows,
        colliders: Followed::of(&toile_assets::rig::report(&toile_assets::rig::fit(body), body)),
        notes: report.notes.clone(),
        files,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_have_shares() {
        assert_eq!(target("a").unwrap(), ("a".to_owned(), 1.0));
        assert_eq!(target("a=-0.5").unwrap(), ("a".to_owned(), -0.5));
        assert!(target("a=b").unwrap_err().contains("--target a=0.5"));
    }
}
