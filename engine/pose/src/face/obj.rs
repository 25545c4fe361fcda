//! The body with an adapted head as OBJ with a material, as other tools read it.

use std::fmt::Write;

use glam::Vec3;
use toile_assets::body::shape::Shapes;

use super::adapt::AdaptedHead;

/// The OBJ of a body with an adapted head, in metres, with the texture points of its atlas, and of its hair: places (m) and triangles. Its
/// materials are in `head.mtl`.
pub fn obj(head: &AdaptedHead, hair: Option<(&[Vec3], &[[u32; 3]])>) -> String {
    let base = Shapes::of(head.sex).base();
    // Writing to a string cannot fail.
    let mut text = String::from("mtllib head.mtl\no body\nusemtl skin\n");
    for p in &head.rest {
        let _ = writeln!(text, "v {:.6} {:.6} {:.6}", p.x, p.y, p.z);
    }
    for uv in &base.uvs {
        let _ = writeln!(text, "vt {:.6} {:.6}", uv.x, uv.y);
    }
    for (corners, points) in base.quads.iter().zip(&base.corners) {
        text.push('f');
        for (v, t) in corners.iter().zip(points) {
            let _ = write!(text, " {}/{}", v + 1, t + 1);
        }
        text.push('\n');
    }
    if let Some((positions, triangles)) = hair {
        text.push_str("o hair\nusemtl hair\n");
        for p in positions {
            let _ = writeln!(text, "v {:.6} {:.6} {:.6}", p.x, p.y, p.z);
        }
        for t in triangles {
            let [a, b, c] = t.map(|v| v as usize + head.rest.len() + 1);
            let _ = writeln!(text, "f {a} {b} {c}");
        }
    }
    text
}

/// The materials of [`obj`]: the skin's picture is `head.png`; hair has one colour (linear RGB, 0 to 1).
pub fn mtl(hair: [f32; 3]) -> String {
    let [r, g, b] = hair;
    format!("newmtl skin\nKd 1 1 1\nmap_Kd head.png\nnewmtl hair\nKd {r:.4} {g:.4} {b:.4}\n")
}
