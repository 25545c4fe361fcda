//! `toile capture face`: photographs with marked points become a mannequin's head that is like them.

use std::path::PathBuf;

use serde::Serialize;
use toile_assets::body::Sex;
use toile_capture::face::{AdaptedHead, FaceView, HeadTexture, MTL, adapt, assumed_camera, obj, png, texture};
use toile_sensors::calibration::{self, CalibratedCamera, Rig};
use toile_sensors::face_points::{MarkedPhotograph, read_marked};
use toile_sensors::pictures::read_picture;

use crate::arguments::{Printing, one_of};
use crate::exit::AppError;
use crate::output::{Inputs, OutputFolder};
use crate::report::Document;
use crate::terminal;

/// Adapt the mannequin's head to a face on one or more photographs.
///
/// Reads a JSON file of photographs with marked points: 68 in the order of Multi-PIE, 468 in that of MediaPipe's face mesh, or by number.
/// The mannequin's head is deformed by radial functions around the points, symmetric and smooth where they say nothing, and the
/// photographs become its texture. Nothing is kept but what --out is given. docs/capture.md describes the file.
#[derive(Debug, Clone, PartialEq, clap::Args)]
#[command(
    after_help = "Example: one photograph\n  toile capture face face.json --out head\nExample: three of calibrated cameras\n  toile \
                  capture face faces.json --calibration cameras.toml --sex male --out head"
)]
pub struct FaceArgs {
    /// File of photographs with their points
    #[arg(value_name = "F.json")]
    pub file: PathBuf,
    /// Calibration of the cameras that it names: TOML of Pose2Sim, YAML of OpenCV, or a folder of those
    #[arg(long, value_name = "F")]
    pub calibration: Option<PathBuf>,
    /// Whose head it is adapted from: female or male
    #[arg(long, value_name = "S", value_parser = one_of(Sex::ALL, Sex::name), default_value = "female")]
    pub sex: Sex,
    /// Standard deviation of a marked point (px)
    #[arg(long, value_name = "PX", value_parser = pixels, default_value = "2")]
    pub sigma: f64,
    /// Folder for head.obj, head.mtl and head.png
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    printing: Printing,
}

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
    /// Mean distance of the face from the mannequin's (mm).
    moved_mm: f64,
    /// Share of the head that a photograph shows well.
    seen: f64,
    /// Colour of the skin (sRGB).
    skin: [u8; 3],
    files: Vec<PathBuf>,
}

/// Runs `toile capture face`.
///
/// # Errors
/// Bad input as one sentence: points, pictures, a calibration without the camera, points of no face; a folder that cannot be written.
pub fn run(args: &FaceArgs) -> Result<(), AppError> {
    let out = args.out.as_deref().map(OutputFolder::prepare).transpose()?;
    let out = out.map(|out| out.sparing(Inputs::new([&args.file])));
    let marked = read_marked(&args.file).map_err(AppError::input)?;
    let rig = args.calibration.as_deref().map(calibration::open).transpose().map_err(AppError::input)?;
    if rig.is_none() && marked.len() > 1 {
        return Err(AppError::Usage(format!(
            "{} photographs need --calibration, which says where their cameras stood; give it, or one photograph",
            marked.len()
        )));
    }
    let (mut views, mut photographs) = (Vec::new(), Vec::new());
    for m in &marked {
        let photograph = read_picture(&m.picture).map_err(AppError::input)?;
        let camera = camera(m, rig.as_ref(), [photograph.width(), photograph.height()])?;
        views.push(FaceView { camera, points: m.points, sigma_px: args.sigma });
        photographs.push(photograph);
    }
    let head = adapt(&views, args.sex).map_err(AppError::input)?;
    let found = texture(&head, &views, &photographs);
    let mut files = Vec::new();
    if let Some(mut out) = out {
        write(&mut out, &head, &found)?;
        files = out.commit()?;
    }
    let document = FaceDocument {
        photographs: views.len(),
        points: head.points,
        residual_px: head.residual_px,
        moved_mm: 1e3 * head.moved,
        seen: found.seen,
        skin: found.skin,
        files,
    };
    if args.printing.json {
        return terminal::print_json(&Document::new("capture-face", document));
    }
    terminal::print(&words(&document))
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

fn write(out: &mut OutputFolder, head: &AdaptedHead, found: &HeadTexture) -> Result<(), AppError> {
    out.write("head.obj", obj(head).as_bytes())?;
    out.write("head.mtl", MTL.as_bytes())?;
    out.write("head.png", &png(found).map_err(AppError::internal)?)?;
    Ok(())
}

fn words(d: &FaceDocument) -> String {
    let [r, g, b] = d.skin;
    let mut text = format!(
        "A head by {} photograph(s) and {} points, which it meets within {:.1} px; the face lies {:.1} mm from the mannequin's\n  \
         {:.0} % of it is seen well; the skin is rgb({r}, {g}, {b})\n",
        d.photographs,
        d.points,
        d.residual_px,
        d.moved_mm,
        100.0 * d.seen
    );
    for file in &d.files {
        text += &format!("  {}\n", file.display());
    }
    text
}
