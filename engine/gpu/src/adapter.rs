//! A graphics adapter of this machine, by its names.

/// One way to compute on the graphics hardware of this machine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adapter {
    /// The device's own name.
    pub name: String,
    /// The interface it is reached by: `vulkan`, `metal`, `dx12`.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// The driver's name and version, where it reports them.
    pub driver: String,
}
