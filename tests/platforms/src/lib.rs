//! State hashes that every platform must reproduce: 600 steps of the benchmark's skirt, and of a baked dress on a moving body.
//!
//! One source serves all platforms. A program prints the hashes where there is a standard output; WebAssembly exports them.
//! The skirt is baked on the platform itself. The dress comes from a file, in the byte form of a baked garment.

#[path = "../../../assets/src/delaunay.rs"]
mod delaunay;
pub mod dress_recording;
#[path = "../../../assets/src/scene/skirt/mod.rs"]
pub mod skirt;

mod skirt_scene;

#[cfg(target_arch = "wasm32")]
#[expect(unsafe_code, reason = "functions that a host calls by their names")]
mod exports;

use glam::Vec3A;
use toile_base::numeric::hash;
use toile_engine::cloth::Cloth;

pub use skirt_scene::skirt_hash;

/// Steps to each hash: five seconds.
pub const STEPS: usize = 600;

/// FNV-1a over the bits of position and velocity of these particles, as the benchmark has it.
fn hash_of(cloth: &Cloth, particles: impl Iterator<Item = usize>) -> u64 {
    let numbers = particles.flat_map(|p| [cloth.positions[p], cloth.velocity(p)]);
    hash::of_numbers(numbers.flat_map(|v: Vec3A| v.to_array()))
}
