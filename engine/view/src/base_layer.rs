//! The mannequin's base layer: briefs, and a bandeau on a woman, painted on the skin, so that no mannequin stands naked under a T-shirt.
//!
//! It is no garment: it costs no step, and follows the skin wherever that goes.

use glam::{Vec2, Vec3};
use toile_base::body::{Body, Region, Sex};
use toile_base::texture::Texture;

use crate::cloth_look::{GarmentLook, TileLevels};

/// Colour of the cotton, sRGB bytes.
const COTTON: [u8; 3] = [226, 224, 219];

/// How far on both sides of its edge the picture of the edge reaches (m).
const REACH_M: f32 = 0.064;

/// Texels across that: half a millimetre each.
const TEXELS: u32 = 256;

/// Where hair lies in the picture of the edge: the skin ends at a quarter of it, the cotton at six tenths, the hair at nine.
pub(crate) const HAIR_AT: Vec2 = Vec2::new(0.75, 0.5);

/// The base layer of a body, as a look of its skin; the look's picture has the colour of hair (sRGB) too.
pub fn base_layer(body: &Body, hair: [u8; 3]) -> GarmentLook {
    let inside = heights(body);
    let along = |d: f32| 0.25 + 0.25 * (d / REACH_M).clamp(-0.98, 0.98);
    let corners = body.mesh.triangles.iter().map(|t| t.map(|v| Vec2::new(along(inside[v as usize]), 0.5)));
    let edge = TileLevels::of(&edge(hair));
    GarmentLook { tile: Some(edge), corners: corners.collect(), opacity: 1.0, ..GarmentLook::default() }
}

/// The picture of the edge, one row, with the colour of hair (sRGB).
pub(crate) fn edge(hair: [u8; 3]) -> Texture {
    let painted = |x: u32| match 10 * x / (2 * TEXELS) {
        _ if x < TEXELS / 2 => (COTTON, 0),
        0..6 => (COTTON, 255),
        6..9 => (hair, 255),
        _ => (COTTON, 0),
    };
    let texels = (0..2 * TEXELS).map(painted).map(|([r, g, b], cover)| [r, g, b, cover]).collect();
    Texture { width: 2 * TEXELS, height: 1, texels }
}

/// How far inside of the base layer each vertex lies at rest, negative outside of it (m).
fn heights(body: &Body) -> Vec<f32> {
    let one = |(p, region): (&Vec3, &Region)| {
        if matches!(region, Region::LeftArm | Region::RightArm | Region::Head) {
            return -REACH_M;
        }
        let briefs = briefs(body, *p);
        if body.sex == Sex::Female { briefs.max(bandeau(body, *p)) } else { briefs }
    };
    body.mesh.positions.iter().zip(&body.regions).map(one).collect()
}

/// From half of the way between waist and hip down to the legs: a woman's are cut out over the thigh, a man's have short legs.
fn briefs(body: &Body, p: Vec3) -> f32 {
    let levels = &body.levels;
    let top = levels.hip + 0.45 * (levels.waist - levels.hip);
    let below = match body.sex {
        Sex::Male => levels.crotch - 0.07,
        Sex::Female => {
            let wide = 0.5 * (levels.waist - levels.crotch);
            let aside = (p.x.abs() / wide.max(0.05)).min(1.0);
            let side = levels.crotch + 0.45 * (levels.hip - levels.crotch);
            levels.crotch - 0.02 + (side - levels.crotch + 0.02) * aside * aside
        }
    };
    (top - p.y).min(p.y - below)
}

/// From below the breasts to above them.
fn bandeau(body: &Body, p: Vec3) -> f32 {
    let levels = &body.levels;
    let rise = levels.chest - levels.underbust;
    (levels.chest + 0.5 * rise.max(0.03) - p.y).min(p.y - (levels.underbust - 0.35 * rise))
}

#[cfg(test)]
mod tests {
    use toile_base::body::Measures;

    use super::*;

    #[test]
    fn what_is_covered_is_covered_and_nothing_else() {
        for sex in [Sex::Female, Sex::Male] {
            let body = toile_assets::body::build(sex, &Measures::average(sex)).unwrap();
            let inside = heights(&body);
            let near = |y: f32, x: f32| {
                let trunk = (0..inside.len())
                    .filter(|v| body.regions[*v] == Region::Torso || body.mesh.positions[*v].y < body.levels.crotch);
                let far = |v: &usize| {
                    let p = body.mesh.positions[*v];
                    (p.y - y).abs() + (p.x.abs() - x).abs()
                };
                inside[trunk.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap()]
            };
            let levels = &body.levels;
            assert!(near(levels.crotch + 0.02, 0.0) > 0.0 && near(levels.hip, 0.1) > 0.0);
            assert!(near(levels.knee, 0.1) < 0.0 && near(levels.waist, 0.1) < 0.0 && near(levels.neck, 0.05) < 0.0);
            assert_eq!(near(levels.chest, 0.08) > 0.0, sex == Sex::Female);
            let arms =
                body.regions.iter().zip(&inside).filter(|(r, _)| matches!(r, Region::LeftArm | Region::RightArm));
            assert!(arms.into_iter().all(|(_, d)| *d < 0.0), "gloves");
            let look = base_layer(&body, [0; 3]);
            assert_eq!(look.corners.len(), body.mesh.triangles.len());
        }
    }
}
