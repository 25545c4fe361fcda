//! The GPUs of this machine; the cloth that runs on them comes here too.
//!
//! Reads: what the graphics drivers tell. Writes: a list of adapters.
//! Budget: at load only, up to some hundred milliseconds, which is what a driver takes to start.
//! Thread: the loading thread; the physics thread never submits to or waits for a GPU.

/// Whether GPU support is built in (feature `wgpu`).
pub const BUILT_IN: bool = cfg!(feature = "wgpu");

/// One way to compute on the graphics hardware of this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adapter {
    /// The device's own name.
    pub name: String,
    /// The interface it is reached by: `vulkan`, `metal`, `dx12`.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// The driver's name and version, as far as it tells them.
    pub driver: String,
}

/// All adapters, real devices before software ones; none where GPU support is not built in.
pub fn adapters() -> Vec<Adapter> {
    #[cfg(feature = "wgpu")]
    return native::adapters();
    #[cfg(not(feature = "wgpu"))]
    Vec::new()
}

#[cfg(feature = "wgpu")]
pub mod cloth;
#[cfg(feature = "wgpu")]
pub mod device;
#[cfg(feature = "wgpu")]
mod maker;
#[cfg(feature = "wgpu")]
mod native;
#[cfg(feature = "wgpu")]
mod shader;
#[cfg(feature = "wgpu")]
pub mod skin;
#[cfg(feature = "wgpu")]
pub mod wait;

#[cfg(feature = "wgpu")]
pub use native::describe;

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
