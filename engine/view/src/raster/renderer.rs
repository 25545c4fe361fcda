//! The renderer: surfaces, lines and backdrop into a part of any target.

use glam::{Vec2, Vec3};
use toile_engine::lines::Line;
use toile_gpu::vertex_source::VertexSource;
use wgpu::{
    BindGroup, Buffer, BufferUsages, CommandEncoder, Device, LoadOp, Operations, Queue, RenderPass, StoreOp,
    TextureFormat, TextureUsages, TextureView,
};

use super::Gpu;
use super::model::{Model, ModelError};
use super::pipelines::{BEAM_DEPTH, Layouts, Pipelines};
use super::render_quality::RenderQuality;
use super::surface_buffers::{SurfaceBuffers, SurfaceUploader, UploadScratch};
use super::textures::{self, BackdropTexture, IntermediateTarget};
use super::view_uniforms::{BLOCK, BackdropKind, ViewUniforms};
use super::weave_textures::WeaveTextures;
use crate::image::Size;
use crate::scene::{Bounds, OrbitCamera};

/// Most pictures drawn into one submission: side by side, and a few small ones.
pub const MOST_VIEWS: usize = 8;

/// A part of a target (pixels, from its upper left corner).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Viewport {
    /// Columns left of it (pixels).
    pub x: u32,
    /// Rows above it (pixels).
    pub y: u32,
    /// Its width and height (pixels).
    pub size: Size,
}

impl Viewport {
    /// The viewport that covers a whole target.
    pub const fn whole(size: Size) -> Self {
        Self { x: 0, y: 0, size }
    }

    /// What of it lies within a target of this size.
    fn within(self, size: Size) -> Option<Self> {
        let width = self.size.width.min(size.width.checked_sub(self.x)?);
        let height = self.size.height.min(size.height.checked_sub(self.y)?);
        (width > 0 && height > 0).then_some(Self { size: Size::new(width, height), ..self })
    }
}

/// The backdrop behind the subject.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Backdrop {
    /// The curved backdrop that the stills have.
    #[default]
    Curved,
    /// The picture of [`Renderer::set_picture`], covering the view; the curved backdrop until one is set.
    Picture,
}

/// One view's uniform block.
#[derive(Debug)]
struct ViewSlot {
    block: Buffer,
    bind: BindGroup,
}

/// Draws a model. All its resources belong to one device; make a new renderer when that is lost.
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    device: Device,
    queue: Queue,
    format: TextureFormat,
    quality: RenderQuality,
    layouts: Layouts,
    pipelines: Pipelines,
    threads: WeaveTextures,
    surfaces: Vec<SurfaceBuffers>,
    subject: Option<Bounds>,
    lines: Buffer,
    line_count: u32,
    beams: TextureView,
    depths: BindGroup,
    behind: BackdropTexture,
    behind_bind: BindGroup,
    has_picture: bool,
    canvas: Option<(IntermediateTarget, Option<BindGroup>)>,
    slots: Vec<ViewSlot>,
    next: usize,
    scratch: UploadScratch,
}

impl Renderer {
    /// Compiles everything for targets of one format. 100 ms to seconds, by the driver.
    pub fn new(gpu: &Gpu, format: TextureFormat, quality: RenderQuality) -> Self {
        let (device, queue) = (gpu.device.clone(), gpu.queue.clone());
        let quality = quality.within_limits(device.limits().max_texture_dimension_2d);
        let layouts = Layouts::new(&device);
        let pipelines = Pipelines::new(&device, &layouts, format, &quality);
        let threads = WeaveTextures::new(&device, &queue, quality.weave);
        let (columns, rows) = quality.grid();
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let size = Size::new(columns * quality.tile, rows * quality.tile);
        let beams = view(&textures::plain(&device, size, BEAM_DEPTH, 1, usage));
        let depths = bind_depths(&device, &layouts, &beams);
        let behind = BackdropTexture::new(&device, Size::new(1, 1));
        let behind_bind = bind_behind(&device, &layouts, &behind);
        Self {
            lines: line_buffer(&device, 0),
            line_count: 0,
            surfaces: Vec::new(),
            subject: None,
            has_picture: false,
            canvas: None,
            slots: (0..MOST_VIEWS).map(|_| slot(&device, &layouts)).collect(),
            next: 0,
            scratch: UploadScratch::default(),
            gpu: gpu.clone(),
            device,
            queue,
            format,
            quality,
            layouts,
            pipelines,
            threads,
            beams,
            depths,
            behind,
            behind_bind,
        }
    }

    /// What it draws with, after the adapter's limits.
    pub fn quality(&self) -> RenderQuality {
        self.quality
    }

    /// The format of the targets that it draws on.
    pub fn format(&self) -> TextureFormat {
        self.format
    }

    /// Takes over a model in place of the one before.
    ///
    /// # Errors
    /// [`ModelError`]: the first surface whose lists do not fit together; the model before stays then.
    pub fn set_model(&mut self, model: &Model) -> Result<(), ModelError> {
        let maker = SurfaceUploader {
            device: &self.device,
            queue: &self.queue,
            layouts: &self.layouts,
            threads: &self.threads,
        };
        let scratch = &mut self.scratch;
        let made = model.surfaces.iter().enumerate().map(|(i, shape)| maker.make(scratch, i, shape));
        self.surfaces = made.collect::<Result<_, _>>()?;
        Ok(())
    }

    /// Where a surface is in the next picture: positions (m) and unit normals `[vertices]`; without normals it is shaded
    /// flat.
    ///
    /// # Errors
    /// [`ModelError`]: no such surface, another length, a place that is not finite. The last places stay then.
    pub fn update(&mut self, surface: usize, positions: &[Vec3], normals: &[Vec3]) -> Result<(), ModelError> {
        self.with(surface, |it, queue, scratch| it.update(queue, scratch, surface, positions, normals))
    }

    /// Draws a surface from where it lies on the renderer's own device, from the next picture on until the next
    /// [`Renderer::update`]: nothing of it goes by way of the CPU. `within` is the box that it is in then (m), which the
    /// shadows are made for: that of the places that came back last, and around it what it may have moved since.
    ///
    /// # Errors
    /// [`ModelError`]: no such surface, another number of vertices, or another device. The last places stay then.
    pub fn follow(&mut self, surface: usize, source: &VertexSource, within: Bounds) -> Result<(), ModelError> {
        if !source.device().is(&self.gpu) {
            return Err(ModelError::Device { surface });
        }
        let count = self.surfaces.len();
        let it = self.surfaces.get_mut(surface).ok_or(ModelError::Surface { surface, count })?;
        it.follow((&self.device, &self.layouts), surface, source, within)
    }

    /// Sets the drawn triangles of a surface: at most as many as it has.
    ///
    /// # Errors
    /// [`ModelError`]: no such surface, too many, or a corner that is no vertex.
    pub fn set_triangles(&mut self, surface: usize, triangles: &[[u32; 3]]) -> Result<(), ModelError> {
        self.with(surface, |it, queue, _| it.set_triangles(queue, surface, triangles))
    }

    /// Changes a surface's base colour, linear RGB.
    ///
    /// # Errors
    /// [`ModelError::Surface`].
    pub fn set_colour(&mut self, surface: usize, colour: Vec3) -> Result<(), ModelError> {
        self.with(surface, |it, queue, _| {
            it.set_colour(queue, colour);
            Ok(())
        })
    }

    /// Paints a surface in the eight steps of the fit map, by a figure a vertex, -1 (loose) .. 1 (tight) `[vertices]`; `None`
    /// gives it its own colour again.
    ///
    /// # Errors
    /// [`ModelError`]: no such surface, or another length.
    pub fn set_fit(&mut self, surface: usize, fit: Option<&[f32]>) -> Result<(), ModelError> {
        self.with(surface, |it, queue, scratch| it.set_fit(queue, scratch, surface, fit))
    }

    /// How much farther off each vertex counts than it is (m) `[vertices]` when it is decided what hides what: skin under
    /// a garment does not show through cloth that lies within this depth of it.
    ///
    /// # Errors
    /// [`ModelError`]: no such surface, or another length.
    pub fn set_recess(&mut self, surface: usize, recess: &[f32]) -> Result<(), ModelError> {
        self.with(surface, |it, queue, scratch| it.set_recess(queue, scratch, surface, recess))
    }

    /// Draws a surface or leaves it out, from the next picture on that is drawn: two sizes side by side are two sets of
    /// surfaces in turn.
    ///
    /// # Errors
    /// [`ModelError::Surface`].
    pub fn set_visible(&mut self, surface: usize, visible: bool) -> Result<(), ModelError> {
        self.with(surface, |it, _, _| {
            it.visible = visible;
            Ok(())
        })
    }

    /// Fixes lighting and backdrop to a subject within this box; `None` fits them to what is drawn, picture by picture.
    pub fn set_subject(&mut self, subject: Option<Bounds>) {
        self.subject = subject;
    }

    /// The lines to draw from now on, over whatever hides them.
    pub fn set_lines(&mut self, lines: &[Line]) {
        let bytes: Vec<f32> = lines.iter().flat_map(|l| [l.from, l.to, l.colour]).flat_map(|v| v.to_array()).collect();
        let bytes: &[u8] = bytemuck::cast_slice(&bytes);
        if bytes.len() as u64 > self.lines.size() {
            self.lines = line_buffer(&self.device, bytes.len());
        }
        self.queue.write_buffer(&self.lines, 0, bytes);
        self.line_count = lines.len() as u32;
    }

    /// The picture behind the subject: red, green, blue, rows from the top `[3 x width x height]`.
    ///
    /// # Errors
    /// [`ModelError::Length`] when the bytes are not as many as the size says.
    pub fn set_picture(&mut self, size: Size, rgb: &[u8]) -> Result<(), ModelError> {
        let want = 3 * size.width as usize * size.height as usize;
        if rgb.len() != want || want == 0 {
            return Err(ModelError::Length { surface: 0, what: "bytes of a picture", got: rgb.len(), want });
        }
        if self.behind.size != size {
            self.behind = BackdropTexture::new(&self.device, size);
            self.behind_bind = bind_behind(&self.device, &self.layouts, &self.behind);
        }
        self.behind.take(&self.queue, rgb);
        self.has_picture = true;
        Ok(())
    }

    /// Draws one view into a part of a target; the rest of the target stays as it is. At most [`MOST_VIEWS`] times
    /// between two submissions.
    pub fn draw(
        &mut self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        viewport: Viewport,
        camera: &OrbitCamera,
        backdrop: Backdrop,
    ) {
        let whole = Size::new(target.texture().width(), target.texture().height());
        let Some(viewport) = viewport.within(whole) else { return };
        // Several samples are drawn on a canvas as large as the view, one sample on the target itself.
        let smooth = self.quality.samples > 1;
        self.fit_canvas(if smooth { viewport.size } else { whole });
        let Some((canvas, finished)) = &self.canvas else { return };
        let slot = &self.slots[self.next];
        let block = self.uniforms(viewport.size, camera, backdrop).block(&self.quality);
        self.queue.write_buffer(&slot.block, 0, bytemuck::cast_slice(&block));
        self.draw_shadow_maps(encoder, slot);
        match (&canvas.smooth, finished) {
            (Some((many, one)), Some(finished)) => {
                let mut pass = begin(encoder, many, Some(one), Some(&canvas.depth), LoadOp::Clear(wgpu::Color::BLACK));
                self.draw_scene(&mut pass, slot);
                drop(pass);
                let mut pass = begin(encoder, target, None, None, LoadOp::Load);
                restrict(&mut pass, viewport);
                pass.set_pipeline(&self.pipelines.blit);
                pass.set_bind_group(0, finished, &[]);
                pass.draw(0..3, 0..1);
            }
            _ => {
                let mut pass = begin(encoder, target, None, Some(&canvas.depth), LoadOp::Load);
                restrict(&mut pass, viewport);
                self.draw_scene(&mut pass, slot);
            }
        }
        self.next = (self.next + 1) % self.slots.len();
    }

    /// The depth maps of all beams.
    fn draw_shadow_maps(&self, encoder: &mut CommandEncoder, slot: &ViewSlot) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("beams"),
            depth_stencil_attachment: Some(depth(&self.beams)),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipelines.depth);
        pass.set_bind_group(0, &slot.bind, &[]);
        for surface in self.surfaces.iter().filter(|s| s.visible && s.count > 0) {
            pass.set_vertex_buffer(0, surface.positions());
            pass.set_index_buffer(surface.own_indices().slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..surface.count, 0, 0..self.quality.beams());
        }
    }

    /// Surfaces from the outermost inwards, so that little is drawn twice; then the backdrop; then lines.
    fn draw_scene(&self, pass: &mut RenderPass<'_>, slot: &ViewSlot) {
        pass.set_bind_group(0, &slot.bind, &[]);
        pass.set_bind_group(1, &self.depths, &[]);
        pass.set_pipeline(&self.pipelines.surface);
        for surface in self.surfaces.iter().rev().filter(|s| s.visible && s.count > 0) {
            pass.set_bind_group(2, &surface.bind, &[]);
            let (places, first) = surface.places();
            pass.set_bind_group(3, places, &[]);
            for (at, part) in (0..).zip([&surface.points, &surface.marks, &surface.rest]) {
                pass.set_vertex_buffer(at, part.slice(..));
            }
            pass.set_index_buffer(surface.indices.slice(..), wgpu::IndexFormat::Uint32);
            // The number of the instance says where the surface's places begin.
            pass.draw_indexed(0..surface.count, 0, first..first + 1);
        }
        pass.set_pipeline(&self.pipelines.backdrop);
        pass.set_bind_group(2, &self.behind_bind, &[]);
        pass.draw(0..3, 0..1);
        if self.line_count > 0 {
            pass.set_vertex_buffer(0, self.lines.slice(..));
            for pipeline in [&self.pipelines.hidden, &self.pipelines.lines] {
                pass.set_pipeline(pipeline);
                pass.draw(0..4, 0..self.line_count);
            }
        }
    }

    fn uniforms(&self, size: Size, camera: &OrbitCamera, backdrop: Backdrop) -> ViewUniforms {
        let shown = self.surfaces.iter().filter(|s| s.visible && s.count > 0);
        let subject = shown.fold(Bounds::EMPTY, |b, s| b.union(s.bounds));
        let behind = match backdrop {
            Backdrop::Picture if self.has_picture => BackdropKind::Picture(covering(self.behind.size, size)),
            _ => BackdropKind::Curved,
        };
        let stands = self.subject.unwrap_or(subject);
        ViewUniforms { camera: *camera, size, subject, stands, behind }
    }

    fn fit_canvas(&mut self, size: Size) {
        if self.canvas.as_ref().is_some_and(|(canvas, _)| canvas.fits(size)) {
            return;
        }
        let canvas = IntermediateTarget::new(&self.device, size, self.format, self.quality.samples);
        let finished = canvas.smooth.as_ref().map(|(_, one)| {
            self.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("finished"),
                layout: &self.layouts.finished,
                entries: &[entry(0, wgpu::BindingResource::TextureView(one))],
            })
        });
        self.canvas = Some((canvas, finished));
    }

    fn with(
        &mut self,
        surface: usize,
        change: impl FnOnce(&mut SurfaceBuffers, &Queue, &mut UploadScratch) -> Result<(), ModelError>,
    ) -> Result<(), ModelError> {
        let count = self.surfaces.len();
        let it = self.surfaces.get_mut(surface).ok_or(ModelError::Surface { surface, count })?;
        change(it, &self.queue, &mut self.scratch)
    }
}

/// How much of a picture's width and height a view shows that it covers whole.
fn covering(picture: Size, size: Size) -> Vec2 {
    let aspect = |s: Size| s.width as f32 / s.height.max(1) as f32;
    let wide = aspect(size) / aspect(picture);
    if wide > 1.0 { Vec2::new(1.0, 1.0 / wide) } else { Vec2::new(wide, 1.0) }
}

fn view(texture: &wgpu::Texture) -> TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn entry(binding: u32, resource: wgpu::BindingResource<'_>) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource }
}

fn slot(device: &Device, layouts: &Layouts) -> ViewSlot {
    let block = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("frame"),
        size: BLOCK,
        usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("frame"),
        layout: &layouts.frame,
        entries: &[entry(0, block.as_entire_binding())],
    });
    ViewSlot { block, bind }
}

fn line_buffer(device: &Device, bytes: usize) -> Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("lines"),
        size: bytes.max(36) as u64,
        usage: BufferUsages::VERTEX | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn bind_depths(device: &Device, layouts: &Layouts, beams: &TextureView) -> BindGroup {
    let nearest = textures::sampler(device, wgpu::AddressMode::ClampToEdge, wgpu::FilterMode::Nearest);
    let (map, sampler) = (wgpu::BindingResource::TextureView(beams), wgpu::BindingResource::Sampler(&nearest));
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("depths"),
        layout: &layouts.depths,
        entries: &[entry(0, map), entry(1, sampler)],
    })
}

fn bind_behind(device: &Device, layouts: &Layouts, behind: &BackdropTexture) -> BindGroup {
    let linear = textures::sampler(device, wgpu::AddressMode::ClampToEdge, wgpu::FilterMode::Linear);
    let (map, sampler) = (wgpu::BindingResource::TextureView(&behind.view), wgpu::BindingResource::Sampler(&linear));
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("behind"),
        layout: &layouts.behind,
        entries: &[entry(0, map), entry(1, sampler)],
    })
}

fn depth(view: &TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let depth_ops = Some(Operations { load: LoadOp::Clear(1.0), store: StoreOp::Store });
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None }
}

fn begin<'a>(
    encoder: &'a mut CommandEncoder,
    target: &TextureView,
    resolved: Option<&TextureView>,
    depths: Option<&TextureView>,
    load: LoadOp<wgpu::Color>,
) -> RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: resolved,
            ops: Operations { load, store: StoreOp::Store },
        })],
        depth_stencil_attachment: depths.map(depth),
        ..Default::default()
    })
}

fn restrict(pass: &mut RenderPass<'_>, viewport: Viewport) {
    let Viewport { x, y, size } = viewport;
    pass.set_viewport(x as f32, y as f32, size.width as f32, size.height as f32, 0.0, 1.0);
    pass.set_scissor_rect(x, y, size.width, size.height);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_viewport_is_cut_to_its_target() {
        let target = Size::new(100, 80);
        let at = |x, y, w, h| Viewport { x, y, size: Size::new(w, h) }.within(target);
        assert_eq!(at(0, 0, 100, 80), Some(Viewport::whole(target)));
        assert_eq!(at(60, 10, 100, 20), Some(Viewport { x: 60, y: 10, size: Size::new(40, 20) }));
        assert_eq!(at(100, 0, 5, 5), None);
        assert_eq!(at(200, 0, 5, 5), None);
        assert_eq!(at(0, 0, 0, 5), None);
    }

    #[test]
    fn a_picture_covers_the_view_without_being_stretched() {
        let tall = covering(Size::new(200, 100), Size::new(100, 100));
        assert_eq!(tall, Vec2::new(0.5, 1.0));
        let wide = covering(Size::new(100, 100), Size::new(200, 100));
        assert_eq!(wide, Vec2::new(1.0, 0.5));
    }
}
