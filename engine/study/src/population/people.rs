//! People of a study by number, drawn or read from a table.

use std::path::Path;

use toile_assets::body::En;
use toile_assets::body::shape::Shapes;
use toile_assets::sizes::{GarmentKind, Girth, SizeTable};
use toile_base::body::{Measures, Sex};
use toile_base::numeric::random::SplitMix64;
use toile_track::estimate::Estimate;
use toile_track::fit::measuring::{FittedMeasure, MEASURES};
use toile_track::tape_readings::{self, BodyEstimate};

use super::draw::{self, Purpose, generator};
use super::person::{Origin, Person};
use super::table::{self, TableRow};
use crate::error::{Result, StudyError};
use crate::study_file::{PeopleFrom, WantedPopulation};

/// People who are drawn where a study does not say how many.
const PEOPLE: u64 = 1000;

/// How people come by.
enum Way {
    Drawn { women: f64 },
    Listed { rows: Vec<TableRow>, drawn: Option<Vec<f64>> },
    Sized { table: SizeTable, girth: Girth, sex: Sex, upto: Vec<f64> },
}

/// Who tries garments on.
pub struct Population {
    people: u64,
    seed: u64,
    way: Way,
    /// The whole table's bytes, or the words that say how people are drawn: part of what a study is.
    pub(crate) source: Vec<u8>,
}

impl std::fmt::Debug for Population {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.debug_struct("Population").field("people", &self.people).field("seed", &self.seed).finish_non_exhaustive()
    }
}

impl Population {
    /// The population that a study file wants; paths are from `folder`.
    ///
    /// # Errors
    /// A table that cannot be used, keys that do not go together.
    pub fn open(wanted: &WantedPopulation, seed: u64, folder: &Path) -> Result<Self> {
        let refused = |key: &str, for_: &str| {
            Err(StudyError::Input(format!(
                "[population] {key} is for from = {for_:?} alone; leave it out or change from"
            )))
        };
        let only = [
            ("file", PeopleFrom::Table, wanted.file.is_some()),
            ("unit", PeopleFrom::Table, wanted.unit.is_some()),
            ("columns", PeopleFrom::Table, !wanted.columns.is_empty()),
            ("ignore", PeopleFrom::Table, !wanted.ignore.is_empty()),
            ("sex", PeopleFrom::Table, wanted.sex.is_some()),
            ("women", PeopleFrom::Ansur, wanted.women.is_some()),
            ("table", PeopleFrom::Sizes, wanted.table.is_some()),
            ("table_for", PeopleFrom::Sizes, wanted.table_for.is_some()),
            ("shares", PeopleFrom::Sizes, !wanted.shares.is_empty()),
        ];
        for (key, from, given) in only {
            if given && from != wanted.from {
                return refused(key, from.word());
            }
        }
        let mut source = Vec::new();
        let (way, people) = match wanted.from {
            PeopleFrom::Ansur => (Way::Drawn { women: wanted.women.unwrap_or(0.5) }, wanted.people.unwrap_or(PEOPLE)),
            PeopleFrom::Table => {
                let Some(file) = &wanted.file else {
                    return Err(StudyError::Input(
                        "[population] from = \"table\" needs file = \"people.csv\"".to_owned(),
                    ));
                };
                let path = folder.join(file);
                let rows = table::read(&path, wanted)?;
                source = std::fs::read(&path).map_err(StudyError::input)?;
                let people = wanted.people.unwrap_or(rows.len() as u64);
                // As many as are asked for are drawn by their weights; else each stands for its own.
                let drawn = wanted.people.map(|_| running(rows.iter().map(|row| row.weight)));
                (Way::Listed { rows, drawn }, people)
            }
            PeopleFrom::Sizes => (sized(wanted)?, wanted.people.unwrap_or(PEOPLE)),
        };
        Ok(Self { people, seed, way, source })
    }

    /// Number of people.
    pub const fn people(&self) -> u64 {
        self.people
    }

    /// Person number `number`, from 0.
    ///
    /// # Panics
    /// Where there is no such number.
    pub fn person(&self, number: u64) -> Person {
        assert!(number < self.people, "there are {} people", self.people);
        let mut random = generator(self.seed, Purpose::Person, number);
        match &self.way {
            Way::Drawn { women } => {
                let sex = if random.uniform_f64() < *women { Sex::Female } else { Sex::Male };
                drawn_person(number, sex, None, &mut random)
            }
            Way::Listed { rows, drawn } => {
                let at = drawn.as_ref().map_or(number as usize, |upto| place(upto, &mut random));
                let row = &rows[at];
                let weight = if drawn.is_some() { 1.0 } else { row.weight };
                given(number, weight, row.sex, row.given.clone())
            }
            Way::Sized { table, girth, sex, upto } => {
                let [least, most] = table.sizes[place(upto, &mut random)].range(*girth);
                let value = least + (most - least) * random.uniform();
                drawn_person(number, *sex, Some((measure_of(*girth), value)), &mut random)
            }
        }
    }
}

impl PeopleFrom {
    const fn word(self) -> &'static str {
        match self {
            Self::Ansur => "ansur",
            Self::Table => "table",
            Self::Sizes => "sizes",
        }
    }
}

/// A person of the survey, with one measure as given (m) where that is so.
fn drawn_person(number: u64, sex: Sex, known: Option<(En, f32)>, random: &mut SplitMix64) -> Person {
    let shapes = Shapes::of(sex);
    let shape = draw::shape(shapes, known, random);
    let readings = shapes.read(&shape).readings;
    let measures = Measures {
        stature: readings.of(En::Stature),
        shoulder_breadth: readings.of(En::ShoulderBreadth),
        chest_girth: readings.of(En::BustGirth),
        waist_girth: readings.of(En::WaistGirth),
        hip_girth: readings.of(En::HipGirth),
    };
    Person { number, weight: 1.0, sex, measures, origin: Origin::Shape(Box::new(shape)) }
}

/// A person of given measures: those that are missing are what people with the others have in the mean.
fn given(number: u64, weight: f64, sex: Sex, given: Vec<(En, f32)>) -> Person {
    let known = expected(sex, given.iter().copied());
    let at = |measure: En| {
        let taken = given.iter().find(|(of, _)| *of == measure).map(|(_, value)| *value);
        taken.unwrap_or_else(|| index(measure).map_or(0.0, |i| known.mean[i]))
    };
    let measures = Measures {
        stature: at(En::Stature),
        shoulder_breadth: at(En::ShoulderBreadth),
        chest_girth: at(En::BustGirth),
        waist_girth: at(En::WaistGirth),
        hip_girth: at(En::HipGirth),
    };
    Person { number, weight, sex, measures, origin: Origin::Given(given) }
}

/// What is known of a person of whom some measures are known exactly.
fn expected(sex: Sex, given: impl Iterator<Item = (En, f32)>) -> BodyEstimate {
    let all = tape_readings::population(Some(sex).into());
    given
        .filter_map(|(m, value)| Some((index(m)?, value)))
        .fold(all, |all, (i, v)| all.observed(i, Estimate::new(v, 1e-4)))
}

fn index(measure: En) -> Option<usize> {
    MEASURES.iter().position(|(_, of, _)| *of == FittedMeasure::Standard(measure))
}

const fn measure_of(girth: Girth) -> En {
    match girth {
        Girth::Chest => En::BustGirth,
        Girth::Waist => En::WaistGirth,
        Girth::Hip => En::HipGirth,
    }
}

/// Sums from the first to each.
fn running(all: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = 0.0;
    all.map(|one| {
        sum += one;
        sum
    })
    .collect()
}

/// Which of them is drawn, by their shares.
fn place(upto: &[f64], random: &mut SplitMix64) -> usize {
    let at = random.uniform_f64() * upto.last().copied().unwrap_or(0.0);
    upto.partition_point(|sum| *sum <= at).min(upto.len() - 1)
}

fn sized(wanted: &WantedPopulation) -> Result<Way> {
    let Some(name) = &wanted.table else {
        let names = SizeTable::embedded_names().join(", ");
        return Err(StudyError::Input(format!("[population] from = \"sizes\" needs table, one of {names}")));
    };
    let table = SizeTable::embedded(name).map_err(StudyError::input)?;
    let kinds: Vec<GarmentKind> = table.designations.iter().map(|d| d.garment).collect();
    let kind = match &wanted.table_for {
        None => kinds[0],
        Some(word) => *kinds.iter().find(|kind| kind.name() == word).ok_or_else(|| {
            let known: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
            StudyError::Input(format!(
                "[population] table_for = {word:?} is not in {name}; use one of {}",
                known.join(", ")
            ))
        })?,
    };
    let girth = table.designation(kind).and_then(|d| d.primary.first().copied()).unwrap_or(Girth::Chest);
    if let Some(size) = wanted.shares.keys().find(|size| table.size(size).is_err()) {
        table.size(size).map_err(|e| StudyError::Input(format!("[population] shares: {e}")))?;
    }
    let sex = match (table.population, wanted.sex.as_deref()) {
        (toile_assets::sizes::Population::Men, _) => Sex::Male,
        _ => Sex::Female,
    };
    let upto = running(table.sizes.iter().map(|size| wanted.shares.get(&size.code).copied().unwrap_or(0.0)));
    if upto.last().is_none_or(|all| *all <= 0.0) {
        return Err(StudyError::Input(
            "[population] shares says of no size how many wear it; give such as { \"38\" = 12, \"40\" = 20 }"
                .to_owned(),
        ));
    }
    Ok(Way::Sized { table, girth, sex, upto })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(text: &str) -> Result<Population> {
        Population::open(&toml::from_str(text).unwrap(), 3, Path::new("."))
    }

    #[test]
    fn a_person_is_the_same_by_number() {
        let population = opened("from = \"ansur\"\npeople = 50\nwomen = 0.5").unwrap();
        let all: Vec<Person> = (0..50).map(|n| population.person(n)).collect();
        for n in [49, 3, 17] {
            assert_eq!(opened("from = \"ansur\"\npeople = 50\nwomen = 0.5").unwrap().person(n), all[n as usize]);
        }
        let women = all.iter().filter(|p| p.sex == Sex::Female).count();
        assert!((15..=35).contains(&women), "{women}");
        let body = all[4].body().unwrap();
        assert!((body.measures.waist_girth - all[4].measures.waist_girth).abs() < 1e-5);
    }

    #[test]
    fn people_of_sizes_have_the_girths_and_the_shares_of_the_sizes() {
        let text = "from = \"sizes\"\npeople = 400\ntable = \"women\"\nshares = { \"38\" = 3, \"42\" = 1 }";
        let population = opened(text).unwrap();
        let women = SizeTable::embedded("women").unwrap();
        let chests: Vec<f32> = (0..400).map(|n| population.person(n).measures.chest_girth).collect();
        let inside = |code: &str| {
            let [least, most] = women.size(code).unwrap().range(Girth::Chest);
            chests.iter().filter(|chest| (least..most).contains(chest)).count()
        };
        let (small, large) = (inside("38"), inside("42"));
        assert!(small + large >= 396 && (260..340).contains(&small), "{small} {large}");
        assert!(opened(&text.replace("\"38\"", "\"39\"")).is_err());
    }

    #[test]
    fn keys_of_another_way_are_refused() {
        let refused = opened("from = \"ansur\"\nfile = \"x.csv\"").unwrap_err().to_string();
        assert!(refused.contains("file is for from = \"table\" alone"), "{refused}");
    }
}
