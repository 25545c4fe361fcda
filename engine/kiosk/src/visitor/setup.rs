//! Setup: the visitor's parts as the configuration of the kiosk has them.

use std::sync::Arc;

use super::controller::{NoWindow, VisitController};
use super::dressing_worker::DressingContext;
use super::model::{VisitDefaults, VisitModel, VisitTimes};
#[cfg(any(test, feature = "window"))]
use super::page_window::{PageWindow, WindowChannels};
use super::reach::DisplayMount;
#[cfg(any(test, feature = "window"))]
use super::screen::Screen;
use super::texts::Language;
#[cfg(any(test, feature = "window"))]
use super::texts::Texts;
use super::wardrobe::Wardrobe;
use crate::error::KioskError;
use crate::service::config::{self, Config};
use crate::service::picture_config::OwnPictureUse;
use crate::service::stock::{LeftOut, Stock};
use crate::service::stock_watch::{Hang, LOOK_EVERY, StockWatch, WatchStart};
use toile_base::frame::Joints;
use toile_fitting::live::shopper_source::ShopperSource;

/// A minute (s).
const MINUTE_S: f64 = 60.0;

/// Everything that is made before there is a window.
pub struct VisitorSetup {
    model: VisitModel,
    #[cfg(any(test, feature = "window"))]
    texts: Texts,
    #[cfg(any(test, feature = "window"))]
    mount: DisplayMount,
    context: DressingContext,
    mark: Option<[f32; 2]>,
    /// What cannot be used.
    pub left_out: Vec<LeftOut>,
}

impl VisitorSetup {
    /// As configured, without a visitor, at this time of the loop's clock (ns).
    ///
    /// # Errors
    /// A display whose controls are out of reach, a garment that is not in the wardrobe or cannot be used.
    pub fn new(config: &Config, stock: &Stock, now_ns: u64) -> Result<Self, KioskError> {
        let display = &config.display;
        let mount = DisplayMount { lower_edge_mm: display.lower_edge_mm, height_mm: display.height_mm };
        if let Some(fault) = mount.fault() {
            return Err(KioskError::Input(fault));
        }
        let mut left_out = stock.left_out.clone();
        let wardrobe = Arc::new(Wardrobe::of(stock, None, &mut left_out)?);
        // Measures by tape are the visit's: they are listed, and can be removed.
        let mut facts = config.shopper.facts().map_err(KioskError::Input)?;
        let tape = std::mem::take(&mut facts.tape);
        let measure_ns = config::ns(config.session.measure_s);
        let defaults = VisitDefaults {
            times: VisitTimes::usual(config.times(), measure_ns, config::ns(display.picture_minutes * MINUTE_S)),
            language: Language::of(&display.language).unwrap_or_default(),
            large: display.large_type,
            wear: stock.first.names(),
            size: config.wear.size.clone(),
            tape,
            motion: display.motion,
            own_picture: display.own_picture == OwnPictureUse::First,
        };
        let first = stock.first.clone();
        let (quality, appearance) = (stock.first.quality, display.appearance());
        let context = DressingContext::new(wardrobe.clone(), first, quality, facts, appearance);
        let context = context.serving(config.picture.clone());
        let model = VisitModel::new(defaults, wardrobe, now_ns);
        Ok(Self {
            model,
            #[cfg(any(test, feature = "window"))]
            texts: Texts::load()?,
            #[cfg(any(test, feature = "window"))]
            mount,
            context,
            mark: display.mark_m,
            left_out,
        })
    }

    /// The same, which makes heads of faces.
    #[cfg(any(test, feature = "window"))]
    #[must_use]
    pub fn making_faces(self, faces: Option<super::own_face::MakeHeads>) -> Self {
        Self { context: self.context.making_faces(faces), ..self }
    }

    /// The screen that is shown first.
    #[cfg(any(test, feature = "window"))]
    pub fn first(&self) -> Screen {
        Screen::of(&self.model, &self.texts, &self.mount)
    }

    /// At work behind a window. `played` is the recording that shoppers are measured from, where one is played.
    #[cfg(any(test, feature = "window"))]
    pub fn controller<'a, O: 'a>(
        self,
        channels: WindowChannels<'a, O>,
        played: Option<ShopperSource>,
    ) -> VisitController<'a> {
        let window = PageWindow::new(self.texts, self.mount, channels);
        VisitController::new(self.model, Box::new(window), self.context, played, self.mark)
    }

    /// At work behind a window that shows nothing.
    pub fn headless(self, played: Option<ShopperSource>) -> VisitController<'static> {
        VisitController::new(self.model, Box::new(NoWindow), self.context, played, self.mark)
    }

    /// Watches the files of the stock; nothing where none can change. `pose` is the mannequin's.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn watch(
        &self,
        config: Config,
        stock: Stock,
        pose: Joints,
    ) -> Result<Option<StockWatch<Arc<Wardrobe>>>, KioskError> {
        let (left_out, hang) = (self.left_out.clone(), self.hang());
        StockWatch::start(WatchStart { config, stock, left_out, pose, every: LOOK_EVERY, hang })
    }

    /// What hangs of a stock that is read again, beginning with what hangs now.
    fn hang(&self) -> Hang<Arc<Wardrobe>> {
        let mut before = self.context.wardrobe.clone();
        Box::new(move |stock, left_out| {
            before = Arc::new(Wardrobe::of(stock, Some(&before), left_out)?);
            Ok(before.clone())
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::visitor::face_maker::FaceMaker;
    use crate::visitor::screen::Page;

    fn set_up(text: &str) -> Result<VisitorSetup, KioskError> {
        let config = Config::parse("k.toml", text)?;
        VisitorSetup::new(&config, &Stock::read(&config)?, 0)
    }

    #[test]
    fn what_is_configured_is_what_is_shown_first() {
        let text = "[display]\nlanguage = \"tr\"\nlarge_type = true\nlower_edge_mm = 300.0\nheight_mm = 1500.0\n";
        let setup = set_up(text).unwrap();
        let first = setup.first();
        assert_eq!((first.page, first.language), (Page::Attract, "tr"));
        assert!(first.type_scale > 1.0);
        let high = 300.0 + first.reach * 1500.0;
        assert!((high - 1220.0).abs() < 0.5, "{high}");
    }

    #[test]
    fn faces_are_off_by_default_and_refused_without_their_network() {
        let none = Path::new("no/such");
        let made = |text: &str| FaceMaker::configured(&Config::parse("k.toml", text).unwrap(), none);
        assert!(!config::DisplayConfig::default().face);
        assert!(made("[sensor]\ncamera = \"webcam\"\n").unwrap().is_none());
        assert!(made("[display]\nface = true\n").unwrap().is_none(), "without a camera there is no face to take");
        let refused = made("[display]\nface = true\n[sensor]\ncamera = \"webcam\"\n").err().unwrap();
        let KioskError::Device(why) = refused else { panic!("{refused}") };
        assert!(
            why.starts_with("a shopper's own face needs the face network of MediaPipe, and no/such holds no"),
            "{why}"
        );
        assert!(why.contains("; fetch it: `cd $(mktemp -d) && npm pack") && !why.contains('\n'), "{why}");
        assert!(Config::parse("k.toml", "[display]\nface = 3\n").is_err());
        assert!(config::EXAMPLE.contains("\nface = false\n"));
    }

    #[test]
    fn all_configured_languages_are_spoken() {
        assert_eq!(config::LANGUAGES, Language::ALL.map(Language::tag));
        let display = config::DisplayConfig::default();
        let mount = DisplayMount { lower_edge_mm: display.lower_edge_mm, height_mm: display.height_mm };
        assert_eq!(mount, DisplayMount::default());
    }

    #[test]
    fn an_unusable_setup_is_refused() {
        for (text, word) in
            [("[display]\nlower_edge_mm = 1000.0", "within reach"), ("[wear]\ngarments = [\"tent\"]", "tent")]
        {
            let refused = set_up(text).err().unwrap();
            assert!(matches!(&refused, KioskError::Input(message) if message.contains(word)), "{refused}");
        }
    }
}
