//! All integration tests of the crate, linked once.

mod camera_faults;
mod cameras;
mod clean;
mod common;
mod filter;
mod fuzz;
mod hostile;
mod joint_streams;
mod recordings;
mod session_file;
mod shopper;
mod synthetic;
