//! A pose from keypoints of several cameras: a skeleton whose bones keep their lengths, found without a start by hand and followed.

mod bones;
mod fit;
mod trc;

pub use bones::{BONES, Bone, marker_name};
pub use fit::{PoseMotion, fit};
pub use trc::{TrcMotion, distances, read_trc, trc_text, write_trc};

#[cfg(test)]
mod tests;
