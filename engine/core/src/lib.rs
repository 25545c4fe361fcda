//! Real-time cloth on a moving body: pose, skinning, collision capsules, and garments of fibers, 120 steps a second on the
//! processor.
//!
//! Give it a mesh and moving capsules, call one function a step, and read the particles. Nothing is allocated in a step.
//!
//! ```
//! use glam::{Affine3A, Vec3, Vec4};
//! use toile_bake::{Shape, bake};
//! use toile_base::{fabric::Fabric, skeleton::BONES};
//! use toile_engine::cloth::{Cloth, Settings, Step};
//! use toile_engine::colliders::{Colliders, RestSphere};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A mesh: 30 by 30 vertices, 2 cm apart, held along the upper edge.
//! let place = |row, column| (Vec3::new(0.02 * column as f32, 1.5 - 0.02 * row as f32, 0.0), row == 0);
//! let garment = bake("curtain", "one size", &Shape::sheet(30, 30, place), &Fabric::cotton_lawn())?;
//! // A capsule between two spheres, and the floor.
//! let ends = [Vec3::new(0.1, 1.2, -0.3), Vec3::new(0.5, 1.2, -0.3)];
//! let spheres = ends.map(|centre| RestSphere { bone: 0, centre, radius: 0.06 });
//! let mut colliders = Colliders::new(&spheres, &[[0, 1]], true)?;
//! let mut cloth = Cloth::new(&garment, &colliders);
//! let (palette, settings) = ([Affine3A::IDENTITY; BONES], Settings::default());
//! // The host's own loop: move the capsule, step, draw.
//! for step in 1..=240 {
//!     let z = (-0.3 + 0.5 * step as f32 / 120.0).min(0.1);
//!     colliders.place_spheres(&ends.map(|p| Vec4::new(p.x, p.y, z, 0.06)));
//!     cloth.step(&garment, &Step { palette: &palette, colliders: &colliders, settings: &settings });
//! }
//! let pushed = cloth.positions.iter().map(|p| p.z).fold(0.0, f32::max);
//! assert!(pushed > 0.15 && cloth.events.rolled_back == 0, "the capsule carries the curtain with it: {pushed} m");
//! # Ok(())
//! # }
//! ```
//!
//! # How it works
//!
//! A garment is particles, and fibers along warp, weft and bias. Each step is divided into substeps (Macklin and others 2019,
//! "Small steps in physics simulation"). In each one the tensions of a fiber are solved at once, as a tridiagonal system by
//! LDL^T; shear and weft links are solved by Gauss-Seidel on compliances (Macklin and others 2016, "XPBD"). Bending is a
//! quadratic form on rings of vertices. Contact is swept against round cones between moving spheres, and against the skin's
//! triangles. Stiffness is physical (N/m, N m), so it does not change with substeps or mesh.
//!
//! # Features
//!
//! | feature | what it adds |
//! |---|---|
//! | none | pose, skinning, colliders, cloth, [`world`]: one step called from the host's own loop. 17 packages |
//! | `threads` | a second worker of the cloth on a thread of its own; the bits stay the same |
//! | `meters` | distributions of step and stage times |
//! | `loop` | sensor, physics and render threads at 120 Hz, recording and replay. With all features 29 packages on Linux |
//!
//! # Limits
//!
//! One body with [32 capsules](toile_base::limits::MAX_CAPSULES), [10 garments](toile_base::limits::MAX_GARMENTS), and
//! 262,144 vertices a garment. Cloth does not tear. Meshes do not change while they are stepped.
//!
//! # Platforms
//!
//! Rust 1.89 or newer. x86-64 with SSE2, AVX2 or AVX-512, chosen when the program runs; aarch64 with NEON; WebAssembly with
//! SIMD128 where it is compiled in; other processors use plain `f32`. All give the same bits. The same input gives the same
//! bits whatever the lanes and the workers.

// Modules in the order of the data: each imports only from the groups above its own (tests/tests/layers.rs).
pub mod bounded;
pub mod clock;
pub mod cone;
pub mod lanes;
pub mod meter;
#[expect(unsafe_code, reason = "a value that threads keep apart by other means")]
pub mod sync;
pub mod triple_buffer;

pub mod body;
pub mod jump_filter;
#[expect(unsafe_code, reason = "a job that borrows the caller's stack is handed to another thread")]
pub mod workers;

pub mod skin;
pub mod surface;

pub mod body_surface;

pub mod colliders;

pub mod cloth;

pub mod lines;
pub mod world;

#[cfg(feature = "loop")]
pub mod frame_loop;
// Not within the module's own file, which the models of the hand-offs include (tests/models).
#[cfg(all(test, feature = "threads"))]
#[path = "workers/tests.rs"]
mod workers_tests;

#[cfg(test)]
#[path = "../../../tests/src/recordings.rs"]
mod recordings;
