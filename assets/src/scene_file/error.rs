//! What is wrong with a scene, in one sentence: the file, the line, the key and the cure.

use std::path::PathBuf;

use thiserror::Error;

/// Why a scene cannot be run.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SceneError {
    /// The scene file itself cannot be read.
    #[error("scene {}: {reason}; give the path of a readable TOML file, or `--example NAME`", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// Something in it is wrong.
    #[error("{file}:{line}:{column}: {says}")]
    At {
        /// The scene file.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// One sentence that names the key and the cure.
        says: String,
    },
    /// No example of that name.
    #[error("there is no example named {name}; choose one of {known}")]
    NoExample {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: String,
    },
}

/// The text of a scene and its name, by which places in it are told.
#[derive(Debug, Clone, Copy)]
pub(super) struct Document<'t> {
    /// The file as the user named it.
    pub file: &'t str,
    /// Its text.
    pub text: &'t str,
}

impl Document<'_> {
    /// An error at a byte of the text.
    pub fn error(&self, at: usize, says: impl Into<String>) -> SceneError {
        let before = self.text.get(..at).unwrap_or(self.text);
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        let says = says.into().split_whitespace().collect::<Vec<_>>().join(" ");
        SceneError::At { file: self.file.into(), line, column, says }
    }
}

/// The known word that a user may have meant: the one fewest letters away, if it is no more than a third of them.
pub(super) fn nearest<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let near = known.map(|k| (distance(word, k), k)).min_by_key(|(d, k)| (*d, *k))?;
    let contained = near.1.starts_with(word) || word.starts_with(near.1);
    (near.0 <= near.1.len().max(word.len()).div_ceil(3) || contained).then_some(near.1)
}

/// Levenshtein distance: letters put in, left out or changed.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let changed = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_in_lines_and_characters() {
        let document = Document { file: "a.toml", text: "x = 1\ny\u{e4} = 2\nz" };
        let told = |at| document.error(at, "wrong").to_string();
        assert_eq!(told(0), "a.toml:1:1: wrong");
        assert_eq!(told(9), "a.toml:2:3: wrong");
        assert_eq!(told(999), "a.toml:3:2: wrong");
    }

    #[test]
    fn the_nearest_word_is_found_and_a_far_one_is_not() {
        let known = ["radius", "centre", "track"];
        assert_eq!(nearest("raduis", known.into_iter()), Some("radius"));
        assert_eq!(nearest("center", known.into_iter()), Some("centre"));
        assert_eq!(nearest("colour", known.into_iter()), None);
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
