//! The body that a pattern is draped on: of a size, of measures, or the largest that it fits.

use std::path::Path;

use serde_json::Value;
use toile_assets::draping::{self, PatternPackage, PatternSizes, TO_MEASURE};
use toile_assets::file::{self, FileKind};
use toile_assets::pattern::Pattern;
use toile_assets::sizes::SizeTable;
use toile_base::body::{Body, Measures, Sex};
use toile_cli::exit::AppError;

/// A body, what it is called, and the pattern for it.
pub struct TailoredBody {
    pub body: Body,
    pub size: String,
    pub pattern: Pattern,
}

/// How the body is asked for.
pub struct WearerChoice<'a> {
    /// Female or male.
    pub sex: Sex,
    /// Size of the table.
    pub size: Option<&'a str>,
    /// Table of sizes; women's or men's where there is none.
    pub table: Option<&'a str>,
    /// File of measures, in place of a size.
    pub measures: Option<&'a Path>,
}

/// A file of measures: a page of numbers.
const MEASURES_FILE: FileKind =
    FileKind { name: "a file of measures", max_bytes: 1 << 16, cure: "give the measures of one body" };

/// Stature over the height of the shoulder's highest point, the mean of ANSUR II, as the tables of FreeSewing's bodies have it.
const STATURE_OVER_SHOULDER: f64 = 1.1576;

/// The table of sizes where none is named.
pub fn usual_table(sex: Sex) -> &'static str {
    if sex == Sex::Male { "men" } else { "women" }
}

/// The body that is asked for, and the pattern graded for it, if it has sizes.
///
/// # Errors
/// A size, table or measures of which no body can be made, a pattern that cannot be laid around one.
pub fn wearer(choice: &WearerChoice<'_>, package: &PatternPackage) -> Result<TailoredBody, AppError> {
    let sex = choice.sex;
    if let Some(path) = choice.measures {
        let body = toile_assets::body::build(sex, &read(path, sex)?).map_err(AppError::input)?;
        let measured = format!("measured by {}", path.display());
        return match package.graded().map_err(AppError::input)? {
            Some(graded) => {
                let pattern = graded.to_measure(&body.measures);
                Ok(TailoredBody { body, size: format!("{TO_MEASURE}, {measured}"), pattern })
            }
            None => Ok(TailoredBody { body, size: measured, pattern: package.parse().map_err(AppError::input)? }),
        };
    }
    let own_table = |sizes: &PatternSizes| choice.table.is_none_or(|table| table == sizes.table);
    if package.sizes.as_ref().is_some_and(own_table) {
        let size = choice.size.unwrap_or_else(|| package.own_size()).to_owned();
        let body = package.body_of(&size).map_err(AppError::input)?;
        let Some(body) = body else {
            return Err(AppError::input(format!("size {size} says nothing of a body; give --measures FILE")));
        };
        let pattern = package.sized(&size, &body.measures).map_err(AppError::input)?;
        return Ok(TailoredBody { body, size, pattern });
    }
    let pattern = package.parse().map_err(AppError::input)?;
    let table = SizeTable::embedded(choice.table.unwrap_or_else(|| usual_table(sex))).map_err(AppError::input)?;
    let size = match choice.size {
        Some(size) => size.to_owned(),
        None => draping::fitting_size(&pattern, &table, sex).map_err(AppError::input)?,
    };
    let measures = Measures::from(table.size_body(&size).map_err(AppError::input)?);
    Ok(TailoredBody { body: toile_assets::body::build(sex, &measures).map_err(AppError::input)?, size, pattern })
}

/// Measures of a file; what it leaves out is the mean person's.
///
/// # Errors
/// A file that cannot be read or holds no measures.
pub fn read(path: &Path, sex: Sex) -> Result<Measures, AppError> {
    let text = file::read_text(path, &MEASURES_FILE).map_err(AppError::input)?;
    let wrong = |reason: String| AppError::input(format!("{}: {reason}; give numbers of mm by name", path.display()));
    let value: Value = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
    let own = value.get("measurements_mm").unwrap_or(&value);
    let find = |names: &[&str]| names.iter().find_map(|n| own.get(n)?.as_f64()).map(|mm| mm * 1e-3);
    let drafted = find(&["hpsToWaistBack"]).zip(find(&["waistToFloor"])).map(|(a, b)| (a + b) * STATURE_OVER_SHOULDER);
    let mut measures = Measures::average(sex);
    let found = [
        (&mut measures.stature, find(&["stature", "height"]).or(drafted)),
        (&mut measures.shoulder_breadth, find(&["shoulder_breadth"])),
        (&mut measures.chest_girth, find(&["chest", "chest_girth"])),
        (&mut measures.waist_girth, find(&["waist", "waist_girth"])),
        (&mut measures.hip_girth, find(&["seat", "hip", "hip_girth"])),
    ];
    let mut any = false;
    for (measure, given) in found {
        if let Some(given) = given {
            *measure = given as f32;
            any = true;
        }
    }
    if any { Ok(measures) } else { Err(wrong("it holds none of stature, chest, waist, hip or seat".into())) }
}
