//! engine/gpu
