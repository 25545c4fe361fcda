//! Printed, sewn and sheer cloth by both ways of drawing.

use glam::{Vec2, Vec3};
use toile_bake::Shape;
use toile_bake::bake;
use toile_base::fabric::Fabric;
use toile_base::garment::Garment;
use toile_base::garment::trim::{ClothTrim, TrimKind};
use toile_base::mesh::vertex_normals;
use toile_view::cloth_look::GarmentLook;
use toile_view::image::{Image, linear};
use toile_view::raster::{Model, RenderSurface, Renderer};
use toile_view::scene::{Bounds, Colours, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace;

use super::{FINE, SIZE, gpu, pixels, shoot};

/// Squares along both sides of the sheet, and how long one is (m).
const SQUARES: u32 = 24;
const SPACING_M: f32 = 0.015;

/// A curved sheet of two panels that meet in the middle, each drawn at an origin of its own.
fn sheet(fabric: &Fabric, trims: Vec<ClothTrim>) -> Garment {
    let side = SQUARES + 1;
    let mut shape = Shape::sheet(side, side, |row, column| {
        let (x, y) = (column as f32 * SPACING_M, 1.0 - row as f32 * SPACING_M);
        (Vec3::new(x, y, 0.06 * (9.0 * x).sin()), row == 0)
    });
    let half = |face: usize| (face as u32 % SQUARES) / (SQUARES / 2);
    shape.panels = (0..shape.faces.len()).map(half).collect();
    let flat = |face: usize| {
        let (row, column) = (face as u32 / SQUARES + 1, face as u32 % SQUARES - half(face) * SQUARES / 2);
        let at = |r: u32, c: u32| Vec2::new(c as f32 * SPACING_M + 0.004 * half(face) as f32, -(r as f32 * SPACING_M));
        [at(row, column), at(row, column + 1), at(row - 1, column + 1), at(row - 1, column)]
    };
    shape.flat = (0..shape.faces.len()).map(flat).collect();
    shape.trims = trims;
    bake("sheet", "one", &shape, fabric).expect("a sheet is whole")
}

/// The sheet from the front by the ray tracer and by the rasteriser.
fn both(fabric: &Fabric) -> Option<[Image; 2]> {
    both_with(fabric, Vec::new())
}

/// The same with trims on it.
fn both_with(fabric: &Fabric, trims: Vec<ClothTrim>) -> Option<[Image; 2]> {
    let gpu = gpu()?;
    let garment = sheet(fabric, trims);
    let mut normals = vec![Vec3::ZERO; garment.particles()];
    vertex_normals(&garment.start, &garment.triangles, &mut normals);
    let look = GarmentLook::of(&garment);
    let surface = PictureSurface {
        positions: &garment.start,
        normals: &normals,
        triangles: &garment.triangles,
        colours: Colours::One(Vec3::from_array(fabric.colour.map(linear))),
        material: Material::Cloth,
        look: Some(look.shown()),
    };
    let camera = OrbitCamera::framing(&Bounds::of(&garment.start), 0.3, SIZE.width as f32 / SIZE.height as f32);
    let scene = PictureScene { surfaces: &[surface], floor: false };
    let theirs = trace::render(&scene, &camera, SIZE, trace::TraceQuality::Still);
    let mut renderer = Renderer::new(gpu, toile_view::raster::Offscreen::FORMAT, FINE);
    let surfaces = vec![RenderSurface::of_garment(&garment)];
    renderer.set_model(&Model { surfaces }).expect("the model is whole");
    renderer.update(0, &garment.start, &normals).expect("as many as there are");
    Some([theirs, shoot(gpu, &mut renderer, &camera)])
}

/// Where the sheet is: its middle, without the backdrop.
fn middle(image: &Image) -> Vec<Vec3> {
    let (width, height) = (SIZE.width as usize, SIZE.height as usize);
    let all = pixels(image);
    let inside = |i: &usize| {
        let (x, y) = (i % width, i / width);
        (width * 2 / 5..width * 3 / 5).contains(&x) && (height * 9 / 20..height * 11 / 20).contains(&y)
    };
    (0..all.len()).filter(inside).map(|i| all[i]).collect()
}

fn mean(of: &[Vec3]) -> Vec3 {
    of.iter().sum::<Vec3>() / of.len() as f32
}

fn spread(of: &[Vec3]) -> f32 {
    let mean = mean(of);
    (of.iter().map(|p| (*p - mean).length_squared()).sum::<f32>() / of.len() as f32).sqrt()
}

#[test]
fn a_print_lies_on_the_cloth_the_same_way_in_both_pictures() {
    let text = "name = \"check\"\ntitle = \"Check\"\nbase = \"cotton-lawn\"\ncolour = [0.9, 0.9, 0.9]\n\
        [print]\npattern = \"gingham\"\ncolours = [[0.1, 0.2, 0.6]]\nrepeat_mm = [60.0, 90.0]\n";
    let printed = toile_assets::fabric::parse("check", text).unwrap();
    let Some([theirs, ours]) = both(&printed) else { return };
    let (theirs, ours) = (middle(&theirs), middle(&ours));
    let off = theirs.iter().zip(&ours).map(|(a, b)| (*a - *b).length()).sum::<f32>() / ours.len() as f32;
    println!("spread {:.1} and {:.1}, {off:.2} apart in the mean", spread(&theirs), spread(&ours));
    assert!(spread(&theirs) > 40.0 && spread(&ours) > 40.0, "the print is seen");
    assert!(off < 9.0, "both show the print in the same places: {off} of 255 apart");
}

#[test]
fn the_seam_between_two_panels_is_a_dark_line_in_both() {
    let Some(both) = both(&toile_assets::fabric::built_in("cotton-lawn").unwrap()) else { return };
    for (name, image) in ["traced", "drawn"].iter().zip(&both) {
        let all = pixels(image);
        let row = |y: usize| &all[y * SIZE.width as usize..(y + 1) * SIZE.width as usize];
        // In the row through the middle: the darkest pixel beside those four pixels off.
        let row = row(SIZE.height as usize / 2);
        let dip = |x: usize| 0.5 * (row[x - 4].y + row[x + 4].y) - row[x].y;
        let deepest = (SIZE.width as usize * 2 / 5..SIZE.width as usize * 3 / 5).map(dip).fold(0.0, f32::max);
        println!("{name}: the seam is {deepest:.1} of 255 darker");
        assert!(deepest > 6.0, "{name}: {deepest}");
    }
}

#[test]
fn a_button_and_a_strip_over_the_seam_are_seen_in_both() {
    let (white, dark) = ([0.9; 3], [0.02; 3]);
    let fabric = Fabric { colour: white, ..toile_assets::fabric::built_in("cotton-lawn").unwrap() };
    // The seam is the right border of the first panel and the left one of the second, 4 mm off there.
    let [seam, there] = [0.18, 0.004];
    let row = -0.5 * 24.0 * SPACING_M;
    let on = |panel, kind, x: f32, half, ends: [f32; 2]| ClothTrim {
        panel,
        kind,
        ends: ends.map(|y| Vec2::new(x, row + y)),
        half,
        colour: dark,
    };
    let halves = [(0, seam), (1, there)];
    let button: Vec<ClothTrim> = halves.iter().map(|(p, x)| on(*p, TrimKind::Button, *x, 0.02, [0.0, 0.001])).collect();
    let strip = halves.iter().map(|(p, x)| on(*p, TrimKind::Strip, *x, 0.02, [-0.1, 0.1])).collect();
    let middle_row = |image: &Image| {
        let all = pixels(image);
        let (width, y) = (SIZE.width as usize, SIZE.height as usize / 2);
        all[y * width + width * 2 / 5..y * width + width * 3 / 5].iter().map(|p| p.y).collect::<Vec<f32>>()
    };
    let least = |row: &[f32]| row.iter().copied().fold(f32::MAX, f32::min);
    let (Some(plain), Some(buttoned), Some(hidden)) =
        (both(&fabric), both_with(&fabric, button), both_with(&fabric, strip))
    else {
        return;
    };
    for (k, name) in ["traced", "drawn"].into_iter().enumerate() {
        let [plain, buttoned, hidden] = [&plain, &buttoned, &hidden].map(|images| middle_row(&images[k]));
        let width = buttoned.iter().filter(|v| **v < 110.0).count();
        println!("{name}: a button {width} pixels wide, {:.0} dark", least(&buttoned));
        assert!(width > 3 && width < 40, "{name}: {width} pixels are dark");
        // Where the strip lies, the seam is no longer a line: in the middle it is as light as beside it.
        let at_seam = plain.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
        let dip = |row: &[f32]| 0.5 * (row[at_seam - 3] + row[at_seam + 3]) - row[at_seam];
        println!("{name}: the seam {:.1} deep, beneath the strip {:.1}", dip(&plain), dip(&hidden));
        assert!(dip(&hidden) < 0.5 * dip(&plain), "{name}: {} beside {}", dip(&hidden), dip(&plain));
    }
}

#[test]
fn sheer_cloth_lets_the_wall_behind_it_be_seen() {
    let opaque = Fabric { colour: [0.1, 0.1, 0.5], ..toile_assets::fabric::built_in("cotton-lawn").unwrap() };
    let sheer = Fabric { opacity: 0.5, ..opaque.clone() };
    let (Some(solid), Some(through)) = (both(&opaque), both(&sheer)) else { return };
    for k in 0..2 {
        let (solid, through) = (mean(&middle(&solid[k])), mean(&middle(&through[k])));
        println!("{k}: {solid:.0} and {through:.0}");
        assert!(through.x > solid.x + 30.0, "the light wall behind shows: {through} beside {solid}");
    }
}
