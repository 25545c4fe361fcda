//! The dressed body as it is drawn behind the panel: its surfaces on the device, their positions by the newest snapshot, and
//! the camera.

use std::f32::consts::TAU;

use glam::Vec3;
use toile_assets::sizes::Girth;
use toile_base::mesh::vertex_normals;
use toile_engine::world::Snapshot;
use toile_view::figure::PlacedHead;
use toile_view::fit_map;
use toile_view::image::Size;
use toile_view::raster::{Backdrop, Gpu, Model, RenderQuality, Renderer, SurfaceInterpolation, Viewport};
use wgpu::{CommandEncoder, TextureFormat, TextureView};

use super::body_model::{BodyModel, ModelPair};
use super::camera;
use crate::visitor::screen::{BodyView, JudgedGarment};

/// A mannequin turns once in so many seconds.
const TURN_S: f64 = 36.0;

/// Time in which the view follows a body across the floor by two thirds of the way (s).
const FOLLOW_S: f32 = 0.075;

/// What is drawn of a moment.
#[derive(Debug, Clone, Copy)]
pub struct BodyScene<'a> {
    /// The body behind the panel.
    pub body_view: &'a BodyView,
    /// Colours of the garments, linear RGB, inner first.
    pub colours: &'a [[f32; 3]],
    /// What the panel leaves of the display: left, top, right, bottom as shares.
    pub free: [f32; 4],
    /// Time since the window was opened (s); a mannequin stands still without one.
    pub time_s: Option<f64>,
    /// The shopper's own picture as a mirror shows it, where that is shown: its size, and red, green, blue.
    pub own: Option<(Size, &'a [u8])>,
}

/// What the fit map shows: zones that are not known, and how the garment in hand was judged.
type FitColours = ([bool; 3], Option<JudgedGarment>);

/// A body with its garments, on a device.
pub struct BodyRenderer {
    renderer: Renderer,
    /// Whether motion between snapshots is shown: where the processor draws, pictures are too far apart for it.
    smooth: bool,
    /// What brings the head along with the posed skin.
    head: PlacedHead,
    triangles: Vec<Vec<[u32; 3]>>,
    /// Surfaces of the body and its garments; those of a pair follow.
    worn: usize,
    /// Surfaces of the left and of the right one.
    pair: [usize; 2],
    fit: Vec<Vec<f32>>,
    zones: Vec<Vec<Girth>>,
    heights: Vec<Vec<f32>>,
    levels: [f32; 3],
    statures: [f32; 3],
    blends: Vec<SurfaceInterpolation>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Where the body stands (m), once it was seen.
    at: Option<Vec3>,
    /// The same of the left and the right one of a pair, which stand as the shopper stood when they were dressed.
    pair_at: [Vec3; 2],
    /// When the snapshot was published that it was seen in (ns).
    followed_ns: u64,
    /// Coordinates on their way to a median.
    sorted: Vec<f32>,
    /// What was painted last: colours, and whether as a fit map, with the zones that it does not know and how the garment in hand was
    /// judged.
    painted: (Vec<[f32; 3]>, Option<FitColours>),
}

impl BodyRenderer {
    /// Without a body, on a device whose pictures have this format. Compiles shaders, which takes a tenth of a second or more.
    pub fn new(gpu: &Gpu, format: TextureFormat) -> Self {
        let software = gpu.is_software();
        Self {
            renderer: Renderer::new(gpu, format, RenderQuality::live(software)),
            smooth: !software,
            head: PlacedHead::default(),
            triangles: Vec::new(),
            worn: 0,
            pair: [0; 2],
            fit: Vec::new(),
            zones: Vec::new(),
            heights: Vec::new(),
            levels: [0.0; 3],
            statures: [1.7; 3],
            blends: Vec::new(),
            positions: Vec::new(),
            normals: Vec::new(),
            at: None,
            pair_at: [Vec3::ZERO; 2],
            followed_ns: 0,
            sorted: Vec::new(),
            painted: (Vec::new(), None),
        }
    }

    /// Sets the body that is drawn, and two sizes of the same outfit beside it if there are any.
    pub fn dress(&mut self, model: &BodyModel, pair: Option<&ModelPair>) {
        let models = || std::iter::once(model).chain(pair.into_iter().flatten());
        let surfaces = || models().flat_map(|m| &m.meshes.surfaces);
        let meshes = Model { surfaces: surfaces().cloned().collect() };
        // A body that cannot be drawn leaves the studio empty; words and controls are there all the same.
        if self.renderer.set_model(&meshes).is_err() {
            self.worn = 0;
            return;
        }
        self.worn = model.meshes.surfaces.len();
        self.pair = pair.map_or([0; 2], |pair| pair.each_ref().map(|m| m.meshes.surfaces.len()));
        self.head = model.head.clone();
        self.triangles = surfaces().map(|s| s.triangles.clone()).collect();
        (self.fit, self.zones) = (model.fit.clone(), model.zones.clone());
        (self.heights, self.levels) = (model.heights.clone(), model.levels);
        self.statures = [model.stature, pair.map_or(1.7, |p| p[0].stature), pair.map_or(1.7, |p| p[1].stature)];
        let mut stands = |model: &BodyModel| {
            let body = model.meshes.surfaces.first();
            body.and_then(|body| camera::middle(&body.rest, &mut self.sorted)).unwrap_or_default()
        };
        self.pair_at = pair.map_or([Vec3::ZERO; 2], |pair| pair.each_ref().map(&mut stands));
        self.blends = vec![SurfaceInterpolation::new(); self.worn];
        self.painted = (Vec::new(), None);
        self.at = None;
        for (i, recess) in models().flat_map(|m| &m.recess).enumerate() {
            // Of the same model, so that it has the same length.
            _ = self.renderer.set_recess(i, recess);
        }
    }

    /// Takes over what a snapshot shows, at a time of its clock (ns).
    pub fn take(&mut self, snapshot: &Snapshot, now_ns: u64) {
        if self.worn != 1 + snapshot.garments.len() {
            return;
        }
        let vertices = snapshot.skin.vertices() + self.head.hair();
        self.positions.resize(vertices, Vec3::ZERO);
        self.normals.resize(vertices, Vec3::ZERO);
        snapshot.skin.read(&mut self.positions, &mut self.normals);
        self.head.place(&mut self.positions, &mut self.normals);
        self.follow(snapshot.times.published_ns);
        self.move_to(0, snapshot.times.published_ns, now_ns);
        for (i, points) in snapshot.garments.iter().enumerate() {
            self.positions.clear();
            self.positions.extend_from_slice(points);
            self.normals.clear();
            self.normals.resize(points.len(), Vec3::ZERO);
            vertex_normals(points, &self.triangles[i + 1], &mut self.normals);
            self.move_to(i + 1, snapshot.times.published_ns, now_ns);
        }
    }

    /// Follows the body, and not an arm that is held out.
    fn follow(&mut self, published_ns: u64) {
        let Some(now) = camera::middle(&self.positions, &mut self.sorted) else { return };
        let since_s = published_ns.saturating_sub(self.followed_ns) as f32 * 1e-9;
        self.followed_ns = published_ns;
        let share = 1.0 - (-since_s / FOLLOW_S).exp();
        self.at = Some(self.at.map_or(now, |at| at.lerp(now, share)));
    }

    /// A position that is NaN, or another body's, leaves a surface where it was.
    fn move_to(&mut self, surface: usize, published_ns: u64, now_ns: u64) {
        let Self { renderer, blends, positions, normals, smooth, .. } = self;
        if !*smooth {
            _ = renderer.update(surface, positions, normals);
            return;
        }
        let blend = &mut blends[surface];
        blend.push(published_ns, positions, normals);
        let (positions, normals) = blend.at(blend.share(now_ns));
        _ = renderer.update(surface, positions, normals);
    }

    /// Draws it over all of a view.
    pub fn draw(&mut self, encoder: &mut CommandEncoder, target: &TextureView, size: Size, scene: &BodyScene<'_>) {
        if let Some((own, rgb)) = scene.own {
            self.draw_own(encoder, target, size, (own, rgb));
            return;
        }
        self.paint(scene);
        match scene.body_view {
            BodyView::Two { yaw } if self.pair[0] > 0 => {
                let half = Size::new(size.width / 2, size.height);
                let [left, top, right, bottom] = scene.free;
                for side in 0..2 {
                    self.show(self.worn + side * self.pair[0], self.pair[side]);
                    let x = side as u32 * half.width;
                    let free = if right < 1.0 { [0.0, top, 1.0, bottom] } else { [left, top, right, bottom] };
                    let place = Viewport { x, y: 0, size: half };
                    self.draw_body(encoder, target, place, (1 + side, self.pair_at[side], *yaw), free);
                }
            }
            view => {
                let yaw = match view {
                    BodyView::Shopper { yaw, .. } | BodyView::Two { yaw } => *yaw,
                    BodyView::Mannequin => (scene.time_s.unwrap_or(1.5) / TURN_S * f64::from(TAU)) as f32 % TAU,
                };
                self.show(0, self.worn);
                let at = self.at.unwrap_or_default();
                self.draw_body(encoder, target, Viewport::whole(size), (0, at, yaw), scene.free);
            }
        }
    }

    /// The picture alone: what is worn is drawn on it already.
    fn draw_own(&mut self, encoder: &mut CommandEncoder, target: &TextureView, size: Size, (own, rgb): (Size, &[u8])) {
        if self.renderer.set_picture(own, rgb).is_err() {
            return;
        }
        self.show(0, 0);
        self.renderer.set_subject(None);
        let aspect = size.width as f32 / size.height.max(1) as f32;
        let camera = camera::camera(self.statures[0], Vec3::ZERO, 0.0, [0.0, 0.0, 1.0, 1.0], aspect);
        self.renderer.draw(encoder, target, Viewport::whole(size), &camera, Backdrop::Picture);
    }

    fn draw_body(
        &mut self,
        encoder: &mut CommandEncoder,
        target: &TextureView,
        place: Viewport,
        (who, at, yaw): (usize, Vec3, f32),
        free: [f32; 4],
    ) {
        let aspect = place.size.width as f32 / place.size.height.max(1) as f32;
        let stature = self.statures[who];
        self.renderer.set_subject(Some(camera::standing_bounds(stature, at)));
        let camera = camera::camera(stature, at, yaw, free, aspect);
        self.renderer.draw(encoder, target, place, &camera, Backdrop::Curved);
    }

    /// Only these surfaces are drawn.
    fn show(&mut self, first: usize, count: usize) {
        for surface in 0..self.triangles.len() {
            _ = self.renderer.set_visible(surface, (first..first + count).contains(&surface));
        }
    }

    /// Colours and fit map, where they have changed.
    fn paint(&mut self, scene: &BodyScene<'_>) {
        let fit = match scene.body_view {
            BodyView::Shopper { fit: true, unknown, judged, .. } => Some((*unknown, *judged)),
            _ => None,
        };
        if (&*self.painted.0, self.painted.1) == (scene.colours, fit) {
            return;
        }
        self.painted = (scene.colours.to_vec(), fit);
        let [left, right] = self.pair;
        let begins = [(0, self.worn), (self.worn, left), (self.worn + left, right)];
        for (begin, count) in begins.into_iter().filter(|(_, count)| *count > 0) {
            for (surface, colour) in (begin + 1..begin + count).zip(scene.colours) {
                _ = self.renderer.set_colour(surface, Vec3::from_array(*colour));
            }
        }
        for (surface, (tight, zones)) in (1..self.worn).zip(self.fit.iter().zip(&self.zones)) {
            let judged = fit.and_then(|(_, judged)| judged).filter(|judged| judged.place + 1 == surface);
            let agreed = judged.map(|judged| {
                let known = self.levels.into_iter().zip(judged.tightness);
                let levels: Vec<(f32, f32)> = known.filter_map(|(level, tight)| Some((level, tight?))).collect();
                fit_map::agreed(tight, &self.heights[surface - 1], &levels)
            });
            let tight = agreed.as_deref().unwrap_or(tight);
            let tight = fit.map(|(unknown, _)| BodyModel::known_fit(tight, zones, unknown));
            _ = self.renderer.set_fit(surface, tight.as_deref());
        }
    }
}
