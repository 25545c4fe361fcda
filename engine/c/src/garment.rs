//! Garments.

use std::ffi::c_char;

use toile_sdk::Garment;

use crate::border::{Buffer, In, Out, Text};
use crate::failure::{Code, Result, call};
use crate::handle::{Handle, Held, stands_for};

/// A garment, open and checked. It can be put on many bodies.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct GarmentHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// What a garment's handle stands for.
#[derive(Debug)]
pub struct GarmentObject(pub Garment);

stands_for!(GarmentHandle, GarmentObject, "garment");

/// The garments of a list of handles.
pub fn garments(given: &In<GarmentHandle>, count: usize) -> Result<Vec<Garment>> {
    given.slice(count, "garments")?.iter().map(|garment| Ok(garment.get()?.0.clone())).collect()
}

/// Opens a garment: a name of TOILE_NAME_LIST_GARMENTS, the path of a mesh (OBJ, glTF, GLB), of a sewn pattern (GarmentCode or
/// FreeSewing JSON, DXF) or of a garment package; behind a colon a built-in fabric may stand, "shirt:lawn-gingham". `size` and
/// `fabric` may be null: the size that fits, the garment's own fabric. A fabric is a name of TOILE_NAME_LIST_FABRICS, or the path of
/// a TOML file.
#[unsafe(no_mangle)]
pub extern "C" fn toile_garment_open(name: Text, size: Text, fabric: Text, garment: Out<GarmentHandle>) -> Code {
    call("toile_garment_open", || {
        let place = garment.empty("garment")?;
        let (name, size, fabric) = (name.of("name")?, size.optional("size")?, fabric.optional("fabric")?);
        let mut opened = Garment::open(name)?;
        if let Some(fabric) = fabric {
            opened = opened.in_fabric(fabric)?;
        }
        if let Some(size) = size {
            opened = opened.in_size(size)?;
        }
        place.set(GarmentHandle::open(GarmentObject(opened)));
        Ok(())
    })
}

/// The sizes that are made, smallest first, a line each, as a text into `bytes`; its length with the closing zero into `needed`. Empty
/// of a mesh that has no sizes.
#[unsafe(no_mangle)]
pub extern "C" fn toile_garment_sizes(
    garment: GarmentHandle,
    bytes: Buffer<c_char>,
    room: usize,
    needed: Out<usize>,
) -> Code {
    call("toile_garment_sizes", || bytes.text(&garment.get()?.0.sizes()?.join("\n"), room, &needed))
}

/// The name of the fabric that a garment is made of, as a text into `bytes`; its length with the closing zero into `needed`.
#[unsafe(no_mangle)]
pub extern "C" fn toile_garment_fabric(
    garment: GarmentHandle,
    bytes: Buffer<c_char>,
    room: usize,
    needed: Out<usize>,
) -> Code {
    call("toile_garment_fabric", || bytes.text(&garment.get()?.0.fabric()?, room, &needed))
}

/// Closes a garment. Scenes that wear it keep what they need.
#[unsafe(no_mangle)]
pub extern "C" fn toile_garment_close(garment: GarmentHandle) -> Code {
    call("toile_garment_close", || garment.close())
}
