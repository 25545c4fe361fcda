//! The kernels of the two blends, and their bindings.

use toile_engine::skin::Blend;

use crate::shader::{LANES, Shader};

/// The shader of both blends; its buffers are those of [`super::Skinning`], in group 0.
pub const SHADER: Shader = Shader {
    name: "skin",
    texts: &[LANES, include_str!("../shaders/skin.wgsl")],
    reads: &[true, true, true, true, true, false, false],
};

/// The entry point of a blend.
pub fn entry(blend: Blend) -> &'static str {
    match blend {
        Blend::Linear => "skin_linear",
        Blend::Dual => "skin_dual",
    }
}

/// How many of four numbers a bone takes in the palette.
pub(super) fn stride(blend: Blend) -> usize {
    match blend {
        Blend::Linear => ROWS,
        Blend::Dual => 2,
    }
}

/// Rows of a bone's matrix: the most that a bone takes in the palette.
pub(super) const ROWS: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::STORAGE_BUFFERS;
    use crate::shader::valid;

    #[test]
    fn the_shader_is_valid_without_any_capability_and_has_both_blends() {
        valid(&SHADER, 0);
        assert!(SHADER.reads.len() <= STORAGE_BUFFERS as usize);
        for blend in Blend::ALL {
            assert!(SHADER.source().contains(&format!("fn {}(", entry(blend))), "{blend}");
        }
    }
}
