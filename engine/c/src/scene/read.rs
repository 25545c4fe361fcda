//! Scenes are read.

use std::ffi::c_char;

use toile_sdk::glam::Vec3;

use super::state::{SceneHandle, SceneState};
use crate::border::{Buffer, Out, Wanted, vectors};
use crate::failure::{Code, Failure, Result, call};
use crate::fit::{FitHandle, FitObject};
use crate::handle::Handle;

/// A garment of a scene. Texts are lent by the scene.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Worn {
    /// What it was opened by, or the name that the scene file gives it.
    pub name: *const c_char,
    /// Code of its size; empty in a scene file.
    pub size: *const c_char,
    /// Its fabric.
    pub fabric: *const c_char,
    /// Vertices in the caller's order.
    pub vertices: usize,
    /// Triangles.
    pub faces: usize,
    /// Layers of a mesh that lie over each other; 1 of all else.
    pub layers: usize,
    /// Whether toile_scene_fit has a fit of it: not of a mesh without sizes, nor in a scene file.
    pub has_fit: bool,
}

/// How a garment does at the moment.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Stats {
    /// Mean strain of warp and weft edges, |length / rest - 1| (1).
    pub strain_mean: f32,
    /// 99th percentile of it (1).
    pub strain_p99: f32,
    /// The worst edge's (1).
    pub strain_max: f32,
    /// Deepest point of a free particle inside of the body or the colliders (mm).
    pub penetration_mm: f32,
    /// Steps so far that were not finite and were rolled back.
    pub rolled_back: u64,
}

/// Vertices of three numbers each.
fn vertices(room: usize, needed: usize) -> Wanted<'static> {
    Wanted { room, needed, each: 3, what: "vertices" }
}

/// Writes vertices where there is room.
fn fill_vectors(to: &Buffer<f32>, room: usize, count: &Out<usize>, from: &[Vec3]) -> Result<()> {
    to.fill(vertices(room, from.len()), count, |to| {
        vectors(to).copy_from_slice(from);
        Ok(())
    })
}

/// Writes triangles where there is room.
fn fill_faces(to: &Buffer<u32>, room: usize, count: &Out<usize>, faces: &[[u32; 3]]) -> Result<()> {
    to.fill(Wanted { room, needed: faces.len(), each: 3, what: "triangles" }, count, |to| {
        to.copy_from_slice(faces.as_flattened());
        Ok(())
    })
}

/// How many garments a scene has. They are numbered from 0, inner first.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_garment_count(scene: SceneHandle, count: Out<usize>) -> Code {
    call("toile_scene_garment_count", || {
        let place = count.place("count")?;
        scene.with(|state| {
            place.set(state.texts.len());
            Ok(())
        })
    })
}

/// A garment of a scene.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_garment(scene: SceneHandle, garment: usize, worn: Out<Worn>) -> Code {
    call("toile_scene_garment", || {
        let place = worn.place("garment")?;
        scene.with(|state| {
            let of = state.worn(garment)?;
            let [name, size, fabric] = [0, 1, 2].map(|i: usize| state.texts[garment][i].as_ptr());
            let (vertices, faces, layers, has_fit) = (of.vertices, of.faces, of.layers, of.fit.is_some());
            place.set(Worn { name, size, fabric, vertices, faces, layers, has_fit });
            Ok(())
        })
    })
}

/// How a garment's size fits over what is worn beneath, as it was dressed.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_fit(scene: SceneHandle, garment: usize, fit: Out<FitHandle>) -> Code {
    call("toile_scene_fit", || {
        let place = fit.empty("fit")?;
        scene.with(|state| {
            let judged = state.worn(garment)?.fit.clone();
            let judged = judged.ok_or_else(|| {
                Failure::usage(format!(
                    "garment {garment} has no sizes, so that there is no fit; look at has_fit first"
                ))
            })?;
            place.set(FitHandle::open(FitObject::new(judged)));
            Ok(())
        })
    })
}

/// Where the vertices of a garment are (m), in the order of the caller's own mesh; of a garment that was drafted, in the order of its
/// draft. xyz[3 * room]; `count`, which may be null, tells how many vertices there are. Always finite. Nothing is allocated.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_positions(
    scene: SceneHandle,
    garment: usize,
    xyz: Buffer<f32>,
    room: usize,
    count: Out<usize>,
) -> Code {
    call("toile_scene_positions", || {
        scene.with(|state| {
            let needed = state.worn(garment)?.vertices;
            xyz.fill(vertices(room, needed), &count, |to| Ok(state.scene.read_positions(garment, vectors(to))?))
        })
    })
}

/// The same, lent by the scene until the scene's next step, until the same garment's positions are lent again, or until the scene is
/// closed. Later calls lend the same memory; only the first one allocates.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_lend_positions(
    scene: SceneHandle,
    garment: usize,
    xyz: Out<*const f32>,
    count: Out<usize>,
) -> Code {
    call("toile_scene_lend_positions", || {
        let (xyz, count) = (xyz.place("positions")?, count.place("count")?);
        scene.with(|state| {
            let vertices = state.worn(garment)?.vertices;
            let SceneState { scene, lent, .. } = state;
            let lent = &mut lent[garment];
            lent.resize(vertices, Vec3::ZERO);
            scene.read_positions(garment, lent)?;
            xyz.set(lent.as_ptr().cast());
            count.set(vertices);
            Ok(())
        })
    })
}

/// Unit normals of a garment's vertices, xyz[3 * room]; zero where a vertex has no face.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_normals(
    scene: SceneHandle,
    garment: usize,
    xyz: Buffer<f32>,
    room: usize,
    count: Out<usize>,
) -> Code {
    call("toile_scene_normals", || {
        scene.with(|state| {
            let needed = state.worn(garment)?.vertices;
            xyz.fill(vertices(room, needed), &count, |to| {
                vectors(to).copy_from_slice(&state.scene.normals(garment)?);
                Ok(())
            })
        })
    })
}

/// Triangles of a garment by the vertices of toile_scene_positions, faces[3 * room]; quads are split. They never change.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_faces(
    scene: SceneHandle,
    garment: usize,
    faces: Buffer<u32>,
    room: usize,
    count: Out<usize>,
) -> Code {
    call("toile_scene_faces", || scene.with(|state| fill_faces(&faces, room, &count, state.scene.faces(garment)?)))
}

/// The vertices of a garment that are held: by pins, by the body where it is worn close, or without a face.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_pinned(
    scene: SceneHandle,
    garment: usize,
    pinned: Buffer<u32>,
    room: usize,
    count: Out<usize>,
) -> Code {
    call("toile_scene_pinned", || {
        scene.with(|state| {
            let held = state.scene.pinned(garment)?;
            pinned.fill(Wanted { room, needed: held.len(), each: 1, what: "vertices" }, &count, |to| {
                to.copy_from_slice(&held);
                Ok(())
            })
        })
    })
}

/// How tight a garment sits at each vertex, -1 (loose) .. 1 (tight); toile_fit_colour gives the colours. NaN where a vertex has no
/// face. Not of a scene file.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_fit_map(
    scene: SceneHandle,
    garment: usize,
    tightness: Buffer<f32>,
    room: usize,
    count: Out<usize>,
) -> Code {
    call("toile_scene_fit_map", || {
        scene.with(|state| {
            let needed = state.worn(garment)?.vertices;
            tightness.fill(Wanted { room, needed, each: 1, what: "vertices" }, &count, |to| {
                to.copy_from_slice(&state.scene.fit_map(garment)?);
                Ok(())
            })
        })
    })
}

/// How a garment does at the moment: stretch, penetration. Not for every frame of a display.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_stats(scene: SceneHandle, garment: usize, stats: Out<Stats>) -> Code {
    call("toile_scene_stats", || {
        let place = stats.place("stats")?;
        scene.with(|state| {
            let of = state.scene.stats(garment)?;
            place.set(Stats {
                strain_mean: of.strain_mean,
                strain_p99: of.strain_p99,
                strain_max: of.strain_max,
                penetration_mm: of.penetration_mm,
                rolled_back: of.rolled_back,
            });
            Ok(())
        })
    })
}

/// Vertices of the body as it stands now, xyz[3 * room] (m), and their unit normals, normals[3 * room], which may be null. Not of a
/// scene file.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_body(
    scene: SceneHandle,
    xyz: Buffer<f32>,
    normals: Buffer<f32>,
    room: usize,
    count: Out<usize>,
) -> Code {
    call("toile_scene_body", || {
        scene.with(|state| {
            let (positions, directions) = state.scene.body()?;
            if normals.is_given() {
                fill_vectors(&normals, room, &Out::nowhere(), &directions)?;
            }
            fill_vectors(&xyz, room, &count, &positions)
        })
    })
}

/// Triangles of the body, faces[3 * room]. They never change. Not of a scene file.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_body_faces(
    scene: SceneHandle,
    faces: Buffer<u32>,
    room: usize,
    count: Out<usize>,
) -> Code {
    call("toile_scene_body_faces", || scene.with(|state| fill_faces(&faces, room, &count, state.scene.body_faces()?)))
}

/// A hash of the whole state: the same input gives the same one on every run of a build, with one worker or two.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_state_hash(scene: SceneHandle, hash: Out<u64>) -> Code {
    call("toile_scene_state_hash", || {
        let place = hash.place("hash")?;
        scene.with(|state| {
            place.set(state.scene.state_hash());
            Ok(())
        })
    })
}

/// What the steps so far had to repair or leave out, a line each, as a text into `bytes`; its length with the closing zero into
/// `needed`.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_warnings(
    scene: SceneHandle,
    bytes: Buffer<c_char>,
    room: usize,
    needed: Out<usize>,
) -> Code {
    call("toile_scene_warnings", || scene.with(|state| bytes.text(&state.scene.warnings().join("\n"), room, &needed)))
}

/// What was repaired in a garment's mesh and what became of its pieces, a line each, as a text into `bytes`; its length with the
/// closing zero into `needed`.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_notes(
    scene: SceneHandle,
    garment: usize,
    bytes: Buffer<c_char>,
    room: usize,
    needed: Out<usize>,
) -> Code {
    call("toile_scene_notes", || scene.with(|state| bytes.text(&state.worn(garment)?.notes.join("\n"), room, &needed)))
}
