//! The processor, its memory and its clocks.

use std::collections::BTreeSet;
use std::time::Instant;

use toile_cli::machine;

use super::check::{Check, field, kernel_file};

/// Physics and sensor threads want one core each.
const CORES_WANTED: usize = 2;

/// A whole try-on with its pictures stays below this (MiB); more is better, less swaps.
const MEMORY_WANTED_MIB: u64 = 1024;

/// Reading the clock stands twice a stage; above this (ns) the meters themselves would cost a per cent of a step.
const CLOCK_WANTED_NS: u128 = 1000;

pub fn cpu() -> Check {
    let name = machine::cpu_name();
    if name == "unknown" { Check::unknown("processor", "all work") } else { Check::ok("processor", "all work", name) }
}

pub fn cores() -> Check {
    let usable = std::thread::available_parallelism().map_or(1, usize::from);
    let status = kernel_file("/proc/self/status").unwrap_or_default();
    let allowed = field(&status, "Cpus_allowed_list").map_or_else(String::new, |list| format!(", processors {list}"));
    let found = format!("{usable} usable{allowed}");
    if usable >= CORES_WANTED {
        return Check::ok("cores", "120 steps a second beside the sensor", found);
    }
    let cure = "give the process two cores: `taskset -c 0,1 toile ...`, or raise the container's CPU limit to 2";
    Check::missing("cores", "120 steps a second beside the sensor", found, cure)
}

pub fn lanes() -> Check {
    match machine::lanes() {
        "none" => Check::unknown("lanes", "fast cloth"),
        found => Check::ok("lanes", "fast cloth", found),
    }
}

pub fn memory() -> Check {
    let Some(text) = kernel_file("/proc/meminfo") else { return Check::unknown("memory", "pictures") };
    let mib = |key| Some(field(&text, key)?.split_whitespace().next()?.parse::<u64>().ok()? / 1024);
    let (Some(total), Some(free)) = (mib("MemTotal"), mib("MemAvailable")) else {
        return Check::unknown("memory", "pictures");
    };
    let limit = kernel_file("/sys/fs/cgroup/memory.max").and_then(|t| t.parse::<u64>().ok()).map(|b| b >> 20);
    let free = free.min(limit.unwrap_or(u64::MAX));
    let within = limit.map_or_else(String::new, |l| format!(", container limit {l} MiB"));
    let found = format!("{free} MiB free of {total} MiB{within}");
    if free >= MEMORY_WANTED_MIB {
        return Check::ok("memory", "pictures", found);
    }
    Check::missing(
        "memory",
        "pictures",
        found,
        format!("close programs or add memory until {MEMORY_WANTED_MIB} MiB are free"),
    )
}

pub fn governor() -> Check {
    let use_for = "even step times";
    let name = "governor";
    let folders = std::fs::read_dir("/sys/devices/system/cpu").into_iter().flatten().flatten();
    let governors: BTreeSet<String> =
        folders.filter_map(|f| kernel_file(f.path().join("cpufreq/scaling_governor"))).collect();
    if governors.is_empty() {
        // Virtual machines and many laptops' hypervisors keep the frequency to themselves.
        return Check::unknown(name, use_for);
    }
    let found = governors.iter().map(String::as_str).collect::<Vec<_>>().join(", ");
    if found == "performance" {
        return Check::ok(name, use_for, found);
    }
    let cure = "`echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor`";
    Check::missing(name, use_for, found, cure)
}

pub fn clock_source() -> Check {
    let (name, use_for) = ("clock source", "cheap meters");
    let folder = "/sys/devices/system/clocksource/clocksource0";
    let Some(current) = kernel_file(format!("{folder}/current_clocksource")) else {
        return Check::unknown(name, use_for);
    };
    // These are read by a slow bus access in the kernel; all others are read in user space.
    if !["hpet", "acpi_pm", "jiffies", "pit"].contains(&current.as_str()) {
        return Check::ok(name, use_for, current);
    }
    let offered = kernel_file(format!("{folder}/available_clocksource")).unwrap_or_default();
    let cure = if offered.split_whitespace().any(|s| s == "tsc") {
        format!("`echo tsc | sudo tee {folder}/current_clocksource`")
    } else {
        "boot with the kernel parameter `tsc=reliable` and look into `dmesg | grep -i tsc`".to_owned()
    };
    Check::missing(name, use_for, current, cure)
}

pub fn clock_cost() -> Check {
    const READS: u128 = 10_000;
    let start = Instant::now();
    let mut last = start;
    for _ in 0..READS {
        last = std::hint::black_box(Instant::now());
    }
    let nanos = last.duration_since(start).as_nanos() / READS;
    let found = format!("{nanos} ns a reading");
    if nanos <= CLOCK_WANTED_NS {
        return Check::ok("clock cost", "cheap meters", found);
    }
    Check::missing(
        "clock cost",
        "cheap meters",
        found,
        "mend the clock source above, or use a host whose clock is read in user space",
    )
}
