//! From a session to a dressed world, in the order of the data: [`session`], [`depth`], [`measured`], [`offer`], [`garment_source`], [`try_on`].
//!
//! Budget: measuring 0.5 s, dressing 1 s.
//!
//! Every command, the kiosk, the studies and an embedder take this way, so that the same session gives the same measures, sizes and bits
//! everywhere.

pub mod depth;
pub mod garment_source;
pub mod measured;
pub mod motion;
pub mod offer;
pub mod player;
pub mod session;
pub mod try_on;
