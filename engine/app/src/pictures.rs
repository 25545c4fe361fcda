//! The pictures of a try-on: the session as an animation, a contact sheet through it, and stills of its end.

use std::f32::consts::{FRAC_PI_2, PI};
use std::fs::File;
use std::io::BufWriter;
use std::ops::RangeInclusive;

use glam::Vec3;
use toile_base::limits::STEP_HZ;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::picture::write_png;
use toile_cli::terminal::Progress;
use toile_engine::lines::Line;
use toile_engine::skin::Posed;
use toile_engine::world::Snapshot;
use toile_view::contact_sheet;
use toile_view::drawn_frame::DrawnFrame;
use toile_view::fit_map;
use toile_view::image::{Animation, Image, Size};
use toile_view::scene::{Bounds, OrbitCamera};
use toile_view::trace::TraceQuality;

use crate::renderer::PictureRenderer;

/// Rows of a still: enough to see a hem's folds, few enough that three take a few seconds.
pub const STILL_ROWS: u16 = 800;

/// Rows that a still may have: fewer show nothing, more are beyond any screen.
pub const ROWS: RangeInclusive<u16> = 100..=4320;

/// A still of so many rows, three parts wide and five high.
const fn still(rows: u16) -> Size {
    Size::new(rows as u32 * 3 / 5, rows as u32)
}

/// Stills at the end: three views in the fabric's colours, three as a fit map.
const STILLS: u64 = 6;

/// A frame of the animation.
const MOTION: Size = Size::new(240, 360);

/// Steps between two frames of the animation, the first for short sessions. All divide a second, so that the animation
/// runs at the speed of life.
const STRIDES: [u64; 5] = [12, 24, 40, 60, STEP_HZ as u64];

/// Most frames of the animation. A session so long that one frame a second is more is shown sped up.
const MOST_FRAMES: u64 = 100;

/// How an animation shows a session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct AnimationTiming {
    /// Steps from one frame to the next.
    stride: u64,
    frames: u32,
    fps: u16,
}

impl AnimationTiming {
    fn new(steps: u64) -> Self {
        let steps = steps.max(1);
        let fits = |stride: &u64| steps.div_ceil(*stride) <= MOST_FRAMES;
        let stride = STRIDES.into_iter().find(fits).unwrap_or_else(|| steps.div_ceil(MOST_FRAMES));
        let fps = (u64::from(STEP_HZ) / stride).max(1) as u16;
        Self { stride, frames: steps.div_ceil(stride) as u32, fps }
    }
}

/// Frames on the contact sheet, in rows of this many.
const SHEET_FRAMES: usize = 12;
const SHEET_COLUMNS: usize = 6;

/// Makes pictures while a session runs.
pub struct Pictures {
    animation: Animation<BufWriter<File>>,
    timing: AnimationTiming,
    kept: Vec<(Image, u64)>,
    frame: DrawnFrame,
    still: Size,
    bar: Progress,
}

impl Pictures {
    /// Begins the animation of a session of `steps` steps; stills will have so many rows.
    pub fn begin(
        out: &mut OutputFolder,
        frame: DrawnFrame,
        (steps, rows): (u64, u16),
        bar: Progress,
    ) -> Result<Self, AppError> {
        let timing = AnimationTiming::new(steps);
        let path = out.stage("session.png")?;
        let file = BufWriter::new(File::create(&path).map_err(AppError::input)?);
        Ok(Self {
            animation: Animation::new(file, MOTION, timing.frames, timing.fps).map_err(AppError::input)?,
            timing,
            kept: Vec::new(),
            frame,
            still: still(rows),
            bar,
        })
    }

    /// Whether the animation wants the snapshot of this tick.
    pub fn wants(&self, tick: u64) -> bool {
        tick.is_multiple_of(self.timing.stride)
    }

    /// Draws a frame of the animation.
    pub fn add(&mut self, renderer: &mut PictureRenderer, snapshot: &Snapshot, lines: &[Line]) -> Result<(), AppError> {
        self.frame.update(snapshot);
        let camera = self.frame.follow(MOTION);
        let surfaces = self.frame.surfaces(None);
        for image in renderer.draw(&surfaces, lines, (MOTION, TraceQuality::Motion), |_| vec![camera], || {})? {
            self.animation.push(&image).map_err(AppError::input)?;
            self.kept.push((image, snapshot.tick));
        }
        self.bar.inc(1);
        Ok(())
    }

    /// Finishes the animation; writes the contact sheet, and the stills of the last snapshot in the fabric's colours
    /// and in those of the fit map. `tightness` has a value in -1..1 for each particle of each garment, `facing` is the
    /// direction that the shopper looks in (rad from +z towards +x). Gives how much all of them hid at most (m).
    pub fn finish(
        mut self,
        out: &mut OutputFolder,
        renderer: &mut PictureRenderer,
        snapshot: &Snapshot,
        end: &FinalState<'_>,
    ) -> Result<f32, AppError> {
        self.animation.finish().map_err(AppError::input)?;
        debug_assert_eq!(self.kept.len(), self.timing.frames as usize);
        contact_sheet(out, &self.kept)?;
        let still = self.still;
        let legend = fit_map::legend(3 * still.width / 4, contact_sheet::PAPER);
        let aspect = still.width as f32 / still.height as f32;
        let look = |bounds: &Bounds| {
            [0.0, FRAC_PI_2, PI].map(|turn| OrbitCamera::framing(bounds, end.facing + turn, aspect)).to_vec()
        };
        if let Some(worst) = end.worst {
            draw_worst(out, renderer, (&mut self.frame, still), worst)?;
        }
        self.frame.update(snapshot);
        for (name, map, legend) in [("look.png", None, None), ("fit.png", Some(end.tightness), Some(&legend))] {
            let surfaces = self.frame.surfaces(map);
            let drawn = renderer.draw(&surfaces, end.lines, (still, TraceQuality::Still), look, || self.bar.inc(1))?;
            let [front, side, back] = &drawn[..] else { return Err(AppError::internal("three views were asked for")) };
            write_png(out, name, &contact_sheet::triptych(front, side, back, end.title, legend))?;
        }
        self.bar.finish_and_clear();
        Ok(self.frame.hidden_m())
    }

    /// Pictures that a session of `steps` steps takes: the animation's frames, and the stills.
    pub fn work(steps: u64) -> u64 {
        u64::from(AnimationTiming::new(steps).frames) + STILLS
    }
}

/// The moment at which most of the cloth passed through cloth.
pub struct WorstMoment {
    /// When it was (s).
    pub seconds: f64,
    /// Edges that passed through faces.
    pub crossings: u64,
    /// Particles of each garment (m).
    pub garments: Box<[Box<[Vec3]>]>,
    /// The skin.
    pub skin: Posed,
    /// The direction in which the shopper looked (rad from +z towards +x).
    pub facing: f32,
}

/// How the session ended, as the stills show it.
pub struct FinalState<'a> {
    /// A value in -1 (loose) .. 1 (tight) for each particle of each garment.
    pub tightness: &'a [Vec<f32>],
    /// The direction in which the shopper looks (rad from +z towards +x).
    pub facing: f32,
    /// Words over the stills: a title, then smaller lines.
    pub title: &'a str,
    /// Lines over the stills.
    pub lines: &'a [Line],
    /// The moment at which most crossed, if anything ever did.
    pub worst: Option<&'a WorstMoment>,
}

/// Draws the moment at which most crossed, from the front and from the back.
fn draw_worst(
    out: &mut OutputFolder,
    renderer: &mut PictureRenderer,
    (frame, still): (&mut DrawnFrame, Size),
    worst: &WorstMoment,
) -> Result<(), AppError> {
    frame.place(&worst.garments, &worst.skin);
    let aspect = still.width as f32 / still.height as f32;
    let look =
        |bounds: &Bounds| [0.0, PI].map(|turn| OrbitCamera::framing(bounds, worst.facing + turn, aspect)).to_vec();
    let drawn = renderer.draw(&frame.surfaces(None), &[], (still, TraceQuality::Still), look, || {})?;
    let views: Vec<&Image> = drawn.iter().collect();
    let title = format!("{:.1} s: most edges through faces, {}", worst.seconds, worst.crossings);
    write_png(out, "worst.png", &contact_sheet::views(&views, &["front", "back"], &title))
}

fn contact_sheet(out: &mut OutputFolder, kept: &[(Image, u64)]) -> Result<(), AppError> {
    let last = kept.len().saturating_sub(1);
    let count = SHEET_FRAMES.min(kept.len());
    let picks: Vec<usize> = (0..count).map(|i| i * last / count.saturating_sub(1).max(1)).collect();
    let images: Vec<&Image> = picks.iter().map(|&i| &kept[i].0).collect();
    let captions: Vec<String> =
        picks.iter().map(|&i| format!("{:.1} s", kept[i].1 as f64 / f64::from(STEP_HZ))).collect();
    let captions: Vec<&str> = captions.iter().map(String::as_str).collect();
    write_png(out, "contact-sheet.png", &contact_sheet::contact_sheet(&images, SHEET_COLUMNS, &captions))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn animations_run_at_the_speed_of_life_while_they_can() {
        for (steps, stride, fps) in [(1, 12, 10), (1_195, 12, 10), (3_111, 40, 3), (4_652, 60, 2), (12_000, 120, 1)] {
            let timing = AnimationTiming::new(steps);
            assert_eq!((timing.stride, timing.fps), (stride, fps), "{steps} steps");
            assert_eq!(timing.stride * u64::from(timing.fps), u64::from(STEP_HZ));
            assert!((1..=MOST_FRAMES).contains(&u64::from(timing.frames)));
        }
        let hour = AnimationTiming::new(3_600 * u64::from(STEP_HZ));
        assert!(u64::from(hour.frames) <= MOST_FRAMES && hour.fps == 1);
    }
}
