//! The kiosk without a window: the visit's controller decides as it does at a window, and nothing is shown.

use toile_engine::clock::Clock;
use toile_engine::frame_loop::physics_thread::WorldScene;
use toile_engine::world::World;
use toile_fitting::live::assembly::HeadlessRenderer;
use toile_fitting::live::own_picture::PictureReceiver;

use crate::error::KioskError;
use crate::service::report::KioskReport;
use crate::service::{BoxedController, ControllerStart, Frontend, KioskRun, serve, stock_watch};
use crate::visitor::setup::VisitorSetup;

/// Runs `toile kiosk --headless`.
///
/// # Errors
/// A garment that cannot be used, a display whose controls are out of reach; as [`serve`].
pub fn run(kiosk: KioskRun<'_>) -> Result<KioskReport, KioskError> {
    let setup = VisitorSetup::new(kiosk.config, kiosk.stock, kiosk.clock.now_ns())?;
    setup.left_out.iter().for_each(|left| (kiosk.print_line)(&stock_watch::line(left)));
    let (config, stock) = (kiosk.config.clone(), kiosk.stock.clone());
    let renderer = |_: &World, _: Option<PictureReceiver>| Ok(HeadlessRenderer::default());
    let controller = move |start: ControllerStart| -> Result<BoxedController<'_, ()>, KioskError> {
        let watch = setup.watch(config, stock, start.pose)?;
        Ok(Box::new(setup.headless(start.played).watching(watch)))
    };
    let frontend = Frontend { renderer, to_scene: Box::new(|world| (WorldScene::new(world), ())), controller };
    Ok(serve(kiosk, frontend)?.0)
}
