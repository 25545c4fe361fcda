//! The video of a try-on: the session in real time.

use std::path::{Path, PathBuf};

use toile_base::limits::STEP_HZ;
use toile_cli::exit::AppError;
use toile_cli::terminal::Progress;
use toile_engine::lines::Line;
use toile_engine::world::Snapshot;
use toile_view::drawn_frame::DrawnFrame;
use toile_view::image::Size;
use toile_view::trace::TraceQuality;
use toile_view::video::VideoWriter;

use crate::renderer::PictureRenderer;

/// Width and height of a frame: a display that stands upright, at half its resolution.
const SIZE: Size = Size::new(540, 960);

/// Frames a second.
const FPS: u16 = 30;

/// Steps from one frame to the next.
const STRIDE: u64 = STEP_HZ as u64 / FPS as u64;

/// Films a session while it runs.
pub struct Video {
    video: VideoWriter,
    frame: DrawnFrame,
    bar: Progress,
}

impl Video {
    /// Begins the video of a session of `steps` steps.
    ///
    /// # Errors
    /// Bad input: a name or a place that no video can have.
    pub fn begin(path: &Path, frame: DrawnFrame, steps: u64, bar: Progress) -> Result<Self, AppError> {
        let video = VideoWriter::begin(path, SIZE, Self::work(steps) as u32, FPS).map_err(AppError::input)?;
        Ok(Self { video, frame, bar })
    }

    /// Frames of a session of so many steps.
    pub fn work(steps: u64) -> u64 {
        steps.div_ceil(STRIDE).max(1)
    }

    /// Whether the video wants the snapshot of this tick.
    pub fn wants(tick: u64) -> bool {
        tick.is_multiple_of(STRIDE)
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// A video that cannot be written, or a device that fails.
    pub fn add(&mut self, renderer: &mut PictureRenderer, snapshot: &Snapshot, lines: &[Line]) -> Result<(), AppError> {
        self.frame.update(snapshot);
        let camera = self.frame.follow(SIZE);
        let surfaces = self.frame.surfaces(None);
        let images = renderer.draw(&surfaces, lines, (SIZE, TraceQuality::Motion), |_| vec![camera], || {})?;
        self.bar.inc(1);
        images.iter().try_for_each(|image| self.video.push(image)).map_err(AppError::input)
    }

    /// Ends the video; says which file it is, and how much it hid at most (m).
    ///
    /// # Errors
    /// A video that cannot be written.
    pub fn finish(self) -> Result<(PathBuf, f32), AppError> {
        self.bar.finish_and_clear();
        Ok((self.video.finish().map_err(AppError::input)?, self.frame.hidden_m()))
    }
}
