//! Dumps of a run: the place of every vertex of the user's mesh, frame by frame, so that users can check them with tools
//! of their own.
//!
//! CSV has the shortest decimals that read back as the same f32. PLY is binary little endian (version 1.0, G. Turk 1994)
//! with the user's faces. An index says the time of each file.

use std::fmt::Write as _;

use glam::Vec3;
use toile_assets::export::session::ExportFrame;
use toile_assets::export::{ExportFormat, ExportPlan, FrameRate, MovingPart, SessionExport, SurfaceLook};
use toile_assets::scene_file::{SceneGarment, UserMesh};
use toile_bake::check::corners;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_fitting::scene::Runner;

use crate::session_export;

/// Name of the file that lists the others.
pub const INDEX: &str = "index.csv";

/// How a frame is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Format {
    /// One line a vertex: its index, x, y, z.
    #[default]
    Csv,
    /// Binary PLY with faces.
    Ply,
    /// All frames in the files of a format of motion.
    Moving(ExportFormat),
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Csv,
        Self::Ply,
        Self::Moving(ExportFormat::Glb),
        Self::Moving(ExportFormat::Usd),
        Self::Moving(ExportFormat::Mdd),
        Self::Moving(ExportFormat::Pc2),
    ];

    /// Whether all frames are in the same files.
    pub fn is_one_file(self) -> bool {
        matches!(self, Self::Moving(_))
    }

    /// Name of the format, which is the ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Ply => "ply",
            Self::Moving(format) => format.name(),
        }
    }
}

/// Writes frames of a run into an output folder; they appear when that is committed.
#[derive(Debug)]
pub struct Dump {
    folder: OutputFolder,
    format: Format,
    every: u64,
    index: String,
    frame: u64,
    /// The files of a format of motion.
    moving: Option<SessionExport>,
}

impl Dump {
    /// A dump of every `every`th step.
    pub fn new(folder: OutputFolder, format: Format, every: u64) -> Self {
        let index = "frame,step,time_s,garment,file\n".into();
        Self { folder, format, every, index, frame: 0, moving: None }
    }

    /// Opens the files of a format of motion; others are opened frame by frame.
    ///
    /// # Errors
    /// More than the format holds, and a file that cannot be written.
    pub fn begin(&mut self, runner: &Runner) -> Result<(), AppError> {
        let Format::Moving(format) = self.format else { return Ok(()) };
        let scene = runner.scene();
        let frames = (scene.steps() / self.every + 1) as usize;
        let rate = FrameRate { frames, hz: scene.step_hz / self.every as f64 };
        let plan = ExportPlan::new(&scene.name, &[format], scene.garments.iter().map(part).collect(), rate)
            .map_err(|e| AppError::Usage(format!("--dump-format {}: {e}", format.name())))?;
        self.moving = Some(session_export::begin(&mut self.folder, plan)?);
        Ok(())
    }

    /// Writes the state of a run if its step is to be dumped; step 0 is the start.
    ///
    /// # Errors
    /// Where a file cannot be written.
    pub fn add(&mut self, runner: &Runner) -> Result<(), AppError> {
        if !runner.steps().is_multiple_of(self.every) {
            return Ok(());
        }
        let scene = runner.scene();
        if let Some(moving) = &mut self.moving {
            let all: Vec<Vec<Vec3>> = (0..scene.garments.len()).map(|k| runner.positions(k).collect()).collect();
            let positions: Vec<&[Vec3]> = all.iter().map(Vec::as_slice).collect();
            let frame = ExportFrame { palette: None, positions: &positions };
            moving.add(&frame).map_err(|e| session_export::failed(&self.folder, e))?;
            self.frame += 1;
            return Ok(());
        }
        for (k, garment) in scene.garments.iter().enumerate() {
            let file = format!("{}-{:06}.{}", garment.name, self.frame, self.format.ending());
            let bytes = match self.format {
                Format::Ply => ply(runner.positions(k), &garment.mesh),
                _ => csv(runner.positions(k)).into_bytes(),
            };
            self.folder.write(&file, &bytes)?;
            let (frame, step, time, name) = (self.frame, runner.steps(), runner.time(), &garment.name);
            // Writing to a string cannot fail.
            let _ = writeln!(self.index, "{frame},{step},{time},{name},{file}");
        }
        self.frame += 1;
        Ok(())
    }

    /// Frames written so far.
    pub fn frames(&self) -> u64 {
        self.frame
    }

    /// Writes the index and gives all files their names.
    ///
    /// # Errors
    /// Where a file cannot be written or named.
    pub fn finish(mut self) -> Result<(), AppError> {
        match self.moving.take() {
            Some(moving) => moving.finish().map_err(|e| session_export::failed(&self.folder, e))?,
            None => self.folder.write(INDEX, self.index.as_bytes())?,
        }
        self.folder.commit()?;
        Ok(())
    }
}

/// A garment of the scene as it is written: the user's mesh, in the colour of its fabric.
fn part(garment: &SceneGarment) -> MovingPart {
    let uvs = if garment.shape.uvs.len() == garment.mesh.faces.len() { garment.shape.uvs.clone() } else { Vec::new() };
    MovingPart {
        name: garment.name.clone(),
        vertices: garment.mesh.start.len(),
        faces: garment.mesh.faces.clone(),
        uvs,
        look: SurfaceLook { opacity: garment.fabric.opacity, ..SurfaceLook::cloth(garment.fabric.colour) },
        skinned: None,
    }
}

fn csv(positions: impl Iterator<Item = Vec3>) -> String {
    let mut text = String::from("vertex,x,y,z\n");
    for (i, p) in positions.enumerate() {
        // Rust prints an f32 with as few digits as bring back the same bits.
        let _ = writeln!(text, "{i},{},{},{}", p.x, p.y, p.z);
    }
    text
}

fn ply(positions: impl Iterator<Item = Vec3>, mesh: &UserMesh) -> Vec<u8> {
    toile_assets::export::ply(&positions.collect::<Vec<_>>(), mesh.faces.iter().map(corners))
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_bake::shape::NO_VERTEX;

    #[test]
    fn decimals_bring_back_the_same_bits() {
        let odd = [0.1f32, -0.0, 1e-30, 16_777_217.0, f32::MIN_POSITIVE, 1.0 / 3.0, -2.5e-7, 123.456_79];
        let points = odd.windows(3).map(|w| Vec3::new(w[0], w[1], w[2]));
        let text = csv(points.clone());
        let read =
            |line: &str| -> Vec<u32> { line.split(',').skip(1).map(|x| x.parse::<f32>().unwrap().to_bits()).collect() };
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!((lines[0], lines.len()), ("vertex,x,y,z", 7));
        for (line, p) in lines[1..].iter().zip(points) {
            assert_eq!(read(line), p.to_array().map(f32::to_bits), "{line}");
        }
    }

    #[test]
    fn ply_holds_bits_and_faces() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::new(0.0, 1.0 / 3.0, 0.0)];
        let mesh = UserMesh {
            start: points.into(),
            faces: vec![[0, 1, 2, 3], [2, 1, 0, NO_VERTEX]],
            to_shape: vec![0, 1, 2, 3],
        };
        let bytes = ply(points.into_iter(), &mesh);
        let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
        let head = std::str::from_utf8(&bytes[..end]).unwrap();
        assert!(head.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 4\n"), "{head}");
        let float = |i: usize| f32::from_le_bytes(bytes[end + 4 * i..][..4].try_into().unwrap());
        assert!((0..12).all(|i| float(i).to_bits() == points[i / 3][i % 3].to_bits()));
        let faces = &bytes[end + 48..];
        assert_eq!((faces.len(), faces[0], faces[17]), (17 + 13, 4, 3));
        assert_eq!(faces[18..22], 2u32.to_le_bytes());
    }
}
