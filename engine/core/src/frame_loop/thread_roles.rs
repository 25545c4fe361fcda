//! Thread roles: the core and the priority that each thread asks for, and those that it got.
//!
//! On two cores the physics has the last core and everything else the first: its worker, which sleeps between steps, the sensor
//! for some 50 us a frame, and the renderer with what is left. Priorities are real-time ones where the system grants
//! them (Linux: `CAP_SYS_NICE` or a limit of `rtprio`): a plain Linux kernel may otherwise wake a thread tens of
//! milliseconds late under load. No thread with such a priority waits by spinning for longer than
//! [`crate::workers::AWAKE`], far from the 950 ms a second at which Linux stops it.

use thread_priority::ThreadPriority;

toile_base::named! {
    /// What a thread does in the loop. Its thread has its name, with `toile-` before it.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum ThreadRole {
        /// Reads and filters the sensor.
        Sensor = "sensor",
        /// Steps the scene.
        Physics = "physics",
        /// Shares the physics' cloth.
        Worker = "worker",
        /// Draws pictures of the newest snapshot.
        Render = "render",
    }
}

impl ThreadRole {
    /// Real-time priority, 1 to 99 on Linux; none where a thread may be late. Below 50, where Linux has its interrupt threads.
    /// A sensor frame is worth less than the step that it would hold up.
    pub fn priority(self) -> Option<u8> {
        match self {
            Self::Physics => Some(40),
            Self::Worker => Some(39),
            Self::Sensor => Some(38),
            Self::Render => None,
        }
    }

    /// Which of so many cores it asks for.
    pub fn core(self, cores: usize) -> usize {
        match self {
            Self::Physics => cores - 1,
            Self::Worker if cores > 2 => cores - 2,
            Self::Worker | Self::Sensor | Self::Render => 0,
        }
    }
}

/// What a thread asked for and got.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RolePlacement {
    /// What the thread does.
    pub role: ThreadRole,
    /// The core that it is pinned to.
    pub core: Option<usize>,
    /// The real-time priority that it has.
    pub priority: Option<u8>,
    /// What it did not get, why, and the cure; one sentence each.
    pub refused: Vec<String>,
}

/// Gives the calling thread the place of its role, as far as the system lets it. At the thread's start.
pub fn apply(role: ThreadRole) -> RolePlacement {
    let mut placement = RolePlacement { role, core: None, priority: None, refused: Vec::new() };
    pin(&mut placement);
    if let Some(priority) = role.priority() {
        // On a shared core a thread that waits for another of a lower priority would wait for ever.
        let raised =
            if placement.core.is_some() { raise(priority) } else { Err("it has no core of its own".to_owned()) };
        match raised {
            Ok(()) => placement.priority = Some(priority),
            Err(why) => placement.refused.push(format!(
                "the {} thread has no real-time priority ({why}); grant CAP_SYS_NICE or raise the limit `rtprio`",
                role.name()
            )),
        }
    }
    placement
}

fn pin(placement: &mut RolePlacement) {
    let role = placement.role;
    let cores = core_affinity::get_core_ids().unwrap_or_default();
    if cores.len() < 2 {
        let why =
            format!("the {} thread is not pinned, because there is no second core to keep it apart from", role.name());
        placement.refused.push(format!("{why}; give the program two cores"));
        return;
    }
    let core = cores[role.core(cores.len())];
    if core_affinity::set_for_current(core) {
        placement.core = Some(core.id);
    } else {
        placement.refused.push(format!(
            "the {} thread could not be pinned to core {}; allow sched_setaffinity to the program",
            role.name(),
            core.id
        ));
    }
}

#[cfg(target_os = "linux")]
fn raise(priority: u8) -> Result<(), String> {
    use thread_priority::{RealtimeThreadSchedulePolicy, ThreadPriorityValue, ThreadSchedulePolicy};
    let value = ThreadPriorityValue::try_from(priority).map_err(|e| e.to_string())?;
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let thread = thread_priority::thread_native_id();
    thread_priority::set_thread_priority_and_policy(thread, ThreadPriority::Crossplatform(value), policy)
        .map_err(|e| e.to_string())
}

#[cfg(not(target_os = "linux"))]
fn raise(_priority: u8) -> Result<(), String> {
    thread_priority::set_current_thread_priority(ThreadPriority::Max).map_err(|e| format!("{e:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn physics_has_a_core_that_nothing_else_asks_for() {
        for cores in 2..16 {
            for role in [ThreadRole::Sensor, ThreadRole::Worker, ThreadRole::Render] {
                assert!(role.core(cores) < cores && role.core(cores) != ThreadRole::Physics.core(cores));
            }
        }
    }

    #[test]
    fn a_thread_gets_its_place_or_says_what_it_lacks() {
        let placement = std::thread::spawn(|| apply(ThreadRole::Physics)).join().unwrap();
        assert!(placement.core.is_some() || placement.refused.iter().any(|r| r.contains("pinned")));
        assert!(placement.priority.is_some() || placement.refused.iter().any(|r| r.contains("priority")));
        let asked = 2;
        let got = usize::from(placement.core.is_some()) + usize::from(placement.priority.is_some());
        assert_eq!(placement.refused.len(), asked - got);
    }
}
