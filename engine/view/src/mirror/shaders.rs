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

/// Depth maps.
pub fn depth() -> String {
    [&numbers(false), FRAME, include_str!("shaders/depth.wgsl")].concat()
}

/// Body and garments, with their threads or without.
pub fn surface(weave: bool) -> String {
    [&numbers(weave), FRAME, LIGHT, include_str!("shaders/surface.wgsl")].concat()
}

/// Studio or picture.
pub fn backdrop() -> String {
    [&numbers(false), FRAME, LIGHT, include_str!("shaders/backdrop.wgsl")].concat()
}

/// Lines.
pub fn lines() -> String {
    [&numbers(false), FRAME, LIGHT, include_str!("shaders/lines.wgsl")].concat()
}

/// The copy onto the target.
pub fn blit() -> String {
    include_str!("shaders/blit.wgsl").to_owned()
}

/// Constants that have their home in Rust.
fn numbers(weave: bool) -> String {
    let steps: Vec<String> = (0..fitmap::STEPS.len())
        .map(|i| fitmap::colour((i as f32 + 0.5) / 4.0 - 1.0))
        .map(|c| format!("vec3<f32>({:.7}, {:.7}, {:.7})", c.x, c.y, c.z))
        .collect();
    format!(
        "const MOST_BEAMS = {MOST_BEAMS};\nconst FRESNEL = {:?};\nconst GLOSS = {:?};\nconst SHEEN_TINT = {:?};\n\
         const BOUNCE = {:?};\nconst DESATURATION = {:?};\nconst STEEPEST = {STEEPEST:?};\n\
         const LINE_HALF_WIDTH = {LINE_HALF_WIDTH:?};\nconst SOFTNESS = {SOFTNESS:?};\nconst WEAVE = {weave};\n\
         const FIT_STEPS = array<vec3<f32>, {}>({});\n",
        shade::FRESNEL,
        shade::GLOSS,
        shade::SHEEN_TINT,
        shade::BOUNCE,
        tone::DESATURATION,
        steps.len(),
        steps.join(", "),
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

    #[test]
    fn every_shader_is_valid_without_any_extension() {
        let all = [
            ("depth", depth(), vec!["project"]),
            ("surface", surface(false), vec!["place", "paint"]),
            ("surface with threads", surface(true), vec!["place", "paint"]),
            ("backdrop", backdrop(), vec!["cover", "paint"]),
            ("lines", lines(), vec!["stretch", "shown", "hidden"]),
            ("blit", blit(), vec!["cover", "copy"]),
        ];
        for (name, text, entries) in all {
            let module = validate(name, &text);
            let found: Vec<&str> = module.entry_points.iter().map(|e| e.name.as_str()).collect();
            assert_eq!(found, entries, "{name}");
        }
    }

    #[test]
    fn every_shader_file_is_used() {
        let used = [depth(), surface(true), backdrop(), lines(), blit()].concat();
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/mirror/shaders");
        for file in std::fs::read_dir(folder).unwrap() {
            let text = std::fs::read_to_string(file.unwrap().path()).unwrap();
            assert!(used.contains(&text));
        }
    }

    /// The block that Rust fills is as large as the one that the shaders read.
    #[test]
    fn the_uniform_block_has_one_size() {
        let module = validate("depth", &depth());
        let mut layouter = naga::proc::Layouter::default();
        layouter.update(module.to_ctx()).unwrap();
        let frame = module.types.iter().find(|(_, t)| t.name.as_deref() == Some("Frame")).unwrap().0;
        assert_eq!(u64::from(layouter[frame].size), super::super::light::BLOCK);
    }
}
