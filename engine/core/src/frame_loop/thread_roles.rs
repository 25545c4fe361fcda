//! Thread roles: the cores and the priority that each thread asks for, and those that it got.
//!
//! | role | 2 cores | 3 cores | n cores | priority |
//! |---|---|---|---|---|
//! | physics | 1 | 2 | n - 1 | real-time 40 |
//! | worker of the physics | 0 | 1 | n - 2 | real-time 39 |
//! | sensor | 0 | 0 | 0 | real-time 38 |
//! | render | 0 | 0 | 0 | normal |
//! | driver that draws on the processor | 0 | 0 | 0 | low |
//! | camera, service, background | 0 | 0 | 0 to n - 3 | normal |
//!
//! Only the worker may share a core with others, and it sleeps between steps. No thread shares the core of the physics. Priorities are
//! real-time ones where the system grants them (Linux: `CAP_SYS_NICE` or a limit of `rtprio`): a plain Linux kernel may otherwise wake a
//! thread tens of milliseconds late under load. No thread with such a priority waits by spinning for longer than
//! [`crate::workers::AWAKE`], far from the 950 ms a second at which Linux stops it.
//!
//! On Linux a thread inherits the cores of the thread that starts it. So every thread of a live program asks for its role.

use std::ops::Range;
use std::sync::OnceLock;

use core_affinity::CoreId;
use thread_priority::ThreadPriority;

toile_base::named! {
    /// What a thread does in a live program.
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
        /// Waits for a camera, or finds the person in its pictures.
        Camera = "camera",
        /// Looks after the others: supervision, window events, metrics.
        Service = "service",
        /// Does jobs that nothing waits for: dressing, measuring, reading a catalogue.
        Background = "background",
        /// Opens a graphics driver that draws on the processor; the driver's own threads inherit cores and priority.
        Driver = "driver",
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
            Self::Render | Self::Camera | Self::Service | Self::Background | Self::Driver => None,
        }
    }

    /// The cores that it asks for, of `cores`, which are two at least.
    pub fn cores(self, cores: usize) -> Range<usize> {
        match self {
            Self::Physics => cores - 1..cores,
            Self::Worker if cores > 2 => cores - 2..cores - 1,
            Self::Worker | Self::Sensor | Self::Render | Self::Driver => 0..1,
            Self::Camera | Self::Service | Self::Background => 0..(cores - 2).max(1),
        }
    }

    /// The role of the second worker of a pool whose runs a thread of this role calls; none where that worker may run on any core. Only
    /// the physics has a core set aside for it.
    pub fn second_worker(self) -> Option<Self> {
        (self == Self::Physics).then_some(Self::Worker)
    }
}

/// What a thread asked for and got.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RolePlacement {
    /// What the thread does.
    pub role: ThreadRole,
    /// The core that it is pinned to; none where it may run on several.
    pub core: Option<usize>,
    /// The real-time priority that it has.
    pub priority: Option<u8>,
    /// What it did not get, why, and the cure; one sentence each.
    pub refused: Vec<String>,
}

/// Gives the calling thread the place of its role, as far as the system lets it. At the thread's start.
pub fn apply(role: ThreadRole) -> RolePlacement {
    let mut placement = RolePlacement { role, core: None, priority: None, refused: Vec::new() };
    place(&mut placement);
    if role == ThreadRole::Driver {
        lower();
    }
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

/// Lets the calling thread run on every core of the program again, whatever it inherited.
pub fn release() {
    restrict(program_cores());
}

/// The cores of the program, as they were before any thread was pinned. A thread that inherited a place sees no other cores.
fn program_cores() -> &'static [CoreId] {
    static CORES: OnceLock<Vec<CoreId>> = OnceLock::new();
    CORES.get_or_init(|| core_affinity::get_core_ids().unwrap_or_default())
}

fn place(placement: &mut RolePlacement) {
    let (role, cores) = (placement.role, program_cores());
    if cores.len() < 2 {
        let why =
            format!("the {} thread is not pinned, because there is no second core to keep it apart from", role.name());
        placement.refused.push(format!("{why}; give the program two cores"));
        return;
    }
    let own = &cores[role.cores(cores.len())];
    let placed = match own {
        [core] => core_affinity::set_for_current(*core),
        several => restrict(several),
    };
    match own {
        [core] if placed => placement.core = Some(core.id),
        _ if placed => {}
        _ => {
            let ids = own.iter().map(|core| core.id.to_string()).collect::<Vec<_>>().join(", ");
            placement.refused.push(format!(
                "the {} thread could not be pinned to core {ids}; allow sched_setaffinity to the program",
                role.name(),
            ));
        }
    }
}

/// Restricts the calling thread to some cores; says whether the system did.
#[cfg(target_os = "linux")]
fn restrict(cores: &[CoreId]) -> bool {
    use nix::sched::{CpuSet, sched_setaffinity};
    let mut set = CpuSet::new();
    // 0 is the calling thread.
    cores.iter().all(|core| set.set(core.id).is_ok()) && sched_setaffinity(nix::unistd::Pid::from_raw(0), &set).is_ok()
}

/// Other systems pin a thread to one core or to none, and their threads inherit nothing.
#[cfg(not(target_os = "linux"))]
fn restrict(_cores: &[CoreId]) -> bool {
    true
}

/// Lowers the priority of the calling thread, and with it that of threads which it starts: on Linux to a nice value of 9. A system
/// that refuses leaves it as it is.
fn lower() {
    #[cfg(target_os = "linux")]
    {
        use thread_priority::{NormalThreadSchedulePolicy, ThreadPriorityValue, ThreadSchedulePolicy};
        let policy = ThreadSchedulePolicy::Normal(NormalThreadSchedulePolicy::Other);
        // A quarter of the way from the least to the most.
        if let Ok(quarter) = ThreadPriorityValue::try_from(25) {
            let (thread, priority) = (thread_priority::thread_native_id(), ThreadPriority::Crossplatform(quarter));
            _ = thread_priority::set_thread_priority_and_policy(thread, priority, policy);
        }
    }
    #[cfg(not(target_os = "linux"))]
    {
        _ = thread_priority::set_current_thread_priority(ThreadPriority::Min);
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
    fn no_role_shares_the_core_of_the_physics() {
        for cores in 2..16 {
            let physics = ThreadRole::Physics.cores(cores);
            assert_eq!((physics.len(), physics.end), (1, cores));
            for role in ThreadRole::ALL.into_iter().filter(|role| *role != ThreadRole::Physics) {
                let own = role.cores(cores);
                assert!(!own.is_empty() && own.end <= physics.start, "{} of {cores} cores: {own:?}", role.name());
            }
        }
    }

    #[test]
    fn second_worker_keeps_off_its_caller() {
        for (cores, caller) in (2..16).flat_map(|cores| ThreadRole::ALL.map(|caller| (cores, caller))) {
            let Some(worker) = caller.second_worker() else { continue };
            let (own, its) = (worker.cores(cores), caller.cores(cores));
            assert!(own.end <= its.start || its.end <= own.start, "{} of {cores} cores", caller.name());
        }
        assert_eq!(ThreadRole::Physics.second_worker(), Some(ThreadRole::Worker));
    }

    #[test]
    fn inherited_places_do_not_count() {
        let placed = std::thread::spawn(|| {
            let first = apply(ThreadRole::Render).core;
            // A thread of a pinned thread asks for another core.
            let second = std::thread::spawn(|| apply(ThreadRole::Physics).core).join().unwrap();
            (first, second)
        });
        let (first, second) = placed.join().unwrap();
        if let (Some(first), Some(second)) = (first, second) {
            assert_ne!(first, second);
        }
        assert_eq!(first.is_some(), second.is_some(), "the second thread sees as many cores as the first");
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
