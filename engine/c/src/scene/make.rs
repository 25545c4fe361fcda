//! Scenes are made and closed.

use toile_sdk::glam::Vec3;
use toile_sdk::{DressOptions, Scene};

use super::options::Dressing;
use super::state::{SceneHandle, SceneObject};
use crate::body::BodyHandle;
use crate::border::{In, Out, Text};
use crate::failure::{Code, Failure, Result, call};
use crate::garment::{GarmentHandle, garments};
use crate::handle::Handle;

/// A file that a scene file names, in memory.
#[repr(C)]
#[derive(Debug)]
pub struct FileInMemory {
    /// The name that the scene file has for it.
    pub name: Text,
    /// What is in it.
    pub bytes: In<u8>,
    /// How many bytes.
    pub size: usize,
}

fn opened(scene: Scene) -> SceneHandle {
    SceneHandle::open(SceneObject::new(scene))
}

/// Numbers three by three; a count whose triple no memory holds is refused.
fn threes<'a, T>(given: &'a In<T>, count: usize, what: &str) -> Result<impl Iterator<Item = [T; 3]> + 'a>
where
    T: Copy,
{
    let numbers =
        count.checked_mul(3).ok_or_else(|| Failure::usage(format!("{count} are more {what} than any memory holds")))?;
    Ok(given.slice(numbers, what)?.chunks_exact(3).map(|three| [three[0], three[1], three[2]]))
}

/// Puts garments on a body, inner first, each in the size that was asked for or the one that fits, and lets them settle. `options` may
/// be null.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_dress(
    body: BodyHandle,
    worn: In<GarmentHandle>,
    count: usize,
    options: In<Dressing>,
    scene: Out<SceneHandle>,
) -> Code {
    call("toile_scene_dress", || {
        let place = scene.empty("scene")?;
        let (body, worn) = (body.get()?, garments(&worn, count)?);
        let options = options.optional("options")?.map_or_else(|| Ok(DressOptions::default()), Dressing::options)?;
        place.set(opened(Scene::dress_with(&body.body, &worn, &options)?));
        Ok(())
    })
}

/// Reads a scene file, with the files beside it that it names, and honours all that it says (docs/scene.md).
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_open(path: Text, scene: Out<SceneHandle>) -> Code {
    call("toile_scene_open", || {
        let place = scene.empty("scene")?;
        place.set(opened(Scene::open(path.of("path")?)?));
        Ok(())
    })
}

/// The same of a text; the files that it names are given along, by the names that it has for them, and no other is read. `name` is
/// what messages call the text.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_parse(
    name: Text,
    text: Text,
    files: In<FileInMemory>,
    count: usize,
    scene: Out<SceneHandle>,
) -> Code {
    call("toile_scene_parse", || {
        let place = scene.empty("scene")?;
        let (name, text) = (name.of("name")?, text.of("text")?);
        let given = files.slice(count, "files")?.iter();
        let file = |file: &FileInMemory| {
            Ok((file.name.of("name of a file")?.to_owned(), file.bytes.slice(file.size, "bytes of a file")?.to_vec()))
        };
        let files: Vec<(String, Vec<u8>)> = given.map(file).collect::<Result<_>>()?;
        place.set(opened(Scene::parse(name, text, &files)?));
        Ok(())
    })
}

/// A piece of cloth of the caller's own triangles in a built-in fabric, held at the vertices `pins`, which stay at exactly these
/// positions. xyz[3 * vertices] (m), triangles[3 * triangle_count] by vertices counted from 0, pins[pin_count].
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_of_mesh(
    xyz: In<f32>,
    vertices: usize,
    triangles: In<u32>,
    triangle_count: usize,
    pins: In<u32>,
    pin_count: usize,
    fabric: Text,
    scene: Out<SceneHandle>,
) -> Code {
    call("toile_scene_of_mesh", || {
        let place = scene.empty("scene")?;
        let positions: Vec<Vec3> = threes(&xyz, vertices, "vertices")?.map(Vec3::from_array).collect();
        if let Some(at) = positions.iter().position(|p| !p.is_finite()) {
            return Err(Failure::input(format!("vertex {at} is not finite; give positions in metres")));
        }
        let triangles: Vec<[u32; 3]> = threes(&triangles, triangle_count, "triangles")?.collect();
        let pins = pins.slice(pin_count, "pins")?;
        place.set(opened(Scene::of_mesh(&positions, &triangles, pins, fabric.of("fabric")?)?));
        Ok(())
    })
}

/// Closes a scene and ends its threads. A scene that another thread's call is at work on is refused and stays open.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_close(scene: SceneHandle) -> Code {
    call("toile_scene_close", || scene.close())
}
