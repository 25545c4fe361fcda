//! The shaders' texts: each is its own file behind what it shares, and the numbers that the ray tracer has too.

use super::quality::MOST_BEAMS;
use super::weave::STEEPEST;
use crate::fitmap;
use crate::{shade, tone};

const FRAME: &str = include_str!("shaders/frame.wgsl");
const LIGHT: &str = include_str!("shaders/light.wgsl");

/// Half the width of a line (pixels).
const LINE_HALF_WIDTH: f32 = 0.9;

/// How far from its place the shadow of a single beam is looked up (texels).
const SOFTNESS: f32 = 1.6;

/// What a shader is made for: written into it as constants, so that what is not wanted costs nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Made {
    /// Threads are drawn.
    pub weave: bool,
    /// Ambient occlusion is found a vertex and not a pixel.
    pub by_vertex: bool,
    /// The target takes sRGB bytes as they are.
    pub encode: bool,
}

/// Depth maps.
pub fn depth(made: Made) -> String {
    [&numbers(made), FRAME, include_str!("shaders/depth.wgsl")].concat()
}

/// Body and garments.
pub fn surface(made: Made) -> String {
    [&numbers(made), FRAME, LIGHT, include_str!("shaders/surface.wgsl")].concat()
}

/// Studio or picture.
pub fn backdrop(made: Made) -> String {
    [&numbers(made), FRAME, LIGHT, include_str!("shaders/backdrop.wgsl")].concat()
}

/// Lines.
pub fn lines(made: Made) -> String {
    [&numbers(made), FRAME, LIGHT, include_str!("shaders/lines.wgsl")].concat()
}

/// The copy onto the target.
pub fn blit() -> String {
    include_str!("shaders/blit.wgsl").to_owned()
}

/// Constants that have their home in Rust.
fn numbers(made: Made) -> String {
    let steps: Vec<String> = (0..fitmap::STEPS.len())
        .map(|i| fitmap::colour((i as f32 + 0.5) / 4.0 - 1.0))
        .map(|c| format!("vec3<f32>({:.7}, {:.7}, {:.7})", c.x, c.y, c.z))
        .collect();
    let figures = [
        ("FRESNEL", shade::FRESNEL),
        ("GLOSS", shade::GLOSS),
        ("SHEEN_TINT", shade::SHEEN_TINT),
        ("BOUNCE", shade::BOUNCE),
        ("DESATURATION", tone::DESATURATION),
        ("STEEPEST", STEEPEST),
        ("LINE_HALF_WIDTH", LINE_HALF_WIDTH),
        ("SOFTNESS", SOFTNESS),
    ];
    let Made { weave, by_vertex, encode } = made;
    let figures: String = figures.iter().map(|(name, value)| format!("const {name} = {value:?};\n")).collect();
    let choices = [("WEAVE", weave), ("BY_VERTEX", by_vertex), ("ENCODE", encode)];
    let choices: String = choices.iter().map(|(name, value)| format!("const {name} = {value};\n")).collect();
    let (count, list) = (steps.len(), steps.join(", "));
    format!(
        "const MOST_BEAMS = {MOST_BEAMS};\n{figures}{choices}const FIT_STEPS = array<vec3<f32>, {count}>({list});\n"
    )
}

#[cfg(test)]
mod tests {
    use wgpu::naga;

    use super::*;

    fn validate(name: &str, text: &str) -> naga::Module {
        let module = naga::front::wgsl::parse_str(text)
            .unwrap_or_else(|e| panic!("{name} does not parse: {}", e.emit_to_string(text)));
        let flags = naga::valid::ValidationFlags::all();
        let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty());
        validator.validate(&module).unwrap_or_else(|e| panic!("{name} is not valid: {}", e.emit_to_string(text)));
        module
    }

    fn all_made() -> impl Iterator<Item = Made> {
        let bit = |i: u32, at: u32| i >> at & 1 == 1;
        (0..8).map(move |i| Made { weave: bit(i, 0), by_vertex: bit(i, 1), encode: bit(i, 2) })
    }

    #[test]
    fn every_shader_is_valid_without_any_extension() {
        for made in all_made() {
            let all = [
                ("depth", depth(made), vec!["project"]),
                ("surface", surface(made), vec!["place", "paint"]),
                ("backdrop", backdrop(made), vec!["cover", "paint"]),
                ("lines", lines(made), vec!["stretch", "shown", "hidden"]),
                ("blit", blit(), vec!["cover", "copy"]),
            ];
            for (name, text, entries) in all {
                let module = validate(name, &text);
                let found: Vec<&str> = module.entry_points.iter().map(|e| e.name.as_str()).collect();
                assert_eq!(found, entries, "{name}, {made:?}");
            }
        }
    }

    #[test]
    fn every_shader_file_is_used() {
        let made = Made { weave: true, by_vertex: false, encode: true };
        let used = [depth(made), surface(made), backdrop(made), lines(made), blit()].concat();
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/mirror/shaders");
        for file in std::fs::read_dir(folder).unwrap() {
            let text = std::fs::read_to_string(file.unwrap().path()).unwrap();
            assert!(used.contains(&text));
        }
    }

    /// The block that Rust fills is as large as the one that the shaders read.
    #[test]
    fn the_uniform_block_has_one_size() {
        let module = validate("depth", &depth(Made { weave: false, by_vertex: false, encode: false }));
        let mut layouter = naga::proc::Layouter::default();
        layouter.update(module.to_ctx()).unwrap();
        let frame = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Frame")).unwrap().0;
        assert_eq!(u64::from(layouter[frame].size), super::super::light::BLOCK);
    }
}
