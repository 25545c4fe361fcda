//! Setup: the guest's parts as a configuration of the kiosk has them.

use std::sync::Arc;

use super::atelier::Room;
use super::desk::{Desk, Front};
use super::layout::Mount;
use super::model::{House, Model, Rules};
use super::screen::Screen;
use super::shelf::Shelf;
use super::words::{Language, Words};
use crate::exit::AppError;
use crate::kiosk::config::{self, Config};
use crate::kiosk::tailor;
use crate::outfit;

/// A minute (s).
const MINUTE_S: f64 = 60.0;

/// Everything that is made before there is a window.
pub struct Setup {
    model: Model,
    words: Words,
    mount: Mount,
    room: Room,
    mark: Option<[f32; 2]>,
}

impl Setup {
    /// As configured, with nobody there, at this time of the loop's clock (ns).
    ///
    /// # Errors
    /// A display whose controls nobody reaches, a garment that is not in the wardrobe or cannot be used.
    pub fn new(config: &Config, now_ns: u64) -> Result<Self, AppError> {
        let display = &config.display;
        let mount = Mount { lower_edge_mm: display.lower_edge_mm, height_mm: display.height_mm };
        if let Some(fault) = mount.fault() {
            return Err(AppError::Input(fault));
        }
        let shelf = Arc::new(Shelf::stock()?);
        let unknown = config.wear.garments.iter().find(|name| shelf.find(name).is_none());
        if let Some(name) = unknown {
            let known: Vec<&str> = shelf.items.iter().map(|item| item.style.name.as_str()).collect();
            return Err(AppError::Input(format!(
                "wear.garments: {name} is not on the shelf; choose of {}",
                known.join(", ")
            )));
        }
        let measure_ns = config::ns(config.session.measure_s);
        let house = House {
            rules: Rules::usual(config.rules(), measure_ns, config::ns(display.picture_minutes * MINUTE_S)),
            language: Language::of(&display.language).unwrap_or_default(),
            large: display.large_type,
            wear: config.wear.garments.clone(),
            size: config.wear.size.clone(),
        };
        let worn: Vec<_> = house.wear.iter().filter_map(|name| shelf.find(name)).collect();
        let worn: Vec<_> = worn.into_iter().map(|place| shelf.items[place].style.clone()).collect();
        let room =
            Room { shelf: shelf.clone(), quality: config.wish().quality, population: outfit::population(&worn)? };
        let model = Model::new(house, shelf, now_ns);
        Ok(Self { model, words: Words::load()?, mount, room, mark: display.mark_m })
    }

    /// What is shown first.
    pub fn first(&self) -> Screen {
        Screen::of(&self.model, &self.words, &self.mount)
    }

    /// At work behind a window. `played` is the recording that shoppers are measured from, where one is played.
    pub fn desk<O>(self, front: Front<'_, O>, played: Option<tailor::Model>) -> Desk<'_, O> {
        Desk::new((self.model, self.words, self.mount), front, self.room, played, self.mark)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guest::screen::Page;

    #[test]
    fn what_is_configured_is_what_is_shown_first() {
        let text = "[display]\nlanguage = \"tr\"\nlarge_type = true\nlower_edge_mm = 300.0\nheight_mm = 1500.0\n";
        let setup = Setup::new(&Config::parse("k.toml", text).unwrap(), 0).unwrap();
        let first = setup.first();
        assert_eq!((first.page, first.language), (Page::Attract, "tr"));
        assert!(first.type_scale > 1.0);
        let high = 300.0 + first.reach * 1500.0;
        assert!((high - 1220.0).abs() < 0.5, "{high}");
    }

    #[test]
    fn all_configured_languages_are_spoken() {
        assert_eq!(config::LANGUAGES, Language::ALL.map(Language::tag));
        let display = config::Display::default();
        let mount = Mount { lower_edge_mm: display.lower_edge_mm, height_mm: display.height_mm };
        assert_eq!(mount, Mount::default());
    }

    #[test]
    fn what_nobody_could_use_is_refused() {
        for (text, word) in
            [("[display]\nlower_edge_mm = 1000.0", "within reach"), ("[wear]\ngarments = [\"tent\"]", "tent")]
        {
            let refused = Setup::new(&Config::parse("k.toml", text).unwrap(), 0).err().unwrap();
            assert!(matches!(&refused, AppError::Input(said) if said.contains(word)), "{refused}");
        }
    }
}
