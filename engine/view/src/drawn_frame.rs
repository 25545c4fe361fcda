//! A frame as it is drawn: body and garments, each beneath what is worn over it.

use glam::Vec3;
use toile_base::body::Body;
use toile_base::garment::{Garment, Tuck};
use toile_base::mesh::vertex_normals;
use toile_engine::skin::Posed;
use toile_engine::world::{Snapshot, World};

use crate::cloth_look::{DrawnLook, GarmentLook};
use crate::figure::{Appearance, Figure, PlacedHead};
use crate::hidden_skin::{CoveringCloth, DrawnSkin};
use crate::image::{Image, Size};
use crate::scene::{Bounds, Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use crate::trace::{TraceQuality, TracedScene};

/// Half the width of what an animation shows around the shopper: arms stretched out (m).
const HALF_REACH_M: f32 = 0.62;

/// Height of what an animation shows as a share of the stature: arms half raised.
const HEADROOM: f32 = 1.04;

/// How fast the camera follows the shopper across the floor (share of the way a frame).
const FOLLOW: f32 = 0.35;

/// Body and garments as they are drawn: topology and colours, which stay, and room for the positions, which change.
pub struct DrawnFrame {
    /// The body's vertices, then its hair's.
    body: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// Of the body, before it is drawn beneath the garments.
    bounds: Bounds,
    body_triangles: Vec<[u32; 3]>,
    /// Triangles of the body that are drawn.
    drawn: Vec<[u32; 3]>,
    head: PlacedHead,
    /// Linear RGB of the skin.
    skin: Vec3,
    /// The base layer painted on it and its hair, and what of them is on the triangles that are drawn.
    base: GarmentLook,
    drawn_base: DrawnLook,
    /// Body vertices under a garment.
    dressed: Vec<bool>,
    cloths: Vec<DrawnGarment>,
    /// Target of the camera.
    middle: Option<Vec3>,
    /// The shopper's height (m).
    stature: f32,
    /// Largest depth hidden so far (m).
    hidden_m: f32,
}

struct DrawnGarment {
    /// Where the particles are drawn: beneath the garments worn over them.
    points: Vec<Vec3>,
    /// Particles under a garment worn over this one.
    dressed: Vec<bool>,
    /// What of it is tucked into another garment, and so drawn beneath that one.
    tuck: Option<Tuck>,
    triangles: Vec<[u32; 3]>,
    /// Those of them that are drawn.
    drawn: Vec<[u32; 3]>,
    normals: Vec<Vec3>,
    colour: Vec3,
    look: GarmentLook,
    /// Texture points and edges of the triangles that are drawn.
    drawn_look: DrawnLook,
}

impl DrawnFrame {
    /// Room for a frame's body and garments, as they are put on.
    pub fn new(world: &World, appearance: Appearance) -> Self {
        Self::of(world.body(), world.garments(), appearance)
    }

    /// Room for a body and garments, inner first, as they are put on.
    pub fn of(body: &Body, garments: &[Garment], appearance: Appearance) -> Self {
        let starts: Vec<&[Vec3]> = garments.iter().map(|g| &*g.start).collect();
        let over = |first: usize| {
            let worn = garments.iter().zip(&starts).skip(first);
            CoveringCloth::new(worn.flat_map(|(g, points)| g.triangles.iter().map(|t| t.map(|i| points[i as usize]))))
        };
        let cloth = |(i, g): (usize, &Garment)| {
            let mut normals = vec![Vec3::ZERO; g.particles()];
            vertex_normals(&g.start, &g.triangles, &mut normals);
            let look = GarmentLook::of(g);
            DrawnGarment {
                points: g.start.to_vec(),
                dressed: over(i + 1).dressed(&g.start, &normals),
                tuck: g.tuck.clone(),
                drawn: g.triangles.to_vec(),
                triangles: g.triangles.to_vec(),
                normals,
                colour: Vec3::from_array(g.fabric.colour.map(crate::image::linear)),
                drawn_look: look.all(),
                look,
            }
        };
        let figure = Figure::of(body, appearance);
        // Hair is worn over everything.
        let mut dressed = over(0).dressed(&body.mesh.positions, &body.normals);
        dressed.resize(figure.rest.len(), false);
        Self {
            drawn_base: figure.look.all(),
            base: figure.look,
            head: figure.head,
            skin: figure.colour,
            dressed,
            bounds: Bounds::of(&figure.rest),
            body: figure.rest,
            normals: figure.normals,
            drawn: figure.triangles.clone(),
            body_triangles: figure.triangles,
            cloths: garments.iter().enumerate().map(cloth).collect(),
            middle: None,
            stature: body.measures.stature,
            hidden_m: 0.0,
        }
    }

    /// The same with garments of other colours (linear RGB, inner first).
    #[must_use]
    pub fn coloured(mut self, colours: &[[f32; 3]]) -> Self {
        for (cloth, colour) in self.cloths.iter_mut().zip(colours) {
            cloth.colour = Vec3::from_array(*colour);
        }
        self
    }

    /// Updates all positions from a snapshot.
    pub fn update(&mut self, snapshot: &Snapshot) {
        self.place(&snapshot.garments, &snapshot.skin);
    }

    /// Updates the particles of each garment (m) and the skin, from the outermost garment to the skin: each is drawn beneath what
    /// is worn over it.
    pub fn place(&mut self, garments: &[impl AsRef<[Vec3]>], skin: &Posed) {
        // Each with the garment that it does not lie over, because it is tucked into it.
        let mut over: Vec<([Vec3; 3], Option<usize>)> = Vec::new();
        for i in (0..self.cloths.len()).rev() {
            let into = self.cloths[i].tuck.as_ref().map(|tuck| tuck.into);
            let into = into.map(|g| cover(&self.cloths[g].triangles, garments[g].as_ref()));
            let DrawnGarment { points: at, dressed, tuck, triangles, drawn, normals, look, drawn_look, .. } =
                &mut self.cloths[i];
            at.copy_from_slice(garments[i].as_ref());
            vertex_normals(at, triangles, normals);
            let worn_over = over.iter().filter(|(_, beneath)| *beneath != Some(i)).map(|(face, _)| *face);
            let mut under = CoveringCloth::new(worn_over).hide_skin(at, normals, dressed, triangles);
            if let (Some(cover), Some(tuck)) = (into, tuck.as_ref()) {
                let tucked = cover.hide_skin(at, normals, &tuck.particles, &picked(triangles, &under.drawn));
                under = DrawnSkin {
                    drawn: tucked.drawn.iter().map(|i| under.drawn[*i as usize]).collect(),
                    hidden_m: under.hidden_m.max(tucked.hidden_m),
                };
            }
            self.hidden_m = self.hidden_m.max(under.hidden_m);
            *drawn = picked(triangles, &under.drawn);
            *drawn_look = look.of_triangles(&under.drawn);
            let beneath = |t: &[u32; 3]| tuck.as_ref().filter(|tuck| tuck.holds(*t)).map(|tuck| tuck.into);
            over.extend(triangles.iter().map(|t| (t.map(|v| at[v as usize]), beneath(t))));
        }
        skin.read(&mut self.body, &mut self.normals);
        self.head.place(&mut self.body, &mut self.normals);
        self.bounds = Bounds::of(&self.body);
        let cover = CoveringCloth::new(over.into_iter().map(|(face, _)| face));
        let under = cover.hide_skin(&mut self.body, &self.normals, &self.dressed, &self.body_triangles);
        self.hidden_m = self.hidden_m.max(under.hidden_m);
        self.drawn = picked(&self.body_triangles, &under.drawn);
        self.drawn_base = self.base.of_triangles(&under.drawn);
    }

    /// How far skin, or cloth worn beneath other cloth, stood out of what covers it at most, in all pictures so far (m):
    /// what these pictures hide.
    pub fn hidden_m(&self) -> f32 {
        self.hidden_m
    }

    /// The surfaces of a picture; `map` gives each garment its colours by vertex instead of the fabric's.
    pub fn surfaces<'a>(&'a self, map: Option<&'a [Vec<f32>]>) -> Vec<PictureSurface<'a>> {
        let mut surfaces = vec![PictureSurface {
            positions: &self.body,
            normals: &self.normals,
            triangles: &self.drawn,
            colours: Colours::One(self.skin),
            material: Material::Skin,
            look: Some(self.base.shown_with(&self.drawn_base)),
        }];
        for (i, cloth) in self.cloths.iter().enumerate() {
            let DrawnGarment { points, normals, drawn: triangles, look, drawn_look, .. } = cloth;
            let (colours, material, look) = match map {
                Some(map) => (Colours::Tightness(&map[i]), Material::Diffuse, None),
                None => (Colours::One(cloth.colour), Material::Cloth, Some(look.shown_with(drawn_look))),
            };
            surfaces.push(PictureSurface { positions: points, normals, triangles, colours, material, look });
        }
        surfaces
    }

    /// A camera before the place where the shopper stands, for frames of one size; it never turns and never zooms.
    pub fn follow(&mut self, size: Size) -> OrbitCamera {
        let now = (self.bounds.min + self.bounds.max) * 0.5;
        let middle = self.middle.map_or(now, |m| m.lerp(now, FOLLOW));
        self.middle = Some(middle);
        let reach = Vec3::new(HALF_REACH_M, 0.0, 0.2);
        let at = Vec3::new(middle.x, 0.0, middle.z);
        let shown = Bounds { min: at - reach, max: at + reach + Vec3::Y * self.stature * HEADROOM };
        OrbitCamera::front(&shown, size.width as f32 / size.height as f32)
    }
}

/// Some of a list of triangles, by their places.
fn picked(triangles: &[[u32; 3]], places: &[u32]) -> Vec<[u32; 3]> {
    places.iter().map(|i| triangles[*i as usize]).collect()
}

/// A garment as what is beneath it sees it.
fn cover(triangles: &[[u32; 3]], points: &[Vec3]) -> CoveringCloth {
    CoveringCloth::new(triangles.iter().map(|t| t.map(|v| points[v as usize])))
}

/// A picture of a frame as it lies in a snapshot, seen from `yaw` (rad).
pub fn still(mut drawn: DrawnFrame, snapshot: &Snapshot, yaw: f32, size: Size) -> Image {
    drawn.update(snapshot);
    let surfaces = drawn.surfaces(None);
    let scene = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    let camera = OrbitCamera::framing(&scene.bounds(), yaw, size.width as f32 / size.height as f32);
    scene.render(&camera, size, TraceQuality::Still)
}
