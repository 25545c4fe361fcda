//! Tests that measure their whole process. They run one after the other.

#![cfg(target_os = "linux")]

#[path = "../../../tests/src/coarse.rs"]
mod coarse;
mod coarse_shop;
mod large_catalogue;
mod visitor;

use std::sync::Mutex;

/// Held by the test that runs.
static ALONE: Mutex<()> = Mutex::new(());
