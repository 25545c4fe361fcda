//! Why a kiosk cannot go on: as a fitting cannot, which it is made of.

pub use toile_fitting::FittingError as KioskError;
