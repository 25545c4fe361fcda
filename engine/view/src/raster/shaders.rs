//! The shaders' texts: each is its own file behind what it shares, and the numbers that the ray tracer has too.

use super::render_quality::MOST_BEAMS;
use super::weave_relief::STEEPEST;
use crate::fit_map;
use crate::{cloth_look, shading, tone_mapping, trim_look};
use toile_base::garment::look::TRIM_SHADOW_M;
use toile_base::garment::trim::MAX_TRIMS;

const FRAME: &str = include_str!("shaders/frame.wgsl");
const SHADING: &str = include_str!("shaders/shading.wgsl");

/// Half the width of a line (pixels).
const LINE_HALF_WIDTH: f32 = 0.9;

/// How far from its place the shadow of a single beam is looked up (texels).
const SOFTNESS: f32 = 1.6;

/// Options of a shader, written into it as constants, so that what is switched off costs nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShaderOptions {
    /// Whether the weave is drawn.
    pub weave: bool,
    /// Whether ambient occlusion is computed a vertex and not a pixel.
    pub by_vertex: bool,
    /// Whether the target takes sRGB bytes as they are.
    pub encode: bool,
}

/// Text of the shader of the shadow maps.
pub fn depth(made: ShaderOptions) -> String {
    [&numbers(made), FRAME, include_str!("shaders/depth.wgsl")].concat()
}

/// Text of the shader of body and garments.
pub fn surface(made: ShaderOptions) -> String {
    [&numbers(made), FRAME, SHADING, include_str!("shaders/trims.wgsl"), include_str!("shaders/surface.wgsl")].concat()
}

/// Text of the shader of the backdrop.
pub fn backdrop(made: ShaderOptions) -> String {
    [&numbers(made), FRAME, SHADING, include_str!("shaders/backdrop.wgsl")].concat()
}

/// Text of the shader of lines.
pub fn lines(made: ShaderOptions) -> String {
    [&numbers(made), FRAME, SHADING, include_str!("shaders/lines.wgsl")].concat()
}

/// Text of the shader that copies a picture onto the target.
pub fn blit() -> String {
    include_str!("shaders/blit.wgsl").to_owned()
}

/// Constants that have their home in Rust.
fn numbers(made: ShaderOptions) -> String {
    let steps: Vec<String> = (0..fit_map::STEPS.len())
        .map(|i| fit_map::colour((i as f32 + 0.5) / 4.0 - 1.0))
        .map(|c| format!("vec3<f32>({:.7}, {:.7}, {:.7})", c.x, c.y, c.z))
        .collect();
    let figures = [
        ("FRESNEL", shading::FRESNEL),
        ("GLOSS", shading::GLOSS),
        ("SHEEN_TINT", shading::SHEEN_TINT),
        ("BOUNCE", shading::BOUNCE),
        ("DESATURATION", tone_mapping::DESATURATION),
        ("STEEPEST", STEEPEST),
        ("LINE_HALF_WIDTH", LINE_HALF_WIDTH),
        ("SOFTNESS", SOFTNESS),
        ("SEAM_HALF", cloth_look::SEAM_HALF_M),
        ("SEAM_DARK", cloth_look::SEAM_DARK),
        ("HEM", cloth_look::HEM_M),
        ("STITCH_HALF", cloth_look::STITCH_HALF_M),
        ("STITCH_DARK", cloth_look::STITCH_DARK),
        ("TRIM_SHADOW", TRIM_SHADOW_M),
        ("EDGE_HALF", trim_look::EDGE_HALF_M),
        ("EDGE_DARK", trim_look::EDGE_DARK),
        ("SHADOW_DARK", trim_look::SHADOW_DARK),
        ("STRIP_STITCH", trim_look::STRIP_STITCH_M),
        ("TRIM_STITCH_HALF", trim_look::TRIM_STITCH_HALF_M),
        ("TRIM_STITCH_DARK", trim_look::TRIM_STITCH_DARK),
        ("RIM", trim_look::RIM),
        ("RIM_DARK", trim_look::RIM_DARK),
        ("HOLE_AWAY", trim_look::HOLE_AWAY),
        ("HOLE", trim_look::HOLE),
        ("HOLE_DARK", trim_look::HOLE_DARK),
        ("TEETH_HALF", trim_look::TEETH_HALF_M),
        ("TOOTH", trim_look::TOOTH_M),
    ];
    let ShaderOptions { weave, by_vertex, encode } = made;
    let figures: String = figures.iter().map(|(name, value)| format!("const {name} = {value:?};\n")).collect();
    let choices = [("WEAVE", weave), ("BY_VERTEX", by_vertex), ("ENCODE", encode)];
    let choices: String = choices.iter().map(|(name, value)| format!("const {name} = {value};\n")).collect();
    let (count, list) = (steps.len(), steps.join(", "));
    format!(
        "const MOST_BEAMS = {MOST_BEAMS};\nconst MAX_TRIMS = {MAX_TRIMS}u;\n{figures}{choices}const FIT_STEPS = array<vec3<f32>, {count}>({list});\n"
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

    fn all_made() -> impl Iterator<Item = ShaderOptions> {
        let bit = |i: u32, at: u32| i >> at & 1 == 1;
        (0..8).map(move |i| ShaderOptions { weave: bit(i, 0), by_vertex: bit(i, 1), encode: bit(i, 2) })
    }

    #[test]
    fn every_shader_is_valid_without_any_extension() {
        for made in all_made() {
            let all = [
                ("depth", depth(made), vec!["vertex_main"]),
                ("surface", surface(made), vec!["vertex_main", "fragment_main"]),
                ("backdrop", backdrop(made), vec!["vertex_main", "fragment_main"]),
                ("lines", lines(made), vec!["vertex_main", "shown", "hidden"]),
                ("blit", blit(), vec!["vertex_main", "fragment_main"]),
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
        let made = ShaderOptions { weave: true, by_vertex: false, encode: true };
        let used = [depth(made), surface(made), backdrop(made), lines(made), blit()].concat();
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/raster/shaders");
        for file in std::fs::read_dir(folder).unwrap() {
            let text = std::fs::read_to_string(file.unwrap().path()).unwrap();
            assert!(used.contains(&text));
        }
    }

    /// The block that Rust fills is as large as the one that the shaders read.
    #[test]
    fn the_uniform_block_has_one_size() {
        let module = validate("depth", &depth(ShaderOptions { weave: false, by_vertex: false, encode: false }));
        let mut layouter = naga::proc::Layouter::default();
        layouter.update(module.to_ctx()).unwrap();
        let frame = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Frame")).unwrap().0;
        assert_eq!(u64::from(layouter[frame].size), super::super::view_uniforms::BLOCK);
    }
}
