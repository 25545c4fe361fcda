//! The body with an adapted head as OBJ with a material, as other tools read it.

use std::fmt::Write;

use toile_assets::body::shape::Shapes;

use super::adapt::AdaptedHead;

/// The OBJ of a body with an adapted head, in metres, with the texture points of its atlas; its material is `head.mtl`.
pub fn obj(head: &AdaptedHead) -> String {
    let base = Shapes::of(head.sex).base();
    let mut text = String::from("mtllib head.mtl\nusemtl skin\n");
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
    text
}

/// The material of [`obj`]: its picture is `head.png`.
pub const MTL: &str = "newmtl skin\nKd 1 1 1\nmap_Kd head.png\n";
