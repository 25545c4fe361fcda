//! The languages of the pages, and the texts in each.

pub use super::text_keys::TextKey;
#[cfg(any(test, feature = "window"))]
pub use super::translation::{TextValue, Texts, Translation};

/// A language of the pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Language {
    /// `en`, in which all texts are whole.
    #[default]
    English,
    /// German (`de`).
    German,
    /// French (`fr`).
    French,
    /// Spanish (`es`).
    Spanish,
    /// Turkish (`tr`).
    Turkish,
    /// Japanese (`ja`).
    Japanese,
}

impl Language {
    /// All of them, in the order in which they are offered.
    pub const ALL: [Self; 6] =
        [Self::English, Self::German, Self::French, Self::Spanish, Self::Turkish, Self::Japanese];

    /// Language tag (BCP 47).
    pub const fn tag(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::German => "de",
            Self::French => "fr",
            Self::Spanish => "es",
            Self::Turkish => "tr",
            Self::Japanese => "ja",
        }
    }

    /// A language by its tag.
    pub fn of(tag: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|language| language.tag() == tag)
    }

    /// Text of its Fluent file.
    pub const fn text(self) -> &'static str {
        match self {
            Self::English => include_str!("../../texts/en.ftl"),
            Self::German => include_str!("../../texts/de.ftl"),
            Self::French => include_str!("../../texts/fr.ftl"),
            Self::Spanish => include_str!("../../texts/es.ftl"),
            Self::Turkish => include_str!("../../texts/tr.ftl"),
            Self::Japanese => include_str!("../../texts/ja.ftl"),
        }
    }

    /// Decimal mark: a point or a comma.
    pub const fn decimal_mark(self) -> char {
        if matches!(self, Self::English | Self::Japanese) { '.' } else { ',' }
    }
}
