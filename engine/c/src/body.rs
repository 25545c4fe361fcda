//! Bodies.

use std::ffi::{CString, c_char};

use toile_sdk::{Body, Sex as SdkSex};

use crate::border::{Buffer, In, Out, Text};
use crate::failure::{Code, Failure, Result, call};
use crate::handle::{Handle, Held, stands_for};
use crate::texts::lent;

/// Whose body, or whose proportions.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sex {
    /// Not known; only of a shopper.
    Unknown = 0,
    /// A woman's.
    Female = 1,
    /// A man's.
    Male = 2,
}

/// A body in its rest pose, feet on the floor, facing +z.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct BodyHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// A measure that is given.
#[repr(C)]
#[derive(Debug)]
pub struct GivenMeasure {
    /// A name of TOILE_NAME_LIST_MEASURES, or a word for one: "chest", "height", "inseam".
    pub name: Text,
    /// The value (mm).
    pub mm: f64,
}

/// The mesh of a body, lent.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct BodyMesh {
    /// Rest positions, x, y, z of each vertex (m).
    pub xyz: *const f32,
    /// Vertices.
    pub vertices: usize,
    /// Triangles, three vertices each, counter-clockwise from outside.
    pub faces: *const u32,
    /// Triangles.
    pub face_count: usize,
}

/// What a body's handle stands for.
#[derive(Debug)]
pub struct BodyObject {
    pub body: Body,
    /// Names of its measures, in their order.
    names: Vec<CString>,
}

stands_for!(BodyHandle, BodyObject, "body");

impl BodyObject {
    pub fn new(body: Body) -> Self {
        let names = body.measures_mm().iter().map(|(name, _)| lent(name)).collect();
        Self { body, names }
    }
}

/// A sex that has to be known.
fn known_sex(sex: i32) -> Result<SdkSex> {
    optional_sex(sex)?.ok_or_else(|| Failure::usage("a body has a sex; give TOILE_SEX_FEMALE or TOILE_SEX_MALE"))
}

/// A sex, or that it is not known.
pub fn optional_sex(sex: i32) -> Result<Option<SdkSex>> {
    let all = [(Sex::Unknown, None), (Sex::Female, Some(SdkSex::Female)), (Sex::Male, Some(SdkSex::Male))];
    let found = all.into_iter().find(|(own, _)| *own as i32 == sex);
    found.map(|(_, sex)| sex).ok_or_else(|| Failure::usage(format!("{sex} is no sex; give one of toile_sex")))
}

/// Names and values (mm) of measures that are given.
pub fn measures(given: &In<GivenMeasure>, count: usize) -> Result<Vec<(&str, f64)>> {
    let each = given.slice(count, "measures")?.iter();
    each.map(|measure| Ok((measure.name.of("name of a measure")?, measure.mm))).collect()
}

/// The body of a sex (a toile_sex) that has these measures, each within 2 mm; all others are what people with these are expected to
/// have. Without any, the average body.
#[unsafe(no_mangle)]
pub extern "C" fn toile_body_from_measures(
    sex: i32,
    given: In<GivenMeasure>,
    count: usize,
    body: Out<BodyHandle>,
) -> Code {
    call("toile_body_from_measures", || {
        let place = body.empty("body")?;
        let (sex, given) = (known_sex(sex)?, measures(&given, count)?);
        let made = if given.is_empty() { Body::average(sex)? } else { Body::from_measures_mm(sex, &given)? };
        place.set(BodyHandle::open(BodyObject::new(made)));
        Ok(())
    })
}

/// A body that others made: a skinned glTF 2.0 mesh (.glb, .gltf) or a VRM avatar. Its measures are read off it, and believed to
/// 10 mm. The sex (a toile_sex) says whose garments it wears.
#[unsafe(no_mangle)]
pub extern "C" fn toile_body_open(path: Text, sex: i32, body: Out<BodyHandle>) -> Code {
    call("toile_body_open", || {
        let place = body.empty("body")?;
        let made = Body::open(path.of("path")?, known_sex(sex)?)?;
        place.set(BodyHandle::open(BodyObject::new(made)));
        Ok(())
    })
}

/// A measure of a body by its name or a word for it (mm).
#[unsafe(no_mangle)]
pub extern "C" fn toile_body_measure_mm(body: BodyHandle, name: Text, mm: Out<f64>) -> Code {
    call("toile_body_measure_mm", || {
        let place = mm.place("value")?;
        place.set(body.get()?.body.measure_mm(name.of("name of the measure")?)?);
        Ok(())
    })
}

/// How many measures are read off a body.
#[unsafe(no_mangle)]
pub extern "C" fn toile_body_measure_count(body: BodyHandle, count: Out<usize>) -> Code {
    call("toile_body_measure_count", || {
        let place = count.place("count")?;
        place.set(body.get()?.names.len());
        Ok(())
    })
}

/// One of them by its number from 0: its name, lent by the body, and its value (mm).
#[unsafe(no_mangle)]
pub extern "C" fn toile_body_measure(body: BodyHandle, index: usize, name: Out<*const c_char>, mm: Out<f64>) -> Code {
    call("toile_body_measure", || {
        let (name, mm, object) = (name.place("name")?, mm.place("value")?, body.get()?);
        let (text, (_, value)) = object.names.iter().zip(object.body.measures_mm()).nth(index).ok_or_else(|| {
            Failure::usage(format!("there is no measure {index}: the body has {}, counted from 0", object.names.len()))
        })?;
        name.set(text.as_ptr());
        mm.set(*value);
        Ok(())
    })
}

/// The mesh of a body in its rest pose, lent by the body.
#[unsafe(no_mangle)]
pub extern "C" fn toile_body_mesh_of(body: BodyHandle, mesh: Out<BodyMesh>) -> Code {
    call("toile_body_mesh_of", || {
        let (place, object) = (mesh.place("mesh")?, body.get()?);
        let (positions, faces) = (object.body.positions(), object.body.faces());
        place.set(BodyMesh {
            xyz: positions.as_ptr().cast(),
            vertices: positions.len(),
            faces: faces.as_ptr().cast(),
            face_count: faces.len(),
        });
        Ok(())
    })
}

/// Notes on how a body was made, a line each, as a text into `bytes`; its length with the closing zero into
/// `needed`.
#[unsafe(no_mangle)]
pub extern "C" fn toile_body_notes(body: BodyHandle, bytes: Buffer<c_char>, room: usize, needed: Out<usize>) -> Code {
    call("toile_body_notes", || bytes.text(&body.get()?.body.notes().join("\n"), room, &needed))
}

/// Closes a body. Scenes and garments that were made with it keep what they need.
#[unsafe(no_mangle)]
pub extern "C" fn toile_body_close(body: BodyHandle) -> Code {
    call("toile_body_close", || body.close())
}
