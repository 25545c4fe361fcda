//! `toile capture face`: turns photographs with marked points, or one photograph with found points, into a mannequin's head that is like them.

use std::path::PathBuf;
use std::slice::from_ref;

use serde::Serialize;
use toile_base::body::Sex;
use toile_cli::arguments::{Printing, one_of};
use toile_cli::document::Document;
use toile_cli::exit::AppError;
use toile_cli::output::{Inputs, OutputFolder};
use toile_cli::picture::write_png;
use toile_cli::terminal;
use toile_pose::face::{AdaptedHead, FaceView, HeadTexture, adapt, assumed_camera, follow, mtl, obj, png, texture};
use toile_sensors::calibration::{self, CalibratedCamera, Rig};
use toile_sensors::face_points::{MarkedPhotograph, read_marked};
use toile_sensors::pictures::read_picture;
use toile_view::figure::Hair;
use toile_view::image::linear;

use super::face_frames::{self, SequenceReport};
use super::face_picture::{HAIR, before_and_after, hair_on};
use super::found_face;

/// Adapt the mannequin's head to a face on one or more photographs, or follow it through a sequence.
///
/// Reads a photograph, whose points MediaPipe's face mesh finds, or a JSON file of photographs with marked points: 68 in the order of Multi-PIE, 468 in that of MediaPipe's face mesh, or by number;
/// and, where they are marked, curves along the head's outline. The mannequin's head is deformed by radial functions around the points
/// and the outline, symmetric and smooth where they say nothing, and the photographs become its texture. Of a sequence pose and
/// expressions are reported for each frame. Nothing is kept but what --out is given. docs/capture.md describes the file.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: one photograph, and a picture of the head before and after\n  toile capture face face.json --out head --picture\n\
                  Example: the same, whose points are found\n  toile capture face face.jpg --out head --picture\n\
                  Example: three of calibrated cameras\n  toile capture face faces.json --calibration cameras.toml --sex male --out head\n\
                  Example: pose and expressions of each frame of a sequence\n  toile capture face frames.json --json"
)]
pub struct FaceArgs {
    /// File of photographs with their points (JSON), or one photograph (JPEG, PNG)
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Calibration of the cameras that it names: TOML of Pose2Sim, YAML of OpenCV, or a folder of those
    #[arg(long, value_name = "F")]
    pub calibration: Option<PathBuf>,
    /// Whose head it is adapted from: female or male
    #[arg(long, value_name = "S", value_parser = one_of(Sex::ALL, Sex::name), default_value = "female")]
    pub sex: Sex,
    /// Standard deviation of a point (px) [default: 2 of a marked one, 3 % of the face of one that is found]
    #[arg(long, value_name = "PX", value_parser = pixels)]
    pub sigma: Option<f64>,
    /// Moulded hair of the head [default: bob for a woman, short for a man]
    #[arg(long, value_name = "CUT", value_parser = one_of(Hair::ALL, Hair::name))]
    pub hair: Option<Hair>,
    /// Folder for head.obj, head.mtl, head.png and report.json
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Draw the head before and after (heads.png)
    #[arg(long, requires = "out")]
    pub picture: bool,
    #[command(flatten)]
    printing: Printing,
}

/// Standard deviation of a point that was marked by hand, where nothing is said (px).
const MARKED_SIGMA_PX: f64 = 2.0;

fn pixels(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "it is no number".to_owned())?;
    if (0.1..=100.0).contains(&value) { Ok(value) } else { Err("it is not between 0.1 and 100".to_owned()) }
}

/// The report as JSON has it.
#[derive(Debug, Serialize)]
struct FaceDocument {
    photographs: usize,
    /// Points that were used, over all photographs.
    points: usize,
    /// Root mean square distance of the head's points from where they were marked.
    residual_px: f64,
    /// How the rim of the head meets its outlines, where those are marked.
    outline: Option<OutlineReport>,
    /// Mean distance of the face from the mannequin's (mm).
    moved_mm: f64,
    /// Share of the head that a photograph shows well.
    seen: f64,
    /// Colour of the skin (sRGB).
    skin: [u8; 3],
    /// Cut of the hair.
    hair: &'static str,
    /// Pose and expressions of each frame of a sequence.
    sequence: Option<SequenceReport>,
    files: Vec<PathBuf>,
}

/// Outlines and the rim of the head.
#[derive(Debug, Serialize)]
struct OutlineReport {
    /// Stretches of the outlines that the rim was brought to.
    stretches: usize,
    /// Its root mean square distance from them (px).
    off_px: f64,
}

/// A head with its photographs' texture, and a sequence's frames.
struct FoundFace {
    head: AdaptedHead,
    texture: HeadTexture,
    sequence: Option<SequenceReport>,
}

/// Runs `toile capture face`.
///
/// # Errors
/// Bad input as one sentence: points, pictures, a calibration without the camera, points of no face; a folder that cannot be written.
pub fn run(args: &FaceArgs) -> Result<(), AppError> {
    let out = args.out.as_deref().map(OutputFolder::prepare).transpose()?;
    let out = out.map(|out| out.sparing(Inputs::new([&args.file])));
    let (marked, usual_sigma) = if found_face::is_picture(&args.file) {
        found_face::find(&args.file)?
    } else {
        (read_marked(&args.file).map_err(AppError::input)?, MARKED_SIGMA_PX)
    };
    let sigma = args.sigma.unwrap_or(usual_sigma);
    let rig = args.calibration.as_deref().map(calibration::open).transpose().map_err(AppError::input)?;
    let photographs = &marked.photographs;
    let found = if marked.sequence {
        of_sequence((args.sex, sigma), photographs, rig.as_ref())?
    } else {
        of_photographs((args.sex, sigma), photographs, rig.as_ref())?
    };
    let hair = args.hair.unwrap_or(Hair::usual(args.sex));
    let outline = found.head.outline;
    let mut document = FaceDocument {
        photographs: photographs.len(),
        points: found.head.points,
        residual_px: found.head.residual_px,
        outline: (outline.0 > 0).then_some(OutlineReport { stretches: outline.0, off_px: outline.1 }),
        moved_mm: 1e3 * found.head.moved,
        seen: found.texture.seen,
        skin: found.texture.skin,
        hair: hair.name(),
        sequence: found.sequence,
        files: Vec::new(),
    };
    if let Some(mut out) = out {
        write(&mut out, &found.head, &found.texture, (hair, args.picture))?;
        out.stage("report.json")?;
        document.files = out.files();
        let text =
            serde_json::to_string_pretty(&Document::new("capture-face", &document)).map_err(AppError::internal)?;
        out.write("report.json", format!("{text}\n").as_bytes())?;
        out.commit()?;
    }
    if args.printing.json {
        return terminal::print_json(&Document::new("capture-face", document));
    }
    terminal::print(&words(&document))
}

/// The head of photographs of one moment.
fn of_photographs(
    (sex, sigma): (Sex, f64),
    marked: &[MarkedPhotograph],
    rig: Option<&Rig>,
) -> Result<FoundFace, AppError> {
    if rig.is_none() && marked.len() > 1 {
        return Err(AppError::Usage(format!(
            "{} photographs need --calibration, which says where their cameras stood; give it, one photograph, or \"sequence\": true",
            marked.len()
        )));
    }
    let (mut views, mut photographs) = (Vec::new(), Vec::new());
    for m in marked {
        let photograph = read_picture(&m.picture).map_err(AppError::input)?;
        let camera = camera(m, rig, [photograph.width(), photograph.height()])?;
        views.push(view(m, camera, sigma));
        photographs.push(photograph);
    }
    let head = adapt(&views, sex).map_err(AppError::input)?;
    let texture = texture(&head, &views, &photographs);
    Ok(FoundFace { head, texture, sequence: None })
}

/// The head of a sequence. Pictures but the one that gives the texture, and the first for its size, are not read.
fn of_sequence(
    (sex, sigma): (Sex, f64),
    marked: &[MarkedPhotograph],
    rig: Option<&Rig>,
) -> Result<FoundFace, AppError> {
    let Some(first) = marked.first() else { return Err(AppError::input("a sequence without frames; give some")) };
    if let Some(other) = marked.iter().find(|m| m.camera != first.camera || m.focal_px != first.focal_px) {
        let (a, b) = (other.picture.display(), first.picture.display());
        return Err(AppError::input(format!(
            "{a}: its camera is not that of {b}; a sequence is of one camera: give each camera's frames in a file"
        )));
    }
    let photograph = read_picture(&first.picture).map_err(AppError::input)?;
    let camera = camera(first, rig, [photograph.width(), photograph.height()])?;
    let views: Vec<FaceView> = marked.iter().map(|m| view(m, camera.clone(), sigma)).collect();
    let found = follow(&views, sex).map_err(AppError::input)?;
    let photograph = match found.first {
        0 => photograph,
        k => read_picture(&marked[k].picture).map_err(AppError::input)?,
    };
    let texture = texture(&found.head, from_ref(&views[found.first]), from_ref(&photograph));
    let sequence = Some(face_frames::report(&found, &views, marked));
    Ok(FoundFace { head: found.head, texture, sequence })
}

fn view(m: &MarkedPhotograph, camera: CalibratedCamera, sigma_px: f64) -> FaceView {
    FaceView { camera, points: m.points, outlines: m.outlines.clone(), sigma_px }
}

/// The camera of a photograph: the calibration's, or one of a usual lens.
fn camera(m: &MarkedPhotograph, rig: Option<&Rig>, size: [u32; 2]) -> Result<CalibratedCamera, AppError> {
    let shown = m.picture.display();
    let Some(rig) = rig else { return assumed_camera(size, m.focal_px).map_err(AppError::input) };
    let name = m.camera.as_deref().unwrap_or_default();
    let found = rig.cameras.iter().find(|c| c.name == name).ok_or_else(|| {
        let known: Vec<&str> = rig.cameras.iter().map(|c| c.name.as_str()).collect();
        AppError::input(format!(
            "{shown}: the calibration has no camera \"{name}\"; name one of {} as its camera",
            known.join(", ")
        ))
    })?;
    if found.size != size {
        let [w, h] = found.size;
        return Err(AppError::input(format!(
            "{shown}: it has {} x {} pixels and its camera {w} x {h}; calibrate the camera at the size of its pictures",
            size[0], size[1]
        )));
    }
    Ok(found.clone())
}

fn write(
    out: &mut OutputFolder,
    head: &AdaptedHead,
    texture: &HeadTexture,
    (hair, picture): (Hair, bool),
) -> Result<(), AppError> {
    let rest: Vec<_> = head.rest.iter().map(|p| p.as_vec3()).collect();
    let worn = hair_on(head.sex, &rest, hair);
    let worn = worn.as_ref().map(|hair| (&hair.positions[..], &hair.triangles[..]));
    out.write("head.obj", obj(head, worn).as_bytes())?;
    out.write("head.mtl", mtl(HAIR.map(|b| linear(f32::from(b) / 255.0))).as_bytes())?;
    out.write("head.png", &png(texture).map_err(AppError::internal)?)?;
    if picture {
        write_png(out, "heads.png", &before_and_after(head, texture, hair))?;
    }
    Ok(())
}

fn words(d: &FaceDocument) -> String {
    let [r, g, b] = d.skin;
    let mut text = format!(
        "A head by {} photograph(s) and {} points, which it meets within {:.1} px; the face lies {:.1} mm from the mannequin's\n",
        d.photographs, d.points, d.residual_px, d.moved_mm,
    );
    if let Some(outline) = &d.outline {
        text +=
            &format!("  its rim meets {} stretches of outline within {:.1} px\n", outline.stretches, outline.off_px);
    }
    text += &format!("  {:.0} % of it is seen well; the skin is rgb({r}, {g}, {b})\n", 100.0 * d.seen);
    text += &d.sequence.as_ref().map(face_frames::words).unwrap_or_default();
    for file in &d.files {
        text += &format!("  {}\n", file.display());
    }
    text
}
