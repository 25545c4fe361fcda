//! A garment's constants for the kernels, from its settings, as `shaders/common.wgsl` declares them.

use bytemuck::{Pod, Zeroable};
use glam::Affine3A;
use toile_base::garment::Garment;
use toile_base::numeric::portable;
use toile_engine::cloth::contact::body::ContactSettings;
use toile_engine::cloth::forces::root::Carried;
use toile_engine::cloth::step::prepared::Prepared;
use toile_engine::cloth::{Quality, Settings, Wind};

/// Flag: weft links keep their tension between passes (soft constraints).
pub const SOFT_WEFT: u32 = 1;
/// Flag: warp fibers keep theirs.
pub const SOFT_FIBERS: u32 = 2;
/// Flag: fibers are damped across themselves.
pub const TAUT: u32 = 4;
/// Flag: tethers are solved.
pub const TETHERS: u32 = 8;
/// Flag: in this step the garment is put back to its rest pose at the root.
pub const DRESS: u32 = 16;
/// Flag: in this step the garment is moved along with the root.
pub const CARRY: u32 = 32;
/// Flag: fibers by index list keep their tension.
pub const SOFT_CROSSING: u32 = 64;
/// Flag: there is wind.
pub const WIND: u32 = 128;
/// Flag: in this step part of the root's motion is compensated.
pub const COMPENSATE: u32 = 256;

/// A garment's constants; the struct `Garment` of `shaders/common.wgsl`, field by field.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct GarmentConstants {
    /// Gravity over a substep (m/s).
    pub gravity_step: [f32; 3],
    /// Fraction of a velocity that is left after a substep of air damping.
    pub damping_factor: f32,
    /// Length of a substep (s).
    pub dt: f32,
    /// 1 / dt of the substep (1/s).
    pub per_dt: f32,
    /// The inverse of its square (1/s2).
    pub per_dt2: f32,
    /// Damping time of stretch over it (1).
    pub gamma: f32,
    /// Length of the time that bending acts for (s).
    pub bend_by: f32,
    /// Number of substeps from one action of bending to the next.
    pub bend_every: u32,
    /// 1 / dt^2 of the time that shear acts for (1/s2).
    pub shear_per_dt2: f32,
    /// Number of substeps from one action of shear to the next.
    pub shear_every: u32,
    /// Farthest that a particle moves in a substep (m).
    pub farthest: f32,
    /// Substeps of a step.
    pub substeps: u32,
    /// Flags, [`SOFT_WEFT`] and the following constants.
    pub bits: u32,
    /// Stages of bending, 1 where it is a force.
    pub stages: u32,
    /// The root's axes and its place: where the garment is dressed again.
    pub root: [[f32; 4]; 4],
    /// The root's motion, likewise, for [`CARRY`].
    pub motion: [[f32; 4]; 4],
    /// Contact: offset (m), static and kinetic friction, length of the step (s).
    pub how: [f32; 4],
    /// Its first set of capsules, those to be believed, its planes, and where they begin.
    pub touch: [u32; 4],
    /// Velocity of the air (m/s), drag coefficient.
    pub air: [f32; 4],
    /// Lift coefficient, 1 / ((Cd + Cl) dt) (1/s).
    pub blow: [f32; 4],
    /// What of the root's motion is not to be felt, for [`COMPENSATE`].
    pub carried: [[f32; 4]; 5],
}

const _: () = assert!(size_of::<GarmentConstants>() == 336, "`Garment` in common.wgsl is 336 bytes");

impl GarmentConstants {
    /// Of a garment that is prepared for these settings; no jump, the root where it is at rest.
    pub fn new(garment: &Garment, prepared: &Prepared, settings: &Settings) -> Self {
        let dt = prepared.dt;
        let per_dt2 = (dt * dt).recip();
        let bit = |holds: bool, bit: u32| if holds { bit } else { 0 };
        let how = ContactSettings::new(&garment.fabric, settings);
        let bound = |w: &Wind| w.bound(settings.step_seconds);
        let wind = settings.wind.map(|w| (w.velocity.extend(w.drag), [w.lift, bound(&w), 0.0, 0.0]));
        let tethered = settings.tethers || prepared.quality == Quality::Draft;
        Self {
            gravity_step: (settings.gravity * dt).to_array(),
            damping_factor: portable::exp(-garment.fabric.damping_per_s * dt),
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
            bits: bit(prepared.soft[0], SOFT_WEFT)
                | bit(prepared.soft[1], SOFT_FIBERS)
                | bit(prepared.soft[2], SOFT_CROSSING)
                | bit(prepared.taut, TAUT)
                | bit(tethered, TETHERS)
                | bit(wind.is_some(), WIND),
            stages: prepared.bending.stages,
            root: columns(&Affine3A::IDENTITY),
            motion: columns(&Affine3A::IDENTITY),
            how: [how.offset_m, how.friction_static, how.friction_kinetic, how.step_seconds],
            touch: [0; 4],
            air: wind.map_or([0.0; 4], |(air, _)| air.to_array()),
            blow: wind.map_or([0.0; 4], |(_, blow)| blow),
            carried: [[0.0; 4]; 5],
        }
    }
}

/// A motion as four columns of four.
pub fn columns(motion: &Affine3A) -> [[f32; 4]; 4] {
    let m = motion.matrix3;
    [m.x_axis, m.y_axis, m.z_axis, motion.translation].map(|c| [c.x, c.y, c.z, 0.0])
}

/// What of the root's motion is not to be felt, as `Garment` of `common.wgsl` has it.
pub fn carried(c: &Carried) -> [[f32; 4]; 5] {
    let with = |v: glam::Vec3A, w: f32| [v.x, v.y, v.z, w];
    [
        with(c.origin, 0.5 * c.dt),
        with(c.velocity, 2.0 * c.angular),
        with(c.turning, c.centrifugal),
        with(c.jolt, 0.0),
        with(c.twist, 0.0),
    ]
}
