//! The buffers of each surface on the device: made once, overwritten from picture to picture.

use std::collections::HashMap;

use glam::{Vec2, Vec3};
use toile_base::fabric::Weave;
use toile_base::garment::trim::MAX_TRIMS;
use toile_base::mesh::vertex_normals;
use toile_gpu::vertex_source::{STRIDE, VertexSource};
use wgpu::{BindGroup, Buffer, BufferSlice, BufferUsages, Device, Queue, TextureView};

use super::model::{ModelError, RenderMaterial, RenderSurface, check_triangles};
use super::pipelines::Layouts;
use super::split_vertices::{POINT_BYTES, SplitVertices};
use super::textures;
use super::weave_relief::repeat;
use super::weave_textures::WeaveTextures;
use crate::scene::Bounds;
use crate::trim_look::DrawnTrim;

/// Numbers of a surface's uniform block: three vectors of four, and as many of each trim.
const BLOCK_NUMBERS: usize = 12 * (1 + MAX_TRIMS);

/// Sent in place of a fit that is NaN.
const NO_FIT: f32 = -9.0;

/// One surface on the device.
#[derive(Debug)]
pub struct SurfaceBuffers {
    positions: Buffer,
    normals: Buffer,
    /// Whether buffers on the device are drawn instead, until the next update.
    follows: bool,
    /// The vertices as they are drawn.
    split: SplitVertices,
    /// Which of the split triangles each triangle is; of a surface that is drawn as it is, nothing.
    split_triangles: HashMap<[u32; 3], u32>,
    /// Of each vertex that is drawn: the surface's vertex; texture point and distance from hem and seam.
    pub points: Buffer,
    /// Fit and recess of each vertex that is drawn.
    pub marks: Buffer,
    /// Place and normal at rest, or place on the cloth, of each vertex that is drawn.
    pub rest: Buffer,
    /// Corners by the vertices that are drawn.
    pub indices: Buffer,
    /// Corners by the surface's own vertices, for what needs no texture; none where they are the same.
    own_indices: Option<Buffer>,
    /// Indices that are drawn.
    pub count: u32,
    pub bind: BindGroup,
    /// Positions and normals as the shader reads them.
    own_places: BindGroup,
    /// The same of what is followed.
    source_places: Option<(VertexSource, BindGroup)>,
    /// The box around it as it is drawn.
    pub bounds: Bounds,
    pub visible: bool,
    block: Buffer,
    vertices: usize,
    room: usize,
    look: [f32; 4],
    trims: Vec<DrawnTrim>,
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
        let split = SplitVertices::of(shape);
        let drawn_vertices = split.source.len();
        let is_split = split.triangles != shape.triangles;
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
        let block = buffer("surface", 4 * BLOCK_NUMBERS, BufferUsages::UNIFORM);
        let weave = if let RenderMaterial::Cloth(cloth) = shape.material { cloth.weave } else { Weave::Plain };
        let places = BufferUsages::VERTEX | BufferUsages::STORAGE;
        let positions = buffer("positions", vertices.max(1) * STRIDE as usize, places);
        let normals_buffer = buffer("normals", vertices.max(1) * STRIDE as usize, places);
        let indices = |label| buffer(label, shape.triangles.len() * 12, BufferUsages::INDEX);
        let tile = shape.look.as_ref().and_then(|look| look.tile.as_ref());
        let tile_view = tile.map(|tile| textures::levels(self.device, self.queue, tile));
        let flag = |on: bool| if on { 1.0 } else { 0.0 };
        let sewn = shape.look.as_ref().is_some_and(|look| !look.edges.is_empty());
        let opacity = shape.look.as_ref().map_or(1.0, |look| look.opacity);
        let mut drawn = SurfaceBuffers {
            own_places: self.places(&positions, &normals_buffer),
            source_places: None,
            follows: false,
            positions,
            normals: normals_buffer,
            points: buffer("points", drawn_vertices * POINT_BYTES, BufferUsages::VERTEX),
            marks: buffer("marks", drawn_vertices * 8, BufferUsages::VERTEX),
            rest: buffer("rest", drawn_vertices * 24, BufferUsages::VERTEX),
            indices: indices("indices"),
            own_indices: is_split.then(|| indices("own indices")),
            split_triangles: if is_split {
                (0..).zip(&shape.triangles).map(|(i, t)| (*t, i)).collect()
            } else {
                HashMap::new()
            },
            split,
            count: 0,
            bind: self.bind(&block, self.threads.of(weave), tile_view.as_ref().unwrap_or(&self.threads.blank)),
            look: [flag(tile.is_some()), flag(sewn), opacity, surface as f32],
            trims: shape.look.as_ref().map_or_else(Vec::new, |look| look.trims.clone()),
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
        drawn.send_points(self.queue);
        drawn.send_rest(self.queue, scratch, shape, &normals);
        drawn.set_triangles(self.queue, surface, &shape.triangles)?;
        drawn.update(self.queue, scratch, surface, &shape.rest, &normals)?;
        drawn.send_marks(self.queue, scratch);
        drawn.send_block(self.queue);
        Ok(drawn)
    }

    fn bind(&self, block: &Buffer, weave: &TextureView, tile: &TextureView) -> BindGroup {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surface"),
            layout: &self.layouts.surface,
            entries: &[
                entry(0, block.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(weave)),
                entry(2, wgpu::BindingResource::Sampler(&self.threads.sampler)),
                entry(3, wgpu::BindingResource::TextureView(tile)),
            ],
        })
    }

    fn places(&self, positions: &Buffer, normals: &Buffer) -> BindGroup {
        bind_places(self.device, self.layouts, [positions, normals])
    }
}

/// Positions and normals, as the shader of surfaces reads them.
fn bind_places(device: &Device, layouts: &Layouts, [positions, normals]: [&Buffer; 2]) -> BindGroup {
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("places"),
        layout: &layouts.places,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: positions.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: normals.as_entire_binding() },
        ],
    })
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
        self.follows = false;
        Ok(())
    }

    /// Draws it from where it lies on the device until the next update; `within` is the box that it is in (m).
    ///
    /// # Errors
    /// [`ModelError::Length`]; the last places stay then.
    pub fn follow(
        &mut self,
        (device, layouts): (&Device, &Layouts),
        surface: usize,
        source: &VertexSource,
        within: Bounds,
    ) -> Result<(), ModelError> {
        self.check(surface, "vertices on the device", source.vertices())?;
        let known = self.source_places.as_ref().filter(|(known, _)| known.buffers() == source.buffers());
        let bind = known.map_or_else(|| bind_places(device, layouts, source.buffers()), |(_, bind)| bind.clone());
        self.source_places = Some((source.clone(), bind));
        self.follows = true;
        self.bounds = within;
        Ok(())
    }

    fn followed(&self) -> Option<&(VertexSource, BindGroup)> {
        self.source_places.as_ref().filter(|_| self.follows)
    }

    /// The positions that are drawn, for what needs nothing else.
    pub fn positions(&self) -> BufferSlice<'_> {
        match self.followed() {
            Some((source, _)) => source.parts()[0],
            None => self.positions.slice(..),
        }
    }

    /// Positions and normals as the shader reads them, and the first of them.
    pub fn places(&self) -> (&BindGroup, u32) {
        match self.followed() {
            Some((source, bind)) => (bind, source.first()),
            None => (&self.own_places, 0),
        }
    }

    /// Corners by the surface's own vertices.
    pub fn own_indices(&self) -> &Buffer {
        self.own_indices.as_ref().unwrap_or(&self.indices)
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
        match &self.own_indices {
            None => queue.write_buffer(&self.indices, 0, bytemuck::cast_slice(triangles)),
            Some(own) => {
                let known = |t: &[u32; 3]| self.split_triangles.get(t).map(|i| self.split.triangles[*i as usize]);
                let unknown = |triangle| ModelError::Unknown { surface, triangle };
                let split = triangles.iter().enumerate().map(|(i, t)| known(t).ok_or_else(|| unknown(i)));
                let split = split.collect::<Result<Vec<_>, _>>()?;
                queue.write_buffer(own, 0, bytemuck::cast_slice(triangles));
                queue.write_buffer(&self.indices, 0, bytemuck::cast_slice(&split));
            }
        }
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
        // On the cloth the weave is seen from its one side.
        let cloth = |point: &[Vec2; 3]| [point[1].x, point[1].y, 0.0, 0.0, 0.0, 1.0];
        if shape.look.as_ref().is_some_and(|look| !look.cloth.is_empty()) {
            return scratch.write(queue, &self.rest, self.split.points.iter().flat_map(cloth));
        }
        let both = |v: &u32| [shape.rest[*v as usize].to_array(), normals[*v as usize].to_array()];
        scratch.write(queue, &self.rest, self.split.source.iter().flat_map(both).flatten());
    }

    fn send_points(&self, queue: &Queue) {
        let SplitVertices { source, points, near, .. } = &self.split;
        let point = |((source, [tile, _, edges]), near): ((&u32, &[Vec2; 3]), &u32)| {
            [*source, tile.x.to_bits(), tile.y.to_bits(), edges.x.to_bits(), edges.y.to_bits(), *near]
        };
        let words: Vec<u32> = source.iter().zip(points).zip(near).flat_map(point).collect();
        queue.write_buffer(&self.points, 0, bytemuck::cast_slice(&words));
    }

    fn send_marks(&self, queue: &Queue, scratch: &mut UploadScratch) {
        let marks = |v: &u32| [self.fit[*v as usize], self.recess[*v as usize]];
        scratch.write(queue, &self.marks, self.split.source.iter().flat_map(marks));
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
        let [tile, sewn, opacity, number] = self.look;
        let mut block = [0.0f32; BLOCK_NUMBERS];
        let own = [x, y, z, kind, sheen, repeats.x, repeats.y, fitted, tile, sewn, opacity, number];
        block[..own.len()].copy_from_slice(&own);
        for (numbers, trim) in block[own.len()..].chunks_exact_mut(12).zip(&self.trims) {
            let ([a, b], Vec3 { x, y, z }) = (trim.ends, trim.colour);
            numbers.copy_from_slice(&[a.x, a.y, b.x, b.y, trim.half, trim.kind as f32, 0.0, 0.0, x, y, z, 0.0]);
        }
        queue.write_buffer(&self.block, 0, bytemuck::cast_slice(&block));
    }
}
