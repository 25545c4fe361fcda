//! Memory of the process, by the system's count.

use serde::Serialize;

use toile_base::numeric::statistics::quantile;
use toile_fitting::heap::HeapProbe;

/// What the process held at one moment; none where the system does not say.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct MemorySample {
    /// Time since the begin, on the loop's clock (h).
    pub hours: f64,
    /// Resident memory (KiB).
    pub rss_kib: Option<u64>,
    /// Memory in use, by the program's allocator (KiB).
    pub heap_kib: Option<u64>,
    /// Number of open files.
    pub files: Option<u64>,
    /// Number of threads.
    pub threads: Option<u64>,
}

impl MemorySample {
    /// What the process holds now, `hours` after the run began.
    pub fn take(hours: f64, heap: &HeapProbe) -> Self {
        let heap_kib = heap.read().map(|h| h.live_bytes.max(0) as u64 / 1024);
        let [rss_kib, threads] = status();
        Self { hours, rss_kib, heap_kib, files: files(), threads }
    }
}

/// Resident memory (KiB) and threads.
fn status() -> [Option<u64>; 2] {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    ["VmRSS:", "Threads:"].map(|key| {
        let line = text.lines().find_map(|line| line.strip_prefix(key))?;
        line.split_whitespace().next()?.parse().ok()
    })
}

/// Open files, without the one that counts them.
fn files() -> Option<u64> {
    let count = std::fs::read_dir("/proc/self/fd").ok()?.count() as u64;
    Some(count.saturating_sub(1))
}

/// Growth of a figure (per hour) over samples: the median of all slopes between two of them (Theil 1950, Sen 1968), which single
/// peaks do not move.
pub fn growth(samples: &[(f64, u64)]) -> Option<f64> {
    let mut slopes = Vec::with_capacity(samples.len() * samples.len() / 2);
    for (i, (from, a)) in samples.iter().enumerate() {
        let later = samples[i + 1..].iter().filter(|(to, _)| to > from);
        slopes.extend(later.map(|(to, b)| (*b as f64 - *a as f64) / (to - from)));
    }
    quantile(&mut slopes, 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leak_is_seen_through_peaks_and_peaks_are_no_leak() {
        let peak = |i: u64| if i.is_multiple_of(7) { 3_000 } else { 0 };
        let flat: Vec<_> = (0..100).map(|i| (i as f64 / 60.0, 50_000 + peak(i))).collect();
        assert_eq!(growth(&flat), Some(0.0));
        let leak: Vec<_> = (0..100).map(|i| (i as f64 / 60.0, 50_000 + 2 * i + peak(i))).collect();
        assert!((growth(&leak).unwrap() - 120.0).abs() < 5.0, "two KiB a minute");
        assert_eq!(growth(&flat[..1]), None);
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn the_process_holds_something() {
        let sample = MemorySample::take(0.0, &HeapProbe::none());
        assert!(sample.rss_kib.unwrap() > 500 && sample.threads.unwrap() >= 1 && sample.files.unwrap() >= 3);
    }
}
