//! A still mesh as Wavefront OBJ with its material (MTL): what point caches move. Vertices keep their order.

use std::fmt::Write as _;

use glam::Vec3;

use super::part::MovingPart;

/// The OBJ file of a part at some positions (m) `[vertices]`, whose material stands in the file `mtl`.
pub(super) fn obj(part: &MovingPart, positions: &[Vec3], mtl: &str) -> String {
    let mut text = format!("mtllib {mtl}\no {}\n", part.name);
    // Writing to a string cannot fail. Numbers have as few digits as bring back the same bits.
    positions.iter().for_each(|p| _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z));
    for (face, uvs) in part.faces.iter().zip(&part.uvs) {
        let corners = MovingPart::corners(face).len();
        uvs[..corners].iter().for_each(|uv| _ = writeln!(text, "vt {} {}", uv.x, uv.y));
    }
    text.push_str("usemtl look\n");
    let mut point = 0;
    for face in &part.faces {
        text.push('f');
        for v in MovingPart::corners(face) {
            point += 1;
            _ = if part.uvs.is_empty() { write!(text, " {}", v + 1) } else { write!(text, " {}/{point}", v + 1) };
        }
        text.push('\n');
    }
    text
}

/// The MTL file of a part; `picture` is the file of its picture. Colours are linear.
pub(super) fn mtl(part: &MovingPart, picture: Option<&str>) -> String {
    let look = &part.look;
    let [r, g, b] = if picture.is_some() { [1.0; 3] } else { look.colour };
    let mut text = format!("newmtl look\nKd {r} {g} {b}\nKs 0 0 0\nPr {}\nd {}\n", look.roughness, look.opacity);
    if let Some(picture) = picture {
        _ = writeln!(text, "map_Kd {picture}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::surface::SurfaceLook;
    use super::*;
    use glam::Vec2;
    use toile_bake::shape::NO_VERTEX;

    #[test]
    fn vertices_keep_their_order_and_corners_their_texture_points() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::Y, Vec3::new(0.0, 1.0 / 3.0, -2.5e-7)];
        let part = MovingPart {
            name: "cloth".into(),
            vertices: 5,
            faces: vec![[0, 1, 2, 3], [3, 2, 4, NO_VERTEX]],
            uvs: vec![[Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y], [Vec2::splat(0.5); 4]],
            look: SurfaceLook::cloth([0.5; 3]),
            skinned: None,
        };
        let text = obj(&part, &points, "cloth.mtl");
        let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &tobj::LoadOptions::default(), |_| {
            tobj::load_mtl_buf(&mut mtl(&part, Some("cloth.png")).as_bytes())
        })
        .unwrap();
        let mesh = &models[0].mesh;
        let read: Vec<Vec3> = mesh.positions.chunks_exact(3).map(Vec3::from_slice).collect();
        assert_eq!(read, points);
        assert_eq!((&mesh.face_arities[..], &mesh.indices[..]), (&[4, 3][..], &[0, 1, 2, 3, 3, 2, 4][..]));
        assert_eq!((mesh.texcoords.len(), mesh.texcoord_indices[3]), (14, 3));
        assert_eq!(mesh.texcoords[6..10], [0.0, 1.0, 0.5, 0.5]);
        let plain = obj(&MovingPart { uvs: Vec::new(), ..part }, &points, "cloth.mtl");
        assert!(plain.ends_with("f 1 2 3 4\nf 4 3 5\n"), "{plain}");
    }
}
