//! Scenes are stepped.

use super::state::SceneHandle;
use crate::border::{In, Out};
use crate::failure::{Code, Failure, call};
use crate::joints::JointFrame;

/// Most steps of one call: 96 days of time in the scene. More is a negative number.
const MOST_STEPS: u64 = 1_000_000_000;

/// Where a scene stands in time.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Clock {
    /// Steps taken so far.
    pub steps: u64,
    /// Time reached (s).
    pub time_s: f64,
    /// Length of a step (s).
    pub time_step_s: f64,
    /// Steps from beginning to end: of the track that is followed, or of the scene file's duration; 0 of a body that stands.
    pub duration_steps: u64,
}

/// One step. A body that follows a track goes on as in its last frame once that has ended.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_step(scene: SceneHandle) -> Code {
    call("toile_scene_step", || {
        scene.with(|state| {
            state.scene.step();
            Ok(())
        })
    })
}

/// So many steps, at most 1,000,000,000.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_step_many(scene: SceneHandle, steps: u64) -> Code {
    call("toile_scene_step_many", || {
        if steps > MOST_STEPS {
            return Err(Failure::usage(format!("{steps} steps are more than {MOST_STEPS}; was the number negative?")));
        }
        scene.with(|state| {
            state.scene.step_many(steps);
            Ok(())
        })
    })
}

/// One step of a dressed body to joints of the caller's own, those at the step's end; it stays there until moved on. Not of a body
/// that follows a track.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_step_to(scene: SceneHandle, joints: In<JointFrame>) -> Code {
    call("toile_scene_step_to", || {
        let joints = joints.value("joints")?.into();
        scene.with(|state| Ok(state.scene.step_to(&joints)?))
    })
}

/// Where a scene stands in time.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_clock(scene: SceneHandle, clock: Out<Clock>) -> Code {
    call("toile_scene_clock", || {
        let place = clock.place("clock")?;
        scene.with(|state| {
            let of = &state.scene;
            place.set(Clock {
                steps: of.steps(),
                time_s: of.time(),
                time_step_s: of.time_step(),
                duration_steps: of.duration_steps().unwrap_or_default(),
            });
            Ok(())
        })
    })
}
