//! A table of people by others: CSV or Parquet, a person a row, in a stated unit.

use std::collections::BTreeMap;
use std::path::Path;

use bytes::Bytes;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use toile_assets::body::{BodyError, En, Wanted};
use toile_assets::file::{self, FileKind};
use toile_assets::toml_keys;
use toile_base::body::Sex;
use toile_track::fit::measuring::{FittedMeasure, MEASURES};

use crate::error::{Result, StudyError};
use crate::study_file::{WantedPopulation, one_of};

/// A table of people: a million rows of ten columns.
const TABLE: FileKind = FileKind {
    name: "a table of people",
    max_bytes: 1 << 30,
    cure: "leave out columns that are not measures, or give it in parts",
};

/// Units of lengths, each with its metres.
const UNITS: [(&str, &str, f32); 4] =
    [("mm", "millimetres", 1e-3), ("cm", "centimetres", 1e-2), ("m", "metres", 1.0), ("in", "inches", 0.0254)];

/// Words that mean a measure, beside its name and its name without its last part.
const WORDS: [(&str, &str); 6] = [
    ("height", "stature"),
    ("bust", "chest_girth"),
    ("hips", "hip_girth"),
    ("seat", "hip_girth"),
    ("inseam", "leg_length"),
    ("shoulders", "shoulder_breadth"),
];

/// A person of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TableRow {
    pub weight: f64,
    pub sex: Sex,
    /// Measures (m), in the order of the columns.
    pub given: Vec<(En, f32)>,
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Holds {
    Measure(En),
    Weight,
    Sex,
    Nothing,
}

/// Reads a table; `path` is where it lies.
pub(super) fn read(path: &Path, wanted: &WantedPopulation) -> Result<Vec<TableRow>> {
    let shown = path.display().to_string();
    let is_parquet = path.extension().is_some_and(|e| e == "parquet");
    let (heads, cells) = if is_parquet { from_parquet(path)? } else { from_csv(path)? };
    let unit = wanted.unit.as_deref().unwrap_or_default();
    let known: Vec<&str> = UNITS.iter().map(|u| u.0).collect();
    if unit.is_empty() {
        return Err(StudyError::Input(format!(
            "{shown}: the unit of its lengths is not said; give [population] unit = \"mm\", \"cm\", \"m\" or \"in\""
        )));
    }
    one_of("[population] unit", unit, &known).map_err(StudyError::Input)?;
    let metres = UNITS.iter().find(|u| u.0 == unit).map_or(1.0, |u| u.2);
    let holds = meanings(&shown, &heads, wanted)?;
    if !holds.iter().any(|h| matches!(h, Holds::Measure(En::BustGirth | En::WaistGirth | En::HipGirth))) {
        return Err(StudyError::Input(format!(
            "{shown}: it has no girth of chest, waist or hip, by which sizes are chosen; name its column in [population] columns"
        )));
    }
    let default_sex =
        wanted.sex.as_deref().map(|word| sex_of(word).ok_or_else(|| no_sex(&shown, 0, word))).transpose()?;
    if default_sex.is_none() && !holds.contains(&Holds::Sex) {
        return Err(StudyError::Input(format!(
            "{shown}: it does not say whose measures they are; give a column sex, or [population] sex = \"female\" or \"male\""
        )));
    }
    if cells.is_empty() {
        return Err(StudyError::Input(format!("{shown}: it has no rows; give one person a row at least")));
    }
    let mut rows = Vec::with_capacity(cells.len());
    for (number, line) in cells.iter().enumerate() {
        rows.push(row(&shown, number + 2, line, (&heads, &holds), (default_sex, metres))?);
    }
    if rows.iter().map(|r| r.weight).sum::<f64>() <= 0.0 {
        return Err(StudyError::Input(format!(
            "{shown}: every weight is 0, so that it stands for no person; correct the column weight"
        )));
    }
    Ok(rows)
}

/// One person of a line.
fn row(
    shown: &str,
    line: usize,
    cells: &[String],
    (heads, holds): (&[String], &[Holds]),
    (default_sex, metres): (Option<Sex>, f32),
) -> Result<TableRow> {
    let mut found = TableRow { weight: 1.0, sex: default_sex.unwrap_or(Sex::Female), given: Vec::new() };
    let number = |at: usize| {
        let text = cells.get(at).map_or("", |c| c.trim());
        // A comma is a decimal one where columns are parted by others.
        let value = text.parse::<f64>().or_else(|_| text.replace(',', ".").parse()).ok().filter(|v| v.is_finite());
        value.ok_or_else(|| {
            let head = &heads[at];
            StudyError::Input(format!(
                "{shown}: line {line}: {head} is {text:?}, which is no number; repair the line or leave it out"
            ))
        })
    };
    for (at, holds) in holds.iter().enumerate() {
        match holds {
            Holds::Nothing => {}
            Holds::Sex => {
                let word = cells.get(at).map_or("", |c| c.trim());
                found.sex = sex_of(word).ok_or_else(|| no_sex(shown, line, word))?;
            }
            Holds::Weight => {
                found.weight = number(at)?;
                if found.weight < 0.0 {
                    let weight = found.weight;
                    return Err(StudyError::Input(format!(
                        "{shown}: line {line}: the weight is {weight}, and a weight cannot be negative; give 0 or more"
                    )));
                }
            }
            // What was not taken of a person follows from what was.
            Holds::Measure(_) if cells.get(at).is_none_or(|c| c.trim().is_empty()) => {}
            Holds::Measure(measure) => {
                let value = number(at)?;
                in_range(*measure, value, metres)
                    .map_err(|why| StudyError::Input(format!("{shown}: line {line}: {why}")))?;
                found.given.push((*measure, value as f32 * metres));
            }
        }
    }
    if !found.given.iter().any(|(m, _)| matches!(m, En::BustGirth | En::WaistGirth | En::HipGirth)) {
        return Err(StudyError::Input(format!(
            "{shown}: line {line}: it has no girth of chest, waist or hip; leave the line out"
        )));
    }
    Ok(found)
}

/// That a body is built for a length; else a sentence with the unit that was probably meant.
fn in_range(measure: En, value: f64, metres: f32) -> std::result::Result<(), String> {
    let Err(BodyError::OutOfRange { measure, least, most, .. }) =
        Wanted::<En>::new().with(measure, value as f32 * metres).check()
    else {
        return Ok(());
    };
    let range = f64::from(least)..=f64::from(most);
    let [least, most] = [least, most].map(|m| (m * 1e3).round());
    let says = format!(
        "the {measure} is {} mm, and a body is built for {least} to {most} mm",
        (value * f64::from(metres) * 1e4).round() / 10.0
    );
    let meant = UNITS.iter().find(|u| range.contains(&(value * f64::from(u.2))));
    Err(match meant {
        Some((unit, words, _)) => format!("{says}; {value} may be {words}: say unit = {unit:?}"),
        None => format!("{says}; correct the line or leave it out"),
    })
}

/// What each column holds.
fn meanings(shown: &str, heads: &[String], wanted: &WantedPopulation) -> Result<Vec<Holds>> {
    let named: BTreeMap<&str, &str> =
        wanted.columns.iter().map(|(holds, column)| (column.as_str(), holds.as_str())).collect();
    for (holds, column) in &wanted.columns {
        if !heads.contains(column) {
            let cure = toml_keys::nearest(column, heads.iter().map(String::as_str))
                .map_or_else(|| format!("it has {}", heads.join(", ")), |near| format!("did you mean {near:?}?"));
            return Err(StudyError::Input(format!(
                "{shown}: there is no column {column:?}, which [population] columns names for {holds}; {cure}"
            )));
        }
        if meaning(holds).is_none() {
            return Err(StudyError::Input(unknown("[population] columns", holds)));
        }
    }
    let mut all = Vec::with_capacity(heads.len());
    for head in heads {
        let found = match named.get(head.as_str()) {
            Some(holds) => meaning(holds),
            None if wanted.ignore.contains(head) || ["id", "person"].contains(&head.as_str()) => Some(Holds::Nothing),
            None => meaning(head),
        };
        let found = found.ok_or_else(|| {
            StudyError::Input(format!(
                "{}; say what it holds in [population] columns, or name it in ignore",
                unknown(&format!("{shown}: the column"), head)
            ))
        })?;
        if found != Holds::Nothing && all.contains(&found) {
            return Err(StudyError::Input(format!(
                "{shown}: two columns hold the same as {head:?}; name one of them in [population] ignore"
            )));
        }
        all.push(found);
    }
    Ok(all)
}

/// That a word is no measure, with the one that was probably meant.
fn unknown(place: &str, word: &str) -> String {
    let names: Vec<&str> = MEASURES.iter().map(|m| m.0).chain(["weight", "sex"]).collect();
    let short = names.iter().filter_map(|name| name.split_once('_').map(|(first, _)| (first, *name)));
    let words: Vec<(&str, &str)> = names.iter().map(|name| (*name, *name)).chain(short).collect();
    let near = toml_keys::nearest(&word.to_lowercase(), words.iter().map(|w| w.0));
    let meant = near.and_then(|near| words.iter().find(|w| w.0 == near));
    let cure =
        meant.map_or_else(|| format!("there are {}", names.join(", ")), |(_, name)| format!("did you mean {name:?}?"));
    format!("{place} {word:?} is no measure that is known; {cure}")
}

fn meaning(word: &str) -> Option<Holds> {
    let plain = word.trim().to_lowercase().replace([' ', '-'], "_");
    match plain.as_str() {
        "weight" => return Some(Holds::Weight),
        "sex" | "gender" => return Some(Holds::Sex),
        _ => {}
    }
    let plain = WORDS.iter().find(|(said, _)| *said == plain).map_or(plain.as_str(), |(_, name)| *name);
    let short = |name: &str| ["_girth", "_breadth", "_length"].iter().any(|e| name.strip_suffix(e) == Some(plain));
    let (_, measure, _) = MEASURES.iter().find(|(name, ..)| *name == plain || short(name))?;
    match measure {
        FittedMeasure::Standard(measure) => Some(Holds::Measure(*measure)),
        FittedMeasure::Torso => None,
    }
}

fn sex_of(word: &str) -> Option<Sex> {
    match word.to_lowercase().as_str() {
        "female" | "f" | "w" | "woman" => Some(Sex::Female),
        "male" | "m" | "man" => Some(Sex::Male),
        _ => None,
    }
}

fn no_sex(shown: &str, line: usize, word: &str) -> StudyError {
    let place = if line == 0 { "[population] sex".to_owned() } else { format!("line {line}: the sex") };
    StudyError::Input(format!("{shown}: {place} is {word:?}; give female or male"))
}

type Cells = (Vec<String>, Vec<Vec<String>>);

fn from_csv(path: &Path) -> Result<Cells> {
    let bytes = file::read(path, &TABLE).map_err(StudyError::input)?;
    let shown = path.display();
    let first: Vec<u8> = bytes.iter().copied().take_while(|b| *b != b'\n').collect();
    let often = |sign: u8| first.iter().filter(|b| **b == sign).count();
    let delimiter = [b',', b';', b'\t'].into_iter().max_by_key(|sign| often(*sign)).unwrap_or(b',');
    let mut reader = csv::ReaderBuilder::new().delimiter(delimiter).from_reader(&bytes[..]);
    let owned = |record: &csv::StringRecord| record.iter().map(|cell| cell.trim().to_owned()).collect::<Vec<String>>();
    let refused = |e: csv::Error| {
        StudyError::Input(format!("{shown}: {e}; give a table with as many cells in each line, in UTF-8"))
    };
    // Programs of others begin a file with a mark of its encoding.
    let heads = owned(reader.headers().map_err(refused)?)
        .into_iter()
        .map(|head| head.trim_start_matches('\u{feff}').to_owned());
    let heads = heads.collect();
    let cells = reader.records().map(|record| record.map(|r| owned(&r)).map_err(refused)).collect::<Result<_>>()?;
    Ok((heads, cells))
}

fn from_parquet(path: &Path) -> Result<Cells> {
    let bytes = file::read(path, &TABLE).map_err(StudyError::input)?;
    let shown = path.display();
    let refused = |e: &dyn std::fmt::Display| {
        StudyError::Input(format!(
            "{shown}: it cannot be read as Parquet ({e}); write it without compression or with Snappy"
        ))
    };
    let reader = SerializedFileReader::new(Bytes::from(bytes)).map_err(|e| refused(&e))?;
    let schema = reader.metadata().file_metadata().schema_descr();
    let heads = schema.columns().iter().map(|c| c.name().to_owned()).collect();
    let mut cells = Vec::new();
    for row in reader.get_row_iter(None).map_err(|e| refused(&e))? {
        let row = row.map_err(|e| refused(&e))?;
        let text = |field: &Field| match field {
            Field::Null => String::new(),
            Field::Str(text) => text.clone(),
            other => other.to_string(),
        };
        cells.push(row.get_column_iter().map(|(_, field)| text(field)).collect());
    }
    Ok((heads, cells))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(columns: &str, line: &str, unit: &str) -> String {
        let heads: Vec<String> = columns.split(',').map(str::to_owned).collect();
        let wanted: WantedPopulation =
            toml::from_str(&format!("from = \"table\"\nunit = {unit:?}\nsex = \"female\"")).unwrap();
        let holds = match meanings("t.csv", &heads, &wanted) {
            Ok(holds) => holds,
            Err(why) => return why.to_string(),
        };
        let cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let metres = UNITS.iter().find(|u| u.0 == unit).unwrap().2;
        row("t.csv", 2, &cells, (&heads, &holds), (Some(Sex::Female), metres))
            .map(|_| String::new())
            .unwrap_or_else(|e| e.to_string())
    }

    #[test]
    fn what_a_table_has_wrong_is_said_with_its_cure() {
        for (columns, line, unit, says) in [
            ("chest,wasit", "920,760", "mm", "did you mean \"waist_girth\"?"),
            ("chest,shoe size", "920,39", "mm", "name it in ignore"),
            ("chest,waist", "36,28", "mm", "36 may be inches: say unit = \"in\""),
            ("chest,waist", "0.92,0.76", "mm", "0.92 may be metres: say unit = \"m\""),
            ("chest,waist", "92,76", "mm", "92 may be centimetres"),
            ("chest,weight", "920,-2", "mm", "the weight is -2"),
            ("chest,waist", "920,x", "mm", "which is no number"),
            ("chest,sex", "920,robot", "mm", "give female or male"),
            ("chest,bust", "920,930", "mm", "two columns hold the same"),
        ] {
            let found = refused(columns, line, unit);
            assert!(found.contains(says), "{columns} {line}: {found}");
        }
        assert_eq!(refused("chest,waist,weight,sex", "36,28.5,2,f", "in"), "");
    }
}
