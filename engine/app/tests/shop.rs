//! Tests of a whole shop in real time: nothing else may run beside them.

/// The program that the tests run.
const PROGRAM: &str = env!("CARGO_BIN_EXE_toile");

#[path = "../../../tests/src/program.rs"]
mod common;
#[cfg(all(feature = "kiosk", target_os = "linux"))]
mod kinect;
#[cfg(unix)]
mod kiosk;
#[cfg(all(feature = "kiosk", target_os = "linux"))]
mod shop_window;
#[cfg(all(feature = "kiosk", target_os = "linux"))]
mod window;
#[cfg(all(feature = "kiosk", target_os = "linux"))]
mod xvfb;
