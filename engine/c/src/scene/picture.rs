//! Pictures of scenes.

use toile_sdk::{Look as SdkLook, Picture, View};

use super::state::SceneHandle;
use crate::border::{Buffer, Out, Text, Wanted};
use crate::failure::{Code, Failure, Result, call};

/// What a picture shows of cloth.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// The fabrics.
    Fabric = 0,
    /// The fit map.
    FitMap = 1,
}

/// A look by its number.
pub fn look(number: i32) -> Result<SdkLook> {
    let all = [(Look::Fabric, SdkLook::Fabric), (Look::FitMap, SdkLook::FitMap)];
    let found = all.into_iter().find(|(own, _)| *own as i32 == number);
    found.map(|(_, look)| look).ok_or_else(|| Failure::usage(format!("{number} is no look; give one of toile_look")))
}

/// Writes a picture's pixels where there is room.
pub fn filled(rgba: &Buffer<u8>, room: usize, needed: &Out<usize>, picture: &Picture) -> Result<()> {
    let bytes = picture.rgba();
    rgba.fill(Wanted { room, needed: bytes.len(), each: 1, what: "bytes of the picture" }, needed, |to| {
        to.copy_from_slice(&bytes);
        Ok(())
    })
}

fn drawn(scene: SceneHandle, shows: i32, degrees: f32, size: [u32; 2]) -> Result<Picture> {
    let shows = look(shows)?;
    if !degrees.is_finite() {
        return Err(Failure::input("the view is not turned by a finite number of degrees; give 0 for the front"));
    }
    scene.with(|state| {
        let mut pictures = state.scene.pictures(&[View::Turned(degrees)], size, shows)?;
        pictures.pop().ok_or_else(|| Failure::internal("no picture was drawn"))
    })
}

/// A picture of this moment by the ray tracer: rgba[4 * width * height] in sRGB, rows from the top, alpha 255; `room` is the
/// array's bytes. It is taken from the front, turned towards the body's left by so many degrees: 90 is its left side, 180 its back.
/// Sides have 16 to 4320 pixels. It takes every core.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_picture(
    scene: SceneHandle,
    shows: i32,
    degrees: f32,
    width: u32,
    height: u32,
    rgba: Buffer<u8>,
    room: usize,
) -> Code {
    call("toile_scene_picture", || {
        let needed = (width as usize).saturating_mul(height as usize).saturating_mul(4);
        if room < needed {
            return Err(Failure::usage(format!(
                "there is room for {room} bytes, and a picture of {width} x {height} pixels takes {needed}; give room for all"
            )));
        }
        if !rgba.is_given() {
            return Err(Failure::usage("the pointer to the picture is null; give one"));
        }
        filled(&rgba, room, &Out::nowhere(), &drawn(scene, shows, degrees, [width, height])?)
    })
}

/// The same as a PNG file, over whatever was there.
#[unsafe(no_mangle)]
pub extern "C" fn toile_scene_write_png(
    scene: SceneHandle,
    shows: i32,
    degrees: f32,
    width: u32,
    height: u32,
    path: Text,
) -> Code {
    call("toile_scene_write_png", || {
        let path = path.of("path")?;
        Ok(drawn(scene, shows, degrees, [width, height])?.write_png(path)?)
    })
}
