//! Meshes as binary PLY (little endian, version 1.0, G. Turk 1994): positions in f32, faces by their corners.

use std::io::Write;

use glam::Vec3;

/// The PLY file of positions (m) and faces; the same input gives the same bytes.
pub fn ply<'a>(positions: &[Vec3], faces: impl ExactSizeIterator<Item = &'a [u32]>) -> Vec<u8> {
    let (vertices, count) = (positions.len(), faces.len());
    let mut bytes = Vec::with_capacity(256 + vertices * 12 + count * 17);
    // Writing to memory cannot fail.
    let _ = write!(
        bytes,
        "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
         property float z\nelement face {count}\nproperty list uchar uint vertex_indices\nend_header\n"
    );
    positions.iter().flat_map(|p| p.to_array()).for_each(|x| bytes.extend(x.to_le_bytes()));
    for ring in faces {
        bytes.push(ring.len() as u8);
        ring.iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    }
    bytes
}

/// The positions (m) of a PLY file as [`ply`] writes it.
///
/// # Errors
/// What is wrong with it, to stand behind the file's name.
pub fn ply_positions(bytes: &[u8]) -> Result<Vec<Vec3>, String> {
    let wrong = || "it is no PLY file as Toile writes it (binary, positions first, in f32)".to_owned();
    const END: &[u8] = b"end_header\n";
    let end = bytes.windows(END.len()).position(|w| w == END).ok_or_else(wrong)? + END.len();
    let head = std::str::from_utf8(&bytes[..end]).map_err(|_| wrong())?;
    let expected = "property float x\nproperty float y\nproperty float z\n";
    let rest = head.strip_prefix("ply\nformat binary_little_endian 1.0\nelement vertex ").ok_or_else(wrong)?;
    let (count, rest) = rest.split_once('\n').ok_or_else(wrong)?;
    let count: usize = count.parse().map_err(|_| wrong())?;
    if !(rest.starts_with(&format!("{expected}element face")) || rest == format!("{expected}end_header\n")) {
        return Err(wrong());
    }
    let length = count.checked_mul(12).ok_or_else(wrong)?;
    let data = bytes.get(end..).and_then(|d| d.get(..length)).ok_or("it ends before its last vertex")?;
    let float = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    Ok(data.chunks_exact(12).map(|p| Vec3::new(float(p), float(&p[4..]), float(&p[8..]))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_come_back_with_the_same_bits() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::new(-0.0, 1.0 / 3.0, 1e-30)];
        let faces: [&[u32]; 2] = [&[0, 1, 2, 3], &[2, 1, 0]];
        let bytes = ply(&points, faces.into_iter());
        let read = ply_positions(&bytes).unwrap();
        assert!(read.iter().zip(points).all(|(a, b)| a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits)));
        assert_eq!(bytes[bytes.len() - 30], 4);
        for end in [0, 30, bytes.len() - 40] {
            assert!(ply_positions(&bytes[..end]).is_err());
        }
    }
}
