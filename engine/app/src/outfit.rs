//! Outfit: a shopper, dressed, made from a recipe that a recording carries along, so that a replay makes the very same.

use serde::{Deserialize, Serialize};
use toile_assets::body::{Body, Measures, Sex};
use toile_assets::garment::Garment;
use toile_assets::rig::Rig;
use toile_assets::sizes::Population;
use toile_assets::wardrobe;
use toile_assets::wardrobe::style::Style;
use toile_engine::cloth::{Quality, Settings};
use toile_engine::frame::{Frame, Snapshot};
use toile_engine::triple_buffer::Reader;
use toile_sensors::frame::Joints;
use toile_sensors::source::Session;
use toile_track::measure::Measurements;

use crate::exit::AppError;
use crate::{fit, shopper};

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
    /// Garments of the wardrobe and their sizes, inner first.
    pub garments: Vec<(String, String)>,
    /// Tested settings of the cloth.
    pub quality: String,
}

/// What a scene is made of.
#[derive(Debug, Clone)]
pub struct Parts {
    /// The shopper's body.
    pub body: Body,
    /// Its colliders.
    pub rig: Rig,
    /// The garments, inner first.
    pub garments: Vec<Garment>,
    /// How they are stepped.
    pub settings: Settings,
}

/// What is asked for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Wish {
    /// Garments of the wardrobe, inner first; empty is the first of the wardrobe.
    pub garments: Vec<String>,
    /// A size in place of the recommended one.
    pub size: Option<String>,
    /// How the cloth is stepped.
    pub quality: Quality,
}

/// Whose bodies these garments are made for: the first of them that is not made for everybody decides.
///
/// # Errors
/// A garment whose size table cannot be used.
pub fn population(styles: &[Style]) -> Result<Population, AppError> {
    let mut population = Population::Mixed;
    for style in styles {
        if population == Population::Mixed {
            population = style.sizes().map_err(AppError::input)?.population;
        }
    }
    Ok(population)
}

impl Recipe {
    /// Measures the shopper of a session and chooses the sizes.
    ///
    /// # Errors
    /// A session that nobody can be measured in, a garment that is not in the wardrobe, a size that is not made.
    pub fn write(session: &Session, wish: &Wish) -> Result<Self, AppError> {
        let names: Vec<&str> = if wish.garments.is_empty() {
            vec![wardrobe::names()[0]]
        } else {
            wish.garments.iter().map(String::as_str).collect()
        };
        let styles = names.iter().map(|name| wardrobe::style(name).map_err(AppError::input));
        let styles = styles.collect::<Result<Vec<_>, _>>()?;
        let population = population(&styles)?;
        let measured = shopper::measure(session, population)?;
        let sizes = styles
            .iter()
            .map(|style| Ok((style.name.clone(), fit::choose(style, wish.size.as_deref(), &measured)?.size)));
        let garments = sizes.collect::<Result<_, AppError>>()?;
        Self::of(&session.name, &measured, population, garments, wish.quality)
    }

    /// Of somebody who was measured and has chosen what to wear: garments and sizes, inner first.
    ///
    /// # Errors
    /// Measures that no body has.
    pub fn of(
        session: &str,
        measured: &Measurements,
        population: Population,
        garments: Vec<(String, String)>,
        quality: Quality,
    ) -> Result<Self, AppError> {
        let sex = if population == Population::Men { Sex::Male } else { Sex::Female };
        let (body, _) = shopper::build(sex, measured, population)?;
        let m = &body.measures;
        let measures = [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth];
        Ok(Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            session: session.to_owned(),
            sex: if sex == Sex::Male { "male" } else { "female" }.to_owned(),
            measures: measures.map(f32::to_bits),
            garments,
            quality: quality.name().to_owned(),
        })
    }

    /// The shopper's body, its colliders, the garments on it, and how they are stepped with one worker.
    ///
    /// # Errors
    /// A recipe of which no scene can be made, because it was tampered with or comes from another version.
    pub fn parts(&self) -> Result<Parts, AppError> {
        let sex = if self.sex == "male" { Sex::Male } else { Sex::Female };
        let [stature, shoulder_breadth, chest_girth, waist_girth, hip_girth] = self.measures.map(f32::from_bits);
        let measures = Measures { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth };
        let body = Body::build(sex, &measures).map_err(AppError::input)?;
        let garments = self.garments.iter().map(|(name, size)| {
            let style = wardrobe::style(name).map_err(AppError::input)?;
            style.dress(size, &body).map_err(AppError::input)
        });
        let garments = garments.collect::<Result<Vec<_>, AppError>>()?;
        let quality = self.quality.parse().map_err(AppError::Input)?;
        let settings = Settings { quality, workers: 1, ..Settings::default() };
        Ok(Parts { rig: Rig::fit(&body), body, garments, settings })
    }

    /// Makes the scene and dresses the shopper as they stand in a frame, with one worker: which crew takes the steps from
    /// then on is the caller's choice and changes no bit.
    ///
    /// # Errors
    /// As [`Self::parts`].
    pub fn make(&self, first: &Joints) -> Result<(Frame, Reader<Snapshot>), AppError> {
        let Parts { body, rig, garments, settings } = self.parts()?;
        let (mut frame, reader) = Frame::new(body, &rig, garments, settings).map_err(AppError::input)?;
        frame.dress(first);
        Ok((frame, reader))
    }

    /// What is worn, in a line.
    pub fn words(&self) -> String {
        let worn: Vec<String> = self.garments.iter().map(|(name, size)| format!("{name} in {size}")).collect();
        format!("session {}, {}, quality {}", self.session, worn.join(" and "), self.quality)
    }
}
