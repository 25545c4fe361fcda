//! The report of a kiosk's run, as in the JSON: figures of the machine, and nothing of a person.

use serde::Serialize;
use toile_engine::frame_loop::loop_meters::LoopMeters;
use toile_engine::frame_loop::physics_thread::LoopScene;
use toile_engine::frame_loop::queue::Capacity;
use toile_engine::frame_loop::render_thread::Renderer;
use toile_fitting::live::depth_camera::CameraFigures;
use toile_fitting::live::live_loop::EndedLive;
use toile_fitting::live::report::{Attributed, Quantiles, QueueUse, ThreadPlacement};
use toile_fitting::live::source::Feed;

use super::health::HealthFigures;
use super::session::SessionState;

/// The body of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KioskReport {
    /// Time since the loop began (s).
    pub seconds: f64,
    /// From the start of the program until the first step and the first picture were made (ms); none where it ended before.
    pub ready_ms: Option<f64>,
    /// The states that were entered, in order; the first thousand.
    pub states: Vec<SessionState>,
    /// Shoppers who stepped in.
    pub sessions: u64,
    /// Pictures that were drawn.
    pub frames: u64,
    /// Pictures that fell out because the one before took too long.
    pub dropped: u64,
    /// Times that the render thread panicked and was started again.
    pub revived: u64,
    /// Frames that the sensor gave.
    pub sensor_frames: u64,
    /// Steps that were taken.
    pub steps: u64,
    /// Steps given up after a late wake-up.
    pub steps_dropped: u64,
    /// Steps that were published after their period, and those given up.
    pub deadline_misses: u64,
    /// The same by their causes.
    pub attributed: Attributed,
    /// A step, begin to publication (us).
    pub step_us: Quantiles,
    /// A picture, from the look at the snapshot until it is handed to the display (us).
    pub present_us: Quantiles,
    /// From when a sensor frame was seen until the first picture that shows it was taken (us).
    pub total_us: Quantiles,
    /// Steps on each quality level.
    #[serde(rename = "rungs")]
    pub level_steps: Vec<u64>,
    /// Steps that were rolled back because of a NaN or an infinity.
    pub nonfinite: u64,
    /// Whether all memory was kept resident.
    pub memory_locked: bool,
    /// Where the threads ran.
    pub threads: Vec<ThreadPlacement>,
    /// How full the queues were.
    pub capacities: Vec<QueueUse>,
    /// What did not go as it should, with the cure.
    pub warnings: Vec<String>,
    /// The live camera, where there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraReport>,
    /// The window, where there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<WindowReport>,
}

/// The camera's part of the JSON.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CameraReport {
    /// How it stood at the end.
    pub state: &'static str,
    /// Frames that came.
    pub frames: u64,
    /// Frames that did not come.
    pub missing: u64,
    /// Frames that were cut short, the same again, or of a covered lens.
    pub unusable: [u64; 3],
    /// Jumps of its clock.
    pub clock_jumps: u64,
    /// Times that it was lost, frozen or covered.
    pub lost: u64,
    /// Times that it was opened anew.
    pub reopened: u64,
    /// Frames in which a person was followed.
    pub followed: u64,
}

impl From<CameraFigures> for CameraReport {
    fn from(CameraFigures { state, counts, tracked: [_, followed], .. }: CameraFigures) -> Self {
        Self {
            state: state.name(),
            frames: counts.frames,
            missing: counts.missing,
            unusable: [counts.half, counts.repeated, counts.empty],
            clock_jumps: counts.clock_jumps,
            lost: counts.lost,
            reopened: counts.reopened,
            followed,
        }
    }
}

/// The window's part of the JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WindowReport {
    /// Name of the graphics adapter.
    pub adapter: String,
    /// Whether that draws on the processor.
    pub software: bool,
    /// Pixels of the window.
    pub size: [u32; 2],
    /// From the start of the program until the first picture was presented (ms).
    pub first_picture_ms: Option<f64>,
    /// Pictures that were presented.
    pub presented: u64,
    /// Pictures that were due and not drawn, because the adapter is to rest or the window is hidden.
    pub rested: u64,
    /// Pictures for which the display gave no surface.
    pub refused: u64,
    /// Times that the device was lost and made anew.
    pub lost: u64,
    /// Painting and drawing a picture (us).
    pub draw_us: Quantiles,
    /// From one presented picture to the next (us).
    pub between_us: Quantiles,
    /// How much longer or shorter that was than the time before it (us): the jitter.
    pub jitter_us: Quantiles,
}

/// What the service recorded of its run, beside the loop's threads.
#[derive(Debug, Clone)]
pub struct RunRecord {
    /// The figures at the end.
    pub figures: HealthFigures,
    /// From the start of the program until it was ready (ms).
    pub ready_ms: Option<f64>,
    /// States of the session, in the order in which they were entered.
    pub states: Vec<SessionState>,
    /// Why steps were late.
    pub attributed: Attributed,
    /// Times that the render thread was revived.
    pub revived: u64,
    /// Where the threads ran.
    pub threads: Vec<ThreadPlacement>,
    /// Whether all memory was kept resident.
    pub memory_locked: bool,
    /// What did not go as it should.
    pub warnings: Vec<String>,
}

impl KioskReport {
    /// Of threads that have ended.
    pub fn of<S: LoopScene, E: Renderer>(
        ended: &EndedLive<S, E, Feed>,
        capacities: [Capacity; 3],
        record: RunRecord,
    ) -> Self {
        let nothing = LoopMeters::default();
        let gauges = ended.physics.as_ref().map_or(&nothing, |physics| &physics.gauges);
        let render = ended.render.as_ref().map(|watched| &watched.render);
        let mut warnings = record.warnings;
        warnings.extend(capacities.iter().filter_map(Capacity::warning));
        warnings.extend(record.threads.iter().flat_map(|t| t.refused.clone()));
        Self {
            seconds: (record.figures.uptime_ns / 1_000_000) as f64 / 1e3,
            ready_ms: record.ready_ms,
            states: record.states,
            sessions: record.figures.sessions,
            frames: render.map_or(0, |r| r.pictures),
            dropped: render.map_or(0, |r| r.dropped),
            revived: record.revived,
            sensor_frames: ended.sensor.as_ref().map_or(0, |s| s.frames()),
            steps: gauges.steps,
            steps_dropped: gauges.dropped,
            deadline_misses: gauges.missed + gauges.dropped,
            attributed: record.attributed,
            step_us: Quantiles::of(&gauges.step),
            present_us: render.map(|r| Quantiles::of(&r.drawing)).unwrap_or_default(),
            total_us: render.map(|r| Quantiles::of(&r.total)).unwrap_or_default(),
            level_steps: gauges.level_steps.to_vec(),
            nonfinite: record.figures.nonfinite,
            memory_locked: record.memory_locked,
            threads: record.threads,
            capacities: capacities.map(QueueUse::from).to_vec(),
            warnings,
            camera: record.figures.camera.map(CameraReport::from),
            window: None,
        }
    }

    /// The same for a person, a few lines.
    pub fn summary(&self) -> String {
        let states: Vec<&str> = self.states.iter().map(|s| s.name()).collect();
        let ready = self.ready_ms.map_or_else(|| "never ready".to_owned(), |ms| format!("ready after {ms:.0} ms"));
        let mut text = format!(
            "Kiosk: {:.0} s, {ready}, {} sessions ({})\n  {} steps, {} of them late or dropped; a step took {:.0} us (p50), \
             {:.0} us (p99.9)\n  {} pictures, {} dropped; {} sensor frames; {} nonfinite\n",
            self.seconds,
            self.sessions,
            states.join(", "),
            self.steps,
            self.deadline_misses,
            self.step_us.p50,
            self.step_us.p999,
            self.frames,
            self.dropped,
            self.sensor_frames,
            self.nonfinite
        );
        if let Some(camera) = &self.camera {
            text.push_str(&format!(
                "  camera: {} frames, {} missing, {} unusable, lost {} times, opened anew {} times\n",
                camera.frames,
                camera.missing,
                camera.unusable.iter().sum::<u64>(),
                camera.lost,
                camera.reopened
            ));
        }
        self.warnings.iter().for_each(|w| text.push_str(&format!("  {w}\n")));
        text
    }
}
