//! Positions of every garment and the body in each frame of a run, written for other tools into the run's output folder.

use std::collections::HashMap;
use std::fs::File;
use std::path::PathBuf;

use glam::{Affine3A, Vec3};
use toile_assets::export::session::{ExportError, ExportFrame};
use toile_assets::export::{ExportFormat, ExportPlan, FrameRate, MovingPart, SessionExport};
use toile_base::skeleton::BONES;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_engine::body::palette;
use toile_engine::world::{Snapshot, World};

/// Promises all files of a plan and opens them; they get their names when the folder is committed.
///
/// # Errors
/// A file that cannot be written.
pub fn begin(out: &mut OutputFolder, plan: ExportPlan) -> Result<SessionExport, AppError> {
    let staged = plan.files().into_iter().map(|name| out.stage(&name).map(|path| (name, path)));
    let places: HashMap<String, PathBuf> = staged.collect::<Result<_, _>>()?;
    // A name that the plan has not said has no folder.
    let open = move |name: &str| File::create(places.get(name).ok_or(std::io::ErrorKind::NotFound)?);
    plan.begin(Box::new(open)).map_err(|e| failed(out, e))
}

/// That a file of an export cannot be written, in words.
pub fn failed(out: &OutputFolder, error: ExportError) -> AppError {
    out.failed(&error.file, error.reason).into()
}

/// A dressed body on its way into files: every so many steps a frame.
#[derive(Debug)]
pub struct DressedExport {
    export: SessionExport,
    /// Steps from one frame to the next.
    stride: u64,
    palette: [Affine3A; BONES],
    skin: Vec<Vec3>,
    normals: Vec<Vec3>,
}

impl DressedExport {
    /// Begins the files of a session of so many steps, `rate` frames a second; skin has this colour (linear RGB).
    ///
    /// # Errors
    /// More than a format holds, and a file that cannot be written.
    pub fn begin(
        out: &mut OutputFolder,
        world: &World,
        skin: [f32; 3],
        formats: &[ExportFormat],
        (steps, stride, hz): (u64, u64, f64),
    ) -> Result<Self, AppError> {
        let rate = FrameRate { frames: steps.div_ceil(stride) as usize, hz };
        let body = std::iter::once(MovingPart::body(world.body(), skin));
        let parts = body.chain(world.garments().iter().map(MovingPart::garment)).collect();
        let plan =
            ExportPlan::new("session", formats, parts, rate).map_err(|e| AppError::input(format!("--export: {e}")))?;
        let vertices = world.body().mesh.positions.len();
        Ok(Self {
            export: begin(out, plan)?,
            stride,
            palette: [Affine3A::IDENTITY; BONES],
            skin: vec![Vec3::ZERO; vertices],
            normals: vec![Vec3::ZERO; vertices],
        })
    }

    /// Writes the state after a step, if its frame is due.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn after(&mut self, tick: u64, world: &World, snapshot: &Snapshot, out: &OutputFolder) -> Result<(), AppError> {
        if !tick.is_multiple_of(self.stride) {
            return Ok(());
        }
        palette(&world.body().skeleton, &snapshot.pose, &mut self.palette);
        snapshot.skin.read(&mut self.skin, &mut self.normals);
        let garments = snapshot.garments.iter().map(|g| &g[..]);
        let positions: Vec<&[Vec3]> = std::iter::once(&self.skin[..]).chain(garments).collect();
        let frame = ExportFrame { palette: Some(&self.palette), positions: &positions };
        self.export.add(&frame).map_err(|e| failed(out, e))
    }

    /// Ends all files; returns how many frames they have.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn finish(self, out: &OutputFolder) -> Result<usize, AppError> {
        let frames = self.export.frames();
        self.export.finish().map_err(|e| failed(out, e))?;
        Ok(frames)
    }
}
