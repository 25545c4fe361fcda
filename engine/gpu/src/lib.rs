//! The GPUs of this machine, the cloth on them, and the choice between them and the processor.
//!
//! The physics thread of garments that the processor steps never submits to a GPU or waits for one.

/// Whether GPU support is built in (feature `wgpu`).
pub const BUILT_IN: bool = cfg!(feature = "wgpu");

pub use adapter::Adapter;

/// All adapters, real devices before software ones; none where GPU support is not built in.
pub fn adapters() -> Vec<Adapter> {
    #[cfg(feature = "wgpu")]
    return adapters::adapters();
    #[cfg(not(feature = "wgpu"))]
    Vec::new()
}

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
mod adapter;
pub mod cloth_batch;
mod device_work;
#[cfg(feature = "wgpu")]
pub mod wait;

#[cfg(feature = "wgpu")]
mod adapters;

#[cfg(feature = "wgpu")]
pub mod device;

#[cfg(feature = "wgpu")]
mod buffer_builder;
#[cfg(feature = "wgpu")]
pub mod vertex_source;

#[cfg(feature = "wgpu")]
mod shader;

#[cfg(feature = "wgpu")]
pub mod cloth;

#[cfg(feature = "wgpu")]
pub mod skin;

pub mod graphics;

pub mod backend;

#[cfg(feature = "wgpu")]
pub use adapters::describe;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adapters_are_listed_only_where_built_in_and_software_comes_last() {
        let found = adapters();
        assert!(BUILT_IN || found.is_empty());
        let first_software = found.iter().position(|a| a.kind == "software").unwrap_or(found.len());
        assert!(found[first_software..].iter().all(|a| a.kind == "software"));
    }
}
