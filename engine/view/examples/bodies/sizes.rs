//! Bodies of clothes sizes, and at the ends of what people measure, from four sides: five PNG files. `bodies.png` has the EN
//! sizes 34, 42, 50 and 46, 52, 58 side by side; for each sex there are these sizes from all sides, and the short and
//! tall, slight and stout of the 1st and 99th percentile of ANSUR II.

use std::{error::Error, fs::File, io::BufWriter, path::Path};

use toile_assets::body::{Ansur, En, Wanted};
use toile_base::body::{Body, Sex};
use toile_view::{
    contact_sheet,
    image::{Image, Size},
    scene::{Colours, MANNEQUIN, Material, OrbitCamera, PictureScene, PictureSurface},
    trace::{TraceQuality, TracedScene},
};

const TURNS: [f32; 4] = [0.0, 45.0, 90.0, 180.0];

/// From the front, a quarter turned.
const QUARTER: f32 = 28.0;

/// Pictures of one body's sides, and of the six together.
const SIDES: Size = Size::new(400, 620);
const TOGETHER: Size = Size::new(310, 440);

/// Deviations of the 99th percentile.
const FAR: f32 = 2.326;

/// Mean and deviation of stature, chest, waist at the navel and buttocks in ANSUR II (m): women, men.
const PEOPLE: [[[f32; 2]; 4]; 2] = [
    [[1.6285, 0.0642], [0.9469, 0.0827], [0.8609, 0.0999], [1.0212, 0.0759]],
    [[1.7562, 0.0685], [1.0587, 0.0874], [0.9406, 0.1117], [1.0195, 0.0767]],
];

/// Label, bust or chest, waist and hip girth (m) of EN 13402-3's sizes: women, men (whose hips follow their waists).
const SIZES: [[(&str, f32, f32, f32); 3]; 2] = [
    [("34", 0.80, 0.64, 0.88), ("42", 0.96, 0.80, 1.04), ("50", 1.16, 1.02, 1.22)],
    [("46", 0.92, 0.80, 0.94), ("52", 1.04, 0.92, 1.06), ("58", 1.16, 1.08, 1.18)],
];

/// Writes the pictures of all sizes.
pub fn write_all(folder: &str) -> Result<(), Box<dyn Error>> {
    let mut six = Vec::new();
    for (sex, name) in [(Sex::Female, "women"), (Sex::Male, "men")] {
        let mut sizes = Vec::new();
        for (code, bust, waist, hip) in SIZES[usize::from(sex == Sex::Male)] {
            let stature = if sex == Sex::Female { 1.68 } else { 1.78 };
            let wanted = Wanted::new()
                .with(En::Stature, stature)
                .with(En::BustGirth, bust)
                .with(En::WaistGirth, waist)
                .with(En::HipGirth, hip);
            sizes.push((format!("EN {code}"), toile_assets::body::fitted(sex, &wanted)?.body));
        }
        write(folder, &format!("{name}-sizes"), &sizes)?;
        six.extend(sizes.into_iter().map(|(code, body)| (format!("{name} {code}"), body)));
        let mut ends = Vec::new();
        for (tall, stout) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            let [stature, girths @ ..] = PEOPLE[usize::from(sex == Sex::Male)];
            let at = |[mean, deviation]: [f32; 2], by: f32| mean + by * FAR * deviation;
            let wanted = Wanted::new()
                .with(Ansur::Stature, at(stature, tall))
                .with(Ansur::ChestCircumference, at(girths[0], stout))
                .with(Ansur::WaistCircumferenceOmphalion, at(girths[1], stout))
                .with(Ansur::ButtockCircumference, at(girths[2], stout));
            let words = [["short", "tall"][usize::from(tall > 0.0)], ["slight", "stout"][usize::from(stout > 0.0)]];
            ends.push((words.join(", "), toile_assets::body::fitted(sex, &wanted)?.body));
        }
        write(folder, &format!("{name}-ends"), &ends)?;
    }
    let images: Vec<Image> = six.iter().map(|(_, body)| picture(body, QUARTER, TOGETHER)).collect();
    let captions: Vec<&str> = six.iter().map(|(name, _)| name.as_str()).collect();
    save(folder, "bodies", &contact_sheet::contact_sheet(&images.iter().collect::<Vec<_>>(), SIZES[0].len(), &captions))
}

/// One row a body, one column a side.
fn write(folder: &str, name: &str, bodies: &[(String, Body)]) -> Result<(), Box<dyn Error>> {
    let images: Vec<Image> = bodies.iter().flat_map(|(_, body)| TURNS.map(|turn| picture(body, turn, SIDES))).collect();
    let captions: Vec<&str> = bodies.iter().flat_map(|(name, _)| [name.as_str(), "", "", ""]).collect();
    save(folder, name, &contact_sheet::contact_sheet(&images.iter().collect::<Vec<_>>(), TURNS.len(), &captions))
}

fn save(folder: &str, name: &str, sheet: &Image) -> Result<(), Box<dyn Error>> {
    let path = Path::new(folder).join(name).with_extension("png");
    sheet.write_png(&mut BufWriter::new(File::create(path)?))?;
    Ok(())
}

fn picture(body: &Body, turn: f32, size: Size) -> Image {
    let colours = vec![MANNEQUIN; body.mesh.positions.len()];
    let surfaces = [PictureSurface {
        positions: &body.mesh.positions,
        normals: &body.normals,
        triangles: &body.mesh.triangles,
        colours: Colours::PerVertex(&colours),
        material: Material::Skin,
        look: None,
    }];
    let stage = TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    // The same camera for all, so that sizes can be compared.
    let camera = OrbitCamera {
        target: glam::Vec3::new(0.0, 0.93, 0.0),
        yaw: turn.to_radians(),
        height: 0.2,
        distance: 4.9,
        fov_y: 0.42,
    };
    stage.render_on(2, &camera, size, TraceQuality::Motion).0
}
