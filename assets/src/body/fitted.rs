//! Building a body to given measures: the public interface of the calibration.

#[cfg(test)]
mod tests;

use std::sync::LazyLock;

use glam::Vec3;

use super::base::BaseBody;
use super::calibrate::{BodyModel, Calibrated};
use super::landmarks::Landmark;
use super::proportions::Proportions;
use super::reading::{En, MeshMeasure, Readings, Vocabulary, Wanted};
use super::{BodyError, Fitted};
use toile_base::body::{Body, Levels, Measures, Sex};
use toile_base::mesh::{Mesh, vertex_normals};
use toile_base::skeleton::Joint;

/// Largest error of a given measure that a caller has to accept (m).
pub const TOLERANCE: f32 = 2e-3;

/// A sex's model, worked out on first use: some hundred milliseconds.
pub(super) fn model(sex: Sex) -> &'static BodyModel {
    static WOMAN: LazyLock<BodyModel> = LazyLock::new(|| BodyModel::new(BaseBody::new(Sex::Female)));
    static MAN: LazyLock<BodyModel> = LazyLock::new(|| BodyModel::new(BaseBody::new(Sex::Male)));
    match sex {
        Sex::Female => &WOMAN,
        Sex::Male => &MAN,
    }
}

/// The measures in the words of the standard.
pub fn wanted(measures: &Measures) -> Wanted<En> {
    Wanted::new()
        .with(En::Stature, measures.stature)
        .with(En::ShoulderBreadth, measures.shoulder_breadth)
        .with(En::BustGirth, measures.chest_girth)
        .with(En::WaistGirth, measures.waist_girth)
        .with(En::HipGirth, measures.hip_girth)
}

/// Tape readings of the five measures that a body keeps.
fn five(readings: &Readings) -> Measures {
    Measures {
        stature: readings.of(En::Stature),
        shoulder_breadth: readings.of(En::ShoulderBreadth),
        chest_girth: readings.of(En::BustGirth),
        waist_girth: readings.of(En::WaistGirth),
        hip_girth: readings.of(En::HipGirth),
    }
}

/// Builds the body of a sex that has the five measures wanted, each within [`TOLERANCE`].
///
/// # Errors
/// As [`fitted`].
pub fn build(sex: Sex, wanted: &Measures) -> Result<Body, BodyError> {
    Ok(fitted(sex, &self::wanted(wanted))?.body)
}

/// Builds the body of a sex that has every measure wanted, each within [`TOLERANCE`]; all other measures are what
/// people with these are expected to have.
///
/// # Errors
/// [`BodyError::OutOfRange`] for a measure that no body is built for, and [`BodyError::Unreachable`], which holds
/// the nearest body, for measures that none has together.
pub fn fitted<V: Vocabulary>(sex: Sex, wanted: &Wanted<V>) -> Result<Fitted, BodyError> {
    wanted.check()?;
    let given: Vec<(MeshMeasure, f32)> = wanted.given().iter().map(|(m, value)| (m.reading(), *value)).collect();
    let model = model(sex);
    let fitted = model.fitted(&model.calibrate(&given));
    let off = |(m, value): &(V, f32)| (fitted.readings.of(*m) - value).abs();
    let furthest = wanted.given().iter().max_by(|a, b| off(a).total_cmp(&off(b)));
    match furthest.filter(|f| off(f) > TOLERANCE) {
        None => Ok(fitted),
        Some(&(measure, value)) => Err(BodyError::Unreachable {
            measure: measure.name(),
            value,
            reached: fitted.readings.of(measure),
            against: model.against(wanted, measure),
            nearest: Box::new(fitted),
        }),
    }
}

/// Where the landmarks of a sex's drawn body lie.
pub(crate) fn proportions(sex: Sex) -> Proportions {
    Proportions::of(&model(sex).morphs.base)
}

impl BodyModel {
    /// The measure without which all others are met, one of them in particular; of several the one that was given last.
    fn against<V: Vocabulary>(&self, wanted: &Wanted<V>, measure: V) -> Option<(&'static str, f32)> {
        let given = wanted.given();
        let without = |left_out: usize| {
            let others = given.iter().enumerate().filter(|&(k, _)| k != left_out).map(|(_, g)| g);
            let others: Vec<(MeshMeasure, f32)> = others.map(|(m, value)| (m.reading(), *value)).collect();
            let found = self.calibrate(&others);
            others.iter().all(|(r, value)| (found.readings[r.index()] - value).abs() <= TOLERANCE)
        };
        let others = (0..given.len()).rev().filter(|&k| given[k].0.reading() != measure.reading());
        let freed = others.into_iter().find(|&k| without(k))?;
        Some((given[freed].0.name(), given[freed].1))
    }

    pub(super) fn fitted(&self, found: &Calibrated) -> Fitted {
        let base = &self.morphs.base;
        let positions = self.morphs.positions(&found.setting);
        let mut normals = vec![Vec3::ZERO; positions.len()];
        vertex_normals(&positions, &base.triangles, &mut normals);
        // Triangles meet a vertex and its mirror image in another order, which rounding shows.
        for (v, &mirror) in self.morphs.near.mirror.iter().enumerate() {
            let other = normals[mirror as usize];
            if mirror as usize == v {
                normals[v].x = 0.0;
                normals[v] = normals[v].normalize_or_zero();
            } else if positions[v].x < 0.0 {
                normals[v] = Vec3::new(-other.x, other.y, other.z);
            }
        }
        let skeleton = self.morphs.skeleton(&found.setting);
        let at = |l: Landmark| base.landmarks.mark(l).on(&positions).y;
        let levels = Levels {
            neck: at(Landmark::Cervicale),
            shoulder: at(Landmark::Acromion),
            chest: at(Landmark::BustPoint),
            underbust: at(Landmark::Underbust),
            waist: at(Landmark::NaturalWaist),
            hip: at(Landmark::Buttock),
            crotch: at(Landmark::Crotch),
            knee: at(Landmark::Midpatella),
            ankle: skeleton.at(Joint::LeftAnkle).y,
        };
        let readings = Readings(found.readings);
        let body = Body {
            sex: base.sex,
            measures: five(&readings),
            mesh: Mesh { positions, uvs: Vec::new(), triangles: base.triangles.clone() },
            normals,
            skeleton,
            weights: base.weights.clone(),
            regions: base.regions.clone(),
            levels,
        };
        Fitted { body, readings, steps: found.steps }
    }
}
