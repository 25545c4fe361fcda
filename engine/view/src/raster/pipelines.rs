//! The render pipelines, made once: shaders, bind group layouts and fixed state.

use toile_gpu::vertex_source::STRIDE;
use wgpu::{
    BindGroupLayout, BindGroupLayoutEntry, BindingType, BlendState, BufferBindingType, ColorTargetState, ColorWrites,
    CompareFunction, DepthBiasState, DepthStencilState, Device, Face, MultisampleState, PrimitiveState, RenderPipeline,
    SamplerBindingType, ShaderModule, ShaderStages, TextureFormat, TextureSampleType, TextureViewDimension,
    VertexAttribute, VertexBufferLayout, VertexFormat, VertexStepMode,
};

use super::render_quality::RenderQuality;
use super::shaders::{self, ShaderOptions};
use super::split_vertices::POINT_BYTES;

/// Format of depth in a picture.
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// Format of the beams' depth maps: over three metres a step is .05 mm.
pub const BEAM_DEPTH: TextureFormat = TextureFormat::Depth16Unorm;

/// How much farther off slopes are drawn into a depth map (texels).
const SLOPE_BIAS: f32 = 1.5;

/// Bind group layouts.
#[derive(Debug)]
pub struct Layouts {
    /// Group 0: the view's uniform block.
    pub frame: BindGroupLayout,
    /// Group 1: the depth maps.
    pub depths: BindGroupLayout,
    /// Group 2 of surfaces: their uniform block, their weave, their print.
    pub surface: BindGroupLayout,
    /// Group 3 of surfaces: positions and normals.
    pub places: BindGroupLayout,
    /// Group 2 of the backdrop: the picture behind.
    pub behind: BindGroupLayout,
    /// Group 0 of the copy onto the target: the finished picture.
    pub finished: BindGroupLayout,
}

/// All render pipelines.
#[derive(Debug)]
pub struct Pipelines {
    pub depth: RenderPipeline,
    pub surface: RenderPipeline,
    pub backdrop: RenderPipeline,
    pub lines: RenderPipeline,
    /// Lines behind surfaces.
    pub hidden: RenderPipeline,
    pub blit: RenderPipeline,
}

/// Strides of the vertex buffers: marks; rest (place and normal) and line; position and normal are the kernels'
/// ([`STRIDE`]), so that a garment is drawn from where it is stepped.
const VEC2: u64 = 8;
const VEC3: u64 = 12;

impl Layouts {
    pub fn new(device: &Device) -> Self {
        let make = |label, entries: &[BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        Self {
            frame: make("frame", &[block(0, ShaderStages::VERTEX_FRAGMENT)]),
            depths: make(
                "depths",
                &[texture(0, TextureSampleType::Depth), sampler(1, false)].map(|e| BindGroupLayoutEntry {
                    // Ambient occlusion may be found a vertex.
                    visibility: ShaderStages::VERTEX_FRAGMENT,
                    ..e
                }),
            ),
            surface: make(
                "surface",
                &[block(0, ShaderStages::FRAGMENT), texture(1, FILTERED), sampler(2, true), texture(3, FILTERED)],
            ),
            places: make("places", &[storage(0), storage(1)]),
            behind: make("behind", &[texture(0, FILTERED), sampler(1, true)]),
            finished: make("finished", &[texture(0, FILTERED)]),
        }
    }
}

const FILTERED: TextureSampleType = TextureSampleType::Float { filterable: true };

fn entry(binding: u32, visibility: ShaderStages, ty: BindingType) -> BindGroupLayoutEntry {
    BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

fn block(binding: u32, visibility: ShaderStages) -> BindGroupLayoutEntry {
    let ty = BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
    entry(binding, visibility, ty)
}

/// A list that the vertex shader reads.
fn storage(binding: u32) -> BindGroupLayoutEntry {
    let ty = BufferBindingType::Storage { read_only: true };
    let ty = BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    entry(binding, ShaderStages::VERTEX, ty)
}

fn texture(binding: u32, sample_type: TextureSampleType) -> BindGroupLayoutEntry {
    let ty = BindingType::Texture { sample_type, view_dimension: TextureViewDimension::D2, multisampled: false };
    entry(binding, ShaderStages::FRAGMENT, ty)
}

fn sampler(binding: u32, filtering: bool) -> BindGroupLayoutEntry {
    let kind = if filtering { SamplerBindingType::Filtering } else { SamplerBindingType::NonFiltering };
    entry(binding, ShaderStages::FRAGMENT, BindingType::Sampler(kind))
}

/// The parameters of one pipeline.
struct PipelineDescription<'a> {
    label: &'static str,
    module: &'a ShaderModule,
    vertex: &'static str,
    fragment: Option<&'static str>,
    groups: &'a [Option<&'a BindGroupLayout>],
    buffers: &'a [Option<VertexBufferLayout<'a>>],
    depth: Option<DepthStencilState>,
    format: TextureFormat,
    blend: Option<BlendState>,
    samples: u32,
    strip: bool,
}

impl PipelineDescription<'_> {
    fn build(self, device: &Device) -> RenderPipeline {
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.label),
            bind_group_layouts: self.groups,
            immediate_size: 0,
        });
        let target = [Some(ColorTargetState { format: self.format, blend: self.blend, write_mask: ColorWrites::ALL })];
        let topology =
            if self.strip { wgpu::PrimitiveTopology::TriangleStrip } else { wgpu::PrimitiveTopology::TriangleList };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: self.buffers,
            },
            // Cloth is seen from both sides, so nothing is culled.
            primitive: PrimitiveState { topology, cull_mode: None::<Face>, ..Default::default() },
            depth_stencil: self.depth,
            multisample: MultisampleState { count: self.samples, ..Default::default() },
            fragment: self.fragment.map(|name| wgpu::FragmentState {
                module: self.module,
                entry_point: Some(name),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &target,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

impl Pipelines {
    /// Compiles everything for targets of one format.
    pub fn new(device: &Device, layouts: &Layouts, format: TextureFormat, quality: &RenderQuality) -> Self {
        let module = |label: &str, text: String| {
            let source = wgpu::ShaderSource::Wgsl(text.into());
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
        };
        let RenderQuality { weave, by_vertex, .. } = *quality;
        let made = ShaderOptions { weave, by_vertex, encode: !format.is_srgb() };
        let depth = module("depth", shaders::depth(made));
        let surface = module("surface", shaders::surface(made));
        let backdrop = module("backdrop", shaders::backdrop(made));
        let lines = module("lines", shaders::lines(made));
        let blit = module("blit", shaders::blit());
        let (frame, depths) = (Some(&layouts.frame), Some(&layouts.depths));
        let lit = |label, module, vertex, fragment| PipelineDescription {
            label,
            module,
            vertex,
            fragment: Some(fragment),
            groups: &[],
            buffers: &[],
            depth: Some(depth_state(DEPTH, true, CompareFunction::Less, 0.0)),
            format,
            blend: None,
            samples: quality.samples,
            strip: false,
        };
        let whole = |shader_location, offset| VertexAttribute { format: VertexFormat::Uint32, offset, shader_location };
        let (source, near) = (whole(0, 0), whole(6, 4 + 2 * VEC2));
        let line_buffers = [Some(VertexBufferLayout {
            array_stride: 3 * VEC3,
            step_mode: VertexStepMode::Instance,
            attributes: &[attribute(0, 0, true), attribute(1, VEC3, true), attribute(2, 2 * VEC3, true)],
        })];
        let line_groups = [frame, depths];
        let line = |label, fragment, compare, blend| PipelineDescription {
            groups: &line_groups,
            buffers: &line_buffers,
            depth: Some(depth_state(DEPTH, false, compare, 0.0)),
            blend,
            strip: true,
            ..lit(label, &lines, "vertex_main", fragment)
        };
        Self {
            depth: PipelineDescription {
                fragment: None,
                groups: &[frame],
                buffers: &[per_vertex(STRIDE, &[attribute(0, 0, true)])],
                depth: Some(depth_state(BEAM_DEPTH, true, CompareFunction::Less, SLOPE_BIAS)),
                samples: 1,
                ..lit("depth", &depth, "vertex_main", "")
            }
            .build(device),
            surface: PipelineDescription {
                groups: &[frame, depths, Some(&layouts.surface), Some(&layouts.places)],
                buffers: &[
                    per_vertex(
                        POINT_BYTES as u64,
                        &[source, attribute(1, 4, false), attribute(2, 4 + VEC2, false), near],
                    ),
                    per_vertex(VEC2, &[attribute(3, 0, false)]),
                    per_vertex(2 * VEC3, &[attribute(4, 0, true), attribute(5, VEC3, true)]),
                ],
                ..lit("surface", &surface, "vertex_main", "fragment_main")
            }
            .build(device),
            backdrop: PipelineDescription {
                groups: &[frame, depths, Some(&layouts.behind)],
                depth: Some(depth_state(DEPTH, false, CompareFunction::LessEqual, 0.0)),
                ..lit("backdrop", &backdrop, "vertex_main", "fragment_main")
            }
            .build(device),
            lines: line("lines", "shown", CompareFunction::LessEqual, None).build(device),
            hidden: line("hidden lines", "hidden", CompareFunction::Greater, Some(BlendState::ALPHA_BLENDING))
                .build(device),
            blit: PipelineDescription {
                groups: &[Some(&layouts.finished)],
                depth: None,
                samples: 1,
                ..lit("blit", &blit, "vertex_main", "fragment_main")
            }
            .build(device),
        }
    }
}

const fn attribute(shader_location: u32, offset: u64, three: bool) -> VertexAttribute {
    let format = if three { VertexFormat::Float32x3 } else { VertexFormat::Float32x2 };
    VertexAttribute { format, offset, shader_location }
}

fn per_vertex(array_stride: u64, attributes: &[VertexAttribute]) -> Option<VertexBufferLayout<'_>> {
    Some(VertexBufferLayout { array_stride, step_mode: VertexStepMode::Vertex, attributes })
}

fn depth_state(format: TextureFormat, write: bool, compare: CompareFunction, slope_scale: f32) -> DepthStencilState {
    DepthStencilState {
        format,
        depth_write_enabled: Some(write),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: DepthBiasState { constant: 0, slope_scale, clamp: 0.0 },
    }
}
