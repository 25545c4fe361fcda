//! The loop's threads while they run: started, watched, revived, ended.

use std::io;
use std::thread;
use std::time::{Duration, Instant};

use toile_engine::clock::Clock;
use toile_engine::frame_loop::ThreadLoop;
use toile_engine::frame_loop::thread_roles::{RolePlacement, ThreadRole};
use toile_engine::frame_loop::threads::{self, LoopThread, Stop};

/// Longest that threads are waited for when they are to end: a picture that a busy processor draws; the others take a fifth of a
/// second.
const LONGEST_END: Duration = Duration::from_secs(3);

/// Most revivals of the render thread within [`REVIVAL_WINDOW`]: one that dies more often is broken for good, and the supervisor
/// starts the program again.
pub const MOST_REVIVALS: usize = 10;

/// Time over which revivals are counted.
pub const REVIVAL_WINDOW: Duration = Duration::from_secs(60);

/// A thread's loop that can go on with what one that panicked left behind.
pub trait Restart {
    /// One in the place of one that panicked; what it was about is given up.
    #[must_use]
    fn restarted(self) -> Self;
}

/// The loops that the three threads run.
#[derive(Debug)]
pub struct Loops<A, P, R> {
    /// Loop of the sensor thread.
    pub sensor: A,
    /// Loop of the physics thread.
    pub physics: P,
    /// Loop of the render thread.
    pub render: R,
}

/// What the threads left when they ended; `None` where one did not end in time, or panicked.
#[derive(Debug)]
pub struct EndedLoops<A, P, R> {
    /// Loop of the sensor thread.
    pub sensor: Option<A>,
    /// Loop of the physics thread.
    pub physics: Option<P>,
    /// Loop of the render thread.
    pub render: Option<R>,
}

/// The three threads.
#[derive(Debug)]
pub struct RunningLoop<A, P, R, C> {
    clock: C,
    stop: Stop,
    sensor: LoopThread<A>,
    physics: LoopThread<P>,
    /// `None` for the moment between a panic and the revival.
    render: Option<LoopThread<R>>,
    placements: Vec<RolePlacement>,
    revivals: Vec<Instant>,
    revived: u64,
}

impl<A, P, R, C> RunningLoop<A, P, R, C>
where
    A: ThreadLoop + Send + 'static,
    P: ThreadLoop + Send + 'static,
    R: ThreadLoop + Restart + Send + 'static,
    C: Clock + Clone + Send + 'static,
{
    /// Starts them, each on its place.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(loops: Loops<A, P, R>, clock: C) -> io::Result<Self> {
        let stop = Stop::default();
        let sensor = threads::start(ThreadRole::Sensor, loops.sensor, clock.clone(), &stop)?;
        let physics = threads::start(ThreadRole::Physics, loops.physics, clock.clone(), &stop)?;
        let render = threads::start(ThreadRole::Render, loops.render, clock.clone(), &stop)?;
        let placements = [sensor.placement(), physics.placement(), render.placement()].into_iter().flatten().collect();
        let revivals = Vec::with_capacity(MOST_REVIVALS);
        Ok(Self { clock, stop, sensor, physics, render: Some(render), placements, revivals, revived: 0 })
    }

    /// The places that the threads got.
    pub fn placements(&self) -> &[RolePlacement] {
        &self.placements
    }

    /// The loop's clock.
    pub fn clock(&self) -> &C {
        &self.clock
    }

    /// Times that the render thread was revived.
    pub fn revived(&self) -> u64 {
        self.revived
    }

    /// Looks after the threads: a render thread that has panicked is started again with what it held, so that pictures go on. Gives
    /// the thread that is over for good: sensor or physics, or a renderer that dies again and again.
    ///
    /// # Errors
    /// Where the system gives no thread to revive it on.
    pub fn look(&mut self) -> io::Result<Option<ThreadRole>> {
        if self.sensor.is_over() {
            return Ok(Some(ThreadRole::Sensor));
        }
        if self.physics.is_over() {
            return Ok(Some(ThreadRole::Physics));
        }
        if self.render.as_ref().is_some_and(LoopThread::is_over) {
            return self.revive();
        }
        Ok(None)
    }

    fn revive(&mut self) -> io::Result<Option<ThreadRole>> {
        self.revivals.retain(|at| at.elapsed() < REVIVAL_WINDOW);
        if self.revivals.len() >= MOST_REVIVALS {
            return Ok(Some(ThreadRole::Render));
        }
        let Some(render) = self.render.take().and_then(LoopThread::salvage) else {
            return Ok(Some(ThreadRole::Render));
        };
        self.render = Some(threads::start(ThreadRole::Render, render.restarted(), self.clock.clone(), &self.stop)?);
        self.revivals.push(Instant::now());
        self.revived += 1;
        Ok(None)
    }

    /// Ends them, and waits for a bounded time: one that hangs is left to the end of the program.
    pub fn end(self) -> EndedLoops<A, P, R> {
        self.stop.now();
        let end = Instant::now() + LONGEST_END;
        let over =
            || self.sensor.is_over() && self.physics.is_over() && self.render.as_ref().is_none_or(LoopThread::is_over);
        while Instant::now() < end && !over() {
            thread::sleep(Duration::from_millis(1));
        }
        EndedLoops { sensor: ended(self.sensor), physics: ended(self.physics), render: self.render.and_then(ended) }
    }
}

fn ended<T>(thread: LoopThread<T>) -> Option<T> {
    if thread.is_over() { thread.join() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_engine::clock::RealClock;

    /// From turn to turn: .1 ms (ns).
    const TURN_NS: u64 = 100_000;

    /// Takes turns until it dies of so many.
    #[derive(Debug)]
    struct Mortal {
        turns: u64,
        dies_at: u64,
        restarts: u64,
    }

    impl Mortal {
        fn living(dies_at: u64) -> Self {
            Self { turns: 0, dies_at, restarts: 0 }
        }
    }

    impl ThreadLoop for Mortal {
        fn run_due(&mut self) -> Option<u64> {
            self.turns += 1;
            if self.turns >= self.dies_at {
                // Past the hook: no words on the test's output.
                std::panic::resume_unwind(Box::new(()));
            }
            // With rests between the turns: at a real-time priority a thread without any would keep all others off its core.
            Some(self.turns * TURN_NS)
        }
    }

    impl Restart for Mortal {
        fn restarted(self) -> Self {
            Self { turns: 0, restarts: self.restarts + 1, ..self }
        }
    }

    fn running(render: Mortal) -> RunningLoop<Mortal, Mortal, Mortal, RealClock> {
        let (sensor, physics) = (Mortal::living(u64::MAX), Mortal::living(u64::MAX));
        RunningLoop::start(Loops { sensor, physics, render }, RealClock::default()).unwrap()
    }

    #[test]
    fn a_render_thread_that_panics_lives_again_with_what_it_held_until_it_does_so_too_often() {
        let mut all = running(Mortal::living(10));
        let over = loop {
            match all.look().unwrap() {
                Some(role) => break role,
                None => thread::sleep(Duration::from_millis(1)),
            }
        };
        assert_eq!((over, all.revived()), (ThreadRole::Render, MOST_REVIVALS as u64));
        let ended = all.end();
        assert!(ended.sensor.is_some() && ended.physics.is_some() && ended.render.is_none());
    }

    #[test]
    fn threads_that_live_are_left_alone_and_end_when_told() {
        let mut all = running(Mortal::living(u64::MAX));
        assert_eq!(
            all.placements().iter().map(|p| p.role).collect::<Vec<_>>(),
            [ThreadRole::Sensor, ThreadRole::Physics, ThreadRole::Render]
        );
        assert_eq!((all.look().unwrap(), all.revived()), (None, 0));
        assert_eq!(all.end().render.unwrap().restarts, 0);
    }
}
