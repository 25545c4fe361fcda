//! The kiosk with a window: the visit's controller decides, the window's renderer draws.

use toile_engine::clock::Clock;
use toile_engine::frame_loop::physics_thread::WorldScene;
use toile_engine::world::{Snapshot, World};
use toile_fitting::live::own_picture::PictureReceiver;
use toile_pose::files;
use toile_view::figure::Appearance;

use super::body_model::BodyModel;
use super::open::{self, ServiceChannels};
use super::options::WindowOptions;
use super::{UserEvent, WindowRenderer};
use crate::error::KioskError;
use crate::service::controller::ToScene;
use crate::service::report::KioskReport;
use crate::service::stock_watch;
use crate::service::{BoxedController, ControllerStart, Frontend, KioskRun, serve};
use crate::visitor::face_camera::FaceCamera;
use crate::visitor::face_maker::FaceMaker;
use crate::visitor::model::Input;
use crate::visitor::own_face::WornFace;
use crate::visitor::page_window::WindowChannels;
use crate::visitor::setup::VisitorSetup;

/// Runs `toile kiosk` at a window.
///
/// # Errors
/// As without a window; where there is no display, or nothing that can draw on it.
pub fn run(kiosk: KioskRun<'_>) -> Result<KioskReport, KioskError> {
    let display = &kiosk.config.display;
    let setup = VisitorSetup::new(kiosk.config, kiosk.stock, kiosk.clock.now_ns())?
        .making_faces(FaceMaker::configured(kiosk.config, &files::folder())?);
    setup.left_out.iter().for_each(|left| (kiosk.print_line)(&stock_watch::line(left)));
    let (config, stock) = (kiosk.config.clone(), kiosk.stock.clone());
    let options = WindowOptions {
        windowed: kiosk.options.windowed,
        height_mm: display.height_mm,
        begun: kiosk.begun,
        clock: kiosk.clock,
        motion: display.motion,
        first: setup.first(),
        stop: kiosk.stop.clone(),
    };
    let (appearance, worn) = (display.appearance(), WornFace::default());
    open::run(options, |channels| {
        let ServiceChannels { screens, mut user_events, pairs, opening } = channels;
        let next_input = Box::new(move || user_events.pop().map(input));
        let (face, to_scene) = (worn.clone(), to_scene(appearance, worn.clone()));
        let draped = Box::new(move |world: &World, snapshot: &Snapshot| {
            BodyModel::draped(world, snapshot, appearance, face.of(world.body().sex).as_deref())
        });
        let channels = WindowChannels { screens, next_input, pairs, draped };
        let controller = move |start: ControllerStart| -> Result<BoxedController<'_, BodyModel>, KioskError> {
            let watch = setup.watch(config, stock, start.pose)?;
            let faces = start.portraits.map(|(pictures, switch)| FaceCamera::new(pictures, switch));
            let visit = setup.controller(channels, start.played).switching(start.switch).taking_faces(faces, worn);
            Ok(Box::new(visit.watching(watch)))
        };
        let print_line = kiosk.print_line;
        let renderer = |mannequin: &World, pictures: Option<PictureReceiver>| {
            let renderer = opening.finish()?.seeing(pictures);
            if let Some(slow) = renderer.slowness() {
                print_line(&slow);
            }
            Ok(renderer.showing(BodyModel::of(mannequin, appearance, None)))
        };
        let (mut report, drawn) = serve(kiosk, Frontend { renderer, to_scene, controller })?;
        if let Some(mut renderer) = drawn {
            let (window, warnings) = WindowRenderer::report(&mut renderer);
            report.window = Some(window);
            report.warnings.extend(warnings);
        }
        Ok(report)
    })
}

/// A frame as a scene of the loop, and what is drawn of it.
fn to_scene(appearance: Appearance, worn: WornFace) -> ToScene<WorldScene, BodyModel> {
    Box::new(move |world| {
        let model = BodyModel::of(&world, appearance, worn.of(world.body().sex).as_deref());
        (WorldScene::new(world), model)
    })
}

/// An event from the display as the visitor's model takes it.
fn input(event: UserEvent) -> Input {
    match event {
        UserEvent::Pressed(action) => Input::Pressed(action),
        UserEvent::Key(key) => Input::Key(key),
        UserEvent::Typed(action) => Input::Typed(action),
    }
}
