//! A mannequin in a rippling skirt, made of formulas: three views, the fit map, and one turn as an animation.
//!
//! `cargo run --release -p toile-view --example render_stills [FOLDER]` writes PNG files into the folder (here by default) and
//! what they cost to standard error.

use std::{
    error::Error,
    f32::consts::TAU,
    fs::File,
    io::BufWriter,
    path::{Path, PathBuf},
    time::Instant,
};

use glam::{Vec2, Vec3};
use toile_assets::mesh::vertex_normals;
use toile_view::{
    contact_sheet, fit_map,
    image::{Animation, Image, Size},
    scene::{Camera, Colours, MANNEQUIN, Material, Scene, Surface},
    trace::{TraceCost, TraceQuality, TracedScene},
};

const STILL: Size = Size::new(480, 800);
const MOTION: Size = Size::new(220, 360);
const FRAMES: u32 = 24;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_owned()));
    let body = mannequin();
    let (skirt, flare) = skirt();

    let plain = [body.skin(), skirt.cloth(Colours::One(Vec3::new(0.055, 0.12, 0.24)), Material::Cloth)];
    let mapped = [body.skin(), skirt.cloth(Colours::Tightness(&flare), Material::Diffuse)];
    let legend = fit_map::legend(420, contact_sheet::PAPER);
    for (name, surfaces, legend) in [("skirt", &plain, None), ("fit", &mapped, Some(&legend))] {
        let [front, side, back] = views(surfaces);
        let title = "Flared skirt, size M\nwaist 700 mm, length 600 mm, light wool";
        write(&folder, name, &contact_sheet::triptych(&front, &side, &back, title, legend))?;
        write(&folder, &format!("{name}-front"), &front)?;
    }
    turn(&folder, &plain)
}

/// The three views, and what they took.
fn views(surfaces: &[Surface<'_>]) -> [Image; 3] {
    let start = Instant::now();
    let stage = TracedScene::build(Scene { surfaces, floor: true });
    eprintln!("tree: {:.1} ms", start.elapsed().as_secs_f32() * 1e3);
    let aspect = STILL.width as f32 / STILL.height as f32;
    let bounds = stage.bounds();
    [Camera::front, Camera::side, Camera::back]
        .map(|preset| timed("still", || stage.render_on(2, &preset(&bounds, aspect), STILL, TraceQuality::Still)).0)
}

fn timed(what: &str, work: impl FnOnce() -> (Image, TraceCost)) -> (Image, TraceCost) {
    let start = Instant::now();
    let (image, cost) = work();
    let seconds = start.elapsed().as_secs_f32();
    let rays = cost.rays as f32;
    eprintln!("{what}: {:.0} ms, {:.2} M rays, {:.2} M rays/s", seconds * 1e3, rays / 1e6, rays / seconds / 1e6);
    (image, cost)
}

/// One turn before the camera; the tree is built anew for each frame, as it is when the cloth moves.
fn turn(folder: &Path, surfaces: &[Surface<'_>]) -> Result<(), Box<dyn Error>> {
    let file = BufWriter::new(File::create(folder.join("turn.png"))?);
    let mut animation = Animation::new(file, MOTION, FRAMES, 12)?;
    for frame in 0..FRAMES {
        let (image, _) = timed("frame", || {
            let stage = TracedScene::build(Scene { surfaces, floor: true });
            let yaw = TAU * frame as f32 / FRAMES as f32;
            let camera = Camera::framing(&stage.bounds(), yaw, MOTION.width as f32 / MOTION.height as f32);
            stage.render_on(2, &camera, MOTION, TraceQuality::Motion)
        });
        animation.push(&image)?;
        if frame == 0 {
            write(folder, "frame", &image)?;
        }
    }
    Ok(animation.finish()?)
}

fn write(folder: &Path, name: &str, image: &Image) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let path = folder.join(name).with_extension("png");
    image.write_png(&mut BufWriter::new(File::create(&path)?))?;
    let bytes = path.metadata()?.len();
    eprintln!("{name}.png: {} KB, {:.0} ms", bytes / 1000, start.elapsed().as_secs_f32() * 1e3);
    Ok(())
}

/// A mesh made ring by ring.
#[derive(Default)]
struct Loft {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
}

impl Loft {
    /// Adds a tube: `point(angle, along)` for `around` angles (0..TAU) and `rings` places along (0..=1).
    fn tube(&mut self, around: u32, rings: u32, point: impl Fn(f32, f32) -> Vec3) {
        let first = self.positions.len() as u32;
        for ring in 0..rings {
            let along = ring as f32 / (rings - 1) as f32;
            self.positions.extend((0..around).map(|i| point(TAU * i as f32 / around as f32, along)));
        }
        for ring in 1..rings {
            for i in 0..around {
                let j = (i + 1) % around;
                let [a, b] = [first + (ring - 1) * around, first + ring * around];
                self.triangles.extend([[a + i, b + j, a + j], [a + i, b + i, b + j]]);
            }
        }
    }

    /// Adds an elliptic tube through stations of centre and half extents (across, along the bend), smoothly joined.
    fn limb(&mut self, stations: &[(Vec3, Vec2)]) {
        self.tube(48, 64, |angle, along| {
            let (centre, half) = through(stations, along);
            // Ends close in a dome.
            let cap = (1.0 - (1.0 - 2.0 * along).abs().powi(24)).max(0.0).sqrt();
            centre + Vec3::new(angle.sin() * half.x * cap, 0.0, angle.cos() * half.y * cap)
        });
    }

    fn finish(mut self) -> Self {
        self.normals = vec![Vec3::ZERO; self.positions.len()];
        vertex_normals(&self.positions, &self.triangles, &mut self.normals);
        self
    }

    fn skin(&self) -> Surface<'_> {
        self.cloth(Colours::One(MANNEQUIN), Material::Skin)
    }

    fn cloth<'a>(&'a self, colours: Colours<'a>, material: Material) -> Surface<'a> {
        let Self { positions, normals, triangles } = self;
        Surface { positions, normals, triangles, colours, material }
    }
}

/// Catmull-Rom through evenly spaced stations.
fn through(stations: &[(Vec3, Vec2)], along: f32) -> (Vec3, Vec2) {
    let last = stations.len() - 1;
    let at = along * last as f32;
    let i = (at as usize).min(last - 1);
    let t = at - i as f32;
    let pick = |k: isize| stations[i.saturating_add_signed(k).min(last)];
    let [a, b, c, d] = [pick(-1), pick(0), pick(1), pick(2)];
    let curve = |a: Vec3, b: Vec3, c: Vec3, d: Vec3| {
        b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
    };
    let half = curve(a.1.extend(0.0), b.1.extend(0.0), c.1.extend(0.0), d.1.extend(0.0));
    (curve(a.0, b.0, c.0, d.0), half.truncate())
}

/// A standing figure 1.72 m tall: torso and head, two arms, two legs.
fn mannequin() -> Loft {
    let mut body = Loft::default();
    let s = |x: f32, y: f32, z: f32, across: f32, deep: f32| (Vec3::new(x, y, z), Vec2::new(across, deep));
    body.limb(&[
        s(0.0, 0.78, 0.0, 0.05, 0.04),
        s(0.0, 0.84, -0.005, 0.155, 0.105),
        s(0.0, 0.92, -0.01, 0.175, 0.115),
        s(0.0, 1.02, 0.0, 0.14, 0.095),
        s(0.0, 1.10, 0.005, 0.118, 0.085),
        s(0.0, 1.20, 0.01, 0.135, 0.10),
        s(0.0, 1.29, 0.015, 0.155, 0.115),
        s(0.0, 1.37, 0.0, 0.165, 0.085),
        s(0.0, 1.42, -0.01, 0.13, 0.06),
        s(0.0, 1.46, -0.01, 0.055, 0.055),
        s(0.0, 1.50, 0.0, 0.05, 0.055),
        s(0.0, 1.55, 0.015, 0.06, 0.08),
        s(0.0, 1.62, 0.02, 0.075, 0.095),
        s(0.0, 1.68, 0.015, 0.07, 0.09),
        s(0.0, 1.725, 0.01, 0.04, 0.05),
    ]);
    for side in [-1.0, 1.0] {
        body.limb(&[
            s(side * 0.185, 1.41, -0.005, 0.035, 0.035),
            s(side * 0.20, 1.35, -0.005, 0.047, 0.05),
            s(side * 0.225, 1.22, -0.005, 0.042, 0.045),
            s(side * 0.25, 1.10, 0.0, 0.036, 0.04),
            s(side * 0.275, 0.97, 0.02, 0.034, 0.036),
            s(side * 0.295, 0.86, 0.045, 0.026, 0.028),
            s(side * 0.305, 0.78, 0.06, 0.022, 0.04),
            s(side * 0.31, 0.68, 0.075, 0.014, 0.025),
        ]);
        body.limb(&[
            s(side * 0.085, 0.90, 0.0, 0.08, 0.09),
            s(side * 0.09, 0.76, 0.0, 0.083, 0.09),
            s(side * 0.09, 0.62, 0.005, 0.068, 0.075),
            s(side * 0.088, 0.48, 0.005, 0.052, 0.056),
            s(side * 0.088, 0.34, -0.015, 0.052, 0.058),
            s(side * 0.088, 0.20, -0.015, 0.037, 0.042),
            s(side * 0.088, 0.09, -0.01, 0.034, 0.042),
            s(side * 0.09, 0.035, 0.03, 0.042, 0.105),
            s(side * 0.09, 0.0, 0.035, 0.038, 0.11),
        ]);
    }
    body.finish()
}

/// A skirt from waist to shin whose ripples grow towards the hem, and how far it stands off at each vertex, from
/// tight (1) at the waist to loose (-1) at the hem.
fn skirt() -> (Loft, Vec<f32>) {
    let (around, rings) = (320, 64);
    let mut cloth = Loft::default();
    let ripple = |angle: f32, along: f32| {
        let drift = 0.35 * (3.0 * along + 2.0 * angle).sin();
        let folds = (9.0 * angle + drift).sin() + 0.45 * (14.0 * angle - 1.3 * drift + 1.0).sin();
        folds * along.powf(1.5)
    };
    cloth.tube(around, rings, |angle, along| {
        let hip = (along * 3.2).min(1.0);
        let ease = hip * hip * (3.0 - 2.0 * hip);
        let flare = Vec2::new(0.122, 0.09) + Vec2::new(0.064, 0.038) * ease + Vec2::splat(0.135 * along.powf(1.3));
        let half = flare + Vec2::splat(0.021 * ripple(angle, along));
        let drop = 0.012 * along * (2.0 * angle + 0.7).sin();
        Vec3::new(angle.sin() * half.x, 1.09 - 0.62 * along + drop, angle.cos() * half.y + 0.003)
    });
    let values = (0..rings).flat_map(|ring| {
        let along = ring as f32 / (rings - 1) as f32;
        (0..around).map(move |i| 1.0 - 2.0 * along.sqrt() - 0.25 * ripple(TAU * i as f32 / around as f32, along))
    });
    (cloth.finish(), values.collect())
}
