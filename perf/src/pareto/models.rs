//! What each model of the cloth costs, and what leaving it out does: the walking skirt in a fabric with numbers for one model,
//! stepped with it and without it from the same moments.
//!
//! x* has the model, with very many substeps of `fine`. Moments carry what friction remembers.

use toile_assets::scene::skirt;
use toile_base::fabric::Fabric;
use toile_base::fabric::stretch_curve::{ShearLock, StretchCurve, StretchCurves};
use toile_base::garment::Garment;
use toile_base::numeric::statistics::median_of;
use toile_engine::cloth::Quality;

use super::error::ParetoError;
use super::meshed_scene::SolverChoice;
use super::play::Setting;
use super::reference::Reference;
use super::report::ModelPoint;
use super::scenes::changed_skirt;
use super::sweep::time_again;

/// Names of the models, in the order in which they are run.
pub const MODELS: [&str; 4] = ["hysteresis", "buckling", "two slopes", "shear lock"];

/// Stretch of the skirt's fabric below a knee at 1 %, which is all of it without the model (N/m), and behind the knee.
const SLOPES_N_M: [f32; 2] = [2_000.0, 4_000.0];

/// Where its shear locks: a suiting's.
const LOCK: ShearLock = ShearLock { degrees: 12.0, beyond_n_m: 1_000.0 };

/// Substeps that are tried beside the garment's own.
const SUBSTEPS: [u32; 7] = [2, 3, 4, 6, 8, 12, 16];

/// The same for a quick look.
const QUICK_SUBSTEPS: [u32; 2] = [2, 8];

/// Gives a fabric the numbers of a model.
fn give(fabric: &mut Fabric, model: &str) {
    match model {
        "hysteresis" => fabric.hysteresis = skirt::LOOPS,
        "buckling" => fabric.buckling = true,
        "two slopes" => {
            let [below, beyond_n_m] = SLOPES_N_M;
            let curve = StretchCurve { knee_percent: 1.0, knee_n_m: 0.01 * below, beyond_n_m, hysteresis_n_m: 0.0 };
            fabric.stretch = StretchCurves { warp: Some(curve), weft: Some(curve) };
        }
        _ => fabric.shear_lock = Some(LOCK),
    }
}

/// Steps the skirt with and without each model; `progress` is given the part that is done (0..1).
///
/// # Errors
/// A scene that cannot be set up.
pub fn study(quick: bool, progress: &dyn Fn(f64)) -> Result<Vec<ModelPoint>, ParetoError> {
    let mut all = Vec::new();
    for (k, model) in MODELS.into_iter().enumerate() {
        progress(k as f64 / MODELS.len() as f64);
        all.extend(of_model(model, quick)?);
    }
    Ok(all)
}

fn of_model(model: &'static str, quick: bool) -> Result<Vec<ModelPoint>, ParetoError> {
    let subject = changed_skirt(quick, |fabric| give(fabric, model))?;
    let without = changed_skirt(quick, |_| ())?;
    let reference = Reference::of(&subject, quick)?;
    let garments: [Garment; 2] = [subject.bake(SolverChoice::Mixed)?, without.bake(SolverChoice::Mixed)?];
    let quality = Quality::Shop;
    let own = quality.substeps(garments[0].substeps);
    let mut tried = if quick { QUICK_SUBSTEPS.to_vec() } else { SUBSTEPS.to_vec() };
    tried.push(own);
    tried.sort_unstable();
    tried.dedup();
    let (mut points, mut played) = (Vec::new(), Vec::new());
    for substeps in tried {
        for (garment, with) in garments.iter().zip([true, false]) {
            let setting = Setting { quality, substeps: Some(substeps), threads: 1 };
            let run = reference.play(&subject, garment, setting)?;
            let [error_mm, max_mm] = reference.error_mm(&run);
            points.push(ModelPoint {
                model,
                with,
                quality: quality.name(),
                substeps: run.substeps,
                default: run.substeps == own,
                step_us: run.step_us,
                error_mm,
                max_mm,
                strain: run.strain,
                reference_gap_mm: reference.gap_mm,
                rolled_back: run.rolled_back,
            });
            played.push((garment, setting, vec![run.step_us]));
        }
    }
    if !quick {
        time_again(&subject, &reference, &mut played)?;
        points.iter_mut().zip(played).for_each(|(point, (.., us))| point.step_us = median_of(us).unwrap_or(0.0));
    }
    Ok(points)
}
