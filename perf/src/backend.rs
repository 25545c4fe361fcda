//! Backend: the device that stepped the garments of a run, as reports have it.

use serde::Serialize;
use toile_gpu::backend::Backends;

/// What stepped, and why not what was asked for.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
pub struct SteppedBy {
    /// `cpu`, `gpu` or `auto`.
    pub asked: &'static str,
    /// `cpu`, `gpu`, or `both` where some garments went over to the processor or were decided otherwise.
    pub backend: &'static str,
    /// The graphics adapter that was opened.
    pub adapter: Option<Adapter>,
    /// Why the processor stepped, some of the garments at least, although a device was asked for.
    pub fallen: Option<String>,
}

/// A graphics adapter.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Adapter {
    /// The device's own name.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// The driver's name and version.
    pub driver: String,
}

impl Adapter {
    /// What a report says of an adapter.
    pub fn of(adapter: &toile_gpu::Adapter) -> Self {
        Self { name: adapter.name.clone(), kind: adapter.kind, driver: adapter.driver.clone() }
    }
}

impl SteppedBy {
    /// The means of a run, after it.
    pub fn of(backends: &Backends) -> Self {
        Self {
            asked: backends.asked().name(),
            backend: backends.used(),
            adapter: backends.adapter().map(Adapter::of),
            fallen: backends.fallback().map(str::to_owned),
        }
    }
}
