//! A glTF file opened: its JSON, its buffers, and the numbers of its accessors, plain or sparse, whole or normalised.
//! Nothing is allocated for a count before the bytes behind it are known to be there. (Khronos glTF 2.0 specification,
//! sections 3.6 and 4.4.)

use glam::{Mat4, Quat, Vec3};
use serde_json::Value;

/// First bytes of a GLB file.
pub(crate) const MAGIC: &[u8] = b"glTF";

/// Types of the parts of a GLB file.
pub(crate) const CHUNK_JSON: u32 = 0x4e4f_534a;
pub(crate) const CHUNK_BIN: u32 = 0x004e_4942;

/// Most elements of an accessor without stored data, which the specification fills with zeros: a sparse one names few.
const MAX_ZEROS: usize = 1 << 22;

/// Reads another file of the same folder, by its name.
pub type ReadBeside<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, String>;

/// Compressions that need a decoder of their own.
const COMPRESSIONS: [&str; 2] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression"];

/// An opened file.
pub(crate) struct GltfFile {
    /// The JSON of the file.
    pub json: Value,
    buffers: Vec<Vec<u8>>,
}

/// Where the elements of an accessor lie: in a buffer, or nowhere (zeros).
struct AccessorBytes<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl GltfFile {
    /// Reads a file's bytes. An error says the cure, to stand behind the file's name.
    pub fn open(bytes: &[u8], beside: ReadBeside<'_>) -> Result<Self, String> {
        let (json, bin) = if bytes.starts_with(MAGIC) { chunks(bytes)? } else { (bytes, None) };
        let json: Value = serde_json::from_slice(json).map_err(|e| format!("{e}; export it as glTF 2.0"))?;
        let required = list(&json["extensionsRequired"]).iter().filter_map(Value::as_str);
        if let Some(name) = required.into_iter().find(|name| COMPRESSIONS.contains(name)) {
            return Err(format!("its data are compressed by {name}; export without compression"));
        }
        let buffers = buffers(&json, bin, beside)?;
        Ok(Self { json, buffers })
    }

    /// How many elements an accessor says that it has.
    pub fn count(&self, accessor: usize) -> Result<usize, String> {
        let count = index(&self.json["accessors"][accessor]["count"]).filter(|n| *n > 0);
        count.ok_or_else(|| format!("its accessor {accessor} is missing or empty; export without compression"))
    }

    /// The elements of an accessor as floats; whole numbers are normalised where it says so.
    pub fn floats<const N: usize>(&self, accessor: usize) -> Result<Vec<[f32; N]>, String> {
        let normalised = self.json["accessors"][accessor]["normalized"].as_bool().unwrap_or(false);
        let component = self.component(accessor);
        self.elements(accessor, |bytes| {
            let (whole, most) = match component {
                5120 => (f32::from(bytes[0] as i8), 127.0),
                5121 => (f32::from(bytes[0]), 255.0),
                5122 => (f32::from(i16::from_le_bytes([bytes[0], bytes[1]])), 32767.0),
                5123 => (f32::from(u16::from_le_bytes([bytes[0], bytes[1]])), 65535.0),
                5125 => (little_endian(bytes) as f32, 4_294_967_295.0),
                _ => (f32::from_bits(little_endian(bytes)), 1.0),
            };
            if normalised { (whole / most).max(-1.0) } else { whole }
        })
    }

    /// The elements of an accessor of whole numbers.
    pub fn integers<const N: usize>(&self, accessor: usize) -> Result<Vec<[u32; N]>, String> {
        if !matches!(self.component(accessor), 5121 | 5123 | 5125) {
            return Err(format!(
                "its accessor {accessor} has no whole numbers where an index belongs; export it again"
            ));
        }
        self.elements(accessor, little_endian)
    }

    /// The bytes of a view of a buffer.
    pub fn view(&self, view: usize) -> Option<&[u8]> {
        let view = &self.json["bufferViews"][view];
        let buffer = index(&view["buffer"]).and_then(|b| self.buffers.get(b))?;
        let start = index(&view["byteOffset"]).unwrap_or(0);
        buffer.get(start..start.checked_add(index(&view["byteLength"])?)?)
    }

    fn component(&self, accessor: usize) -> u64 {
        self.json["accessors"][accessor]["componentType"].as_u64().unwrap_or(0)
    }

    fn elements<T: Copy + Default, const N: usize>(
        &self,
        number: usize,
        read: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<[T; N]>, String> {
        let accessor = &self.json["accessors"][number];
        let wrong = |what: &str| format!("its accessor {number} has {what}; export without compression");
        let kind = match N {
            1 => "SCALAR",
            2 => "VEC2",
            3 => "VEC3",
            4 => "VEC4",
            _ => "MAT4",
        };
        if accessor["type"] != kind {
            return Err(wrong(&format!("data of another type than {kind}")));
        }
        let size = component_size(self.component(number)).ok_or_else(|| wrong("numbers of an unknown type"))?;
        let count = self.count(number)?;
        let element = |bytes: &[u8]| std::array::from_fn(|k| read(&bytes[k * size..][..size]));
        let mut out: Vec<[T; N]> = match index(&accessor["bufferView"]) {
            Some(_) => {
                let run = self.run(accessor, count, size * N).map_err(|what| wrong(&what))?;
                (0..count).map(|i| element(&run.bytes[i * run.stride..])).collect()
            }
            None if count <= MAX_ZEROS => vec![[T::default(); N]; count],
            None => return Err(wrong("no data")),
        };
        if accessor["sparse"].is_object() {
            self.sparse(number, size * N, |at, bytes| {
                let to = out.get_mut(at)?;
                *to = element(bytes);
                Some(())
            })?;
        }
        Ok(out)
    }

    /// Hands each element that a sparse accessor replaces to `set`, which says whether there is such an element.
    fn sparse(
        &self,
        number: usize,
        size: usize,
        mut set: impl FnMut(usize, &[u8]) -> Option<()>,
    ) -> Result<(), String> {
        let sparse = &self.json["accessors"][number]["sparse"];
        let wrong = |what: &str| format!("the sparse part of its accessor {number} has {what}; export it again");
        let width = match sparse["indices"]["componentType"].as_u64() {
            Some(kind @ (5121 | 5123 | 5125)) => component_size(kind).unwrap_or(4),
            _ => return Err(wrong("indices of an unknown type")),
        };
        let count = index(&sparse["count"]).ok_or_else(|| wrong("no count"))?;
        let at = self.run(&sparse["indices"], count, width).map_err(|what| wrong(&what))?;
        let values = self.run(&sparse["values"], count, size).map_err(|what| wrong(&what))?;
        for i in 0..count {
            let element = little_endian(&at.bytes[i * at.stride..][..width]) as usize;
            let set = set(element, &values.bytes[i * values.stride..][..size]);
            set.ok_or_else(|| wrong(&format!("an index {element} that its accessor lacks")))?;
        }
        Ok(())
    }

    /// The bytes from an accessor's first element to its last, of `size` bytes each.
    fn run(&self, accessor: &Value, count: usize, size: usize) -> Result<AccessorBytes<'_>, String> {
        let view = index(&accessor["bufferView"]).map(|v| &self.json["bufferViews"][v]).ok_or("no plain data")?;
        let buffer = index(&view["buffer"]).and_then(|b| self.buffers.get(b)).ok_or("a view of no buffer")?;
        let stride = index(&view["byteStride"]).unwrap_or(size).max(size);
        let start = index(&view["byteOffset"]).unwrap_or(0).saturating_add(index(&accessor["byteOffset"]).unwrap_or(0));
        let end = count.saturating_sub(1).saturating_mul(stride).saturating_add(start).saturating_add(size);
        let bytes = buffer.get(start..end).filter(|_| count > 0);
        Ok(AccessorBytes { bytes: bytes.ok_or("a buffer that is shorter than its data")?, stride })
    }
}

/// Bytes of a component, by glTF's number for its type.
fn component_size(kind: u64) -> Option<usize> {
    match kind {
        5120 | 5121 => Some(1),
        5122 | 5123 => Some(2),
        5125 | 5126 => Some(4),
        _ => None,
    }
}

/// The JSON and the binary part of a GLB file.
fn chunks(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let cut = || "the file ends too early; export it again".to_owned();
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let (mut json, mut bin, mut at) = (None, None, 12);
    while let Some((size, kind)) = word(at).zip(word(at + 4)) {
        let part = bytes.get(at + 8..at + 8 + size as usize).ok_or_else(cut)?;
        match kind {
            CHUNK_JSON => json = json.or(Some(part)),
            CHUNK_BIN => bin = bin.or(Some(part)),
            _ => {}
        }
        at += 8 + size as usize;
    }
    Ok((json.ok_or_else(cut)?, bin))
}

fn buffers(json: &Value, bin: Option<&[u8]>, beside: ReadBeside<'_>) -> Result<Vec<Vec<u8>>, String> {
    let read = |buffer: &Value| match buffer["uri"].as_str() {
        None => bin.map(Vec::from).ok_or_else(|| "it has a buffer without data; export it again".into()),
        Some(uri) if uri.starts_with("data:") => {
            data_address(uri).ok_or_else(|| "it holds a data address that is not base64; export it again".into())
        }
        Some(uri) => beside(uri),
    };
    list(&json["buffers"]).iter().map(read).collect()
}

/// The bytes of a data address in base64.
pub(crate) fn data_address(uri: &str) -> Option<Vec<u8>> {
    uri.split_once(";base64,").and_then(|(_, text)| base64(text))
}

/// A node's transform: a matrix, or scale, then rotation, then translation.
pub(crate) fn transform(node: &Value) -> Mat4 {
    if let Some(matrix) = numbers::<16>(&node["matrix"]) {
        return Mat4::from_cols_array(&matrix);
    }
    let scale = numbers(&node["scale"]).map_or(Vec3::ONE, Vec3::from_array);
    let turn = numbers(&node["rotation"]).map_or(Quat::IDENTITY, |q| Quat::from_array(q).normalize());
    Mat4::from_scale_rotation_translation(scale, turn, numbers(&node["translation"]).map_or(Vec3::ZERO, Vec3::from))
}

fn numbers<const N: usize>(value: &Value) -> Option<[f32; N]> {
    let found: Vec<f32> = value.as_array()?.iter().filter_map(|v| v.as_f64().map(|x| x as f32)).collect();
    found.try_into().ok()
}

/// A number that can be an index.
pub(crate) fn index(value: &Value) -> Option<usize> {
    value.as_u64().and_then(|i| usize::try_from(i).ok())
}

/// The elements of a list; none where there is no list.
pub(crate) fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Up to four bytes, least first.
fn little_endian(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |sum, b| sum << 8 | u32::from(*b))
}

/// Base64 (RFC 4648, section 4).
fn base64(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut held) = (0u32, 0u32);
    for byte in text.trim_end_matches('=').bytes() {
        let six = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        held = held << 6 | u32::from(six);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((held >> bits) as u8);
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests;
