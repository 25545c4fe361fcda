//! A base body as it is drawn, from all sides and near to: one PNG file a view. With `DRAWINGS=FOLDER` the drawings are read from
//! there instead of from `assets/sculpt/data`.

use std::{error::Error, fs::File, io::BufWriter, path::Path, time::Instant};

use glam::Vec3;
use toile_base::mesh::vertex_normals;
use toile_sculpt::{Drawn, draw};
use toile_view::{
    contact_sheet,
    image::{Image, Size},
    scene::{Colours, MANNEQUIN, Material, OrbitCamera, PictureScene, PictureSurface},
    trace::{TraceQuality, TracedScene},
};

/// A view: name, target as shares of the stature (x, y, z), height of what is seen (share), turns (degrees), height of the
/// eye as a share of its distance, field of view (rad).
type View = (&'static str, [f32; 3], f32, &'static [f32], f32, f32);

const VIEWS: [View; 11] = [
    ("whole", [0.0, 0.5, 0.0], 1.12, &[0.0, 40.0, 90.0, 140.0, 180.0], 0.1, 0.42),
    ("face", [0.0, 0.925, 0.02], 0.19, &[0.0, 40.0, 90.0, 150.0], 0.05, 0.42),
    ("hand", [0.35, 0.555, 0.02], 0.19, &[0.0, 45.0, 90.0, 180.0, 265.0], 0.1, 0.8),
    ("foot", [0.06, 0.04, 0.02], 0.17, &[0.0, 45.0, 90.0, 150.0, 180.0], 0.35, 0.6),
    ("shoulder", [0.09, 0.76, 0.0], 0.24, &[0.0, 45.0, 180.0, 225.0], 0.1, 0.42),
    ("armpit", [0.1, 0.75, 0.0], 0.2, &[0.0, 30.0, 180.0], -0.9, 0.42),
    ("hips", [0.0, 0.52, 0.0], 0.3, &[0.0, 45.0, 90.0, 135.0, 180.0], 0.0, 0.42),
    ("crotch", [0.0, 0.48, 0.0], 0.2, &[0.0, 45.0, 135.0, 180.0], -0.45, 0.6),
    ("chest", [0.0, 0.7, 0.0], 0.36, &[0.0, 45.0, 90.0, 135.0, 180.0], 0.05, 0.42),
    ("knee", [0.055, 0.25, 0.0], 0.36, &[0.0, 60.0, 90.0, 180.0, 225.0], 0.0, 0.42),
    ("elbow", [0.22, 0.67, 0.0], 0.24, &[0.0, 90.0, 180.0], 0.3, 0.42),
];

/// Writes the wanted views of the wanted bodies; all of them where none is named.
pub fn write_all(folder: &str, wanted: &[String]) -> Result<(), Box<dyn Error>> {
    let asked = |name: &str| wanted.iter().any(|w| w == name);
    for sex in ["female", "male"] {
        if !asked(sex) && (asked("female") || asked("male")) {
            continue;
        }
        let drawings = std::env::var("DRAWINGS").unwrap_or_else(|_| "assets/sculpt/data".to_owned());
        let text = std::fs::read_to_string(Path::new(&drawings).join(sex).with_extension("toml"))?;
        let start = Instant::now();
        let drawn = draw(&text)?;
        eprintln!("{sex}: {} quads drawn in {:.2} s", drawn.quads.len(), start.elapsed().as_secs_f32());
        let any = VIEWS.iter().any(|v| asked(v.0));
        for view in VIEWS.iter().filter(|v| !any || asked(v.0)) {
            let image = picture(&drawn, view, asked("wire"));
            let path = Path::new(folder).join(format!("{sex}-{}.png", view.0));
            image.write_png(&mut BufWriter::new(File::create(path)?))?;
        }
    }
    Ok(())
}

fn picture(drawn: &Drawn, &(_, target, tall, turns, tilt, fov_y): &View, checks: bool) -> Image {
    let mut triangles: Vec<[u32; 3]> = drawn.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mut positions = drawn.positions.clone();
    let mut normals = vec![Vec3::ZERO; positions.len()];
    vertex_normals(&positions, &triangles, &mut normals);
    let mut colours = vec![MANNEQUIN; positions.len()];
    if checks {
        // Every other quad is darker: the grid shows.
        (positions, normals, triangles, colours) = chequered(drawn, &positions, &normals);
    }
    let surface = PictureSurface {
        positions: &positions,
        normals: &normals,
        triangles: &triangles,
        colours: Colours::PerVertex(&colours),
        material: Material::Skin,
        look: None,
    };
    let surfaces = [surface];
    let stage = TracedScene::build(PictureScene { surfaces: &surfaces, floor: tilt >= 0.0 });
    let stature = positions.iter().map(|p| p.y).fold(0.0, f32::max);
    let size = if tall > 1.0 { Size::new(560, 900) } else { Size::new(560, 560) };
    let images: Vec<Image> = turns
        .iter()
        .map(|turn| {
            let distance = 0.5 * tall * stature / (0.5 * fov_y).tan();
            let camera = OrbitCamera {
                target: Vec3::from(target) * stature,
                yaw: turn.to_radians(),
                height: distance * tilt,
                distance,
                fov_y,
            };
            stage.render_on(2, &camera, size, TraceQuality::Motion).0
        })
        .collect();
    contact_sheet::contact_sheet(&images.iter().collect::<Vec<_>>(), turns.len(), &vec![""; turns.len()])
}

type Soup = (Vec<Vec3>, Vec<Vec3>, Vec<[u32; 3]>, Vec<Vec3>);

/// Quads apart, with their edges darkened by a smaller quad inside each.
fn chequered(drawn: &Drawn, positions: &[Vec3], normals: &[Vec3]) -> Soup {
    let mut soup: Soup = Default::default();
    for q in &drawn.quads {
        let middle = q.iter().map(|&v| positions[v as usize]).sum::<Vec3>() * 0.25;
        let first = soup.0.len() as u32;
        for (inner, colour) in [(0.0, MANNEQUIN * 0.25), (0.12, MANNEQUIN)] {
            for &v in q {
                soup.0.push(positions[v as usize].lerp(middle, inner));
                soup.1.push(normals[v as usize]);
                soup.3.push(colour);
            }
        }
        for k in 0..4 {
            let n = (k + 1) % 4;
            soup.2.extend([[first + k, first + n, first + 4 + n], [first + k, first + 4 + n, first + 4 + k]]);
        }
        soup.2.extend([[first + 4, first + 5, first + 6], [first + 4, first + 6, first + 7]]);
    }
    soup
}
