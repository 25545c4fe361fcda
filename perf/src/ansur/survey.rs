//! The survey's files: the measured people, in millimetres.

use std::path::{Path, PathBuf};

use toile_assets::file::{self, FileError, FileKind};
use toile_base::body::Sex;

use crate::random::CaseRandom;

/// A survey as a table: ANSUR II has 3 MB and more people than any other that is public.
const SURVEY: FileKind = FileKind {
    name: "an ANSUR II file, such as ANSUR_II_FEMALE.csv",
    max_bytes: 64 << 20,
    cure: "leave out columns that are not measures",
};

/// Why the survey cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurveyError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A measure that the file does not have.
    #[error("{file}: there is no column {column}; give a file of ANSUR II with `;` between its columns")]
    NoColumn {
        /// The file's path as the user gave it.
        file: String,
        /// The column's name.
        column: String,
    },
    /// A cell that does not hold a number.
    #[error("{file}: line {line}: {column} is no number of millimetres; repair the line or leave it out")]
    NoNumber {
        /// The file's path as the user gave it.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The column's name.
        column: String,
    },
}

/// One of the survey's files.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    file: PathBuf,
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Survey {
    /// Reads a file: `;` between columns, names in the first line.
    ///
    /// # Errors
    /// [`SurveyError::File`].
    pub fn read(path: &Path) -> Result<Self, SurveyError> {
        let bytes = file::read(path, &SURVEY)?;
        // One name has a letter that is not UTF-8; the measures are plain digits.
        let text = String::from_utf8_lossy(&bytes);
        let mut lines = text.lines().map(|l| l.split(';').map(|c| c.trim().to_owned()).collect::<Vec<_>>());
        let names = lines.next().unwrap_or_default();
        Ok(Self { file: path.to_owned(), names, rows: lines.filter(|r| r.len() > 1).collect() })
    }

    /// Number of people.
    pub fn people(&self) -> usize {
        self.rows.len()
    }

    /// Whose measures these are, by the column `Gender` of the first person.
    ///
    /// # Errors
    /// [`SurveyError::NoColumn`] where that column is missing or says something else.
    pub fn sex(&self) -> Result<Sex, SurveyError> {
        let place = self.names.iter().position(|n| n == "Gender");
        let word = place.and_then(|c| self.rows.first()?.get(c)).map(String::as_str);
        match word {
            Some("Female") => Ok(Sex::Female),
            Some("Male") => Ok(Sex::Male),
            _ => Err(SurveyError::NoColumn { file: self.file.display().to_string(), column: "Gender".into() }),
        }
    }

    /// One measure of all people (mm).
    ///
    /// # Errors
    /// [`SurveyError::NoColumn`], [`SurveyError::NoNumber`].
    pub fn column(&self, name: &str) -> Result<Vec<f64>, SurveyError> {
        let file = || self.file.display().to_string();
        let place = self
            .names
            .iter()
            .position(|n| n == name)
            .ok_or_else(|| SurveyError::NoColumn { file: file(), column: name.to_owned() })?;
        let cell = |(line, row): (usize, &Vec<String>)| {
            let number = row.get(place).and_then(|c| c.parse::<f64>().ok()).filter(|x| x.is_finite());
            number.ok_or_else(|| SurveyError::NoNumber { file: file(), line: line + 2, column: name.to_owned() })
        };
        self.rows.iter().enumerate().map(cell).collect()
    }
}

/// Draws `count` of so many people without repeats: the first rows of a shuffle (Fisher and Yates).
pub fn chosen(people: usize, count: usize, seed: u64) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..people).collect();
    let mut random = CaseRandom::new("ansur", seed);
    let count = count.min(people);
    for i in 0..count {
        let other = i + random.below(people - i);
        rows.swap(i, other);
    }
    rows.truncate(count);
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_person_is_drawn_twice() {
        let mut rows = chosen(100, 60, 7);
        assert_eq!(rows, chosen(100, 60, 7), "by the seed");
        assert_ne!(rows, chosen(100, 60, 8));
        rows.sort_unstable();
        rows.dedup();
        assert_eq!(rows.len(), 60);
        assert_eq!(chosen(5, 60, 7).len(), 5);
    }
}
