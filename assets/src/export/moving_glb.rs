//! A session as an animated GLB, written while it is played: a body by skin animation, everything else by morph targets.
//!
//! For everything but the body the first frame is the mesh, and each later frame is a morph target: the displacement of every
//! vertex and its normal since the first frame. One animation sets the target of each frame to 1 at its time and to 0 at its
//! neighbours', so that a viewer shows positions that lie on a straight line between those of two frames.
//!
//! A body has its skeleton's rotations, and viewers skin it by linear blending. Where Toile blends dual quaternions, the two differ
//! at bent joints by up to centimetres, so every frame has a target with what is missing there, before skinning: with `B` the
//! blended matrix of a vertex, `inverse(B) (p - B rest)`.
//!
//! The buffer is written as frames come, and never held. Its description stands before it in the file, so room is left for
//! that; the end of it is filled with blanks, which the format allows.

use std::io::{self, Seek, SeekFrom, Write};
use std::sync::Arc;

use glam::{Affine3A, DAffine3, Vec3};
use serde_json::{Value, json};

use super::frame_rate::FrameRate;
use super::glb::body_mesh;
use super::joints::{self, LocalBone};
use super::material::material;
use super::part::{MovingPart, SplitSurface};
use super::parts::{GlbBuffer, HEAD, buffer_head, head};
use super::surface::png;
use toile_base::body::Body;
use toile_base::mesh::{SkinWeights, vertex_normals};
use toile_base::skeleton::{BONES, Joint};

/// Most frames of a session: the weights of the targets are a table of frames by frames, and a viewer holds every target.
pub const MAX_GLB_FRAMES: usize = 1_200;

/// Most bytes of a GLB file: its header counts them in 32 bits.
const MAX_BYTES: u64 = u32::MAX as u64;

/// What is less than this apart needs no target (m).
const ALIKE_M: f64 = 1e-5;

/// A blended matrix whose determinant is less than this has flattened its vertex: nothing brings it back (1).
const FLAT: f64 = 1e-2;

/// Bytes left for what the description says of a view or an accessor, of a frame and of a part: each at its longest.
const ENTRY_BYTES: usize = 360;
const TARGET_BYTES: usize = 64;
const PART_BYTES: usize = 2_048;
/// The same of all bones together, their nodes and their channels in the animation.
const SKELETON_BYTES: usize = BONES * 1_024;

/// One part on its way into the file.
struct GlbPart {
    name: String,
    split: SplitSurface,
    first: Vec<Vec3>,
    first_normals: Vec<Vec3>,
    /// Accessors of the mesh, and of each later frame.
    mesh: Value,
    targets: Vec<Value>,
    material: Value,
    skinned: bool,
}

/// A GLB file being written, frame by frame.
pub struct MovingGlb<W> {
    out: W,
    parts: GlbBuffer,
    rate: FrameRate,
    added: usize,
    body: Option<Arc<Body>>,
    bones: Vec<[LocalBone; BONES]>,
    surfaces: Vec<GlbPart>,
    images: Vec<usize>,
    room: usize,
    title: String,
}

impl<W> std::fmt::Debug for MovingGlb<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "MovingGlb({} parts, {} of {} frames)", self.surfaces.len(), self.added, self.rate.frames)
    }
}

/// Bytes that a file of these parts will have at most.
fn most_bytes(parts: &[MovingPart], rate: FrameRate) -> u64 {
    let frames = rate.frames as u64;
    let vertices = |p: &MovingPart| SplitSurface::of(p).source.len() as u64;
    let targets: u64 = parts.iter().map(|p| 24 * vertices(p) * frames + 4 * frames * frames).sum();
    let meshes: u64 = parts.iter().map(|p| 52 * vertices(p) + 24 * p.faces.len() as u64).sum();
    let pictures: u64 = parts.iter().filter_map(|p| p.look.picture.as_ref()).map(|p| 4 * p.bytes() as u64).sum();
    targets + meshes + pictures + room(parts, rate) as u64 + 28 * BONES as u64 * frames
}

/// Whether a file of so many bytes can be written.
///
/// # Errors
/// What is wrong, where it cannot.
pub(super) fn fits(parts: &[MovingPart], rate: FrameRate) -> Result<(), String> {
    let bytes = most_bytes(parts, rate);
    if bytes > MAX_BYTES { Err(format!("a GLB file holds 4 GiB, and this has {} MiB", bytes >> 20)) } else { Ok(()) }
}

/// Room that the description needs at most (bytes).
fn room(parts: &[MovingPart], rate: FrameRate) -> usize {
    let part = |p: &MovingPart| {
        let entries = 4 * rate.frames + 16;
        PART_BYTES + 6 * p.name.len() + entries * ENTRY_BYTES + rate.frames * TARGET_BYTES
    };
    (parts.iter().map(part).sum::<usize>() + SKELETON_BYTES + PART_BYTES).next_multiple_of(4)
}

impl<W: Write + Seek> MovingGlb<W> {
    /// Begins a file of these parts, of which at most the first is a body.
    ///
    /// # Errors
    /// What the output says, and a file beyond 4 GiB.
    pub fn begin(mut out: W, title: &str, parts: &[MovingPart], rate: FrameRate) -> io::Result<Self> {
        fits(parts, rate).map_err(io::Error::other)?;
        let room = room(parts, rate);
        // Written anew at the end: what is cut short before is no GLB file.
        out.write_all(&vec![0; HEAD + room + buffer_head(0).len()])?;
        let mut this = Self {
            out,
            parts: GlbBuffer::default(),
            rate,
            added: 0,
            body: parts.first().and_then(|p| p.skinned.clone()),
            bones: Vec::new(),
            surfaces: Vec::new(),
            images: Vec::new(),
            room,
            title: title.to_owned(),
        };
        for part in parts {
            let texture = part.look.picture.as_ref().map(|picture| {
                this.images.push(this.parts.file(&png(picture)));
                this.images.len() - 1
            });
            this.surfaces.push(GlbPart {
                name: part.name.clone(),
                split: SplitSurface::of(part),
                first: Vec::new(),
                first_normals: Vec::new(),
                mesh: Value::Null,
                targets: Vec::new(),
                material: material(&part.name, &part.look, texture),
                skinned: part.skinned.is_some(),
            });
        }
        Ok(this)
    }

    /// Writes the next frame: the positions of each part (m) `[parts][vertices]`, and the skin
    /// matrices of its bones (rest to world, rigid).
    ///
    /// # Errors
    /// An error of the output, or a frame that was not announced.
    pub fn add(&mut self, palette: Option<&[Affine3A; BONES]>, positions: &[&[Vec3]]) -> io::Result<()> {
        if self.added == self.rate.frames || positions.len() != self.surfaces.len() {
            return Err(io::Error::other("it gets other frames than were announced"));
        }
        if let Some(body) = &self.body {
            self.bones.push(joints::local_bones(body, palette));
        }
        for (k, (part, now)) in self.surfaces.iter_mut().zip(positions).enumerate() {
            match (self.added, part.skinned, &self.body) {
                (added, true, Some(body)) => {
                    if added == 0 {
                        part.mesh = body_mesh(&mut self.parts, body);
                    }
                    let missing = palette.map(|palette| missing(body, palette, now)).unwrap_or_default();
                    part.targets.push(json!({ "POSITION": self.parts.sparse_ways(now.len(), &missing) }));
                }
                (0, ..) => part.begin(&mut self.parts, now, k),
                _ => part.add(&mut self.parts, now),
            }
        }
        self.added += 1;
        self.parts.hand_on(&mut self.out)
    }

    /// Ends the file.
    ///
    /// # Errors
    /// An error of the output, or missing frames.
    pub fn finish(mut self) -> io::Result<W> {
        if self.added != self.rate.frames || self.added == 0 {
            return Err(io::Error::other("frames are missing"));
        }
        let animations = self.animations();
        let description = self.description(animations);
        self.parts.hand_on(&mut self.out)?;
        let (mut text, size) = self.parts.describe(description);
        if text.len() > self.room {
            return Err(io::Error::other("its description is longer than was thought"));
        }
        text.resize(self.room, b' ');
        self.out.seek(SeekFrom::Start(0))?;
        self.out.write_all(&head(text.len(), size))?;
        self.out.write_all(&text)?;
        self.out.write_all(&buffer_head(size))?;
        self.out.seek(SeekFrom::End(0))?;
        self.out.flush()?;
        Ok(self.out)
    }

    /// Nodes before those of the bones: the parts'.
    fn first_bone(&self) -> usize {
        self.surfaces.len()
    }

    fn animations(&mut self) -> Vec<Value> {
        let frames = self.rate.frames;
        if frames < 2 {
            return Vec::new();
        }
        let times = self.parts.times(self.rate);
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        let mut channel = |node: usize, path: &str, output: usize| {
            channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
            samplers.push(json!({ "input": times, "output": output, "interpolation": "LINEAR" }));
        };
        // At each frame one target counts; a body has one for the first frame too.
        for (skinned, first) in [(true, 0), (false, 1)] {
            let moving: Vec<usize> =
                (0..self.surfaces.len()).filter(|k| self.surfaces[*k].skinned == skinned).collect();
            if moving.is_empty() {
                continue;
            }
            let weights = (0..frames).flat_map(|f| (first..frames).map(move |t| if t == f { 1.0 } else { 0.0 }));
            let output = self.parts.scalars(weights, frames * (frames - first));
            moving.into_iter().for_each(|node| channel(node, "weights", output));
        }
        let first = self.surfaces.len();
        for bone in 0..if self.body.is_some() { BONES } else { 0 } {
            let turns: Vec<[f32; 4]> = self.bones.iter().map(|b| b[bone].rotation.to_array()).collect();
            let places: Vec<[f32; 3]> = self.bones.iter().map(|b| b[bone].translation.to_array()).collect();
            let turned = shortest(turns);
            channel(first + bone, "rotation", self.parts.motion(&turned));
            channel(first + bone, "translation", self.parts.motion(&places));
        }
        vec![json!({ "name": self.title, "samplers": samplers, "channels": channels })]
    }

    fn description(&mut self, animations: Vec<Value>) -> Value {
        let first = self.first_bone();
        let mut roots: Vec<usize> = (0..self.surfaces.len()).collect();
        let node = |(k, part): (usize, &GlbPart)| match part.skinned {
            true => json!({ "name": part.name, "mesh": k, "skin": 0 }),
            false => json!({ "name": part.name, "mesh": k }),
        };
        let mut nodes: Vec<Value> = self.surfaces.iter().enumerate().map(node).collect();
        let meshes: Vec<Value> = self.surfaces.iter_mut().map(GlbPart::described).collect();
        let materials: Vec<Value> = self.surfaces.iter().map(|p| p.material.clone()).collect();
        let mut description = json!({
            "asset": { "version": "2.0", "generator": concat!("Toile ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "meshes": meshes,
            "materials": materials,
        });
        if let (Some(body), Some(bones)) = (&self.body, self.bones.first()) {
            nodes.extend(joints::nodes(bones, first));
            roots.push(first + Joint::Pelvis.index());
            let joints: Vec<usize> = (first..first + BONES).collect();
            let matrices = self.parts.matrices(&joints::inverse_binds(body));
            description["skins"] = json!([{
                "name": "skeleton", "joints": joints, "inverseBindMatrices": matrices,
                "skeleton": first + Joint::Pelvis.index(),
            }]);
        }
        if !self.images.is_empty() {
            let image = |view: &usize| json!({ "bufferView": view, "mimeType": "image/png" });
            description["images"] = self.images.iter().map(image).collect();
            description["textures"] = (0..self.images.len()).map(|k| json!({ "source": k })).collect();
        }
        if !animations.is_empty() {
            description["animations"] = animations.into();
        }
        description["scenes"] = json!([{ "name": self.title, "nodes": roots }]);
        description["nodes"] = nodes.into();
        description
    }
}

impl GlbPart {
    /// The part's vertices as they are in the file.
    fn placed(&self, now: &[Vec3]) -> (Vec<Vec3>, Vec<Vec3>) {
        let positions: Vec<Vec3> = self.split.source.iter().map(|v| now[*v as usize]).collect();
        // Normals over the unsplit surface, so that a seam of the texture is none of the light.
        let unsplit: Vec<[u32; 3]> =
            self.split.triangles.iter().map(|t| t.map(|v| self.split.source[v as usize])).collect();
        let mut smooth = vec![Vec3::ZERO; now.len()];
        vertex_normals(now, &unsplit, &mut smooth);
        let normals = self.split.source.iter().map(|v| smooth[*v as usize].try_normalize().unwrap_or(Vec3::Y));
        let normals = normals.collect();
        (positions, normals)
    }

    fn begin(&mut self, parts: &mut GlbBuffer, now: &[Vec3], material: usize) {
        (self.first, self.first_normals) = self.placed(now);
        let mut attributes =
            json!({ "POSITION": parts.positions(&self.first), "NORMAL": parts.normals(&self.first_normals) });
        if !self.split.uvs.is_empty() {
            // The format counts v downwards.
            let uvs: Vec<_> = self.split.uvs.iter().map(|uv| glam::Vec2::new(uv.x, 1.0 - uv.y)).collect();
            attributes["TEXCOORD_0"] = parts.uvs(&uvs).into();
        }
        let indices = parts.indices(&self.split.triangles);
        self.mesh = json!({
            "name": self.name,
            "primitives": [{ "attributes": attributes, "indices": indices, "material": material }],
        });
    }

    fn add(&mut self, parts: &mut GlbBuffer, now: &[Vec3]) {
        let (positions, normals) = self.placed(now);
        let gone =
            |now: &[Vec3], first: &[Vec3]| -> Vec<Vec3> { now.iter().zip(first).map(|(n, f)| *n - *f).collect() };
        let position = parts.positions(&gone(&positions, &self.first));
        let normal = parts.turned_normals(&gone(&normals, &self.first_normals));
        self.targets.push(json!({ "POSITION": position, "NORMAL": normal }));
    }

    /// Its mesh with all of its targets.
    fn described(&mut self) -> Value {
        let mut mesh = std::mem::take(&mut self.mesh);
        if !self.targets.is_empty() {
            let mut weights = vec![0.0; self.targets.len()];
            // Without the animation the first frame is shown.
            weights[0] = if self.skinned { 1.0 } else { 0.0 };
            mesh["weights"] = weights.into();
            mesh["primitives"][0]["targets"] = std::mem::take(&mut self.targets).into();
        }
        mesh
    }
}

/// What linear blending misses of each vertex of a body (m), before it is skinned; vertices that it has right are left out.
fn missing(body: &Body, palette: &[Affine3A; BONES], now: &[Vec3]) -> Vec<(u32, Vec3)> {
    let vertex = |(v, ((p, weights), rest)): (usize, ((&Vec3, &SkinWeights), &Vec3))| {
        let blend = weights.iter().fold(DAffine3::ZERO, |sum, (bone, w)| {
            let bone = palette[usize::from(bone)];
            let (turn, way) =
                (sum.matrix3 + bone.matrix3.as_dmat3() * f64::from(w), bone.translation.as_dvec3() * f64::from(w));
            DAffine3 { matrix3: turn, translation: sum.translation + way }
        });
        let apart = p.as_dvec3() - blend.transform_point3(rest.as_dvec3());
        let gone = apart.length() < ALIKE_M || blend.matrix3.determinant() < FLAT;
        (!gone).then(|| (v as u32, (blend.matrix3.inverse() * apart).as_vec3()))
    };
    now.iter().zip(&body.weights).zip(&body.mesh.positions).enumerate().filter_map(vertex).collect()
}

/// Rotations that follow each other on the shorter arc.
fn shortest(mut turns: Vec<[f32; 4]>) -> Vec<[f32; 4]> {
    for k in 1..turns.len() {
        let dot: f32 = turns[k].iter().zip(turns[k - 1]).map(|(a, b)| a * b).sum();
        if dot < 0.0 {
            turns[k] = turns[k].map(|x| -x);
        }
    }
    turns
}
