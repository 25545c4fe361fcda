//! The scenes: the cantilever in four meshes, the skirt in three and meshed irregularly, the garments of the wardrobe on an average mannequin.

use glam::DVec3;
use toile_assets::scene::shopper;
use toile_assets::scene::skirt::{self, SkirtMotion, Stretch};
use toile_bake::Shape;
use toile_engine::colliders::{Colliders, RestSphere};

use super::error::ParetoError;
use super::meshed_scene::{MeshedScene, ReferenceKind, SceneMotion};
use crate::validate::mesh::{CaseFabric, EndSupport, MeshStyle, Strip};
use crate::worn::AverageBody;

/// Names of all scenes, in the order in which they are run.
pub const SCENES: [&str; 6] = ["cantilever", "skirt", IRREGULAR, "strap-dress", "tee", "wide-leg-trousers"];

/// The skirt with an irregular mesh.
const IRREGULAR: &str = "skirt-irregular";

/// Time of the walk that is compared (s): the legs swing once to and fro.
const WALK_S: f64 = 1.0;

/// Time that a garment gets on the mannequin: half of it the pose is taken (s).
const STAND_S: f64 = 1.5;

/// Time that the cantilever gets to come to rest (s).
const HANG_S: f64 = 4.0;

/// The cantilever's w L^3 / B, its length (m) and width (m), and its damping (1/s).
const CANTILEVER: [f64; 4] = [10.0, 0.3, 0.1, 10.0];

/// Acceleration of gravity (m/s2).
const G: f64 = 9.81;

/// A scene in all its meshes; the first is the one that every setting is run on.
pub fn subjects(name: &str, quick: bool) -> Result<Vec<MeshedScene>, ParetoError> {
    match name {
        "cantilever" => {
            let rows: &[usize] = if quick { &[24, 12] } else { &[24, 12, 36, 48] };
            rows.iter().enumerate().map(|(k, rows)| cantilever(*rows, k == 0)).collect()
        }
        "skirt" => {
            let sides: &[usize] = if quick { &[32, 16] } else { &[64, 32, 96] };
            let grid = |side: usize| ("skirt", format!("grid {side} x {side}"), skirt::shape(side));
            sides.iter().enumerate().map(|(k, side)| walk(grid(*side), k == 0, quick)).collect()
        }
        IRREGULAR => {
            let side = if quick { 32 } else { 64 };
            let mesh = (IRREGULAR, format!("irregular {}", side * side), skirt::irregular(side, 1));
            Ok(vec![walk(mesh, true, quick)?])
        }
        garment => Ok(vec![worn(garment, quick)?]),
    }
}

fn cantilever(rows: usize, main: bool) -> Result<MeshedScene, ParetoError> {
    let [gamma, length, width, damping] = CANTILEVER;
    let ends = [EndSupport::Clamped, EndSupport::Free];
    let strip = Strip { length, width, rows, columns: rows / 3, style: MeshStyle::Grid, ends };
    let bend = CaseFabric::PLAIN.density * G * length.powi(3) / gamma;
    Ok(MeshedScene {
        scene: "cantilever",
        mesh: format!("grid {rows} x {}", rows / 3),
        main,
        shape: strip.shape(|along, across| DVec3::new(along, 0.0, across)),
        fabric: CaseFabric { bend, damping, ..CaseFabric::PLAIN }.fabric(),
        drive: SceneMotion::Still,
        colliders: Colliders::new(&[], &[], false)?,
        seconds: HANG_S,
        truth: ReferenceKind::Equilibrium,
    })
}

fn walk(
    (scene, mesh, shape): (&'static str, String, Shape),
    main: bool,
    quick: bool,
) -> Result<MeshedScene, ParetoError> {
    let rest =
        skirt::JOINTS.map(|(p, r)| RestSphere { bone: 0, centre: DVec3::from_array(p).as_vec3(), radius: r as f32 });
    Ok(MeshedScene {
        scene,
        mesh,
        main,
        fabric: skirt::fabric(&shape, Stretch::Inextensible),
        shape,
        drive: SceneMotion::Skirt(SkirtMotion::Walk),
        colliders: Colliders::new(&rest, &skirt::CAPSULES, false)?,
        seconds: if quick { 0.5 } else { WALK_S },
        truth: ReferenceKind::Trajectory,
    })
}

fn worn(name: &str, quick: bool) -> Result<MeshedScene, ParetoError> {
    let scene = SCENES.into_iter().find(|s| *s == name).ok_or_else(|| ParetoError::Unknown(name.into()))?;
    let mannequin = AverageBody::of(name)?;
    let (size, shape, fabric) = mannequin.wear(name)?;
    let skeleton = mannequin.body.skeleton.clone();
    let goal = shopper(&skeleton, 0.0);
    Ok(MeshedScene {
        scene,
        mesh: format!("size {size}"),
        main: true,
        shape,
        fabric,
        drive: SceneMotion::Mannequin(Box::new(skeleton), Box::new(goal)),
        colliders: mannequin.colliders()?,
        seconds: if quick { 0.5 } else { STAND_S },
        truth: ReferenceKind::Trajectory,
    })
}
