//! Health: the counters of a running kiosk, and the health line. The service's thread counts and writes, never a thread
//! of the loop.

use std::fmt::{self, Display, Formatter};

use toile_engine::frame_loop::event::{Event, EventKind};
use toile_engine::meter::Meter;
use toile_fitting::live::depth_camera::CameraFigures;
use toile_fitting::live::lateness::LatenessAttribution;
use toile_fitting::live::live_scene::StepReport;
use toile_fitting::live::report::Attributed;

use super::session::SessionState;

/// The figures as they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HealthFigures {
    /// Time since the loop began (ns).
    pub uptime_ns: u64,
    /// Where the session is.
    pub state: SessionState,
    /// Steps that were taken.
    pub steps: u64,
    /// 99.9 % of the steps since the last health line took no longer (us).
    pub step_p999_us: f64,
    /// Steps that were published after their period, and steps that were dropped.
    pub misses: u64,
    /// The quality level: 0 is whole quality.
    pub level: u8,
    /// Steps that were rolled back because of a NaN or an infinity.
    pub nonfinite: u64,
    /// Shoppers who stepped in.
    pub sessions: u64,
    /// Pictures that were drawn.
    pub pictures: u64,
    /// Times that the sensor was lost.
    pub sensor_lost: u64,
    /// The live camera, where there is one.
    pub camera: Option<CameraFigures>,
}

impl Default for HealthFigures {
    fn default() -> Self {
        Self {
            uptime_ns: 0,
            state: SessionState::Attract,
            steps: 0,
            step_p999_us: 0.0,
            misses: 0,
            level: 0,
            nonfinite: 0,
            sessions: 0,
            pictures: 0,
            sensor_lost: 0,
            camera: None,
        }
    }
}

impl Display for HealthFigures {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "health: up {} s, {}, {} steps, p99.9 of a step {:.2} ms, {} misses, rung {}, {} nonfinite, {} sessions, {} \
             pictures, sensor lost {} times",
            self.uptime_ns / 1_000_000_000,
            self.state.name(),
            self.steps,
            self.step_p999_us * 1e-3,
            self.misses,
            self.level,
            self.nonfinite,
            self.sessions,
            self.pictures,
            self.sensor_lost
        )?;
        match &self.camera {
            None => Ok(()),
            Some(CameraFigures { state, counts, .. }) => {
                write!(f, ", camera {state}, lost {} times, {} of its frames missing", counts.lost, counts.missing)
            }
        }
    }
}

/// Counts the figures.
#[derive(Debug, Default)]
pub struct HealthCounter {
    figures: HealthFigures,
    /// Steps since the last health line.
    step: Meter,
    /// Why steps were late.
    late: LatenessAttribution,
}

impl HealthCounter {
    /// Adds a step.
    pub fn step(&mut self, step: &StepReport) {
        self.step.add(step.step_ns);
        self.figures.steps += 1;
        self.figures.misses += u64::from(step.late);
        (self.figures.level, self.figures.nonfinite) = (step.level, step.nonfinite);
    }

    /// Something happened in the loop. Late steps are reported by their beats.
    pub fn event(&mut self, event: &Event) {
        self.late.take(event);
        match event.what {
            EventKind::Dropped(steps) => self.figures.misses += steps,
            EventKind::SensorLost => self.figures.sensor_lost += 1,
            _ => {}
        }
    }

    /// Counts a measured person where they are `new`.
    pub fn stepped_in(&mut self, new: bool) {
        self.figures.sessions += u64::from(new);
    }

    /// The camera as it stands, where there is one.
    pub fn camera(&mut self, camera: Option<CameraFigures>) {
        self.figures.camera = camera;
    }

    /// The figures now.
    pub fn figures(&self, uptime_ns: u64, state: SessionState, pictures: u64) -> HealthFigures {
        let h = self.step.histogram();
        let step_p999_us = h.value_at_quantile(0.999).min(h.max()) as f64 * 1e-3;
        HealthFigures { uptime_ns, state, pictures, step_p999_us, ..self.figures }
    }

    /// Why steps were late.
    pub fn attributed(&self) -> Attributed {
        self.late.attributed()
    }

    /// A health line was printed: the next one is about the steps from now on.
    pub fn reported(&mut self) {
        self.step.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beats_and_events_add_up_to_one_line() {
        let mut counter = HealthCounter::default();
        for i in 0..2_000 {
            counter.step(&StepReport { step_ns: 2_000_000, late: i % 1_000 == 7, level: 1, nonfinite: i / 1_000 });
        }
        for what in
            [EventKind::Dropped(5), EventKind::SensorLost, EventKind::SensorBack, EventKind::Missed(Default::default())]
        {
            counter.event(&Event { tick: 0, scheduled_ns: 0, what });
        }
        counter.stepped_in(true);
        counter.stepped_in(false);
        let figures = counter.figures(61_000_000_000, SessionState::TryOn, 99);
        let printed = figures.to_string();
        // A meter keeps 1 % of a time.
        let expected = "health: up 61 s, try-on, 2000 steps, p99.9 of a step 2.01 ms, 7 misses, rung 1, 1 nonfinite, 1 \
                        sessions, 99 pictures, sensor lost 1 times";
        assert_eq!(printed, expected);
        counter.reported();
        let next = counter.figures(0, SessionState::Attract, 0);
        assert_eq!((next.steps, next.step_p999_us), (2_000, 0.0), "only the distribution begins anew");
    }
}
