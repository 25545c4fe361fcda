//! Backend: what the garments of a run were stepped by, as reports have it.

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

impl SteppedBy {
    /// The means of a run, after it.
    pub fn of(backends: &Backends) -> Self {
        let adapter = |a: &toile_gpu::Adapter| Adapter { name: a.name.clone(), kind: a.kind, driver: a.driver.clone() };
        Self {
            asked: backends.asked().name(),
            backend: backends.used(),
            adapter: backends.adapter().map(adapter),
            fallen: backends.fallback().map(str::to_owned),
        }
    }
}
