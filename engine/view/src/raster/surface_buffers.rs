//! The buffers of each surface on the device: made once, overwritten from picture to picture.

use glam::{Vec2, Vec3};
use toile_assets::fabric::Weave;
use toile_assets::mesh::vertex_normals;
use toile_gpu::vertex_source::{STRIDE, VertexSource};
use wgpu::{BindGroup, Buffer, BufferSlice, BufferUsages, Device, Queue, TextureView};

use super::model::{ModelError, RenderMaterial, RenderSurface, check_triangles};
use super::pipelines::Layouts;
use super::weave_relief::repeat;
use super::weave_textures::WeaveTextures;
use crate::scene::Bounds;

/// Sent in place of a fit that is NaN.
const NO_FIT: f32 = -9.0;

/// One surface on the device.
#[derive(Debug)]
pub struct SurfaceBuffers {
    positions: Buffer,
    normals: Buffer,
    /// Buffers on the device that are drawn instead, until the next update.
    source: Option<VertexSource>,
    /// Fit and recess of each vertex.
    pub marks: Buffer,
    /// Place and normal at rest.
    pub rest: Buffer,
    pub indices: Buffer,
    /// Indices that are drawn.
    pub count: u32,
    pub bind: BindGroup,
    /// The box around it as it is drawn.
    pub bounds: Bounds,
    pub visible: bool,
    block: Buffer,
    vertices: usize,
    room: usize,
    colour: Vec3,
    material: RenderMaterial,
    fit: Vec<f32>,
    recess: Vec<f32>,
    fitted: bool,
}

/// Numbers on their way to the device; kept so that a picture allocates nothing once they have grown.
#[derive(Debug, Default)]
pub struct UploadScratch(Vec<f32>);

impl UploadScratch {
    /// Sends vectors; says where the first is that is not finite, and sends nothing then.
    fn send(&mut self, queue: &Queue, buffer: &Buffer, vectors: &[Vec3]) -> Result<Bounds, usize> {
        self.0.clear();
        let mut bounds = Bounds::EMPTY;
        for (at, v) in vectors.iter().enumerate() {
            if !v.is_finite() {
                return Err(at);
            }
            bounds = bounds.grown(*v);
            self.0.extend(padded(*v));
        }
        queue.write_buffer(buffer, 0, bytemuck::cast_slice(&self.0));
        Ok(bounds)
    }

    fn write(&mut self, queue: &Queue, buffer: &Buffer, numbers: impl Iterator<Item = f32>) {
        self.0.clear();
        self.0.extend(numbers);
        queue.write_buffer(buffer, 0, bytemuck::cast_slice(&self.0));
    }
}

/// A vector padded to the compute kernels' stride.
fn padded(v: Vec3) -> [f32; 4] {
    [v.x, v.y, v.z, 0.0]
}

/// Creates the buffers of surfaces.
pub struct SurfaceUploader<'a> {
    pub device: &'a Device,
    pub queue: &'a Queue,
    pub layouts: &'a Layouts,
    pub threads: &'a WeaveTextures,
}

impl SurfaceUploader<'_> {
    /// Puts a surface onto the device as it is at rest.
    ///
    /// # Errors
    /// As [`RenderSurface::check`].
    pub fn make(
        &self,
        scratch: &mut UploadScratch,
        surface: usize,
        shape: &RenderSurface,
    ) -> Result<SurfaceBuffers, ModelError> {
        shape.check(surface)?;
        let vertices = shape.rest.len();
        let buffer = |label, bytes: usize, usage| {
            let size = bytes.max(4) as u64;
            let usage = usage | BufferUsages::COPY_DST;
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let block = buffer("surface", 32, BufferUsages::UNIFORM);
        let weave = if let RenderMaterial::Cloth(cloth) = shape.material { cloth.weave } else { Weave::Plain };
        let mut drawn = SurfaceBuffers {
            positions: buffer("positions", vertices * STRIDE as usize, BufferUsages::VERTEX),
            normals: buffer("normals", vertices * STRIDE as usize, BufferUsages::VERTEX),
            source: None,
            marks: buffer("marks", vertices * 8, BufferUsages::VERTEX),
            rest: buffer("rest", vertices * 24, BufferUsages::VERTEX),
            indices: buffer("indices", shape.triangles.len() * 12, BufferUsages::INDEX),
            count: 0,
            bind: self.bind(&block, self.threads.of(weave)),
            bounds: Bounds::EMPTY,
            visible: true,
            block,
            vertices,
            room: shape.triangles.len(),
            colour: shape.colour,
            material: shape.material,
            fit: vec![NO_FIT; vertices],
            recess: vec![0.0; vertices],
            fitted: false,
        };
        let mut normals = vec![Vec3::ZERO; vertices];
        vertex_normals(&shape.rest, &shape.triangles, &mut normals);
        drawn.send_rest(self.queue, scratch, shape, &normals);
        drawn.set_triangles(self.queue, surface, &shape.triangles)?;
        drawn.update(self.queue, scratch, surface, &shape.rest, &normals)?;
        drawn.send_marks(self.queue, scratch);
        drawn.send_block(self.queue);
        Ok(drawn)
    }

    fn bind(&self, block: &Buffer, weave: &TextureView) -> BindGroup {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surface"),
            layout: &self.layouts.surface,
            entries: &[
                entry(0, block.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(weave)),
                entry(2, wgpu::BindingResource::Sampler(&self.threads.sampler)),
            ],
        })
    }
}

impl SurfaceBuffers {
    /// Takes over positions (m) and unit normals `[vertices]`; without normals it is shaded flat.
    ///
    /// # Errors
    /// [`ModelError::Length`] or [`ModelError::NotFinite`]; the last places stay then.
    pub fn update(
        &mut self,
        queue: &Queue,
        scratch: &mut UploadScratch,
        surface: usize,
        positions: &[Vec3],
        normals: &[Vec3],
    ) -> Result<(), ModelError> {
        self.check(surface, "positions", positions.len())?;
        if !normals.is_empty() {
            self.check(surface, "normals", normals.len())?;
        }
        let not_finite = |vertex| ModelError::NotFinite { surface, vertex };
        self.bounds = scratch.send(queue, &self.positions, positions).map_err(not_finite)?;
        let clean = |n: &Vec3| padded(if n.is_finite() { *n } else { Vec3::ZERO });
        let zeros = std::iter::repeat_n([0.0; 4], if normals.is_empty() { self.vertices } else { 0 });
        scratch.write(queue, &self.normals, normals.iter().map(clean).chain(zeros).flatten());
        self.source = None;
        Ok(())
    }

    /// Draws it from where it lies on the device until the next update; `within` is the box that it is in (m).
    ///
    /// # Errors
    /// [`ModelError::Length`]; the last places stay then.
    pub fn follow(&mut self, surface: usize, source: &VertexSource, within: Bounds) -> Result<(), ModelError> {
        self.check(surface, "vertices on the device", source.vertices())?;
        self.source = Some(source.clone());
        self.bounds = within;
        Ok(())
    }

    /// The positions and the normals that are drawn.
    pub fn places(&self) -> [BufferSlice<'_>; 2] {
        match &self.source {
            Some(source) => source.parts(),
            None => [self.positions.slice(..), self.normals.slice(..)],
        }
    }

    /// Draws these triangles of it from now on, at most as many as it was made with.
    ///
    /// # Errors
    /// [`ModelError::Triangle`] or [`ModelError::Length`].
    pub fn set_triangles(&mut self, queue: &Queue, surface: usize, triangles: &[[u32; 3]]) -> Result<(), ModelError> {
        check_triangles(surface, triangles, self.vertices)?;
        if triangles.len() > self.room {
            return Err(ModelError::Length { surface, what: "triangles", got: triangles.len(), want: self.room });
        }
        queue.write_buffer(&self.indices, 0, bytemuck::cast_slice(triangles));
        self.count = 3 * triangles.len() as u32;
        Ok(())
    }

    /// Changes the base colour (linear RGB).
    pub fn set_colour(&mut self, queue: &Queue, colour: Vec3) {
        self.colour = colour;
        self.send_block(queue);
    }

    /// Shows the fit map of these figures `[vertices]`, or the surface's own colour again.
    ///
    /// # Errors
    /// [`ModelError::Length`].
    pub fn set_fit(
        &mut self,
        queue: &Queue,
        scratch: &mut UploadScratch,
        surface: usize,
        fit: Option<&[f32]>,
    ) -> Result<(), ModelError> {
        if let Some(fit) = fit {
            self.check(surface, "figures of fit", fit.len())?;
            let sent = |f: &f32| if f.is_nan() { NO_FIT } else { f.clamp(-1.0, 1.0) };
            self.fit.iter_mut().zip(fit).for_each(|(to, f)| *to = sent(f));
            self.send_marks(queue, scratch);
        }
        self.fitted = fit.is_some();
        self.send_block(queue);
        Ok(())
    }

    /// Counts each vertex as so much farther off (m) `[vertices]` when it is decided what hides what.
    ///
    /// # Errors
    /// [`ModelError::Length`].
    pub fn set_recess(
        &mut self,
        queue: &Queue,
        scratch: &mut UploadScratch,
        surface: usize,
        recess: &[f32],
    ) -> Result<(), ModelError> {
        self.check(surface, "depths", recess.len())?;
        let sent = |r: &f32| if r.is_finite() { *r } else { 0.0 };
        self.recess.iter_mut().zip(recess).for_each(|(to, r)| *to = sent(r));
        self.send_marks(queue, scratch);
        Ok(())
    }

    fn check(&self, surface: usize, what: &'static str, got: usize) -> Result<(), ModelError> {
        let want = self.vertices;
        if got == want { Ok(()) } else { Err(ModelError::Length { surface, what, got, want }) }
    }

    fn send_rest(&self, queue: &Queue, scratch: &mut UploadScratch, shape: &RenderSurface, normals: &[Vec3]) {
        let cloth = |uv: &Vec2| [uv.x, uv.y, 0.0, 0.0, 0.0, 1.0];
        match &shape.uv {
            Some(uv) => scratch.write(queue, &self.rest, uv.iter().flat_map(cloth)),
            None => {
                let both = shape.rest.iter().zip(normals).flat_map(|(p, n)| [p.to_array(), n.to_array()]);
                scratch.write(queue, &self.rest, both.flatten());
            }
        }
    }

    fn send_marks(&self, queue: &Queue, scratch: &mut UploadScratch) {
        scratch.write(queue, &self.marks, self.fit.iter().zip(&self.recess).flat_map(|(f, r)| [*f, *r]));
    }

    fn send_block(&self, queue: &Queue) {
        let (kind, sheen, repeats) = match self.material {
            RenderMaterial::Skin => (0.0, 0.0, Vec2::ZERO),
            RenderMaterial::Cloth(cloth) => {
                let repeat = (cloth.pitch * repeat(cloth.weave) as f32).max(Vec2::splat(1e-6));
                (1.0, cloth.sheen, 1.0 / repeat)
            }
            RenderMaterial::Diffuse => (2.0, 0.0, Vec2::ZERO),
        };
        let Vec3 { x, y, z } = if self.colour.is_finite() { self.colour } else { Vec3::splat(0.5) };
        let fitted = if self.fitted { 1.0 } else { 0.0 };
        let block = [x, y, z, kind, sheen, repeats.x, repeats.y, fitted];
        queue.write_buffer(&self.block, 0, bytemuck::cast_slice(&block));
    }
}
