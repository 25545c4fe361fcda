//! How contact acts on a garment.

use toile_base::fabric::Fabric;

use super::sweep::QUICK;
use crate::cloth::Settings;

/// How contact acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSettings {
    /// Distance kept from every surface (m).
    pub offset_m: f32,
    /// Coulomb coefficient of what sticks.
    pub friction_static: f32,
    /// Coulomb coefficient of what slides, at most the static one.
    pub friction_kinetic: f32,
    /// Length of a step (s): how far what moves may come until the next search.
    pub step_seconds: f32,
    /// Whether ways are followed between the ends of a substep, or only these looked at.
    pub continuous: bool,
    /// Every how many steps the nearest point of the skin is looked for, where there is one; 0 leaves all to the cones.
    pub skin_every: u8,
}

impl ContactSettings {
    /// Of a fabric, in steps with these settings.
    pub fn new(fabric: &Fabric, settings: &Settings) -> Self {
        Self {
            offset_m: fabric.contact_offset_mm * 1e-3,
            friction_static: fabric.friction * settings.static_friction,
            friction_kinetic: fabric.friction,
            step_seconds: settings.step_seconds,
            continuous: settings.continuous,
            skin_every: settings.contact.skin,
        }
    }

    /// What moves less than this part of the smallest radius relative to a capsule is not followed.
    pub fn quick(&self) -> f32 {
        if self.continuous { QUICK } else { f32::MAX }
    }
}
