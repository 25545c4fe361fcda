//! Tests that measure their whole process. They run one after the other.

#![cfg(target_os = "linux")]

mod large_catalogue;
mod visitor;

use std::sync::Mutex;

/// Held by the test that runs.
static ALONE: Mutex<()> = Mutex::new(());
