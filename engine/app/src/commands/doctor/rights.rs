//! Rights of this process: real-time priority, locked memory.

use toile_engine::frame_loop::thread_roles::{self, RolePlacement, ThreadRole};

use super::check::{Check, field, kernel_file};

/// `CAP_SYS_NICE`, real-time priority, in the capability masks of the kernel.
const CAP_SYS_NICE: u32 = 23;

/// `CAP_IPC_LOCK`, locked memory without limit, in the same masks.
const CAP_IPC_LOCK: u32 = 14;

/// The highest priority that the loop's threads ask for: the physics', below the interrupts' 50.
const PRIORITY_WANTED: u64 = 40;

/// Locked memory that a kiosk asks for (MiB), so that no step waits for a page.
const LOCKED_WANTED_MIB: u64 = 1024;

const LIMITS: &str = "/etc/security/limits.d/95-toile.conf";

pub fn priority() -> Check {
    let (name, use_for) = ("priority", "a kiosk's deadlines");
    let (Some(limits), Some(status)) = (kernel_file("/proc/self/limits"), kernel_file("/proc/self/status")) else {
        return Check::unknown(name, use_for);
    };
    match priority_right(&limits, &status) {
        None => Check::unknown(name, use_for),
        Some(Right::Capability) => Check::ok(name, use_for, "real-time allowed (CAP_SYS_NICE)"),
        Some(Right::Soft(n)) if n >= PRIORITY_WANTED => Check::ok(name, use_for, format!("real-time up to {n}")),
        Some(Right::Hard(n)) if n >= PRIORITY_WANTED => {
            let cure = format!("in the shell that starts Toile: `ulimit -r {PRIORITY_WANTED}`");
            Check::missing(name, use_for, format!("real-time allowed up to {n}, but not switched on"), cure)
        }
        Some(Right::Soft(n) | Right::Hard(n)) => {
            let program = std::env::current_exe().map_or_else(|_| "toile".to_owned(), |p| p.display().to_string());
            let line = limits_line("rtprio", PRIORITY_WANTED);
            let cure =
                format!("{line}, then log in again; or `sudo setcap cap_sys_nice+ep {program}` after each build");
            Check::missing(name, use_for, format!("real-time up to {n} of {PRIORITY_WANTED}"), cure)
        }
    }
}

/// What the physics thread gets here: tried on a thread that ends at once.
pub fn placement() -> Check {
    match std::thread::Builder::new().spawn(|| thread_roles::apply(ThreadRole::Physics)).map(|thread| thread.join()) {
        Ok(Ok(placement)) => placed(&placement),
        _ => Check::unknown(PLACEMENT, PLACEMENT_FOR),
    }
}

const PLACEMENT: &str = "pinning";
const PLACEMENT_FOR: &str = "a kiosk's deadlines";

fn placed(placement: &RolePlacement) -> Check {
    let core = placement.core.map_or_else(|| "not pinned".to_owned(), |core| format!("pinned to core {core}"));
    let priority = placement.priority.map_or_else(|| "no real-time priority".to_owned(), |p| format!("priority {p}"));
    let found = format!("physics {core}, {priority}");
    // Each sentence ends with its cure.
    let cures: Vec<&str> = placement.refused.iter().filter_map(|r| r.rsplit_once("; ")).map(|(_, cure)| cure).collect();
    if cures.is_empty() {
        return Check::ok(PLACEMENT, PLACEMENT_FOR, found);
    }
    Check::missing(PLACEMENT, PLACEMENT_FOR, found, cures.join("; "))
}

pub fn locked_memory() -> Check {
    let (name, use_for) = ("locked memory", "a kiosk's deadlines");
    if has_capability(&kernel_file("/proc/self/status").unwrap_or_default(), CAP_IPC_LOCK) {
        return Check::ok(name, use_for, "unlimited (CAP_IPC_LOCK)");
    }
    let limits = kernel_file("/proc/self/limits").unwrap_or_default();
    let Some((soft, _)) = limit(&limits, "Max locked memory") else { return Check::unknown(name, use_for) };
    let mib = soft >> 20;
    let found = if soft == u64::MAX { "unlimited".to_owned() } else { format!("{mib} MiB") };
    if mib >= LOCKED_WANTED_MIB {
        return Check::ok(name, use_for, found);
    }
    let cure = format!("{}, then log in again", limits_line("memlock", LOCKED_WANTED_MIB * 1024));
    Check::missing(name, use_for, found, cure)
}

/// Whether memory may be locked without limit.
pub fn may_lock_all() -> bool {
    let limits = kernel_file("/proc/self/limits").unwrap_or_default();
    has_capability(&kernel_file("/proc/self/status").unwrap_or_default(), CAP_IPC_LOCK)
        || limit(&limits, "Max locked memory").is_some_and(|(soft, _)| soft == u64::MAX)
}

pub fn kernel() -> Check {
    let (name, use_for) = ("kernel", "a kiosk's deadlines");
    let Some(version) = kernel_file("/proc/version") else { return Check::unknown(name, use_for) };
    let release = version.split_whitespace().nth(2).unwrap_or("unnamed");
    let real_time = kernel_file("/sys/kernel/realtime").is_some_and(|t| t == "1") || version.contains("PREEMPT_RT");
    if real_time {
        return Check::ok(name, use_for, format!("{release}, real-time"));
    }
    let cure = format!(
        "a real-time kernel; on Debian `sudo apt install linux-image-rt-{}`, then boot it",
        debian_architecture()
    );
    Check::missing(name, use_for, format!("{release}, not real-time: it may wake a thread tens of ms late"), cure)
}

fn debian_architecture() -> &'static str {
    if cfg!(target_arch = "aarch64") { "arm64" } else { "amd64" }
}

fn limits_line(item: &str, value: u64) -> String {
    format!("`echo \"$USER - {item} {value}\" | sudo tee -a {LIMITS}`")
}

#[derive(Debug, PartialEq)]
enum Right {
    Capability,
    Soft(u64),
    Hard(u64),
}

fn priority_right(limits: &str, status: &str) -> Option<Right> {
    if has_capability(status, CAP_SYS_NICE) {
        return Some(Right::Capability);
    }
    let (soft, hard) = limit(limits, "Max realtime priority")?;
    Some(if hard > soft { Right::Hard(hard) } else { Right::Soft(soft) })
}

fn has_capability(status: &str, bit: u32) -> bool {
    let mask = field(status, "CapEff").and_then(|m| u64::from_str_radix(m, 16).ok());
    mask.is_some_and(|m| m >> bit & 1 == 1)
}

/// Soft and hard limit of a row of `/proc/self/limits`; `unlimited` is the largest number.
fn limit(limits: &str, row: &str) -> Option<(u64, u64)> {
    let mut fields = limits.lines().find_map(|line| line.strip_prefix(row))?.split_whitespace();
    let mut next = || {
        let word = fields.next()?;
        if word == "unlimited" { Some(u64::MAX) } else { word.parse().ok() }
    };
    Some((next()?, next()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS_TEXT: &str = "Limit                     Soft Limit           Hard Limit           Units     \n\
        Max locked memory         8388608              unlimited            bytes     \n\
        Max realtime priority     10                   95                   \n";

    #[test]
    fn the_priority_that_is_looked_for_is_the_one_that_is_asked_for() {
        assert_eq!(ThreadRole::Physics.priority().map(u64::from), Some(PRIORITY_WANTED));
    }

    #[test]
    fn a_place_that_was_refused_is_told_with_its_cure() {
        let all = RolePlacement { role: ThreadRole::Physics, core: Some(1), priority: Some(40), refused: Vec::new() };
        let fine = placed(&all);
        assert_eq!((fine.found.as_str(), fine.cure), ("physics pinned to core 1, priority 40", None));
        let refused = vec!["the physics thread has no real-time priority (no; reason); raise the limit".to_owned()];
        let check = placed(&RolePlacement { priority: None, refused, ..all });
        assert_eq!(check.found, "physics pinned to core 1, no real-time priority");
        assert_eq!(check.cure.as_deref(), Some("raise the limit"));
    }

    #[test]
    fn limits_are_read_by_row() {
        assert_eq!(limit(LIMITS_TEXT, "Max locked memory"), Some((8_388_608, u64::MAX)));
        assert_eq!(limit(LIMITS_TEXT, "Max realtime priority"), Some((10, 95)));
        assert_eq!(limit(LIMITS_TEXT, "Max nothing"), None);
    }

    #[test]
    fn a_capability_beats_the_limit() {
        assert_eq!(priority_right(LIMITS_TEXT, "CapEff:\t000001ffffffffff\n"), Some(Right::Capability));
        assert_eq!(priority_right(LIMITS_TEXT, "CapEff:\t0000000000000000\n"), Some(Right::Hard(95)));
        // All but CAP_SYS_NICE, as some containers run.
        assert_eq!(priority_right(LIMITS_TEXT, "CapEff:\t000001ffff7fffff\n"), Some(Right::Hard(95)));
        let none = "Max realtime priority     0                    0                    \n";
        assert_eq!(priority_right(none, ""), Some(Right::Soft(0)));
    }
}
