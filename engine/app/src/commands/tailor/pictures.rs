//! Pictures of a pattern on its way: flat panels, panels around the body, draped cloth.

use std::f32::consts::PI;
use std::fmt::Write;

use glam::Vec3;
use toile_assets::draping::DrapedPattern;
use toile_bake::Shape;
use toile_bake::check::corners;
use toile_base::fabric::Fabric;
use toile_base::mesh::vertex_normals;
use toile_cli::exit::AppError;
use toile_cli::output::OutputFolder;
use toile_cli::picture::write_png;
use toile_view::cloth_look::GarmentLook;
use toile_view::contact_sheet;
use toile_view::figure::Figure;
use toile_view::image::{Image, Size, linear};
use toile_view::scene::{Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

/// A picture of one side.
const STILL: Size = Size::new(480, 800);

/// Pixels a metre of the flat panels, the gap between them and their widest row (m).
const PIXELS: f64 = 800.0;
const GAP_M: f64 = 0.04;
const ROW_M: f64 = 2.0;

/// Draws all of them.
pub fn draw(out: &mut OutputFolder, draped: &DrapedPattern, figure: &Figure, fabric: &Fabric) -> Result<(), AppError> {
    out.write("flat.svg", flat(draped).as_bytes())?;
    let placed = &draped.placed;
    let look = |shape: &Shape| GarmentLook::new(&toile_bake::look::look_of(shape), fabric);
    let colour = Vec3::from_array(fabric.colour.map(linear));
    let before = Cloth { at: &placed.worn, triangles: &placed.triangles(), colour, look: look(placed) };
    write_png(out, "placed.png", &sides(figure, &before, "Around the body"))?;
    let hanging = draped.hanging();
    let after = Cloth { at: &hanging.worn, triangles: &hanging.triangles(), colour, look: look(&hanging) };
    write_png(out, "draped.png", &sides(figure, &after, "Draped"))
}

/// Cloth as it lies.
struct Cloth<'a> {
    at: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    colour: Vec3,
    look: GarmentLook,
}

/// Front and back of a figure in cloth.
fn sides(figure: &Figure, cloth: &Cloth<'_>, title: &str) -> Image {
    let Cloth { at, triangles, colour, ref look } = *cloth;
    let mut normals = vec![Vec3::ZERO; at.len()];
    vertex_normals(at, triangles, &mut normals);
    let skin = PictureSurface {
        positions: &figure.rest,
        normals: &figure.normals,
        triangles: &figure.triangles,
        colours: Colours::One(figure.colour),
        material: Material::Skin,
        look: Some(figure.look.shown()),
    };
    let cloth = PictureSurface {
        positions: at,
        normals: &normals,
        triangles,
        colours: Colours::One(colour),
        material: Material::Cloth,
        look: Some(look.shown()),
    };
    let surfaces = [skin, cloth];
    let scene = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    let look = |yaw: f32| {
        let camera = OrbitCamera::framing(&scene.bounds(), yaw, STILL.width as f32 / STILL.height as f32);
        scene.render(&camera, STILL, TraceQuality::Still)
    };
    let (front, back) = (look(0.0), look(PI));
    contact_sheet::views(&[&front, &back], &["front", "back"], title)
}

/// The flat panels beside each other, sewn edges in red.
fn flat(draped: &DrapedPattern) -> String {
    let (mut body, mut x, mut y, mut height, mut width) = (String::new(), GAP_M, GAP_M, 0.0f64, 0.0f64);
    // Writing to a string cannot fail.
    for (p, mesh) in draped.sewn.panels.iter().enumerate() {
        let low = mesh.points.iter().copied().reduce(|a, b| a.min(b)).unwrap_or_default();
        let size = mesh.points.iter().copied().reduce(|a, b| a.max(b)).unwrap_or_default() - low;
        if x > GAP_M && x + size.x > ROW_M {
            (x, y, height) = (GAP_M, y + height + GAP_M, 0.0);
        }
        let place = |v: u32| {
            let at = mesh.points[v as usize] - low;
            format!("{:.1},{:.1}", (x + at.x) * PIXELS, (y + size.y - at.y) * PIXELS)
        };
        for face in &mesh.faces {
            let ring: Vec<String> = corners(face).iter().map(|v| place(*v)).collect();
            let colour = if ring.len() == 3 { "#f2d9a6" } else { "#bcd6f2" };
            let _ = writeln!(body, "<polygon points=\"{}\" fill=\"{colour}\"/>", ring.join(" "));
        }
        let sewn = |v: u32| draped.sewn.members[draped.sewn.number[p][v as usize] as usize].len() > 1;
        let count = mesh.boundary.points.len() as u32;
        for v in (0..count).filter(|v| sewn(*v) && sewn((*v + 1) % count)) {
            let _ = writeln!(
                body,
                "<polyline points=\"{} {}\" stroke=\"#c0392b\" stroke-width=\"3\"/>",
                place(v),
                place((v + 1) % count)
            );
        }
        x += size.x + GAP_M;
        height = height.max(size.y);
        width = width.max(x);
    }
    let (w, h) = (width * PIXELS, (y + height + GAP_M) * PIXELS);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.0}\" height=\"{h:.0}\" fill=\"none\" stroke=\"#8a8f98\" \
         stroke-width=\".6\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\" stroke=\"none\"/>\n{body}</svg>\n"
    )
}
