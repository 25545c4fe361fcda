//! The study file: garments, people, sensor, amount of physics. Unknown keys are refused.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;
use toile_assets::toml_keys;
use toml::de::{DeTable, DeValue};

use crate::error::{Result, StudyError};

/// Most people of a study: more would not fit into the numbers of rows of one file.
const MOST_PEOPLE: u64 = 1_000_000_000;

/// Keys of each table of the file, by its name in sentences.
const KEYS: [(&str, &[&str]); 5] = [
    ("a study", &["name", "seed", "garment", "population", "sensor", "physics"]),
    ("[[garment]]", &["name", "fabric", "sizes"]),
    (
        "[population]",
        &["from", "people", "women", "file", "unit", "columns", "ignore", "sex", "table", "shares", "table_for"],
    ),
    ("[sensor]", &["view", "sigma_mm"]),
    ("[physics]", &["mode", "people", "sizes", "poses", "quality", "start", "settle_s", "compare", "compare_s"]),
];

/// A study file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StudyFile {
    /// What it is called on its page.
    pub name: String,
    /// Which people are drawn, and which errors the sensor makes.
    #[serde(default)]
    pub seed: u64,
    /// The garments.
    #[serde(default)]
    pub garment: Vec<WantedGarment>,
    /// Who tries them on.
    pub population: WantedPopulation,
    /// Through which sensor their measures are seen.
    #[serde(default)]
    pub sensor: WantedSensor,
    /// How much of it is simulated.
    #[serde(default)]
    pub physics: WantedPhysics,
}

/// A garment.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct WantedGarment {
    /// As `toile try-on --garment` has it; a path is from the study file's folder.
    pub name: String,
    /// A built-in fabric in place of its own.
    pub fabric: Option<String>,
    /// The sizes that are tried; all that are made where there are none.
    #[serde(default)]
    pub sizes: Vec<String>,
}

/// Where the people come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PeopleFrom {
    /// Drawn from the covariance of ANSUR II.
    Ansur,
    /// A table of measures, a person a row.
    Table,
    /// How many wear each size of a table.
    Sizes,
}

/// Who tries the garments on.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct WantedPopulation {
    /// Where they come from.
    pub from: PeopleFrom,
    /// How many are drawn; of a table all of its rows where it is left out.
    pub people: Option<u64>,
    /// Share of women among those drawn, 0 to 1.
    pub women: Option<f64>,
    /// The table's file: CSV or Parquet.
    pub file: Option<String>,
    /// Unit of its lengths: mm, cm, m or in.
    pub unit: Option<String>,
    /// The columns that hold a measure, the weight or the sex, by what they hold.
    #[serde(default)]
    pub columns: BTreeMap<String, String>,
    /// Columns that are passed over.
    #[serde(default)]
    pub ignore: Vec<String>,
    /// Whose measures a table without a column `sex` has.
    pub sex: Option<String>,
    /// The size table of `from = "sizes"`.
    pub table: Option<String>,
    /// The kind of garment whose first girth says what a size is.
    pub table_for: Option<String>,
    /// How many wear each of its sizes, in any unit.
    #[serde(default)]
    pub shares: BTreeMap<String, f64>,
}

/// Errors with which measures are seen.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
pub struct WantedSensor {
    /// `front`, `turned` or `none`.
    pub view: Option<String>,
    /// Errors of one's own (standard deviations, mm): stature, chest, waist, hip.
    #[serde(default)]
    pub sigma_mm: BTreeMap<String, f64>,
}

/// Whether cloth is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum PhysicsMode {
    /// Sizes and ease alone.
    #[default]
    None,
    /// Try-ons are draped.
    Drape,
}

/// How much is simulated.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default)]
pub struct WantedPhysics {
    /// Whether cloth is simulated.
    pub mode: PhysicsMode,
    /// The first so many people are draped; all where it is left out.
    pub people: Option<u64>,
    /// `recommended`, `near` (one smaller and one larger besides) or `all`.
    pub sizes: String,
    /// `standing`, `arms-raised`, `sitting`, `walking`.
    pub poses: Vec<String>,
    /// Tested settings of the cloth: draft, shop or fine.
    pub quality: String,
    /// `size` (as it hangs on the body of the size) or `panels` (sewn up around each body).
    pub start: String,
    /// Time in which a garment settles once it is dressed (s).
    pub settle_s: f64,
    /// The first so many people are draped a second time, sewn up around them and settled for long: the error of `start` and
    /// `settle_s`.
    pub compare: u64,
    /// How long that is (s).
    pub compare_s: f64,
}

impl Default for WantedPhysics {
    fn default() -> Self {
        Self {
            mode: PhysicsMode::None,
            people: None,
            sizes: "near".to_owned(),
            poses: vec!["standing".to_owned()],
            quality: "fine".to_owned(),
            start: "size".to_owned(),
            settle_s: 0.5,
            compare: 0,
            compare_s: 8.0,
        }
    }
}

impl StudyFile {
    /// Reads a study's text; `shown` is what messages call it.
    ///
    /// # Errors
    /// What of it cannot be used, with its line and the cure.
    pub fn parse(shown: &str, text: &str) -> Result<Self> {
        let at = |place: usize, why: &str| {
            let (line, column) = toml_keys::place(text, place);
            StudyError::Input(format!("{shown}: line {line}, column {column}: {why}"))
        };
        let failed = |e: toml::de::Error| {
            let start = e.span().map_or(0, |span| span.start);
            at(start, &format!("{}; docs/study.md has an example", e.message().lines().next().unwrap_or("no TOML")))
        };
        let root = DeTable::parse(text).map_err(failed)?;
        let unknown = |u: toml_keys::UnknownKey| at(u.at, &u.message);
        toml_keys::check(root.get_ref(), KEYS[0].0, KEYS[0].1).map_err(unknown)?;
        for (table, (name, known)) in ["garment", "population", "sensor", "physics"].iter().zip(&KEYS[1..]) {
            match root.get_ref().get(*table).map(|value| value.get_ref()) {
                Some(DeValue::Table(entries)) => toml_keys::check(entries, name, known).map_err(unknown)?,
                Some(DeValue::Array(all)) => {
                    for entries in all.iter().filter_map(|one| one.get_ref().as_table()) {
                        toml_keys::check(entries, name, known).map_err(unknown)?;
                    }
                }
                _ => {}
            }
        }
        let file: Self = toml::from_str(text).map_err(failed)?;
        file.check().map_err(|why| StudyError::Input(format!("{shown}: {why}")))?;
        Ok(file)
    }

    /// Reads a study's file.
    ///
    /// # Errors
    /// As [`Self::parse`]; a file that cannot be read.
    pub fn read(path: &Path) -> Result<(Self, String)> {
        const KIND: toile_assets::file::FileKind = toile_assets::file::FileKind {
            name: "a study file",
            max_bytes: 1 << 20,
            cure: "give people as a table of their own",
        };
        let text = toile_assets::file::read_text(path, &KIND).map_err(StudyError::input)?;
        Ok((Self::parse(&path.display().to_string(), &text)?, text))
    }

    fn check(&self) -> std::result::Result<(), String> {
        if self.garment.is_empty() {
            return Err("there is no [[garment]]; name one at least, such as name = \"tee\"".to_owned());
        }
        let people = &self.population;
        if people.people == Some(0) || people.people.is_some_and(|n| n > MOST_PEOPLE) {
            return Err(format!("[population] people has to be 1 to {MOST_PEOPLE}"));
        }
        if people.women.is_some_and(|share| !(0.0..=1.0).contains(&share)) {
            return Err("[population] women is a share, 0 to 1".to_owned());
        }
        for (size, share) in &people.shares {
            if !(share.is_finite() && *share >= 0.0) {
                return Err(format!("[population] shares: {size} = {share} is no share; give 0 or more"));
            }
        }
        let physics = &self.physics;
        let seconds = |name: &str, value: f64| match (0.0..=60.0).contains(&value) {
            true => Ok(()),
            false => Err(format!("[physics] {name} = {value} is no time from 0 to 60 s")),
        };
        seconds("settle_s", physics.settle_s)?;
        seconds("compare_s", physics.compare_s)?;
        if physics.poses.is_empty() {
            return Err("[physics] poses is empty; leave it out to let all people stand".to_owned());
        }
        one_of("[physics] sizes", &physics.sizes, &["recommended", "near", "all"])
    }
}

/// That a word is one of those that are known.
pub(crate) fn one_of(key: &str, word: &str, known: &[&str]) -> std::result::Result<(), String> {
    if known.contains(&word) {
        return Ok(());
    }
    let meant = toml_keys::nearest(word, known.iter().copied());
    let cure = meant.map_or_else(|| format!("use one of {}", known.join(", ")), |m| format!("did you mean {m:?}?"));
    Err(format!("{key} = {word:?} is not known; {cure}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = "name = \"x\"\n[[garment]]\nname = \"tee\"\n[population]\nfrom = \"ansur\"\npeople = 10\n";

    #[test]
    fn a_small_study_is_read_and_every_wrong_key_is_refused_by_its_line() {
        let file = StudyFile::parse("x.toml", SMALL).unwrap();
        assert_eq!((file.garment.len(), file.population.people, file.physics.mode), (1, Some(10), PhysicsMode::None));
        for (text, says) in [
            (
                SMALL.replace("people", "poeple"),
                "line 6, column 1: [population] has no key \"poeple\"; did you mean \"people\"",
            ),
            (
                SMALL.replace("tee\"\n", "tee\"\nsize = [\"38\"]\n"),
                "[[garment]] has no key \"size\"; did you mean \"sizes\"",
            ),
            (SMALL.replace("ansur", "ansor"), "line 5"),
            (SMALL.replace("10", "0"), "people has to be 1 to"),
            (format!("{SMALL}women = 2.0\n"), "women is a share"),
            (format!("{SMALL}[physics]\nsizes = \"nera\"\n"), "did you mean \"near\"?"),
            (format!("{SMALL}[physics]\nsettle_s = -1\n"), "is no time"),
            (SMALL.replace("[[garment]]\nname = \"tee\"\n", ""), "there is no [[garment]]"),
        ] {
            let refused = StudyFile::parse("x.toml", &text).unwrap_err().to_string();
            assert!(refused.contains(says) && refused.starts_with("x.toml"), "{refused}");
        }
    }
}
