//! The form of a body: a drawing in sections, muscles and hollows, with its distance from any point.
//!
//! The trunk and the limbs are superellipse sections along an axis, so that breadth, depth and girth are what the table
//! says; fillets join them (smooth minimum); ellipsoids and round cones add muscles, fingers and toes; Gaussian bumps
//! finish the surface.

mod drawing;
mod group;
mod parts;
mod spline;

pub(crate) use drawing::{Drawing, Form, GridRow};
