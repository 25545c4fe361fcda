//! One job at a time on a thread of its own, for which nothing waits.

use std::io;
use std::thread::{self, JoinHandle};

use toile_engine::frame_loop::thread_roles::{self, ThreadRole};

/// A job that has ended.
#[derive(Debug)]
pub enum Finished<T> {
    /// It gave this, and whether the caller still wants it.
    Done {
        /// What the job returned.
        value: T,
        /// Whether it was not abandoned.
        wanted: bool,
    },
    /// The thread of the job panicked.
    Panicked,
}

/// Runs jobs, one at a time.
#[derive(Debug)]
pub struct BackgroundJob<T> {
    thread: Option<JoinHandle<T>>,
    abandoned: bool,
}

impl<T> Default for BackgroundJob<T> {
    fn default() -> Self {
        Self { thread: None, abandoned: false }
    }
}

impl<T: Send + 'static> BackgroundJob<T> {
    /// Whether a job is under way, abandoned or not.
    pub fn is_running(&self) -> bool {
        self.thread.is_some()
    }

    /// Starts a job on a thread of this name. One at a time: a job under way goes on, and what it gives is lost.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(&mut self, name: &str, work: impl FnOnce() -> T + Send + 'static) -> io::Result<()> {
        self.abandoned = false;
        let placed = move || {
            thread_roles::apply(ThreadRole::Background);
            work()
        };
        self.thread = Some(thread::Builder::new().name(name.to_owned()).spawn(placed)?);
        Ok(())
    }

    /// Abandons the job: its result is not wanted any more.
    pub fn abandon(&mut self) {
        self.abandoned = true;
    }

    /// What has come of the job, once, when it has ended.
    pub fn poll(&mut self) -> Option<Finished<T>> {
        let thread = self.thread.take_if(|thread| thread.is_finished())?;
        Some(match thread.join() {
            Ok(value) => Finished::Done { value, wanted: !self.abandoned },
            Err(_) => Finished::Panicked,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn ended<T: Send + 'static>(job: &mut BackgroundJob<T>) -> Finished<T> {
        loop {
            match job.poll() {
                Some(finished) => return finished,
                None => thread::sleep(Duration::from_millis(1)),
            }
        }
    }

    #[test]
    fn a_job_gives_its_value_once_and_says_whether_it_is_still_wanted() {
        let mut job = BackgroundJob::default();
        job.start("test", || 7).unwrap();
        assert!(matches!(ended(&mut job), Finished::Done { value: 7, wanted: true }));
        assert!(job.poll().is_none() && !job.is_running());
        job.start("test", || 8).unwrap();
        job.abandon();
        assert!(matches!(ended(&mut job), Finished::Done { value: 8, wanted: false }));
        // Past the hook: no words on the test's output.
        job.start("test", || std::panic::resume_unwind(Box::new(()))).unwrap();
        assert!(matches!(ended(&mut job), Finished::Panicked));
    }
}
