//! Constants: what the settings make of a garment, as `shaders/common.wgsl` has it.

use bytemuck::{Pod, Zeroable};
use glam::Affine3A;
use toile_assets::garment::Garment;
use toile_engine::cloth::contact::ContactSettings;
use toile_engine::cloth::prepared::Prepared;
use toile_engine::cloth::{Quality, Settings};

/// Weft links remember their tension.
pub const SOFT_WEFT: u32 = 1;
/// Fibers remember theirs.
pub const SOFT_FIBERS: u32 = 2;
/// Fibers are calmed across themselves.
pub const TAUT: u32 = 4;
/// Tethers hold.
pub const TETHERS: u32 = 8;
/// In this step the garment is dressed again where the root now is.
pub const DRESS: u32 = 16;
/// In this step it is carried along with the root.
pub const CARRY: u32 = 32;
/// Fibers by index list remember their tension.
pub const SOFT_CROSSING: u32 = 64;

/// A garment's constants; the struct `Garment` of `shaders/common.wgsl`, field by field.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Constants {
    /// Gravity over a substep (m/s).
    pub fall: [f32; 3],
    /// What the air leaves of a velocity in a substep.
    pub kept: f32,
    /// Length of a substep (s).
    pub dt: f32,
    /// Its inverse (1/s).
    pub per_dt: f32,
    /// The inverse of its square (1/s2).
    pub per_dt2: f32,
    /// Damping time of stretch over it (1).
    pub gamma: f32,
    /// Length of the time that bending acts for (s).
    pub bend_by: f32,
    /// Bending acts every so many substeps.
    pub bend_every: u32,
    /// 1 / dt^2 of the time that shear acts for (1/s2).
    pub shear_per_dt2: f32,
    /// Shear acts every so many substeps.
    pub shear_every: u32,
    /// Farthest that a particle moves in a substep (m).
    pub farthest: f32,
    /// Substeps of a step.
    pub substeps: u32,
    /// See the constants above.
    pub bits: u32,
    spare: u32,
    /// The root's axes and its place: where the garment is dressed again.
    pub root: [[f32; 4]; 4],
    /// The root's motion, likewise, for [`CARRY`].
    pub motion: [[f32; 4]; 4],
    /// Contact: offset (m), static and kinetic friction, length of the step (s).
    pub how: [f32; 4],
    /// Its first set of capsules, those to be believed, its planes, and where they begin.
    pub touch: [u32; 4],
}

const _: () = assert!(size_of::<Constants>() == 224, "`Garment` in common.wgsl is 224 bytes");

impl Constants {
    /// Of a garment that is prepared for these settings; no jump, the root where it is at rest.
    pub fn new(garment: &Garment, prepared: &Prepared, settings: &Settings) -> Self {
        let dt = prepared.dt;
        let per_dt2 = (dt * dt).recip();
        let bit = |holds: bool, bit: u32| if holds { bit } else { 0 };
        let how = ContactSettings::new(&garment.fabric, settings);
        let tethered = settings.tethers || prepared.quality == Quality::Draft;
        Self {
            fall: (settings.gravity * dt).to_array(),
            kept: (-garment.fabric.damping_per_s * dt).exp(),
            dt,
            per_dt: dt.recip(),
            per_dt2,
            gamma: prepared.gamma,
            bend_by: if prepared.bend.every == 1 { dt } else { dt * prepared.bend.every as f32 },
            bend_every: prepared.bend.every,
            shear_per_dt2: per_dt2 / prepared.shear_every as f32,
            shear_every: prepared.shear_every,
            farthest: settings.max_speed * dt,
            substeps: prepared.substeps,
            bits: bit(prepared.soft(0), SOFT_WEFT)
                | bit(prepared.soft(1), SOFT_FIBERS)
                | bit(prepared.soft(2), SOFT_CROSSING)
                | bit(prepared.taut, TAUT)
                | bit(tethered, TETHERS),
            spare: 0,
            root: columns(&Affine3A::IDENTITY),
            motion: columns(&Affine3A::IDENTITY),
            how: [how.offset_m, how.friction_static, how.friction_kinetic, how.step_seconds],
            touch: [0; 4],
        }
    }
}

/// A motion as four columns of four.
pub fn columns(motion: &Affine3A) -> [[f32; 4]; 4] {
    let m = motion.matrix3;
    [m.x_axis, m.y_axis, m.z_axis, motion.translation].map(|c| [c.x, c.y, c.z, 0.0])
}
