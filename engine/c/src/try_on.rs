//! A whole try-on: a recording in; measures, size, pictures and the moving scene out.

use std::ffi::c_char;

use std::sync::{Mutex, PoisonError};

use toile_sdk::{Look, Picture, Scene, TryOn, TryOnOptions, try_on};

use crate::border::{Buffer, In, Out, Text};
use crate::failure::{Code, Failure, Result, call};
use crate::garment::{GarmentHandle, garments};
use crate::handle::{Handle, Held, stands_for};
use crate::recording::{MeasureList, RecordingHandle, ShopperKnown, TakenMeasure};
use crate::scene::{SceneHandle, SceneObject, filled, look, quality, tucked};

/// A try-on that was made.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct TryOnHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// How a try-on is made. Zeros throughout, { 0 }, are the defaults: nothing is known, quality shop, no pictures, nothing tucked in.
#[repr(C)]
#[derive(Debug)]
pub struct TryOnWishes {
    /// What is known of the person; null is nothing.
    pub shopper: In<ShopperKnown>,
    /// A toile_quality.
    pub quality: i32,
    /// Width of each picture (px); 0 makes none.
    pub width: u32,
    /// Height of each picture (px).
    pub height: u32,
    /// Names of garments that are tucked in; null is none.
    pub tuck: In<Text>,
    /// How many.
    pub tuck_count: usize,
}

/// What a try-on gives.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct TryOnFacts {
    /// Measures of the person.
    pub measures: usize,
    /// Pictures of each look: front, side, back; 0 where none were asked for.
    pub pictures: usize,
    /// Their width (px).
    pub width: u32,
    /// Their height (px).
    pub height: u32,
}

/// What a try-on's handle stands for.
#[derive(Debug)]
pub struct TryOnObject {
    measures: MeasureList,
    notes: String,
    pictures: Vec<Picture>,
    fit_maps: Vec<Picture>,
    /// Until it is taken out.
    scene: Mutex<Option<Scene>>,
}

stands_for!(TryOnHandle, TryOnObject, "try-on");

impl TryOnObject {
    fn new(made: TryOn) -> Self {
        let TryOn { measures, notes, pictures, fit_maps, scene, .. } = made;
        let (measures, notes) = (MeasureList::new(measures), notes.join("\n"));
        Self { measures, notes, pictures, fit_maps, scene: Mutex::new(Some(scene)) }
    }
}

impl TryOnWishes {
    fn options(given: &In<Self>) -> Result<TryOnOptions> {
        let Some(given) = given.optional("options")? else {
            return Ok(TryOnOptions::default());
        };
        Ok(TryOnOptions {
            shopper: ShopperKnown::shopper(&given.shopper)?,
            quality: quality(given.quality)?,
            picture: (given.width != 0 || given.height != 0).then_some([given.width, given.height]),
            tuck: tucked(&given.tuck, given.tuck_count)?,
        })
    }
}

/// Measures the person in a recording, puts the garments on a body of those measures, inner first, lets them move as the recording
/// does and draws its end: the same measures, sizes and bits as `toile try-on`. `options` may be null.
#[unsafe(no_mangle)]
pub extern "C" fn toile_try_on(
    recording: RecordingHandle,
    worn: In<GarmentHandle>,
    count: usize,
    options: In<TryOnWishes>,
    result: Out<TryOnHandle>,
) -> Code {
    call("toile_try_on", || {
        let place = result.empty("result")?;
        let (recording, worn) = (recording.get()?, garments(&worn, count)?);
        let made = try_on(&recording.0, &worn, &TryOnWishes::options(&options)?)?;
        place.set(TryOnHandle::open(TryOnObject::new(made)));
        Ok(())
    })
}

/// What a try-on gives.
#[unsafe(no_mangle)]
pub extern "C" fn toile_try_on_result_read(result: TryOnHandle, facts: Out<TryOnFacts>) -> Code {
    call("toile_try_on_result_read", || {
        let (place, of) = (facts.place("facts")?, result.get()?);
        let [width, height] = of.pictures.first().map_or([0, 0], |picture| [picture.width(), picture.height()]);
        place.set(TryOnFacts { measures: of.measures.len(), pictures: of.pictures.len(), width, height });
        Ok(())
    })
}

/// A measure of the person by its number from 0.
#[unsafe(no_mangle)]
pub extern "C" fn toile_try_on_result_measure(result: TryOnHandle, index: usize, measure: Out<TakenMeasure>) -> Code {
    call("toile_try_on_result_measure", || {
        let (place, of) = (measure.place("measure")?, result.get()?);
        place.set(of.measures.at(index)?);
        Ok(())
    })
}

/// Notes on the measures and the body, a line each, as a text into `bytes`; its length with the closing zero into
/// `needed`.
#[unsafe(no_mangle)]
pub extern "C" fn toile_try_on_result_notes(
    result: TryOnHandle,
    bytes: Buffer<c_char>,
    room: usize,
    needed: Out<usize>,
) -> Code {
    call("toile_try_on_result_notes", || bytes.text(&result.get()?.notes, room, &needed))
}

/// A picture of the recording's end in a look (a toile_look): 0 is the front, 1 the side, 2 the back. rgba as toile_scene_picture
/// gives it; `needed` tells how many bytes there are.
#[unsafe(no_mangle)]
pub extern "C" fn toile_try_on_result_picture(
    result: TryOnHandle,
    shows: i32,
    view: usize,
    rgba: Buffer<u8>,
    room: usize,
    needed: Out<usize>,
) -> Code {
    call("toile_try_on_result_picture", || {
        let of = result.get()?;
        let pictures = if look(shows)? == Look::FitMap { &of.fit_maps } else { &of.pictures };
        let picture = pictures.get(view).ok_or_else(|| {
            let count = pictures.len();
            Failure::usage(format!(
                "there is no picture {view}: {count} were asked for; give a width and a height for three"
            ))
        })?;
        filled(&rgba, room, &needed, picture)
    })
}

/// The scene as the recording ended, with the fit of each garment; the caller closes it. It can be taken out once.
#[unsafe(no_mangle)]
pub extern "C" fn toile_try_on_result_scene(result: TryOnHandle, scene: Out<SceneHandle>) -> Code {
    call("toile_try_on_result_scene", || {
        let (place, of) = (scene.empty("scene")?, result.get()?);
        let taken = of.scene.lock().unwrap_or_else(PoisonError::into_inner).take();
        let taken =
            taken.ok_or_else(|| Failure::usage("the scene was taken out of this try-on before; keep its handle"))?;
        place.set(SceneHandle::open(SceneObject::new(taken)));
        Ok(())
    })
}

/// Closes a try-on, with its scene where that was not taken out.
#[unsafe(no_mangle)]
pub extern "C" fn toile_try_on_result_close(result: TryOnHandle) -> Code {
    call("toile_try_on_result_close", || result.close())
}
