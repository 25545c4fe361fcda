//! The kiosk: a fitting room that runs unattended, with a window or without, from visitor to visitor.
//!
//! It is ready within 5 s of its start. The service has a round each 20 ms, which takes under 100 µs of the first core. Besides the threads
//! of the loop there is one for the service, one for jobs of the visitor and one for metrics. The main thread waits for the window system.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
pub mod error;
mod http;

pub mod service;

#[cfg_attr(not(feature = "window"), allow(dead_code, reason = "pages are made for a window alone"))]
pub mod visitor;

mod headless;
#[cfg(feature = "window")]
pub mod window;

use std::time::Instant;

pub use error::KioskError;
pub use service::KioskOptions;
pub use service::config::EXAMPLE as EXAMPLE_CONFIG;
pub use service::report::KioskReport;

/// Runs a kiosk of a program that was started at `begun` until it is asked to end; `print_line` prints a line for the operator.
///
/// # Errors
/// A kiosk that already runs, a configuration, a session or a garment that cannot be used, no window where one is wanted, a
/// thread that ended while it ran.
pub fn run(
    options: &KioskOptions,
    begun: Instant,
    print_line: &(dyn Fn(&str) + Sync),
) -> Result<KioskReport, KioskError> {
    #[cfg(feature = "window")]
    let windowed = window::run;
    #[cfg(not(feature = "window"))]
    let windowed = service::without_window;
    service::run(options, begun, print_line, if options.headless { headless::run } else { windowed })
}
