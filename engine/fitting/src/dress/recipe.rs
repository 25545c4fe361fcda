//! The recipe of a dressed shopper, which a recording holds so that a replay makes the same one.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use toile_assets::sizes::Population;
use toile_assets::wardrobe::own;
use toile_base::body::{Body, Measures, Sex};
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_base::rig::Rig;
use toile_engine::cloth::{Quality, Settings};
use toile_engine::frame::{Frame, Snapshot};
use toile_engine::triple_buffer::Reader;
use toile_track::measure::Measurements;

use super::attire::{self, Attire, FindChoice};
use super::body;
use super::measured::Measured;
use super::wish::{self, Wish};
use crate::FittingError;

/// How a scene is made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// Version of the program that wrote it: another one may compute other bits.
    pub version: String,
    /// The session that the shopper comes from.
    pub session: String,
    /// `female` or `male`.
    pub sex: String,
    /// Stature, shoulder breadth, girths of chest, waist and hip: the bits of f32 (m).
    pub measures: [u32; 5],
    /// Garments, by name or path, and their sizes, inner first.
    pub garments: Vec<(String, String)>,
    /// Tested settings of the cloth.
    pub quality: String,
}

/// What a scene is made of.
#[derive(Debug, Clone)]
pub struct Parts {
    /// The shopper's body.
    pub body: Body,
    /// Spheres and capsules that stand for the body in contact.
    pub rig: Rig,
    /// The garments, inner first.
    pub garments: Vec<Garment>,
    /// Settings of the cloth.
    pub settings: Settings,
}

impl Recipe {
    /// Of somebody who was measured, in the sizes that fit them or the one that is asked for.
    ///
    /// # Errors
    /// A garment that there is not, a size that is not made, measures that no body has.
    pub fn choose(session: &str, measured: &Measured, wish: &Wish) -> Result<Self, FittingError> {
        Self::choose_of(session, measured, &Attire::open(wish.clone())?)
    }

    /// The same of garments that are open.
    ///
    /// # Errors
    /// As [`Self::choose`].
    pub fn choose_of(session: &str, measured: &Measured, attire: &Attire) -> Result<Self, FittingError> {
        let Attire { wish, choices } = attire;
        let sex = measured.sex(wish::population(choices.iter().map(Arc::as_ref))?);
        let (body, _) = body::build(sex, &measured.best, Population::from(Some(sex)))?;
        let (mut garments, mut beneath) = (Vec::with_capacity(choices.len()), Vec::new());
        for choice in choices {
            let fit = choice.judge(wish.size.as_deref(), &measured.best, &body, &beneath)?;
            garments.push((choice.name.clone(), fit.map_or_else(|| own::UNKNOWN.to_owned(), |fit| fit.size)));
            beneath.extend(choice.offer(&body)?);
        }
        Ok(Self::of_body(session, sex, &body.measures, garments, wish.quality))
    }

    /// Of somebody who was measured and has chosen what to wear: garments and sizes, inner first.
    ///
    /// # Errors
    /// Measures that no body has.
    pub fn of(
        session: &str,
        measured: &Measurements,
        sex: Sex,
        garments: Vec<(String, String)>,
        quality: Quality,
    ) -> Result<Self, FittingError> {
        let (body, _) = body::build(sex, measured, Population::from(Some(sex)))?;
        Ok(Self::of_body(session, sex, &body.measures, garments, quality))
    }

    /// Of a body of these measures.
    pub fn of_body(session: &str, sex: Sex, m: &Measures, garments: Vec<(String, String)>, quality: Quality) -> Self {
        let measures = [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth];
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            session: session.to_owned(),
            sex: if sex == Sex::Male { "male" } else { "female" }.to_owned(),
            measures: measures.map(f32::to_bits),
            garments,
            quality: quality.name().to_owned(),
        }
    }

    /// The shopper's body, its colliders, the garments on it, and how they are stepped with one worker.
    ///
    /// # Errors
    /// A recipe of which no scene can be made, because it was tampered with or comes from another version.
    pub fn parts(&self) -> Result<Parts, FittingError> {
        self.parts_of(&attire::find_now)
    }

    fn parts_of(&self, find: FindChoice<'_>) -> Result<Parts, FittingError> {
        let sex = if self.sex == "male" { Sex::Male } else { Sex::Female };
        let [stature, shoulder_breadth, chest_girth, waist_girth, hip_girth] = self.measures.map(f32::from_bits);
        let measures = Measures { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth };
        let body = toile_assets::body::build(sex, &measures).map_err(FittingError::input)?;
        let mut garments = Vec::with_capacity(self.garments.len());
        for (name, size) in &self.garments {
            garments.extend(find(name)?.dress(Some(size), &body)?.garments);
        }
        let quality = self.quality.parse().map_err(FittingError::Input)?;
        let settings = Settings { quality, workers: 1, ..Settings::default() };
        Ok(Parts { rig: toile_assets::rig::fit(&body), body, garments, settings })
    }

    /// Makes the scene and dresses the shopper as they stand in a frame, with one worker: which crew takes the steps from
    /// then on is the caller's choice and changes no bit.
    ///
    /// # Errors
    /// As [`Self::parts`].
    pub fn make(&self, first: &Joints) -> Result<(Frame, Reader<Snapshot>), FittingError> {
        self.make_of(first, &attire::find_now)
    }

    /// The same with garments that are found by `find`.
    ///
    /// # Errors
    /// As [`Self::parts`]; those of `find`.
    pub fn make_of(&self, first: &Joints, find: FindChoice<'_>) -> Result<(Frame, Reader<Snapshot>), FittingError> {
        let Parts { body, rig, garments, settings } = self.parts_of(find)?;
        let (mut frame, reader) = Frame::new(body, &rig, garments, settings).map_err(FittingError::input)?;
        frame.dress(first);
        Ok((frame, reader))
    }

    /// What is worn, in a line.
    pub fn words(&self) -> String {
        let worn: Vec<String> = self.garments.iter().map(|(name, size)| format!("{name} in {size}")).collect();
        format!("session {}, {}, quality {}", self.session, worn.join(" and "), self.quality)
    }
}
