//! A compute shader: its text, its bindings and its pipeline.

use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BufferBindingType, ComputePipeline, ComputePipelineDescriptor,
    PipelineLayoutDescriptor, ShaderModule, ShaderModuleDescriptor, ShaderSource,
};

use crate::buffer_builder::bound;

/// The functions that the CPU's lanes have: what every shader begins with.
pub(crate) const LANES: &str = include_str!("shaders/lanes.wgsl");

/// A shader's text and bindings.
#[derive(Debug, Clone, Copy)]
pub struct Shader {
    /// Name of its file.
    pub name: &'static str,
    /// Shared snippets, then its own text.
    pub(crate) texts: &'static [&'static str],
    /// Its storage buffers in the order of their bindings: whether each is only read.
    pub reads: &'static [bool],
}

impl Shader {
    /// The complete WGSL text.
    pub fn source(&self) -> String {
        self.texts.concat()
    }

    /// Its module, and the layout of its own storage buffers. At load.
    pub(crate) fn module(&self, device: &wgpu::Device) -> (ShaderModule, BindGroupLayout) {
        let source = ShaderSource::Wgsl(self.source().into());
        let module = device.create_shader_module(ShaderModuleDescriptor { label: Some(self.name), source });
        let storage = |(binding, read_only): (u32, &bool)| {
            bound(binding, BufferBindingType::Storage { read_only: *read_only }, false)
        };
        let entries: Vec<_> = (0..).zip(self.reads).map(storage).collect();
        let layout = BindGroupLayoutDescriptor { label: Some(self.name), entries: &entries };
        (module, device.create_bind_group_layout(&layout))
    }
}

/// The pipeline of an entry point. At load.
pub(crate) fn pipeline(
    device: &wgpu::Device,
    groups: &[Option<&BindGroupLayout>],
    module: &ShaderModule,
    entry: &str,
) -> ComputePipeline {
    let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
        label: Some(entry),
        bind_group_layouts: groups,
        immediate_size: 0,
    });
    device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some(entry),
        layout: Some(&layout),
        module,
        entry_point: Some(entry),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// Asserts that a shader is valid without any capability, and that the storage buffers of a group are bound as it says.
#[cfg(test)]
pub(crate) fn valid(shader: &Shader, group: u32) {
    use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};
    use wgpu::naga::{AddressSpace, StorageAccess, front::wgsl};

    let module = wgsl::parse_str(&shader.source())
        .unwrap_or_else(|e| panic!("{}: {}", shader.name, e.emit_to_string(&shader.source())));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).unwrap_or_else(|e| panic!("{}: {e:?}", shader.name));
    let mut reads = vec![None; shader.reads.len()];
    for (_, variable) in module.global_variables.iter() {
        let Some(binding) = variable.binding.filter(|b| b.group == group) else { continue };
        let AddressSpace::Storage { access } = variable.space else { panic!("{}: not storage", shader.name) };
        reads[binding.binding as usize] = Some(!access.contains(StorageAccess::STORE));
    }
    let declared: Vec<_> = shader.reads.iter().map(|r| Some(*r)).collect();
    assert_eq!(reads, declared, "{}", shader.name);
}
