//! Photographs of garments for `toile collage`, as a shop takes them: drafts on a body of size 38, cut out, with their arm layers.
//!
//! `cargo run --release -p toile-view --example photographs [DIR]` writes a TOML file a garment and its pictures into DIR
//! (photographs by default); docs/collage.md lays them on other bodies.

use std::error::Error;
use std::f32::consts::{FRAC_PI_2, PI};
use std::fmt::Write;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};
use toile_assets::catalogue::FittingLevel;
use toile_assets::drafting;
use toile_base::body::{Body, Region};
use toile_base::garment::Garment;
use toile_base::mesh::vertex_normals;
use toile_view::cloth_look::GarmentLook;
use toile_view::image::Size;
use toile_view::scene::{Colours, MANNEQUIN, Material, OrbitCamera, PictureScene, PictureSurface};
use toile_view::trace::{TraceQuality, TracedScene};

/// Size of a photograph, samples along each side of a pixel, distance of the camera (m), height that it shows (m).
const SIZE: Size = Size::new(720, 1_080);
const SAMPLES: usize = 3;
const AWAY: f32 = 14.0;
const SHOWN: f32 = 1.86;

/// How far the body is drawn within its skin, so that no skin shows through cloth (m).
const WITHIN: f32 = 0.008;

/// Half of what is measured between the points (m).
const HALF: f32 = 0.15;

/// A garment: draft, layer, level, and the girths that it stretches to.
const GARMENTS: [(&str, &str, &str, FittingLevel, &str); 4] = [
    ("straight-skirt", "shirts", "waist", FittingLevel::Waist, "waist = [640, 800]\nhip = [880, 1060]"),
    ("tee", "tank-tops", "shoulders", FittingLevel::Shoulders, "chest = [800, 960]"),
    ("blazer", "jackets", "shoulders", FittingLevel::Shoulders, "chest = [820, 980]"),
    ("coat", "coats", "shoulders", FittingLevel::Shoulders, "chest = [820, 1000]"),
];

fn main() -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "photographs".to_owned()));
    fs::create_dir_all(&out)?;
    for (name, layer, word, level, limits) in GARMENTS {
        let style = drafting::style(name).ok_or("no such draft")?;
        let package = style.package()?;
        let body = package.body_of("38")?.ok_or("a size says what body it is for")?;
        let garment = package.dress("38", &body)?;
        let mut text =
            format!("name = \"{}\"\nlayer = \"{layer}\"\nlevel = \"{word}\"\n\n[stretches]\n{limits}\n", style.title());
        for (side, yaw) in [("front", 0.0), ("side", FRAC_PI_2), ("back", PI)] {
            let shot = Photograph::take(&body, &garment, yaw, level);
            let sleeves = shot.arms.iter().any(|a| *a > 0.0);
            shot.write(&out, &format!("{name}-{side}"), sleeves)?;
            let row = SIZE.height as f32 * 0.5 - (level.height(&body.levels) - 0.5 * SHOWN) * per_metre();
            // The middle of the body is seen in the middle of the picture from the front and behind, from the side where its trunk is.
            let middle = 0.5 * SIZE.width as f32 + if side == "side" { shot.middle } else { 0.0 };
            let [left, right] = [-HALF, HALF].map(|x| middle + x * per_metre());
            write!(text, "\n[{side}]\npicture = \"{name}-{side}.png\"\n")?;
            if sleeves {
                writeln!(text, "arms = \"{name}-{side}-arms.png\"")?;
            }
            writeln!(
                text,
                "points = [[{left:.1}, {row:.1}], [{right:.1}, {row:.1}]]\ndistance_mm = {}",
                2000.0 * HALF
            )?;
        }
        fs::write(out.join(format!("{name}.toml")), text)?;
    }
    Ok(())
}

fn per_metre() -> f32 {
    SIZE.height as f32 / SHOWN
}

/// A garment, cut out.
struct Photograph {
    /// Colour and opacity of each pixel.
    pixels: Vec<[u8; 4]>,
    /// How much of it lies on an arm.
    arms: Vec<f32>,
    /// Where the trunk's middle is at the garment's level, right of the picture's (px).
    middle: f32,
}

impl Photograph {
    fn take(body: &Body, garment: &Garment, yaw: f32, level: FittingLevel) -> Self {
        let skin: Vec<Vec3> = body.mesh.positions.iter().zip(&body.normals).map(|(p, n)| *p - *n * WITHIN).collect();
        let mut normals = vec![Vec3::ZERO; garment.start.len()];
        vertex_normals(&garment.start, &garment.triangles, &mut normals);
        let look = GarmentLook::of(garment);
        let target = Vec3::new(0.0, 0.5 * SHOWN, 0.0);
        let camera = OrbitCamera { target, yaw, height: 0.0, distance: AWAY, fov_y: 2.0 * (0.5 * SHOWN / AWAY).atan() };
        let colour = Vec3::from_array(garment.fabric.colour.map(toile_view::image::linear));
        let surfaces = [
            PictureSurface {
                positions: &skin,
                normals: &body.normals,
                triangles: &body.mesh.triangles,
                colours: Colours::One(MANNEQUIN),
                material: Material::Skin,
                look: None,
            },
            PictureSurface {
                positions: &garment.start,
                normals: &normals,
                triangles: &garment.triangles,
                colours: Colours::One(colour),
                material: Material::Cloth,
                look: Some(look.shown()),
            },
        ];
        let image = TracedScene::build(PictureScene { surfaces: &surfaces, floor: false }).render(
            &camera,
            SIZE,
            TraceQuality::Still,
        );
        let seen = Seen::of(body, &skin, garment, yaw);
        let (w, h) = (SIZE.width as usize, SIZE.height as usize);
        let whole = |i: usize| seen.cover[i] > 0.999;
        let pixels = (0..w * h).map(|i| {
            // At the edge a pixel has half of the wall's colour: it takes that of the nearest one that has none.
            let (x, y) = ((i % w) as i64, (i / w) as i64);
            let around = (-3..=3i64).flat_map(|dy| (-3..=3i64).map(move |dx| (dx, dy)));
            let inside = around
                .filter(|(dx, dy)| (0..w as i64).contains(&(x + dx)) && (0..h as i64).contains(&(y + dy)))
                .filter(|(dx, dy)| whole(((y + dy) * w as i64 + x + dx) as usize))
                .min_by_key(|(dx, dy)| dx * dx + dy * dy);
            let (dx, dy) = inside.unwrap_or((0, 0));
            let [r, g, b] = image.pixel((x + dx) as u32, (y + dy) as u32).unwrap_or_default();
            let opacity = if inside.is_some() { seen.cover[i] } else { 0.0 };
            [r, g, b, (255.0 * opacity).round() as u8]
        });
        let is_arm = |r: &Region| matches!(r, Region::LeftArm | Region::RightArm);
        let trunk = body.mesh.positions.iter().zip(&body.regions).filter(|(_, r)| !is_arm(r));
        let near = trunk.filter(|(p, _)| (p.y - level.height(&body.levels)).abs() < 0.01).map(|(p, _)| p.z);
        let (low, high) = near.fold((f32::MAX, f32::MIN), |(l, h), z| (l.min(z), h.max(z)));
        Self { pixels: pixels.collect(), arms: seen.arms, middle: -0.5 * (low + high) * per_metre() }
    }

    fn write(&self, folder: &Path, name: &str, sleeves: bool) -> Result<(), Box<dyn Error>> {
        let bytes: Vec<u8> = self.pixels.iter().flatten().copied().collect();
        png(&folder.join(format!("{name}.png")), png::ColorType::Rgba, &bytes)?;
        if sleeves {
            let bytes: Vec<u8> = self.arms.iter().map(|a| (255.0 * a.min(1.0)).round() as u8).collect();
            png(&folder.join(format!("{name}-arms.png")), png::ColorType::Grayscale, &bytes)?;
        }
        Ok(())
    }
}

fn png(path: &Path, colour: png::ColorType, bytes: &[u8]) -> Result<(), Box<dyn Error>> {
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(path)?), SIZE.width, SIZE.height);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(bytes)?;
    Ok(())
}

/// The cover of each pixel.
struct Seen {
    /// Share of the garment.
    cover: Vec<f32>,
    /// Share of what of it lies on an arm.
    arms: Vec<f32>,
}

impl Seen {
    fn of(body: &Body, skin: &[Vec3], garment: &Garment, yaw: f32) -> Self {
        let (w, h) = (SIZE.width as usize * SAMPLES, SIZE.height as usize * SAMPLES);
        let mut depth = vec![f32::INFINITY; w * h];
        let mut first = vec![0u8; w * h];
        let (sin, cos) = yaw.sin_cos();
        let place = |p: &Vec3| {
            let z = AWAY - (p.x * sin + p.z * cos);
            let scale = per_metre() * SAMPLES as f32 * AWAY / z;
            let at = Vec2::new(p.x * cos - p.z * sin, 0.5 * SHOWN - p.y) * scale;
            (at + 0.5 * Vec2::new(w as f32, h as f32) - 0.5, z)
        };
        let sleeve = sleeves(body, garment);
        let mut draw = |positions: &[Vec3], triangles: &[[u32; 3]], kind: &dyn Fn(usize) -> u8| {
            let placed: Vec<(Vec2, f32)> = positions.iter().map(place).collect();
            for (t, corners) in triangles.iter().enumerate() {
                let [(a, za), (b, zb), (c, zc)] = corners.map(|v| placed[v as usize]);
                let area = (b - a).perp_dot(c - a);
                let low = a.min(b).min(c).max(Vec2::ZERO).ceil();
                let high = a.max(b).max(c).min(Vec2::new(w as f32 - 1.0, h as f32 - 1.0)).floor();
                if area.abs() < 1e-9 || !(low.x <= high.x && low.y <= high.y) {
                    continue;
                }
                for y in low.y as usize..=high.y as usize {
                    for x in low.x as usize..=high.x as usize {
                        let p = Vec2::new(x as f32, y as f32);
                        let (wb, wc) = ((p - a).perp_dot(c - a) / area, (b - a).perp_dot(p - a) / area);
                        let wa = 1.0 - wb - wc;
                        let z = wa * za + wb * zb + wc * zc;
                        if wa >= 0.0 && wb >= 0.0 && wc >= 0.0 && z < depth[y * w + x] {
                            (depth[y * w + x], first[y * w + x]) = (z, kind(t));
                        }
                    }
                }
            }
        };
        draw(skin, &body.mesh.triangles, &|_| 0);
        draw(&garment.start, &garment.triangles, &|t| 1 + u8::from(sleeve[t]));
        let each = 1.0 / (SAMPLES * SAMPLES) as f32;
        let mut seen = Self { cover: vec![0.0; w * h / SAMPLES / SAMPLES], arms: vec![0.0; w * h / SAMPLES / SAMPLES] };
        for (i, kind) in first.iter().enumerate().filter(|(_, k)| **k > 0) {
            let at = i / w / SAMPLES * SIZE.width as usize + i % w / SAMPLES;
            seen.cover[at] += each;
            seen.arms[at] += if *kind == 2 { each } else { 0.0 };
        }
        seen
    }
}

/// Whether each triangle of a garment lies on an arm: nearest to skin of one.
fn sleeves(body: &Body, garment: &Garment) -> Vec<bool> {
    let on_arm: Vec<bool> = garment
        .start
        .iter()
        .map(|p| {
            let skin = body.mesh.positions.iter().zip(&body.regions);
            let nearest = skin.min_by(|a, b| a.0.distance_squared(*p).total_cmp(&b.0.distance_squared(*p)));
            nearest.is_some_and(|(_, r)| matches!(r, Region::LeftArm | Region::RightArm))
        })
        .collect();
    garment.triangles.iter().map(|t| t.iter().filter(|v| on_arm[**v as usize]).count() >= 2).collect()
}
