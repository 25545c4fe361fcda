//! Contact: of garments with the body, and of garments with each other and themselves.

pub mod body;
pub mod garments;
