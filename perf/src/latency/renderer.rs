//! What stands in for a display: it takes what it would be handed and, where that is asked for, draws the mirror with the shopper's own
//! picture, which costs the same with a display.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Serialize;
use toile_engine::clock::{Clock, RealClock};
use toile_engine::frame_loop::render_thread::Renderer;
use toile_engine::meter::Meter;
use toile_engine::world::Snapshot;
use toile_fitting::live::assembly::HeadlessRenderer;
use toile_fitting::live::own_picture::PictureReceiver;
use toile_fitting::live::report::Quantiles;
use toile_view::image::Size;
use toile_view::own_picture::{OwnPicture, OwnPictureInput, OwnPictureModel, OwnPictureOptions, Plain};

/// Size of the mirror: 1080 rows of a standing display.
const SIZE: Size = Size::new(608, 1080);

/// What the mirror is drawn from.
pub struct OwnPictureParts {
    /// Body and garments.
    pub model: Arc<OwnPictureModel>,
    /// The camera's pictures.
    pub pictures: PictureReceiver,
}

/// What became of the pictures.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OwnPictureFigures {
    /// From a picture's stamp until it was drawn (us).
    pub stamp_us: Quantiles,
    /// How long drawing took (us).
    pub drawing_us: Quantiles,
    /// Pictures that were drawn, and those with the garment on them.
    pub pictures: [u64; 2],
    /// Pictures without it, by reason.
    pub plain: BTreeMap<String, u64>,
}

/// Takes what a display would be handed.
pub struct LatencyRenderer {
    headless: HeadlessRenderer,
    own: Option<MeteredMirror>,
}

struct MeteredMirror {
    parts: OwnPictureParts,
    mirror: OwnPicture,
    clock: RealClock,
    from_ns: u64,
    stamp: Meter,
    drawing: Meter,
    pictures: [u64; 2],
    plain: [u64; Plain::ALL.len()],
}

impl LatencyRenderer {
    /// For a scene like that of this snapshot; meters begin at a time of the clock (ns).
    pub fn new(snapshot: &Snapshot, own: Option<OwnPictureParts>, clock: RealClock, from_ns: u64) -> Self {
        let mirror = |parts| MeteredMirror {
            parts,
            mirror: OwnPicture::new(),
            clock,
            from_ns,
            stamp: Meter::new(),
            drawing: Meter::new(),
            pictures: [0; 2],
            plain: [0; Plain::ALL.len()],
        };
        Self { headless: HeadlessRenderer::sized_for(snapshot), own: own.map(mirror) }
    }

    /// What became of the pictures, and the meters of stamp and drawing.
    pub fn figures(&self) -> Option<(OwnPictureFigures, [&Meter; 2])> {
        let own = self.own.as_ref()?;
        let [stamp_us, drawing_us] = [&own.stamp, &own.drawing].map(Quantiles::of);
        let counted = Plain::ALL.iter().zip(own.plain).filter(|(_, count)| *count > 0);
        let plain = counted.map(|(why, count)| (format!("{why:?}"), count)).collect();
        let figures = OwnPictureFigures { stamp_us, drawing_us, pictures: own.pictures, plain };
        Some((figures, [&own.stamp, &own.drawing]))
    }
}

impl Renderer for LatencyRenderer {
    type Outfit = ();

    fn set_outfit(&mut self, _outfit: &mut ()) {}

    fn draw(&mut self, snapshot: &Snapshot) {
        self.headless.draw(snapshot);
        let Some(own) = &mut self.own else { return };
        let Some(seen) = own.parts.pictures.news().filter(|seen| seen.taken_ns > 0) else { return };
        let begun = own.clock.now_ns();
        let input = OwnPictureInput {
            picture: &seen.picture,
            camera: seen.camera.as_ref(),
            joints: &seen.joints,
            depth: seen.depth.as_deref(),
            mask: Some(&seen.mask).filter(|mask| mask.side > 0),
            colours: &[],
        };
        let drawn = own.mirror.draw(&own.parts.model, snapshot, &input, &OwnPictureOptions::of(SIZE));
        let now = own.clock.now_ns();
        if begun >= own.from_ns {
            own.stamp.add(now.saturating_sub(seen.taken_ns));
            own.drawing.add(now - begun);
            own.pictures[0] += 1;
            match drawn {
                Ok(()) => own.pictures[1] += 1,
                Err(plain) => own.plain[plain as usize] += 1,
            }
        }
    }
}
