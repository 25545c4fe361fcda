//! The visitor's part of the kiosk, without drawing: pages, texts, controls, and the facts known of the visitor.
//!
//! A poll takes at most 0.5 ms, or 10 ms if it judges a size.
//!
//! [`model`] is a state machine that knows the time and its inputs, and nothing else; `pages` makes a [`screen::Screen`] of it. docs/screens.md
//! shows the transitions.

mod actions;
pub mod body_turn;
mod colours;
pub mod controller;
pub mod dressing_worker;
mod face;
pub mod face_camera;
#[cfg(any(test, feature = "window"))]
pub mod face_maker;
pub mod measure_entry;
mod measuring;
mod message;
pub mod model;
mod navigation;
pub mod own_face;
mod own_measures;
#[cfg(any(test, feature = "window"))]
pub mod page_window;
#[cfg(any(test, feature = "window"))]
pub mod pages;
#[cfg(any(test, feature = "window"))]
pub mod photographs;
pub mod picture;
pub mod picture_link;
pub mod picture_store;
pub mod plain;
pub mod presence;
pub mod reach;
pub mod screen;
pub mod setup;
pub mod size_fit;
#[cfg(test)]
pub(crate) mod tests;
mod text_keys;
pub mod texts;
#[cfg(any(test, feature = "window"))]
mod translation;
mod visit;
pub mod wardrobe;
