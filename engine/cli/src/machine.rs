//! The machine that a figure was measured on: every JSON object carries it.

use std::process::Command;

use serde::Serialize;

/// The machine that figures were measured on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Machine {
    /// The processor's own name, or `unknown`.
    pub cpu: String,
    /// Cores that this process may use (affinity and quota respected).
    pub cores: usize,
    /// The widest vector instructions found.
    pub lanes: &'static str,
    /// The first GPU adapter, where GPU support is built in and there is one.
    pub adapter: Option<String>,
}

impl Machine {
    /// Looks at this machine.
    pub fn here() -> Self {
        Self {
            cpu: cpu_name(),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            lanes: lanes(),
            adapter: toile_gpu::adapters().into_iter().next().map(|a| a.name),
        }
    }
}

/// The widest vector instructions of this processor.
pub fn lanes() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if std::is_x86_feature_detected!("avx512f") {
            return "AVX-512";
        }
        if std::is_x86_feature_detected!("avx2") {
            return "AVX2";
        }
        // Part of every x86-64 processor.
        "SSE2"
    }
    #[cfg(target_arch = "aarch64")]
    {
        if std::arch::is_aarch64_feature_detected!("neon") { "NEON" } else { "none" }
    }
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    {
        "none"
    }
}

/// The processor's own name, or `unknown`.
pub fn cpu_name() -> String {
    let linux = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| cpu_model(&text));
    linux.or_else(mac_cpu_name).unwrap_or_else(|| "unknown".to_owned())
}

/// The model in the text of `/proc/cpuinfo`; arm kernels call it by other keys, or not at all.
fn cpu_model(cpuinfo: &str) -> Option<String> {
    let value = |key: &str| {
        let fields = cpuinfo.lines().filter_map(|line| line.split_once(':'));
        fields.filter(|(k, _)| k.trim() == key).map(|(_, v)| v.trim()).find(|v| !v.is_empty())
    };
    let named = ["model name", "Model", "Hardware"].into_iter().find_map(value).map(str::to_owned);
    named.or_else(|| {
        let (maker, part) = (value("CPU implementer")?, value("CPU part")?);
        Some(format!("Arm implementer {maker} part {part}"))
    })
}

fn mac_cpu_name() -> Option<String> {
    if !cfg!(target_os = "macos") {
        return None;
    }
    let found = Command::new("sysctl").args(["-n", "machdep.cpu.brand_string"]).output().ok()?;
    let name = String::from_utf8(found.stdout).ok()?.trim().to_owned();
    (!name.is_empty()).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cpu_model_is_read_from_either_kind_of_kernel() {
        let x86 = "processor\t: 0\nmodel\t\t: 106\nmodel name\t: Some CPU @ 2.0GHz\n";
        assert_eq!(cpu_model(x86).as_deref(), Some("Some CPU @ 2.0GHz"));
        let arm = "processor\t: 0\nCPU implementer\t: 0x41\nCPU part\t: 0xd0c\n";
        assert_eq!(cpu_model(arm).as_deref(), Some("Arm implementer 0x41 part 0xd0c"));
        assert_eq!(cpu_model("nothing here"), None);
    }

    #[test]
    fn this_machine_has_a_core() {
        assert!(Machine::here().cores >= 1);
    }
}
