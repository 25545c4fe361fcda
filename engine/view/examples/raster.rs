//! A dressed mannequin by the rasteriser and by the ray tracer, side by side, with the time of each.
//!
//! `cargo run --release -p toile-view --features view --example raster [FOLDER] [GARMENT] [SIZE]` writes PNG files into the
//! folder (here by default) and what they cost to standard error.

use std::{error::Error, fs::File, io::BufWriter, path::Path, time::Instant};

use toile_view::image::{Image, Size};
use toile_view::raster::{AdapterChoice, Backdrop, Gpu, Offscreen, RenderQuality, Renderer};
use toile_view::scene::{OrbitCamera, PictureScene};
use toile_view::{contact_sheet, trace};

#[path = "../tests/raster/dressed.rs"]
mod dressed;

use dressed::Dressed;

const STILL: Size = Size::new(480, 800);
const LIVE: Size = Size::new(540, 960);

/// Pictures that a cost is measured over.
const RUNS: usize = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let word = |i: usize, usual: &'static str| words.get(i).cloned().unwrap_or_else(|| usual.to_owned());
    let (folder, garment, size) = (word(0, "."), word(1, "strap-dress"), word(2, "38"));
    let scene = Dressed::new(&garment, &size);
    let gpu = Gpu::offscreen(&AdapterChoice::Fastest)?;
    eprintln!("{gpu}; {} triangles", scene.body_triangles.len() + scene.garment.triangles.len());
    for (name, quality) in [("low", RenderQuality::LOW), ("high", RenderQuality::HIGH), ("still", RenderQuality::STILL)]
    {
        let image = cost(&gpu, &scene, name, quality)?;
        write(&folder, &format!("raster-{name}"), &image)?;
    }
    for map in [false, true] {
        let by_gpu = views(&gpu, &scene, map)?;
        let by_cpu = traced(&scene, map);
        let [a, b, c] = &by_gpu;
        let [d, e, f] = &by_cpu;
        let name = if map { "raster-fit" } else { "raster" };
        write(
            &folder,
            name,
            &contact_sheet::contact_sheet(&[a, b, c, d, e, f], 3, &["rasteriser", "", "", "ray tracer", "", ""]),
        )?;
    }
    Ok(())
}

/// Three views by the rasteriser.
fn views(gpu: &Gpu, scene: &Dressed, map: bool) -> Result<[Image; 3], Box<dyn Error>> {
    let offscreen = Offscreen::new(gpu, STILL)?;
    let mut renderer = Renderer::new(gpu, Offscreen::FORMAT, RenderQuality::STILL);
    scene.put_on(&mut renderer, map);
    let mut shoot = |preset: fn(&toile_view::scene::Bounds, f32) -> OrbitCamera| {
        offscreen.shoot(gpu, &mut renderer, &preset(&scene.bounds(), 0.6), Backdrop::Curved)
    };
    Ok([shoot(OrbitCamera::front)?, shoot(OrbitCamera::side)?, shoot(OrbitCamera::back)?])
}

/// The same three by the ray tracer.
fn traced(scene: &Dressed, map: bool) -> [Image; 3] {
    let surfaces = scene.surfaces(map);
    let stage = trace::TracedScene::build(PictureScene { surfaces: &surfaces, floor: true });
    [OrbitCamera::front, OrbitCamera::side, OrbitCamera::back]
        .map(|preset| stage.render(&preset(&scene.bounds(), 0.6), STILL, trace::TraceQuality::Still))
}

/// The middle cost of a live picture in which everything moves, from the update to the last pixel.
fn cost(gpu: &Gpu, scene: &Dressed, name: &str, quality: RenderQuality) -> Result<Image, Box<dyn Error>> {
    let begun = Instant::now();
    let mut renderer = Renderer::new(gpu, Offscreen::FORMAT, quality);
    scene.put_on(&mut renderer, false);
    let made = begun.elapsed();
    let offscreen = Offscreen::new(gpu, LIVE)?;
    let camera = OrbitCamera::front(&scene.bounds(), LIVE.width as f32 / LIVE.height as f32);
    let mut times = Vec::new();
    let begun = Instant::now();
    let image = offscreen.shoot(gpu, &mut renderer, &camera, Backdrop::Curved)?;
    let first = begun.elapsed();
    let used = processor_ms();
    for _ in 0..RUNS {
        let begun = Instant::now();
        renderer.update(0, &scene.body, &scene.body_normals)?;
        renderer.update(1, &scene.garment.start, &scene.cloth_normals)?;
        let whole = toile_view::raster::Viewport::whole(LIVE);
        offscreen.draw(gpu, &mut renderer, whole, &camera, Backdrop::Curved);
        gpu.finish();
        times.push(begun.elapsed());
    }
    let used = (processor_ms() - used) / RUNS as f64;
    times.sort();
    let ms = |t: std::time::Duration| t.as_secs_f64() * 1e3;
    eprintln!(
        "{name}: {LIVE}: {used:.0} ms of processor, p50 {:.1} ms, max {:.1} ms; made in {:.0} ms, first picture {:.0} ms",
        ms(times[RUNS / 2]),
        ms(times[RUNS - 1]),
        ms(made),
        ms(first)
    );
    Ok(image)
}

/// Processor time of this program so far (ms), on all cores; 0 where the system does not tell it this way. On a busy
/// machine it says more than a clock.
fn processor_ms() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the name in brackets come state and then twelve fields up to the two times, in hundredths of a second.
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
    fields.filter_map(|f| f.parse::<f64>().ok()).sum::<f64>() * 10.0
}

fn write(folder: &str, name: &str, image: &Image) -> Result<(), Box<dyn Error>> {
    let path = Path::new(folder).join(name).with_extension("png");
    Ok(image.write_png(&mut BufWriter::new(File::create(path)?))?)
}
