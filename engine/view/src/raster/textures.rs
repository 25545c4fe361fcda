//! Textures that are drawn on and read from.

use wgpu::{
    AddressMode, Device, Extent3d, FilterMode, MipmapFilterMode, Queue, Sampler, Texture, TextureFormat, TextureUsages,
    TextureView,
};

use crate::cloth_look::TileLevels;
use crate::image::Size;

/// A sampler with one way of filtering in all directions.
pub fn sampler(device: &Device, edge: AddressMode, filter: FilterMode) -> Sampler {
    let between = if filter == FilterMode::Linear { MipmapFilterMode::Linear } else { MipmapFilterMode::Nearest };
    device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: edge,
        address_mode_v: edge,
        mag_filter: filter,
        min_filter: filter,
        mipmap_filter: between,
        ..Default::default()
    })
}

/// A texture of one level.
pub fn plain(device: &Device, size: Size, format: TextureFormat, samples: u32, usage: TextureUsages) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: extent(size.width, size.height),
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// Writes all texels of a level, four bytes each.
pub fn write(queue: &Queue, texture: &Texture, level: u32, width: u32, height: u32, bytes: &[u8]) {
    queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: level,
            origin: wgpu::Origin3d::ZERO,
            aspect: wgpu::TextureAspect::All,
        },
        bytes,
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None },
        extent(width, height),
    );
}

/// A picture with all of its levels of detail.
pub fn levels(device: &Device, queue: &Queue, tile: &TileLevels) -> TextureView {
    let finest = &tile.levels()[0];
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("tile"),
        size: extent(finest.width, finest.height),
        mip_level_count: tile.levels().len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TextureFormat::Rgba8UnormSrgb,
        usage: TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (number, level) in (0..).zip(tile.levels()) {
        write(queue, &texture, number, level.width, level.height, bytemuck::cast_slice(&level.texels));
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn extent(width: u32, height: u32) -> Extent3d {
    Extent3d { width: width.max(1), height: height.max(1), depth_or_array_layers: 1 }
}

/// The intermediate target of a multisampled picture; made again when the size changes.
#[derive(Debug)]
pub struct IntermediateTarget {
    size: Size,
    pub depth: TextureView,
    /// Several samples a pixel, and the picture that they become.
    pub smooth: Option<(TextureView, TextureView)>,
}

impl IntermediateTarget {
    pub fn new(device: &Device, size: Size, format: TextureFormat, samples: u32) -> Self {
        let drawn = TextureUsages::RENDER_ATTACHMENT;
        let view = |t: Texture| t.create_view(&wgpu::TextureViewDescriptor::default());
        let smooth = (samples > 1).then(|| {
            let many = plain(device, size, format, samples, drawn);
            let one = plain(device, size, format, 1, drawn | TextureUsages::TEXTURE_BINDING);
            (view(many), view(one))
        });
        Self { size, depth: view(plain(device, size, super::pipelines::DEPTH, samples, drawn)), smooth }
    }

    /// True if it has this size.
    pub fn fits(&self, size: Size) -> bool {
        self.size == size
    }
}

/// The picture behind the subject.
#[derive(Debug)]
pub struct BackdropTexture {
    pub size: Size,
    texture: Texture,
    pub view: TextureView,
    texels: Vec<u8>,
}

impl BackdropTexture {
    /// A picture of this size, black.
    pub fn new(device: &Device, size: Size) -> Self {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let texture = plain(device, size, TextureFormat::Rgba8UnormSrgb, 1, usage);
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Self { size, texture, view, texels: Vec::new() }
    }

    /// Takes over red, green, blue, rows from the top `[3 x width x height]`.
    pub fn take(&mut self, queue: &Queue, rgb: &[u8]) {
        self.texels.clear();
        self.texels.extend(rgb.chunks_exact(3).flat_map(|p| [p[0], p[1], p[2], 255]));
        write(queue, &self.texture, 0, self.size.width, self.size.height, &self.texels);
    }
}
