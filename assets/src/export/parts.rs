//! The parts of a glTF file: one buffer, its views, and accessors over them. (Khronos glTF 2.0, sections 3.6 and 4.4.)

use glam::{Mat4, Vec2, Vec3};
use serde_json::{Value, json};

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

/// A buffer being filled.
#[derive(Debug, Default)]
pub(super) struct GlbBuffer {
    bytes: Vec<u8>,
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
    pub fn times(&mut self, frames: usize, rate: f32) -> usize {
        let view = self.view((0..frames).flat_map(|f| (f as f32 / rate).to_le_bytes()), None);
        let last = frames.saturating_sub(1) as f32 / rate;
        self.accessor(json!({
            "bufferView": view, "componentType": FLOAT, "count": frames, "type": "SCALAR", "min": [0.0], "max": [last],
        }))
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
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGN), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    /// The GLB file of a description, to which the buffer is added.
    pub fn glb(self, mut description: Value) -> Vec<u8> {
        description["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        description["bufferViews"] = self.views.into();
        description["accessors"] = self.accessors.into();
        let mut text = description.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(ALIGN), b' ');
        let mut file = b"glTF".to_vec();
        let length = 12 + 8 + text.len() + 8 + self.bytes.len();
        for word in [VERSION, length as u32, text.len() as u32, CHUNK_JSON] {
            file.extend(word.to_le_bytes());
        }
        file.extend(text);
        for word in [self.bytes.len() as u32, CHUNK_BIN] {
            file.extend(word.to_le_bytes());
        }
        file.extend(self.bytes);
        file
    }
}
