//! Drafts for several sizes are gathered in one package.

use std::path::Path;

use toile_assets::draping::{self, PatternPackage, PatternSizes, SizedDraft};
use toile_assets::sizes::{GarmentKind, SizeTable};
use toile_base::body::{Measures, Sex};

use toile_cli::exit::AppError;
use toile_fitting::dress::offer;

/// For whom the drafts are that are named.
pub struct DraftChoice<'a> {
    /// Size that the package's own draft is for.
    pub size: &'a str,
    /// Table of sizes.
    pub table: &'a str,
    /// Drafts for other sizes, SIZE=FILE.
    pub drafts: &'a [String],
    /// Seam file of all of them.
    pub seams: Option<&'a Path>,
    /// What the garment is; without it what its panels show on a body of this sex.
    pub kind: Option<GarmentKind>,
    pub sex: Sex,
}

/// Adds the drafts that are named to a package.
///
/// # Errors
/// A draft without a size, a file that cannot be read, a size or kind that the table does not have.
pub fn add(choice: &DraftChoice<'_>, package: &mut PatternPackage) -> Result<(), AppError> {
    let DraftChoice { size, table, seams, sex, .. } = *choice;
    let drafts = choice.drafts.iter().map(|text| draft(text, seams)).collect::<Result<_, _>>()?;
    let kind = match choice.kind {
        Some(kind) => kind,
        None => {
            let sized = SizeTable::embedded(table).and_then(|t| t.size_body(size)).map_err(AppError::input)?;
            let body = toile_assets::body::build(sex, &Measures::from(sized)).map_err(AppError::input)?;
            let pattern = package.parse().map_err(AppError::input)?;
            let found = draping::ease(&pattern, &body);
            found.map_err(|e| AppError::input(format!("{}: {e}", package.name)))?.kind
        }
    };
    let girths = Vec::new();
    package.sizes = Some(PatternSizes { table: table.into(), kind, size: size.into(), drafts, girths });
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
