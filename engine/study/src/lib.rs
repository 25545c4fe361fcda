//! Counts the people whom each size of a garment fits, finds where it fails, and which step between sizes would help most.
//!
//! A study file names garments, people, sensor and amount of physics; each try-on is one row, a function of the study
//! and the row's number alone, so that any machine may compute any part of it:
//!
//! ```no_run
//! use std::path::Path;
//! use toile_study::Study;
//!
//! let study = Study::open(Path::new("study.toml"))?;
//! let row = study.row(17)?; // the same on every machine
//! println!("{} in {}: fits {}", row.garment, row.size, row.fits);
//! # Ok::<(), toile_study::StudyError>(())
//! ```

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
mod digest;
mod error;
mod row;

mod study_file;

mod garments;
mod parquet_file;
mod population;

mod drape;
mod sensor;

mod study;

mod folder;
mod pictures;
mod shares;

mod page;

pub use drape::{Draped, TriedPose, WornFrame};
pub use error::{Result, StudyError};
pub use folder::{Merged, RunReport, Shard, StudyFolder};
pub use garments::{GarmentNote, TriedGarment, ZoneEase};
pub use page::{TypicalPicture, page};
pub use parquet_file::{Notes, bytes_of, notes, read};
pub use pictures::picture;
pub use population::{Person, Population};
pub use row::{Kind, StudyRow, Value};
pub use sensor::Sensor;
pub use shares::{
    Convergence, DrapedFigures, GarmentSummary, GradingStep, Share, SizeSummary, Summary, SummaryWearer, ZoneFailure,
};
pub use study::{SCHEMA, Study};
pub use study_file::StudyFile;
