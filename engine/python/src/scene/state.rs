//! A scene on which one call at a time works, and its state: open, closed, broken by a fault.

use std::mem;
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use toile_sdk::{Scene as SdkScene, WornGarment};

use super::moments::Moments;
use crate::failure::{Failure, detached, guarded};

/// How long steps run until Python may answer a signal, such as that of Ctrl-C.
const UNINTERRUPTED: Duration = Duration::from_millis(50);

/// A scene and what is shown of it.
#[derive(Debug)]
pub struct SceneState {
    pub scene: SdkScene,
    pub moments: Vec<Moments>,
    pub faces: Vec<Arc<[[u32; 3]]>>,
}

#[derive(Debug)]
enum Condition {
    Open(Box<SceneState>),
    Closed,
    Broken,
}

/// A scene that takes one call at a time.
#[derive(Debug)]
pub struct SceneLock {
    condition: Mutex<Condition>,
    /// The process that the scene's threads live in.
    process: u32,
}

impl SceneState {
    fn new(scene: SdkScene) -> toile_sdk::Result<Self> {
        let numbers = 0..scene.garments().len();
        let faces = numbers.clone().map(|garment| Ok(scene.faces(garment)?.into()));
        let faces = faces.collect::<toile_sdk::Result<_>>()?;
        Ok(Self { moments: numbers.map(|_| Moments::default()).collect(), faces, scene })
    }

    /// A garment by its number.
    pub fn worn(&self, garment: usize) -> toile_sdk::Result<&WornGarment> {
        // If the number does not exist, the scene returns an error that says so.
        self.scene.faces(garment)?;
        Ok(&self.scene.garments()[garment])
    }
}

impl Condition {
    fn open(&mut self) -> Result<&mut SceneState, Failure> {
        match self {
            Self::Open(state) => Ok(state),
            Self::Closed => Err(Failure::usage("the scene was closed before; make another")),
            Self::Broken => Err(Failure::internal(
                "a fault of Toile's own ended an earlier call on this scene; close it and make another",
            )),
        }
    }
}

impl SceneLock {
    pub fn new(scene: SdkScene) -> PyResult<Self> {
        let state = SceneState::new(scene).map_err(Failure::from)?;
        Ok(Self { condition: Mutex::new(Condition::Open(Box::new(state))), process: std::process::id() })
    }

    fn lock(&self) -> Result<MutexGuard<'_, Condition>, Failure> {
        if std::process::id() != self.process {
            return Err(Failure::usage(
                "the scene was made before this process forked, and its threads are not here; make scenes after the fork, or \
                 start processes by multiprocessing's \"spawn\"",
            ));
        }
        match self.condition.try_lock() {
            Ok(condition) => Ok(condition),
            Err(TryLockError::Poisoned(condition)) => Ok(condition.into_inner()),
            Err(TryLockError::WouldBlock) => Err(Failure::usage(
                "another call is at work on this scene; let one thread call it, or let the threads wait for each other",
            )),
        }
    }

    /// Works on the scene with the interpreter's lock: what is short.
    pub fn with<T>(&self, work: impl FnOnce(&mut SceneState) -> PyResult<T>) -> PyResult<T> {
        let mut condition = self.lock()?;
        let state = condition.open()?;
        match panic::catch_unwind(AssertUnwindSafe(|| work(state))) {
            Ok(done) => done,
            Err(said) => {
                *condition = Condition::Broken;
                guarded(|| panic::resume_unwind(said))
            }
        }
    }

    /// Works on the scene without the interpreter's lock: what takes its time.
    pub fn detached<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut SceneState) -> toile_sdk::Result<T> + Send,
    ) -> PyResult<T> {
        let mut condition = self.lock()?;
        released(py, &mut condition, work)
    }

    /// So many steps without the interpreter's lock; signals are answered in between, and an exception of theirs ends them.
    pub fn step(&self, py: Python<'_>, steps: u64) -> PyResult<()> {
        let mut condition = self.lock()?;
        let mut left = steps;
        while left > 0 {
            left -= released(py, &mut condition, |state| {
                let began = Instant::now();
                let mut done = 0;
                while done < left && began.elapsed() < UNINTERRUPTED {
                    state.scene.step();
                    done += 1;
                }
                Ok(done)
            })?;
            if left > 0 {
                py.check_signals()?;
            }
        }
        // What cannot be stepped says so, also where no step is asked for.
        condition.open()?;
        Ok(())
    }

    /// Ends the scene and its threads; arrays that show it stay. Nothing of a scene that was closed.
    pub fn close(&self, py: Python<'_>) -> PyResult<()> {
        let open = mem::replace(&mut *self.lock()?, Condition::Closed);
        py.detach(|| drop(open));
        Ok(())
    }
}

/// Works on a scene without the interpreter's lock.
fn released<T: Send>(
    py: Python<'_>,
    condition: &mut Condition,
    work: impl FnOnce(&mut SceneState) -> toile_sdk::Result<T> + Send,
) -> PyResult<T> {
    let state = condition.open()?;
    let mut whole = false;
    let done = detached(py, || {
        let done = work(state);
        whole = true;
        done
    });
    if !whole {
        *condition = Condition::Broken;
    }
    done
}

impl Drop for SceneLock {
    fn drop(&mut self) {
        if std::process::id() != self.process {
            // Its threads are in the process that this one was forked from; to wait for them here would take for ever.
            let condition = self.condition.get_mut().unwrap_or_else(PoisonError::into_inner);
            mem::forget(mem::replace(condition, Condition::Closed));
        }
    }
}
