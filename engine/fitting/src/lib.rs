//! The one assembly: from a sensor's data to a dressed body in motion, for the program, the kiosk and an embedder alike.
//!
//! Measuring takes 0.5 s and dressing 1 s, both outside of the step. `dress`, `scene` and `plan` run on the caller's thread. `live` has
//! sensor, physics and render threads of its own.
//!
//! A recording becomes a dressed body in motion, with the measures, size and verdicts that every command of the program reports:
//!
//! ```
//! use toile_fitting::dress::player::Player;
//! use toile_fitting::dress::try_on::TryOn;
//! use toile_fitting::dress::{measured, session};
//!
//! let session = session::open(None, None)?; // the embedded one; `Some(path)` is any recording
//! let request = TryOn::default(); // or `TryOn::of_shopper(&names, size, facts)`
//! let measured = measured::measure(&session, request.facts())?;
//! let track = measured::track(&session, &measured)?;
//! let mut dressed = request.sized_for(&session.name, &measured)?.build(&track[0])?;
//! let mut player = Player::new(&track);
//! for _ in 0..12 {
//!     dressed.world.step(&player.step());
//! }
//! let snapshot = dressed.reader.latest();
//! assert!(snapshot.garments[0].iter().all(|particle| particle.is_finite()));
//! # Ok::<(), toile_fitting::FittingError>(())
//! ```
//!
//! A scene of one's own, whose pins, planes and settings are those of `toile run`; positions come in the order of the user's mesh:
//!
//! ```
//! use toile_assets::scene_file::{SceneFile, SceneSource};
//! use toile_fitting::scene::Runner;
//!
//! let text = "duration = 0.5\n[garment]\ngrid = { rows = 8, columns = 6, width = 0.3, height = 0.4 }\npin = { vertices = [0, 5] }\n";
//! let scene = SceneFile::parse("flag.toml", text, SceneSource::Inside(&[]))?;
//! let mut runner = Runner::new(scene)?;
//! let start: Vec<_> = runner.positions(0).collect();
//! for _ in 0..runner.scene().steps() {
//!     runner.step();
//! }
//! let end: Vec<_> = runner.positions(0).collect();
//! assert_eq!((start[0], start[5]), (end[0], end[5]), "pins stay where they are");
//! assert!(end[40].y < start[40].y);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
pub mod crossings;
pub mod error;
pub mod heap;
pub mod timing;

pub mod dress;
pub mod scene;

pub mod live;
pub mod plan;
pub mod wearing;

pub use error::FittingError;
