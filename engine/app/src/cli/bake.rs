//! The grammar of `toile bake`.

use clap::{Arg, ArgMatches};

use super::{json, required, text};
use crate::exit::AppError;

/// Arguments of `toile bake`.
#[derive(Debug, Clone, PartialEq)]
pub struct BakeArgs {
    /// Garment of the wardrobe or OBJ file.
    pub garment: String,
    /// Its size; `None` is the middle of its table.
    pub size: Option<String>,
    /// Fabric that is built in, or the path of a fabric file; `None` is the garment's own.
    pub fabric: Option<String>,
    /// One JSON object on stdout in place of the table.
    pub json: bool,
}

/// The grammar of the command.
pub(super) fn grammar() -> clap::Command {
    clap::Command::new("bake")
        .about("Bake a garment, and say what its mesh becomes: fibers, solvers, bending, memory")
        .long_about(
            "Bakes one garment in one size, on the body that the size is cut for, and reports what the cloth will step \
             over: how many edges the fibers of each direction cover, which solver they get, tethers and bending \
             stencils, memory, time and substeps, and what in the mesh gives reason to worry.",
        )
        .args([
            Arg::new("garment").value_name("GARMENT").required(true).help("Garment of the wardrobe, or an OBJ file"),
            text("size", "S", "Size, as the garment's table names it [default: the middle of the table]"),
            text("fabric", "F", "Fabric that is built in, or a fabric file (.toml) [default: the garment's own]"),
            json(),
        ])
        .after_help(
            "Example: see whether a mesh of your own makes good cloth\n  toile bake my-skirt.obj --fabric linen-twill",
        )
}

/// The arguments as the grammar has admitted them.
pub(super) fn args(matches: &ArgMatches) -> Result<BakeArgs, AppError> {
    Ok(BakeArgs {
        garment: required(matches, "garment")?,
        size: matches.get_one("size").cloned(),
        fabric: matches.get_one("fabric").cloned(),
        json: matches.get_flag("json"),
    })
}
