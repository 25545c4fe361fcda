//! Texts: the words of the pages in six languages, with the plurals and the decimal mark of each.

use fluent_bundle::concurrent::FluentBundle;
use fluent_bundle::{FluentArgs, FluentResource, FluentValue};
use unic_langid::LanguageIdentifier;

use super::texts::{Language, TextKey};
use crate::error::KioskError;

/// A value that stands in a text.
#[derive(Debug, Clone, PartialEq)]
pub enum TextValue<'a> {
    /// Texts, as they are.
    Text(&'a str),
    /// A whole number, by which a text may choose its plural.
    Count(u32),
    /// A number with so many decimals.
    Number(f32, u8),
}

/// The texts of all languages.
pub struct Texts {
    bundles: [FluentBundle<FluentResource>; Language::ALL.len()],
}

impl Texts {
    /// Reads all texts. At load.
    ///
    /// # Errors
    /// Only where a text of the program's own is broken, which its tests forbid.
    pub fn load() -> Result<Self, KioskError> {
        let bundles = Language::ALL.map(bundle);
        let mut good = Vec::with_capacity(bundles.len());
        for bundle in bundles {
            good.push(bundle?);
        }
        let bundles = good.try_into().map_err(|_| KioskError::internal("a language is missing"))?;
        Ok(Self { bundles })
    }

    /// The texts of one language.
    pub fn of(&self, language: Language) -> Translation<'_> {
        let at = Language::ALL.iter().position(|l| *l == language).unwrap_or_default();
        Translation { bundle: &self.bundles[at], language }
    }
}

fn bundle(language: Language) -> Result<FluentBundle<FluentResource>, KioskError> {
    let broken = |why: String| KioskError::internal(format!("the texts in {} are broken: {why}", language.tag()));
    let tag: LanguageIdentifier = language.tag().parse().map_err(|e| broken(format!("{e}")))?;
    let resource = FluentResource::try_new(language.text().to_owned())
        .map_err(|(_, errors)| broken(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")))?;
    let mut bundle = FluentBundle::new_concurrent(vec![tag]);
    // The marks that isolate text of the other direction are painted as boxes by fonts that lack them; no language here needs them.
    bundle.set_use_isolating(false);
    if language.decimal_mark() == '.' {
        bundle.set_formatter(Some(|value, _| number(value, '.')));
    } else {
        bundle.set_formatter(Some(|value, _| number(value, ',')));
    }
    bundle.add_resource(resource).map_err(|e| broken(format!("{e:?}")))?;
    Ok(bundle)
}

/// A number as it is written, with a real minus.
fn number(value: &FluentValue, mark: char) -> Option<String> {
    let FluentValue::Number(number) = value else { return None };
    let digits = number.options.minimum_fraction_digits.unwrap_or(0);
    Some(format!("{:.digits$}", number.value).replace('.', &mark.to_string()).replace('-', "\u{2212}"))
}

/// The texts of one language.
pub struct Translation<'a> {
    bundle: &'a FluentBundle<FluentResource>,
    language: Language,
}

impl Translation<'_> {
    /// Language of the texts.
    pub fn language(&self) -> Language {
        self.language
    }

    /// A text without values.
    pub fn text(&self, key: TextKey) -> String {
        self.format(key, &[])
    }

    /// A text with values; the name of an unknown text, which tests forbid.
    pub fn format(&self, key: TextKey, values: &[(&str, TextValue)]) -> String {
        let mut args = FluentArgs::with_capacity(values.len());
        for (name, value) in values {
            args.set(*name, fluent(value));
        }
        let pattern = self.bundle.get_message(key.name()).and_then(|message| message.value());
        let Some(pattern) = pattern else { return key.name().to_owned() };
        self.bundle.format_pattern(pattern, Some(&args), &mut Vec::new()).into_owned()
    }

    /// Several words as a list.
    pub fn list(&self, words: &[String]) -> String {
        let pair = |key, first: &str, last: &str| {
            self.format(key, &[("first", TextValue::Text(first)), ("last", TextValue::Text(last))])
        };
        match words {
            [] => String::new(),
            [one] => one.clone(),
            [before @ .., last] => {
                let mut all = before[0].clone();
                for word in &before[1..] {
                    all = pair(TextKey::ListComma, &all, word);
                }
                pair(TextKey::ListAnd, &all, last)
            }
        }
    }
}

fn fluent<'a>(value: &TextValue<'a>) -> FluentValue<'a> {
    match value {
        TextValue::Text(text) => FluentValue::from(*text),
        TextValue::Count(count) => FluentValue::from(*count),
        TextValue::Number(number, decimals) => {
            // Rounded before it is written, so that nothing reads as minus zero.
            let scale = 10_f64.powi(i32::from(*decimals));
            let rounded = (f64::from(*number) * scale).round() / scale + 0.0;
            let options = fluent_bundle::types::FluentNumberOptions {
                minimum_fraction_digits: Some(usize::from(*decimals)),
                ..Default::default()
            };
            FluentValue::Number(fluent_bundle::types::FluentNumber::new(rounded, options))
        }
    }
}
