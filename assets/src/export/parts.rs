//! The parts of a glTF file: one buffer, its views, and accessors over them. (Khronos glTF 2.0, sections 3.6 and 4.4.)

use std::io::{self, Write};

use glam::{Mat4, Vec2, Vec3};
use serde_json::{Value, json};

use super::frame_rate::FrameRate;

/// What a view of the buffer is bound as: vertices, or indices.
const ARRAY_BUFFER: u32 = 34_962;
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;

/// Numbers by which glTF 2.0 names the types of an accessor's components.
const UNSIGNED_BYTE: u32 = 5_121;
const UNSIGNED_INT: u32 = 5_125;
const FLOAT: u32 = 5_126;

/// Everything is aligned to words (bytes).
const ALIGN: usize = 4;

/// Types of the parts of a GLB file, and its version.
const CHUNK_JSON: u32 = 0x4e4f_534a;
const CHUNK_BIN: u32 = 0x004e_4942;
const VERSION: u32 = 2;

/// The first bytes of a GLB file: `glTF`.
const MAGIC: u32 = 0x4654_6c67;

/// A buffer being filled.
#[derive(Debug, Default)]
pub(super) struct GlbBuffer {
    bytes: Vec<u8>,
    /// Bytes before them that were handed on ([`Self::hand_on`]).
    gone: usize,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl GlbBuffer {
    /// Positions, with the bounds that the format asks for; returns the accessor.
    pub fn positions(&mut self, points: &[Vec3]) -> usize {
        let min = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let max = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let bounds = json!({ "min": min.to_array(), "max": max.to_array() });
        self.floats(points.iter().flat_map(|p| p.to_array()), points.len(), "VEC3", Some(bounds))
    }

    /// Unit normals; returns the accessor.
    pub fn normals(&mut self, normals: &[Vec3]) -> usize {
        // What has no direction, or not exactly unit length, would not be valid.
        let unit = normals.iter().map(|n| n.try_normalize().unwrap_or(Vec3::Y));
        self.floats(unit.flat_map(|n| n.to_array()), normals.len(), "VEC3", None)
    }

    /// Ways that some of so many vertices go, all others standing still, with the bounds that the format asks for; returns the
    /// accessor, which is a sparse one.
    pub fn sparse_ways(&mut self, vertices: usize, ways: &[(u32, Vec3)]) -> usize {
        // The format wants at least one.
        let ways = if ways.is_empty() { &[(0, Vec3::ZERO)] } else { ways };
        let min = ways.iter().fold(Vec3::ZERO, |low, (_, p)| low.min(*p));
        let max = ways.iter().fold(Vec3::ZERO, |high, (_, p)| high.max(*p));
        let indices = self.view(ways.iter().flat_map(|(v, _)| v.to_le_bytes()), None);
        let values = self.view(ways.iter().flat_map(|(_, p)| p.to_array()).flat_map(f32::to_le_bytes), None);
        self.accessor(json!({
            "componentType": FLOAT, "count": vertices, "type": "VEC3", "min": min.to_array(), "max": max.to_array(),
            "sparse": {
                "count": ways.len(),
                "indices": { "bufferView": indices, "componentType": UNSIGNED_INT },
                "values": { "bufferView": values },
            },
        }))
    }

    /// Texture coordinates; returns the accessor.
    pub fn uvs(&mut self, uvs: &[Vec2]) -> usize {
        self.floats(uvs.iter().flat_map(|uv| uv.to_array()), uvs.len(), "VEC2", None)
    }

    /// Weights; returns the accessor.
    pub fn weights(&mut self, weights: impl ExactSizeIterator<Item = [f32; 4]>) -> usize {
        let count = weights.len();
        self.floats(weights.flatten(), count, "VEC4", None)
    }

    /// Joints of each vertex; returns the accessor.
    pub fn joints(&mut self, joints: impl ExactSizeIterator<Item = [u8; 4]>) -> usize {
        let count = joints.len();
        let view = self.view(joints.flatten(), Some(ARRAY_BUFFER));
        self.accessor(json!({ "bufferView": view, "componentType": UNSIGNED_BYTE, "count": count, "type": "VEC4" }))
    }

    /// Inverse bind matrices; returns the accessor.
    pub fn matrices(&mut self, matrices: &[Mat4]) -> usize {
        let numbers = matrices.iter().flat_map(|m| m.to_cols_array());
        let view = self.view(numbers.flat_map(f32::to_le_bytes), None);
        let count = matrices.len();
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": "MAT4" }))
    }

    /// Corners of triangles; returns the accessor.
    pub fn indices(&mut self, triangles: &[[u32; 3]]) -> usize {
        let view = self.view(triangles.iter().flatten().flat_map(|i| i.to_le_bytes()), Some(ELEMENT_ARRAY_BUFFER));
        let count = 3 * triangles.len();
        self.accessor(json!({ "bufferView": view, "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR" }))
    }

    /// Times of frames (s), with the bounds that the format asks for; returns the accessor.
    pub fn times(&mut self, rate: FrameRate) -> usize {
        let view = self.view((0..rate.frames).flat_map(|f| rate.time(f).to_le_bytes()), None);
        let last = rate.time(rate.frames.saturating_sub(1));
        self.accessor(json!({
            "bufferView": view, "componentType": FLOAT, "count": rate.frames, "type": "SCALAR",
            "min": [0.0], "max": [last],
        }))
    }

    /// Directions that are added to normals, of any length; returns the accessor.
    pub fn turned_normals(&mut self, differences: &[Vec3]) -> usize {
        self.floats(differences.iter().flat_map(|n| n.to_array()), differences.len(), "VEC3", None)
    }

    /// Translations (m) or rotations in time; returns the accessor.
    pub fn motion<const N: usize>(&mut self, all: &[[f32; N]]) -> usize {
        let kind = if N == 4 { "VEC4" } else { "VEC3" };
        let view = self.view(all.iter().flatten().flat_map(|x| x.to_le_bytes()), None);
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT, "count": all.len(), "type": kind }))
    }

    /// The bytes of a file inside this one, a picture's for example; returns the view.
    pub fn file(&mut self, bytes: &[u8]) -> usize {
        self.view(bytes.iter().copied(), None)
    }

    /// Plain numbers that are bound to no vertex; returns the accessor.
    pub fn scalars(&mut self, all: impl Iterator<Item = f32>, count: usize) -> usize {
        let view = self.view(all.flat_map(f32::to_le_bytes), None);
        self.accessor(json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": "SCALAR" }))
    }

    fn floats(&mut self, all: impl Iterator<Item = f32>, count: usize, kind: &str, bounds: Option<Value>) -> usize {
        let view = self.view(all.flat_map(f32::to_le_bytes), Some(ARRAY_BUFFER));
        let mut accessor = json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": kind });
        if let (Some(Value::Object(bounds)), Some(accessor)) = (bounds, accessor.as_object_mut()) {
            accessor.extend(bounds);
        }
        self.accessor(accessor)
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: impl Iterator<Item = u8>, target: Option<u32>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        let mut view = json!({ "buffer": 0, "byteOffset": self.gone + start, "byteLength": length });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGN), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    /// Hands what was filled in since the last time to an output, and forgets it.
    ///
    /// # Errors
    /// An error of the output.
    pub fn hand_on(&mut self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(&self.bytes)?;
        self.gone += self.bytes.len();
        self.bytes.clear();
        Ok(())
    }

    /// Adds the buffer to a description; returns the description's text and the buffer's size (bytes).
    pub fn describe(&mut self, mut description: Value) -> (Vec<u8>, usize) {
        let size = self.gone + self.bytes.len();
        description["buffers"] = json!([{ "byteLength": size }]);
        description["bufferViews"] = std::mem::take(&mut self.views).into();
        description["accessors"] = std::mem::take(&mut self.accessors).into();
        let mut text = description.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(ALIGN), b' ');
        (text, size)
    }

    /// The GLB file of a description, to which the buffer is added.
    pub fn glb(mut self, description: Value) -> Vec<u8> {
        let (text, size) = self.describe(description);
        let mut file = head(text.len(), size).to_vec();
        file.extend(text);
        file.extend(buffer_head(size));
        file.extend(self.bytes);
        file
    }
}

/// Bytes before the description: the file's header and the description's.
pub(super) const HEAD: usize = 12 + 8;

/// The first bytes of a file with a description and a buffer of so many bytes.
pub(super) fn head(text: usize, buffer: usize) -> [u8; HEAD] {
    let length = HEAD + text + 8 + buffer;
    let mut file = [0; HEAD];
    let words = [MAGIC, VERSION, length as u32, text as u32, CHUNK_JSON];
    file.chunks_exact_mut(4).zip(words).for_each(|(to, word)| to.copy_from_slice(&word.to_le_bytes()));
    file
}

/// What stands before the buffer.
pub(super) fn buffer_head(buffer: usize) -> [u8; 8] {
    let mut head = [0; 8];
    head[..4].copy_from_slice(&(buffer as u32).to_le_bytes());
    head[4..].copy_from_slice(&CHUNK_BIN.to_le_bytes());
    head
}
