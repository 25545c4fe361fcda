//! The guest: everything between a shopper and the mirror that is no picture: pages, words, what can be pressed, what is known.
//!
//! Reads: what is seen, pressed and gestured; what the tailor has measured and dressed. Writes: one `Screen` for whoever paints,
//! errands for the tailor; nothing to a disk or a network, and nothing of a shopper once they have left.
//! Budget: 0.5 ms a look, 10 ms where a size is judged. Thread: the service's.
//!
//! [`model`] is a machine that knows the time and its inputs, and nothing else; [`pages`] makes a [`screen::Screen`] of it. docs/screens.md
//! shows what leads where.

mod actions;
pub mod controller;
pub mod dressing_worker;
mod message;
pub mod model;
mod navigation;
pub mod pages;
pub mod picture;
pub mod presence;
pub mod reach;
pub mod screen;
pub mod setup;
pub mod size_fit;
#[cfg(test)]
pub(crate) mod tests;
mod text_keys;
pub mod texts;
mod visit;
pub mod wardrobe;
