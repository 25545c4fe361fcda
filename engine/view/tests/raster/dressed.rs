//! A dressed mannequin, for both ways of drawing: shared by the tests of the rasteriser and its example.

use glam::Vec3;
use toile_assets::drafting;
use toile_base::body::{Body, Measures, Sex};
use toile_base::garment::Garment;
use toile_base::mesh::vertex_normals;
use toile_view::hidden_skin::CoveringCloth;
use toile_view::image::linear;
use toile_view::raster::{self, Model, RenderSurface, Renderer};
use toile_view::scene::{Bounds, Colours, MANNEQUIN, Material, PictureSurface};

/// Body and garment as they are drawn: the skin tucked beneath the cloth.
pub struct Dressed {
    pub body: Vec<Vec3>,
    pub body_normals: Vec<Vec3>,
    pub body_triangles: Vec<[u32; 3]>,
    pub garment: Garment,
    pub cloth_normals: Vec<Vec3>,
    pub colour: Vec3,
    /// A figure of fit a vertex of the garment, from loose above to tight below.
    pub fit: Vec<f32>,
}

/// A woman of middle size.
pub fn wearer() -> Body {
    let measures =
        Measures { stature: 1.68, shoulder_breadth: 0.38, chest_girth: 0.90, waist_girth: 0.74, hip_girth: 0.98 };
    toile_assets::body::build(Sex::Female, &measures).expect("a usual body is built")
}

impl Dressed {
    /// A garment of the wardrobe on her.
    pub fn new(name: &str, size: &str) -> Self {
        Self::in_fabric(name, &drafting::package(name).expect("the wardrobe has it").fabric, size)
    }

    /// The same in another fabric that is built in.
    pub fn in_fabric(name: &str, fabric: &str, size: &str) -> Self {
        let body = wearer();
        let package = drafting::package(name).expect("the wardrobe has it");
        let fabric = toile_assets::fabric::built_in(fabric).expect("it is built in");
        let garment = package.dress_in(&fabric, size, &body).expect("it is made in this size");
        let mut cloth_normals = vec![Vec3::ZERO; garment.particles()];
        vertex_normals(&garment.start, &garment.triangles, &mut cloth_normals);
        let cover = CoveringCloth::new(garment.triangles.iter().map(|t| t.map(|i| garment.start[i as usize])));
        let mut positions = body.mesh.positions.clone();
        let dressed = cover.dressed(&positions, &body.normals);
        let under = cover.hide_skin(&mut positions, &body.normals, &dressed, &body.mesh.triangles);
        let body_triangles = under.drawn.iter().map(|t| body.mesh.triangles[*t as usize]).collect();
        let Bounds { min, max } = Bounds::of(&garment.start);
        let fit =
            garment.start.iter().map(|p| (1.5 - 3.0 * (p.y - min.y) / (max.y - min.y)).clamp(-1.0, 1.0)).collect();
        Self {
            body: positions,
            body_normals: body.normals.clone(),
            body_triangles,
            cloth_normals,
            colour: Vec3::from_array(garment.fabric.colour.map(linear)),
            fit,
            garment,
        }
    }

    /// The surfaces as the ray tracer takes them.
    pub fn surfaces(&self, map: bool) -> [PictureSurface<'_>; 2] {
        let (colours, material) = match map {
            true => (Colours::Tightness(&self.fit), Material::Diffuse),
            false => (Colours::One(self.colour), Material::Cloth),
        };
        let skin = PictureSurface {
            positions: &self.body,
            normals: &self.body_normals,
            triangles: &self.body_triangles,
            colours: Colours::One(MANNEQUIN),
            material: Material::Skin,
            look: None,
        };
        let cloth = PictureSurface {
            positions: &self.garment.start,
            normals: &self.cloth_normals,
            triangles: &self.garment.triangles,
            colours,
            material,
            look: None,
        };
        [skin, cloth]
    }

    /// The same as the rasteriser takes them.
    pub fn model(&self) -> Model {
        let skin = RenderSurface {
            rest: self.body.clone(),
            look: None,
            triangles: self.body_triangles.clone(),
            colour: MANNEQUIN,
            material: raster::RenderMaterial::Skin,
        };
        let cloth = RenderSurface {
            rest: self.garment.start.to_vec(),
            look: None,
            triangles: self.garment.triangles.to_vec(),
            colour: self.colour,
            material: raster::RenderMaterial::Cloth((&self.garment.fabric).into()),
        };
        Model { surfaces: vec![skin, cloth] }
    }

    /// Hands the model to a renderer.
    pub fn put_on(&self, renderer: &mut Renderer, map: bool) {
        renderer.set_model(&self.model()).expect("the model is whole");
        renderer.update(0, &self.body, &self.body_normals).expect("as many as there are");
        renderer.update(1, &self.garment.start, &self.cloth_normals).expect("as many as there are");
        renderer.set_fit(1, map.then_some(&self.fit[..])).expect("one for each");
    }

    /// The box around what is drawn.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(&self.body).union(Bounds::of(&self.garment.start))
    }
}
