//! Meshes patterns and prints how good the meshes are; with `--svg FOLDER` it also draws them:
//! `cargo run --release -p toile-assets --example panels -- [--spacing MM] [--seams FILE] [--svg FOLDER] FILE...`
//!
//! A seam file is for the pattern that follows it. Warp and weft cells are drawn in blue, quads beside the seams in green,
//! triangles in sand, and vertices that were sewn to others as dots.

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use toile_assets::import::pattern;
use toile_assets::pattern::Pattern;
use toile_assets::tailor::{PanelQuality, SewnMesh, sew};

/// Pixels a metre, and the margin around a panel (m).
const PIXELS: f64 = 1_600.0;
const MARGIN: f64 = 0.03;

/// What the program says with its exit code where a file is refused.
const REFUSED: u8 = 4;

/// Widest row of panels in a picture (m).
const ROW: f64 = 1.6;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("{e}");
            ExitCode::from(REFUSED)
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let (mut spacing, mut seams, mut folder) = (0.015, None, None);
    println!(
        "| pattern | panels | seams | particles | inner | regular | smallest angle | sharpest corner | area error | largest gather | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--spacing" => spacing = value()?.parse::<f64>()? * 1e-3,
            "--seams" => seams = Some(PathBuf::from(value()?)),
            "--svg" => folder = Some(PathBuf::from(value()?)),
            file => {
                let path = Path::new(file);
                let pattern = pattern::read(path, seams.take().as_deref())?;
                let begin = std::time::Instant::now();
                let sewn = sew(&pattern, spacing)?;
                let name = path.file_stem().unwrap_or_default().to_string_lossy();
                println!("| {name} | {} | {:.0} |", row(&pattern, &sewn), begin.elapsed().as_secs_f64() * 1e3);
                if let Some(folder) = &folder {
                    std::fs::create_dir_all(folder)?;
                    std::fs::write(folder.join(format!("{name}-{:.0}.svg", spacing * 1e3)), svg(&pattern, &sewn))?;
                }
            }
        }
    }
    Ok(())
}

/// The figures of a pattern: sums and worst cases over its panels.
fn row(pattern: &Pattern, sewn: &SewnMesh) -> String {
    let all: Vec<PanelQuality> = sewn.panels.iter().zip(pattern.panels()).map(|(m, p)| m.quality(p)).collect();
    let sum = |of: fn(&PanelQuality) -> usize| all.iter().map(of).sum::<usize>();
    let least = |of: fn(&PanelQuality) -> f64| all.iter().map(of).fold(f64::MAX, f64::min);
    let gathers = pattern.seams().iter().map(|seam| {
        let [a, b] = seam.sides.map(|side| side.length(pattern.panels()));
        (a / b).max(b / a)
    });
    let worst_area = all.iter().map(|q| q.area_error.abs()).fold(0.0, f64::max);
    format!(
        "{} | {} | {} | {} | {:.1} % | {:.1} | {:.1} | {:.3} % | {:.2}",
        pattern.panels().len(),
        pattern.seams().len(),
        sewn.members.len(),
        sum(|q| q.inner),
        100.0 * sum(|q| q.regular) as f64 / sum(|q| q.inner).max(1) as f64,
        least(|q| q.least_angle),
        least(|q| q.sharpest_corner),
        100.0 * worst_area,
        gathers.fold(1.0, f64::max)
    )
}

/// All panels of a pattern beside each other.
fn svg(pattern: &Pattern, sewn: &SewnMesh) -> String {
    let (mut body, mut at, mut height, mut width) = (String::new(), [MARGIN, MARGIN], 0.0f64, 0.0f64);
    for (index, (mesh, panel)) in sewn.panels.iter().zip(pattern.panels()).enumerate() {
        let low = mesh.points.iter().copied().reduce(|a, b| a.min(b)).unwrap_or_default();
        let size = mesh.points.iter().copied().reduce(|a, b| a.max(b)).unwrap_or_default() - low;
        if at[0] > MARGIN && at[0] + size.x > ROW {
            at = [MARGIN, at[1] + height + 2.0 * MARGIN];
            height = 0.0;
        }
        let place = |v: u32| {
            let p = mesh.points[v as usize] - low;
            format!("{:.1},{:.1}", (at[0] + p.x) * PIXELS, (at[1] + size.y - p.y) * PIXELS)
        };
        for face in &mesh.faces {
            let ring: Vec<String> = face.iter().filter(|v| **v != u32::MAX).map(|v| place(*v)).collect();
            let inner = face.iter().all(|v| *v as usize >= mesh.boundary.points.len());
            let colour = if ring.len() == 3 {
                "#f2d9a6"
            } else if inner {
                "#bcd6f2"
            } else {
                "#c4e3bf"
            };
            let _ = writeln!(body, "<polygon points=\"{}\" fill=\"{colour}\"/>", ring.join(" "));
        }
        for v in (0..mesh.boundary.points.len() as u32)
            .filter(|v| sewn.members[sewn.number[index][*v as usize] as usize].len() > 1)
        {
            let p = place(v);
            let (x, y) = p.split_once(',').unwrap_or_default();
            let _ = writeln!(body, "<circle cx=\"{x}\" cy=\"{y}\" r=\"3\" fill=\"#b03030\"/>");
        }
        let (x, y) = (at[0] * PIXELS, (at[1] + size.y + MARGIN) * PIXELS);
        let _ = writeln!(
            body,
            "<text x=\"{x:.0}\" y=\"{y:.0}\" font-size=\"24\" stroke=\"none\" fill=\"#222\">{}</text>",
            panel.name
        );
        at[0] += size.x + 2.0 * MARGIN;
        (height, width) = (height.max(size.y), width.max(at[0]));
    }
    let (w, h) = (width * PIXELS, (at[1] + height + 2.0 * MARGIN) * PIXELS);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.0}\" height=\"{h:.0}\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<g stroke=\"#456\" stroke-width=\"1\">\n{body}</g>\n</svg>\n"
    )
}
