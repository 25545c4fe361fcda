//! engine/view
