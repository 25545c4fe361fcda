//! engine/track
