//! The render thread: it draws the newest snapshot at the display's rate. Physics never waits for it.

use super::ThreadLoop;
use super::handover::HandoverReceiver;
use super::schedule::{Due, Schedule};
use crate::clock::Clock;
use crate::meter::Meter;
use crate::triple_buffer::Reader;
use crate::world::Snapshot;

/// Pictures a second.
pub const DISPLAY_HZ: u32 = 60;

/// Time between two frames of the sensor, for those that no picture was taken of (ns).
const SENSOR_PERIOD_NS: u64 = 33_333_333;

/// Most of these that are metered one by one.
const MOST_TOLD: u64 = 300;

/// Who makes a picture of a snapshot.
pub trait Renderer: Send {
    /// What else it has to know of a scene to draw it, such as triangles and colours: made elsewhere, changed with the scene.
    type Outfit: Send;

    /// From the next look on another scene is seen, with this outfit; what it leaves in its place is dropped elsewhere.
    fn set_outfit(&mut self, outfit: &mut Self::Outfit);

    /// Makes it; returns when it is handed to the display, or would be.
    fn draw(&mut self, snapshot: &Snapshot);
}

/// Where another scene's snapshots come out, and what is drawn of them.
#[derive(Debug)]
pub struct SceneView<O> {
    /// Reads the newest snapshot.
    pub reader: Reader<Snapshot>,
    /// What the renderer has to know.
    pub outfit: O,
}

/// What the render thread runs.
#[derive(Debug)]
pub struct RenderThread<E: Renderer, C> {
    /// Draws the pictures.
    pub renderer: E,
    clock: C,
    schedule: Schedule,
    reader: Reader<Snapshot>,
    changes: Option<HandoverReceiver<SceneView<E::Outfit>>>,
    /// From a snapshot's publication until its picture was taken.
    pub picture: Meter,
    /// How long the picture itself took.
    pub drawing: Meter,
    /// From when a sensor frame was seen until the first picture that shows it was taken. Frames that no picture was
    /// taken of count as shown with the next, at their own age.
    pub total: Meter,
    /// Pictures that were drawn.
    pub pictures: u64,
    /// Pictures that fell out because the one before took too long.
    pub dropped: u64,
    frame: u64,
    from_ns: u64,
}

impl<E: Renderer, C: Clock> RenderThread<E, C> {
    /// At load; the first picture is due at `origin_ns`.
    pub fn new(renderer: E, clock: C, origin_ns: u64, reader: Reader<Snapshot>) -> Self {
        Self {
            renderer,
            clock,
            schedule: Schedule::new(origin_ns, DISPLAY_HZ),
            reader,
            changes: None,
            picture: Meter::new(),
            drawing: Meter::new(),
            total: Meter::new(),
            pictures: 0,
            dropped: 0,
            frame: 0,
            from_ns: 0,
        }
    }

    /// The same, whose meters begin at this time (ns).
    #[must_use]
    pub fn metering_from(self, from_ns: u64) -> Self {
        Self { from_ns, ..self }
    }

    /// The same, which looks at another scene when it is handed to it.
    #[must_use]
    pub fn changing(self, changes: HandoverReceiver<SceneView<E::Outfit>>) -> Self {
        Self { changes: Some(changes), ..self }
    }

    /// One in the place of one that died, with what it held; the next picture is due now.
    #[must_use]
    pub fn begun_again(self) -> Self {
        let schedule = Schedule::new(self.clock.now_ns(), DISPLAY_HZ);
        Self { schedule, ..self }
    }

    fn take(&mut self) {
        let begun = self.clock.now_ns();
        if let Some(changes) = &mut self.changes {
            let (reader, renderer) = (&mut self.reader, &mut self.renderer);
            changes.take(|change| {
                std::mem::swap(&mut change.scene.reader, reader);
                renderer.set_outfit(&mut change.scene.outfit);
            });
        }
        let Some(snapshot) = self.reader.news() else { return };
        let times = snapshot.times;
        self.renderer.draw(snapshot);
        let taken = self.clock.now_ns();
        if begun < self.from_ns {
            self.frame = times.frame;
            return;
        }
        self.pictures += 1;
        self.drawing.add(taken - begun);
        if times.published_ns > 0 {
            self.picture.add(taken.saturating_sub(times.published_ns));
        }
        if times.frame > self.frame {
            let age = taken.saturating_sub(times.seen_ns);
            let missed = if self.frame == 0 { 0 } else { times.frame - self.frame - 1 };
            (0..=missed.min(MOST_TOLD)).for_each(|k| self.total.add(age + k * SENSOR_PERIOD_NS));
            self.frame = times.frame;
        }
    }
}

impl<E: Renderer, C: Clock> ThreadLoop for RenderThread<E, C> {
    fn run_due(&mut self) -> Option<u64> {
        match self.schedule.due(self.clock.now_ns()) {
            Due::At(ns) => Some(ns),
            Due::Now(mut tick) => {
                // An old picture is of no use: only the last that is due is taken.
                loop {
                    self.dropped += tick.dropped;
                    match self.schedule.due(self.clock.now_ns()) {
                        Due::Now(later) => {
                            self.dropped += 1;
                            tick = later;
                        }
                        Due::At(_) => break,
                    }
                }
                self.take();
                Some(self.schedule.next_ns())
            }
        }
    }
}
