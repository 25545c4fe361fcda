//! The weaves as textures, one each, shared by all cloth.

use wgpu::{Device, Extent3d, Queue, Sampler, TextureView};

use super::textures;
use super::weave_relief::{SIDE, WeaveRelief};
use toile_base::fabric::Weave;

/// The relief textures of all weaves.
#[derive(Debug)]
pub struct WeaveTextures {
    maps: [TextureView; 3],
    /// How they are read: repeated without end, with levels of detail.
    pub sampler: Sampler,
    /// Texture of cloth without a print: empty.
    pub blank: TextureView,
}

const ALL: [Weave; 3] = [Weave::Plain, Weave::Twill, Weave::Knit];

impl WeaveTextures {
    /// Makes the reliefs, or a flat texel each where threads are not drawn.
    pub fn new(device: &Device, queue: &Queue, drawn: bool) -> Self {
        let map = |weave: Weave| {
            let levels = if drawn { WeaveRelief(weave).levels() } else { vec![vec![[128, 128, 255, 255]]] };
            let side = if drawn { SIDE } else { 1 };
            upload(device, queue, side, &levels)
        };
        let sampler = textures::sampler(device, wgpu::AddressMode::Repeat, wgpu::FilterMode::Linear);
        let blank = upload(device, queue, 1, &[vec![[0; 4]]]);
        Self { maps: ALL.map(map), sampler, blank }
    }

    /// The relief of a weave.
    pub fn of(&self, weave: Weave) -> &TextureView {
        match weave {
            Weave::Plain => &self.maps[0],
            Weave::Twill => &self.maps[1],
            Weave::Knit => &self.maps[2],
        }
    }
}

fn upload(device: &Device, queue: &Queue, side: u32, levels: &[Vec<[u8; 4]>]) -> TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("weave"),
        size: Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (level, texels) in (0..).zip(levels) {
        textures::write(queue, &texture, level, side >> level, side >> level, bytemuck::cast_slice(texels));
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
