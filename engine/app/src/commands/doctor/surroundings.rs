//! The surroundings of the process: GPU, display, output folder, other programs.

use std::env;
use std::path::{Path, PathBuf};

use toile_cli::output::OutputFolder;
use toile_gpu::Adapter;

use super::check::Check;

pub fn gpu(adapters: &[Adapter]) -> Check {
    let (name, use_for) = ("gpu", "cloth and pictures on the GPU; the CPU does both without");
    if !toile_gpu::BUILT_IN {
        return Check::missing(name, use_for, "support not built in", "`cargo build --release --features gpu`");
    }
    if adapters.is_empty() {
        let cure = "install the graphics driver; on Debian `sudo apt install libvulkan1 mesa-vulkan-drivers`";
        return Check::missing(name, use_for, "no adapter", cure);
    }
    let each = adapters.iter().map(|a| format!("{} ({}, {}, {})", a.name, a.kind, a.backend, a.driver));
    Check::ok(name, use_for, each.collect::<Vec<_>>().join("; "))
}

pub fn display() -> Check {
    let (name, use_for) = ("display", "a kiosk; try-on writes files and needs none");
    if cfg!(any(windows, target_os = "macos")) {
        return Check::ok(name, use_for, "the desktop");
    }
    let set = |key| env::var(key).ok().filter(|v| !v.is_empty()).map(|v| format!("{key}={v}"));
    match set("WAYLAND_DISPLAY").or_else(|| set("DISPLAY")) {
        Some(found) => Check::ok(name, use_for, found),
        None => {
            let cure = "start Toile from a desktop session, or set DISPLAY (`export DISPLAY=:0`) for the one that runs";
            Check::missing(name, use_for, "none: neither WAYLAND_DISPLAY nor DISPLAY is set", cure)
        }
    }
}

/// Tries to write in the folder, and leaves no trace of it.
pub fn output_folder(folder: &Path) -> Check {
    let (name, use_for) = ("output folder", "pictures and reports");
    match OutputFolder::prepare(folder) {
        Ok(_) => Check::ok(name, use_for, format!("`{}` can be written", folder.display())),
        Err(error) => Check::missing(name, use_for, error.to_string(), "name a folder of your own: `--out DIR`"),
    }
}

pub fn ffmpeg() -> Check {
    let (name, use_for) = ("ffmpeg", "turning the animated PNG into a film; Toile itself needs none");
    match program("ffmpeg") {
        Some(path) => Check::ok(name, use_for, path.display().to_string()),
        None => Check::missing(name, use_for, "not on the PATH", "on Debian `sudo apt install ffmpeg`"),
    }
}

fn program(name: &str) -> Option<PathBuf> {
    let file = format!("{name}{}", env::consts::EXE_SUFFIX);
    env::split_paths(&env::var_os("PATH")?).map(|folder| folder.join(&file)).find(|path| path.is_file())
}
