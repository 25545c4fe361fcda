//! Drafts for several sizes are gathered in one package.

use std::path::Path;

use toile_assets::body::{Body, Measures};
use toile_assets::draping::{self, PatternPackage, PatternSizes, SizedDraft};
use toile_assets::sizes::SizeTable;

use toile_fitting::dress::offer;

use super::TailorArgs;
use super::wearer::usual_table;
use crate::exit::AppError;

/// Adds the drafts that are named to a package.
///
/// # Errors
/// A draft without a size, a file that cannot be read, a size or kind that the table does not have.
pub fn add(args: &TailorArgs, package: &mut PatternPackage) -> Result<(), AppError> {
    let Some(size) = &args.drafted_for else { return Ok(()) };
    let table = args.table.as_deref().unwrap_or_else(|| usual_table(args.body));
    let drafts = args.draft.iter().map(|text| draft(text, args.seams.as_deref())).collect::<Result<_, _>>()?;
    let kind = match args.kind {
        Some(kind) => kind,
        None => {
            let sized = SizeTable::embedded(table).and_then(|t| t.size_body(size)).map_err(AppError::input)?;
            let body = Body::build(args.body, &Measures::from(sized)).map_err(AppError::input)?;
            let pattern = package.parse().map_err(AppError::input)?;
            let found = draping::ease(&pattern, &body);
            found.map_err(|e| AppError::input(format!("{}: {e}", args.pattern.display())))?.kind
        }
    };
    let girths = Vec::new();
    package.sizes = Some(PatternSizes { table: table.into(), kind, size: size.clone(), drafts, girths });
    let girths = offer::girths(package)?;
    package.sizes.iter_mut().for_each(|sizes| sizes.girths.clone_from(&girths));
    Ok(())
}

/// A draft for a size, SIZE=FILE, sewn as the pattern is.
fn draft(text: &str, seams: Option<&Path>) -> Result<SizedDraft, AppError> {
    let Some((size, file)) = text.split_once('=').filter(|(size, file)| !size.is_empty() && !file.is_empty()) else {
        return Err(AppError::input(format!(
            "--draft {text}: it is not SIZE=FILE; give a size of the table and a file"
        )));
    };
    let read = draping::read_package(Path::new(file), seams).map_err(AppError::input)?;
    if read.sizes.is_some() {
        return Err(AppError::input(format!("--draft {text}: it is a package with sizes of its own; give a draft")));
    }
    Ok(SizedDraft { size: size.into(), pattern: read.pattern, seams: read.seams })
}
