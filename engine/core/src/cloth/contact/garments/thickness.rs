//! How far apart two cloths lie.

use toile_base::fabric::Fabric;

/// Distance that two fabrics keep (m): half of both thicknesses.
pub fn thickness(one: &Fabric, other: &Fabric) -> f32 {
    0.5e-3 * (one.thickness_mm + other.thickness_mm)
}
