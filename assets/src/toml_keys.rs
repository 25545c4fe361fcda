//! Keys of TOML files: one that is not known is refused by its place, with the known key that may have been meant.

use toml::de::DeTable;

/// A key that is not known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownKey {
    /// Its place (byte of the text).
    pub at: usize,
    /// The sentence: the table, the key and the cure.
    pub message: String,
}

/// Refuses the first key of a table that is not among the known ones. `table` is its name in the sentence.
///
/// # Errors
/// [`UnknownKey`].
pub fn check(entries: &DeTable<'_>, table: &str, known: &[&str]) -> Result<(), UnknownKey> {
    let unknown = entries.keys().find(|key| !known.contains(&key.get_ref().as_ref()));
    let Some(key) = unknown else { return Ok(()) };
    let word: &str = key.get_ref();
    let cure = match nearest(word, known.iter().copied()) {
        Some(meant) => format!("did you mean \"{meant}\"?"),
        None => format!("delete it, or use one of {}", known.join(", ")),
    };
    Err(UnknownKey { at: key.span().start, message: format!("{table} has no key \"{word}\"; {cure}") })
}

/// Line and column of a byte of a text, in characters, both from 1.
pub fn place(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
    (before.matches('\n').count() + 1, column)
}

/// The known word that may have been meant: the one with the fewest letters put in, left out, changed or exchanged, if they
/// are no more than a third of them; or one that begins with the other.
pub fn nearest<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let near = known.map(|k| (strsim::damerau_levenshtein(word, k), k)).min()?;
    let begins = near.1.starts_with(word) || word.starts_with(near.1);
    (near.0 <= near.1.len().max(word.len()).div_ceil(3) || begins).then_some(near.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_key_is_refused_with_its_place_and_the_nearest() {
        let text = "quality = 1\ngarmets = []\n";
        let table = DeTable::parse(text).unwrap();
        let unknown = check(table.get_ref(), "[wear]", &["garments", "quality"]).unwrap_err();
        assert_eq!(unknown.message, "[wear] has no key \"garmets\"; did you mean \"garments\"?");
        assert_eq!(place(text, unknown.at), (2, 1));
        let unknown = check(table.get_ref(), "[wear]", &["quality", "size"]).unwrap_err();
        assert_eq!(unknown.message, "[wear] has no key \"garmets\"; delete it, or use one of quality, size");
        assert_eq!(check(table.get_ref(), "[wear]", &["garmets", "quality"]), Ok(()));
    }

    #[test]
    fn places_are_counted_in_lines_and_characters() {
        let text = "x = 1\ny\u{e4} = 2\nz";
        assert_eq!([0, 9, 999].map(|at| place(text, at)), [(1, 1), (2, 3), (3, 2)]);
    }

    #[test]
    fn the_nearest_word_is_found_and_a_far_one_is_not() {
        let known = ["radius", "centre", "track"];
        assert_eq!(nearest("raduis", known.into_iter()), Some("radius"));
        assert_eq!(nearest("center", known.into_iter()), Some("centre"));
        assert_eq!(nearest("colour", known.into_iter()), None);
    }
}
