//! Gives the shared library its name: the one that programs look for carries the number of its ABI.

use std::env;

/// As `TOILE_ABI_VERSION` of `src/version.rs`; a test holds both together.
const ABI_VERSION: u32 = 1;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let system = env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    match system.as_str() {
        "linux" | "freebsd" | "netbsd" | "openbsd" | "android" => {
            println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libtoile.so.{ABI_VERSION}");
        }
        "macos" => {
            println!("cargo::rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libtoile.{ABI_VERSION}.dylib");
        }
        _ => {}
    }
}
