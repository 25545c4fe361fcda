//! One moment of a scene, kept.

use toile_sdk::glam::Vec3;

use super::state::SceneHandle;
use crate::border::Out;
use crate::failure::{Code, Failure, Result, call};
use crate::handle::{Handle, Held, stands_for};

/// Everything that a display needs of one moment. It never changes: another thread may draw it while the scene is stepped.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct SnapshotHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// When a snapshot was taken, and what is in it.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Steps that were taken.
    pub step: u64,
    /// Time that was reached (s).
    pub time_s: f64,
    /// Garments.
    pub garments: usize,
    /// Vertices of the body; 0 of a scene file.
    pub body_vertices: usize,
    /// Positions of the body, x, y, z of each vertex (m), lent by the snapshot; null of a scene file.
    pub body_xyz: *const f32,
    /// Unit normals of the body, lent by the snapshot; null of a scene file.
    pub body_normals: *const f32,
}

/// What a snapshot's handle stands for.
#[derive(Debug)]
pub struct SnapshotObject(toile_sdk::Snapshot);

stands_for!(SnapshotHandle, SnapshotObject, "snapshot");

fn pointer(vectors: &[Vec3]) -> *const f32 {
    if vectors.is_empty() { std::ptr::null() } else { vectors.as_ptr().cast() }
}

/// Keeps this moment of a scene.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_snapshot(scene: SceneHandle, snapshot: Out<SnapshotHandle>) -> Code {
    call("toile_scene_snapshot", || {
        let place = snapshot.empty("snapshot")?;
        let taken = scene.with(|state| Ok(state.scene.snapshot()))?;
        place.set(SnapshotHandle::open(SnapshotObject(taken)));
        Ok(())
    })
}

/// When a snapshot was taken, and the body in it.
#[unsafe(no_mangle)]
pub extern "C" fn toile_snapshot_moment(snapshot: SnapshotHandle, moment: Out<Moment>) -> Code {
    call("toile_snapshot_moment", || {
        let (place, of) = (moment.place("moment")?, snapshot.get()?);
        place.set(Moment {
            step: of.0.step,
            time_s: of.0.time_s,
            garments: of.0.garments.len(),
            body_vertices: of.0.body.len(),
            body_xyz: pointer(&of.0.body),
            body_normals: pointer(&of.0.body_normals),
        });
        Ok(())
    })
}

/// Positions of a garment in a snapshot, x, y, z of each vertex (m), lent by the snapshot, and the number of its vertices.
#[unsafe(no_mangle)]
pub extern "C" fn toile_snapshot_garment(
    snapshot: SnapshotHandle,
    garment: usize,
    xyz: Out<*const f32>,
    count: Out<usize>,
) -> Code {
    call("toile_snapshot_garment", || {
        let (xyz, count, of) = (xyz.place("positions")?, count.place("count")?, snapshot.get()?);
        let positions = garment_of(&of, garment)?;
        xyz.set(pointer(positions));
        count.set(positions.len());
        Ok(())
    })
}

fn garment_of(of: &SnapshotObject, garment: usize) -> Result<&[Vec3]> {
    let all = &of.0.garments;
    let refused =
        || Failure::usage(format!("there is no garment {garment}: the snapshot has {}, counted from 0", all.len()));
    all.get(garment).map(Vec::as_slice).ok_or_else(refused)
}

/// Closes a snapshot.
#[unsafe(no_mangle)]
pub extern "C" fn toile_snapshot_close(snapshot: SnapshotHandle) -> Code {
    call("toile_snapshot_close", || snapshot.close())
}
