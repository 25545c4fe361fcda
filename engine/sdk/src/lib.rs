//! A virtual fitting room to build into your own program: bodies of measures, garments of files, cloth that moves, size and fit.
//!
//! A garment from a file on a body of measures; what is drawn, what is judged, what is coloured:
//!
//! ```
//! use toile_sdk::{Body, Garment, Scene, Sex, fit_colour, recommend};
//!
//! let mm = [("stature", 1720.0), ("chest", 920.0), ("waist", 760.0), ("hip", 1000.0)];
//! let body = Body::from_measures_mm(Sex::Female, &mm)?;
//! let garment = Garment::open("tee")?.in_fabric("jersey-dots")?; // or "shirt.obj", "shirt.json", "shirt.toile"
//!
//! let fit = recommend(&body, &garment)?;
//! println!("size {}: {}", fit.size, fit.verdict);
//! for zone in &fit.zones {
//!     println!("{} {:+.0} mm (sigma {:.0}): {}", zone.zone, zone.ease_mm, zone.sigma_mm, zone.verdict);
//! }
//!
//! let mut scene = Scene::dress(&body, &[garment])?; // in the size that fits
//! scene.step_many(12); // 0.1 s: each step is TIME_STEP
//! let (positions, faces) = (scene.positions(0)?, scene.faces(0)?);
//! assert!(faces.iter().flatten().all(|v| positions[*v as usize].is_finite()));
//! let colours: Vec<[u8; 3]> = scene.fit_map(0)?.into_iter().map(fit_colour).collect();
//! assert_eq!(colours.len(), positions.len());
//! # Ok::<(), toile_sdk::Error>(())
//! ```
//!
//! A recording in, snapshots out:
//!
//! ```
//! use toile_sdk::{DressOptions, Garment, Motion, Recording, Scene, Shopper};
//!
//! let recording = Recording::embedded()?; // or Recording::open("shopper.mcap")
//! let measured = recording.measure(&Shopper::default())?;
//! for measure in measured.measures() {
//!     println!("{}: {:.0} mm, sigma {:.0}", measure.name, measure.mm, measure.sigma_mm);
//! }
//! let garments = [Garment::open("strap-dress")?];
//! let body = measured.body_for(&garments)?;
//! let motion = Motion::Track(recording.track(&measured)?);
//! let mut scene = Scene::dress_with(&body, &garments, &DressOptions { motion, ..DressOptions::default() })?;
//! for _ in 0..24 {
//!     scene.step();
//!     let snapshot = scene.snapshot();
//!     assert_eq!(snapshot.body.len(), body.positions().len());
//!     assert!(snapshot.garments[0].iter().all(|p| p.is_finite()));
//! }
//! assert!((scene.time() - 24.0 * toile_sdk::TIME_STEP).abs() < 1e-9);
//! # Ok::<(), toile_sdk::Error>(())
//! ```
//!
//! A body takes 20 ms, dressing a second for each garment, a step at most 8.3 ms, a picture a second. Everything runs on the caller's thread;
//! every type may be sent to another.
//!
//! # What is promised
//!
//! - **Units.** Metres and seconds; what is taken by tape, and ease, in millimetres, and the name says so (`_mm`). Right-handed, y up,
//!   the floor at y = 0, a body facing +z. A step is [`TIME_STEP`] long.
//! - **Order.** Positions come in the order of your own mesh, whatever order the engine keeps. A pin stays at its vertex's own
//!   position, to the bit.
//! - **Nothing is passed over.** A scene file's key that cannot be honoured is an error with file, line and cure, and so is an option.
//! - **Errors** are [`Error`]: a kind for your program, a sentence with the cure for people. Nothing here panics on bad input.
//! - **Determinism.** The same input gives the same bits, those of the program `toile`, with one worker or two.
//! - **Versions.** Semantic versioning, of this crate's items alone: while the version is 0.y, what breaks a caller raises y, and all
//!   else raises the last number. Options are structs that grow: build them with `..Default::default()`. The lower crates that this
//!   one is made of promise nothing to callers. The minimum Rust is 1.89; to raise it raises y.
//!
//! [`glam`] is re-exported: use this one, so that the types agree.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
mod error;

mod measures;

mod body;
mod garment;
mod picture;

mod fit;
mod recording;

mod scene;

mod try_on;

pub use glam;

pub use toile_assets::scene_file::Wind;
pub use toile_base::body::Sex;
pub use toile_base::frame::{DepthFrame, HandState, Intrinsics, Joints, TrackedJoint};
pub use toile_base::skeleton::Joint;
pub use toile_engine::cloth::Quality;

pub use body::Body;
pub use error::{Error, ErrorKind, Result};
pub use fit::{MeasureAdvice, Recommendation, SizeChance, ZoneFit, recommend};
pub use garment::{Garment, fabric_names, garment_names};
pub use measures::{Measure, measure_names};
pub use picture::{Look, Picture, View, fit_colour};
pub use recording::{Measured, Recording, Shopper};
pub use scene::{DressOptions, GarmentStats, Motion, Scene, Snapshot, TIME_STEP, WornGarment};
pub use try_on::{TryOn, TryOnOptions, VIEWS, try_on};
