//! Bodies on which fits are judged: sizes of EN 13402-3, and strangers drawn at random.

use crate::body::{BodyError, En, Wanted};
use toile_base::body::{Body, Sex};
use toile_base::numeric::random::SplitMix64;

/// One of them: what it is called, its sex, and stature, bust or chest, waist and hip girth (m).
#[derive(Debug, Clone, PartialEq)]
pub struct SizedPerson {
    /// Its name.
    pub name: String,
    /// The drawing that it is stretched from.
    pub sex: Sex,
    /// Stature, bust or chest, waist and hip girth (m).
    pub size: [f32; 4],
}

/// A small, a middle and a large size of EN 13402-3: women 34, 42, 50 and men 46, 52, 58.
pub fn sizes() -> Vec<SizedPerson> {
    let of = |name: &str, sex, size| SizedPerson { name: name.into(), sex, size };
    vec![
        of("women 34", Sex::Female, [1.68, 0.80, 0.64, 0.88]),
        of("women 42", Sex::Female, [1.68, 0.96, 0.80, 1.04]),
        of("women 50", Sex::Female, [1.68, 1.16, 1.02, 1.22]),
        of("men 46", Sex::Male, [1.78, 0.92, 0.80, 0.94]),
        of("men 52", Sex::Male, [1.78, 1.04, 0.92, 1.06]),
        of("men 58", Sex::Male, [1.78, 1.16, 1.08, 1.18]),
    ]
}

/// People as they come, women and men in turn: chest and stature anywhere in their range, waist and hip by a drop from the
/// chest. The same seed gives the same people.
pub fn strangers(count: usize, seed: u64) -> Vec<SizedPerson> {
    let mut random = SplitMix64::new(seed);
    (0..count)
        .map(|i| {
            let mut draw = |from: f32, to: f32| random.between(from, to);
            let woman = i % 2 == 0;
            let stature = if woman { draw(1.52, 1.78) } else { draw(1.62, 1.95) };
            let chest = if woman { draw(0.82, 1.16) } else { draw(0.90, 1.20) };
            let waist = chest - if woman { draw(0.10, 0.20) } else { draw(0.06, 0.16) };
            let hip = chest + if woman { draw(0.02, 0.12) } else { draw(-0.06, 0.04) };
            let sex = if woman { Sex::Female } else { Sex::Male };
            SizedPerson { name: format!("stranger {}", i + 1), sex, size: [stature, chest, waist, hip] }
        })
        .collect()
}

impl SizedPerson {
    /// Their body; where no body has these measures together, the nearest one.
    ///
    /// # Errors
    /// [`BodyError::OutOfRange`].
    pub fn body(&self) -> Result<Body, BodyError> {
        let measures = [En::Stature, En::BustGirth, En::WaistGirth, En::HipGirth];
        let wanted = measures.into_iter().zip(self.size).fold(Wanted::new(), |w, (m, value)| w.with(m, value));
        match crate::body::fitted(self.sex, &wanted) {
            Ok(fitted) => Ok(fitted.body),
            Err(BodyError::Unreachable { nearest, .. }) => Ok(nearest.body),
            Err(error) => Err(error),
        }
    }
}
