//! A try-on, from the request to a dressed world: the wearer, the garments with their sizes, and the settings of the cloth.
//!
//! [`TryOn`] is the one request. It begins with what a shopper asks for; [`TryOn::sized_for`] turns it into a body and sizes once the shopper
//! was measured, and in that form a recording holds it, so that a replay makes the same world. [`TryOn::put_on`] and [`TryOn::dress`] make a
//! [`DressedBody`] of it, and [`DressedBody::build`] is the only place where a world is built.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use toile_assets::adapt::dress as own;
use toile_assets::sizes::{Girth, Population};
use toile_base::body::{Body, Measures, Sex};
use toile_base::frame::Joints;
use toile_base::garment::Garment;
use toile_base::limits::MAX_GARMENTS;
use toile_base::rig::Rig;
use toile_engine::cloth::contact::garments::tuck_in;
use toile_engine::cloth::{Quality, Settings};
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World, WorldError};
use toile_sensors::source::Session;
use toile_track::measure::Measurements;

use super::garment_source::{self, FittedGarment, GarmentSource};
use super::measured::{self, MeasuredSubject, ShopperFacts};
use crate::FittingError;

/// A request to try garments on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TryOn {
    /// Version of the program that made it. Another version may compute other bits.
    pub version: String,
    /// Name of the session that the wearer comes from; empty before the wearer is known.
    pub session: String,
    /// The person who wears the garments.
    #[serde(flatten)]
    pub wearer: Wearer,
    /// The garments, inner first.
    pub garments: Vec<RequestedGarment>,
    /// Names of garments that are tucked into the next one under them that has a waistband.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tuck: Vec<String>,
    /// Tested settings of the cloth.
    #[serde(with = "quality_name")]
    pub quality: Quality,
}

/// The person who wears the garments of a request.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Wearer {
    /// A body of these measures.
    Body {
        /// The sex of its drawing.
        #[serde(with = "measured::sex_name")]
        sex: Sex,
        /// Its measures (m). A recording holds their bits.
        #[serde(with = "measure_bits")]
        measures: Measures,
    },
    /// A shopper who has yet to be measured.
    Shopper {
        /// Facts known before the measuring.
        shopper: ShopperFacts,
    },
}

/// A garment of a request; in a recording a pair of its name and its size.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "(String, Option<String>)", into = "(String, Option<String>)")]
pub struct RequestedGarment {
    /// The name that it is found by: one of the wardrobe, or a path, with a fabric behind a colon if another than its own is worn.
    pub name: String,
    /// Code of the size; `None` takes the one that fits.
    pub size: Option<String>,
    /// The garment once it was opened. Later changes of its file do not count.
    source: Option<Arc<GarmentSource>>,
}

impl RequestedGarment {
    /// A garment by its name.
    pub fn named(name: impl Into<String>, size: Option<String>) -> Self {
        Self { name: name.into(), size, source: None }
    }

    /// A garment that is open.
    pub fn of(source: Arc<GarmentSource>, size: Option<String>) -> Self {
        Self { name: source.name.clone(), size, source: Some(source) }
    }

    /// The garment: as it was opened, or else as it is found now.
    ///
    /// # Errors
    /// As [`GarmentSource::find`].
    pub fn source(&self) -> Result<Arc<GarmentSource>, FittingError> {
        self.source.clone().map_or_else(|| GarmentSource::find(&self.name).map(Arc::new), Ok)
    }
}

impl PartialEq for RequestedGarment {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, &self.size) == (&other.name, &other.size)
    }
}

impl From<(String, Option<String>)> for RequestedGarment {
    fn from((name, size): (String, Option<String>)) -> Self {
        Self::named(name, size)
    }
}

impl From<RequestedGarment> for (String, Option<String>) {
    fn from(garment: RequestedGarment) -> Self {
        (garment.name, garment.size)
    }
}

impl Default for TryOn {
    fn default() -> Self {
        Self::of_shopper(&[], None, ShopperFacts::default())
    }
}

impl TryOn {
    /// A request of a shopper who has yet to be measured: garments by name, inner first, all in `size` or each in the size that fits. No
    /// name stands for those of [`shown_first`].
    pub fn of_shopper(names: &[String], size: Option<&str>, shopper: ShopperFacts) -> Self {
        let named = |name: &str| RequestedGarment::named(name, size.map(str::to_owned));
        let garments = match names {
            [] => shown_first(shopper.sex).iter().map(|name| named(name)).collect(),
            names => names.iter().map(|name| named(name)).collect(),
        };
        Self::new("", Wearer::Shopper { shopper }, garments)
    }

    /// A request for a body of these measures.
    pub fn of_body(session: &str, sex: Sex, measures: Measures, garments: Vec<RequestedGarment>) -> Self {
        Self::new(session, Wearer::Body { sex, measures }, garments)
    }

    fn new(session: &str, wearer: Wearer, garments: Vec<RequestedGarment>) -> Self {
        let (version, session) = (env!("CARGO_PKG_VERSION").to_owned(), session.to_owned());
        Self { version, session, wearer, garments, tuck: Vec::new(), quality: Quality::default() }
    }

    /// The same request in another quality.
    #[must_use]
    pub fn in_quality(self, quality: Quality) -> Self {
        Self { quality, ..self }
    }

    /// Facts known of the wearer before the measuring.
    pub fn facts(&self) -> ShopperFacts {
        match self.wearer {
            Wearer::Shopper { shopper } => shopper,
            Wearer::Body { sex, .. } => ShopperFacts { sex: Some(sex), ..ShopperFacts::default() },
        }
    }

    /// Names of the garments, inner first.
    pub fn names(&self) -> Vec<String> {
        self.garments.iter().map(|garment| garment.name.clone()).collect()
    }

    /// Settings of the steps.
    pub fn settings(&self) -> Settings {
        Settings { quality: self.quality, ..Settings::default() }
    }

    /// The request with all garments open.
    ///
    /// # Errors
    /// More garments than a body wears; an unknown name, a file that cannot be used.
    pub fn open(mut self) -> Result<Self, FittingError> {
        self.check_count()?;
        for garment in &mut self.garments {
            garment.source = Some(garment.source()?);
        }
        Ok(self)
    }

    /// Checks that a body can wear as many garments.
    ///
    /// # Errors
    /// [`FittingError::Input`] for more than [`MAX_GARMENTS`].
    pub fn check_count(&self) -> Result<(), FittingError> {
        let count = self.garments.len();
        if count > MAX_GARMENTS {
            return Err(FittingError::Input(format!(
                "{count} garments are asked for, and a body wears at most {MAX_GARMENTS} at once; leave some out"
            )));
        }
        Ok(())
    }

    /// The people whom the garments are made for.
    ///
    /// # Errors
    /// As [`garment_source::population`], and as [`Self::open`] where a garment is not open.
    pub fn population(&self) -> Result<Population, FittingError> {
        let sources = self.garments.iter().map(RequestedGarment::source).collect::<Result<Vec<_>, _>>()?;
        garment_source::population(sources.iter().map(Arc::as_ref))
    }

    /// The request for the body of a shopper who was measured, each garment in the size that fits or the one that was asked for.
    ///
    /// # Errors
    /// As [`Self::open`]; a size that is not made, measures that no body has.
    pub fn sized_for(&self, session: &str, measured: &MeasuredSubject) -> Result<Self, FittingError> {
        let request = self.clone().open()?;
        let sex = measured.sex(request.population()?);
        let (body, _) = measured::build_body(sex, &measured.best, Population::from(Some(sex)))?;
        let (mut garments, mut beneath) = (Vec::with_capacity(request.garments.len()), Vec::new());
        for garment in &request.garments {
            let source = garment.source()?;
            let fit = source.judge(garment.size.as_deref(), &measured.best, &body, &beneath)?;
            beneath.extend(source.offer(&body)?);
            let size = fit.map_or_else(|| own::UNKNOWN.to_owned(), |fit| fit.size);
            garments.push(RequestedGarment::of(source, Some(size)));
        }
        Ok(Self { garments, ..request.worn_by(session, sex, body.measures) })
    }

    /// The same request for a body of these measures.
    #[must_use]
    pub fn worn_by(self, session: &str, sex: Sex, measures: Measures) -> Self {
        Self { session: session.to_owned(), wearer: Wearer::Body { sex, measures }, ..self }
    }

    /// Puts the garments on a body: each is sized by the measures over those beneath it, unless a size was asked for.
    ///
    /// # Errors
    /// A size that is not made; a garment that cannot be laid on the body or tucked in.
    pub fn put_on(&self, body: Body, measured: &Measurements) -> Result<DressedBody, FittingError> {
        let (mut dressed, mut beneath) =
            (DressedBody::new(toile_assets::rig::fit(&body), body, Vec::new()), Vec::new());
        for garment in &self.garments {
            let source = garment.source()?;
            dressed.add(source.put_on(garment.size.as_deref(), measured, &dressed.body, &beneath)?);
            beneath.extend(source.offer(&dressed.body)?);
        }
        self.tuck.iter().try_for_each(|name| dressed.tuck(name))?;
        Ok(dressed)
    }

    /// Puts the garments on the body of the request, in the sizes of the request.
    ///
    /// # Errors
    /// A wearer who was not measured; measures, garments or sizes that cannot be made, as in a request of another version.
    pub fn dress(&self) -> Result<DressedBody, FittingError> {
        let Wearer::Body { sex, measures } = self.wearer else {
            return Err(FittingError::Input(
                "the wearer of this request was not measured; size it for a shopper".into(),
            ));
        };
        let body = toile_assets::body::build(sex, &measures).map_err(FittingError::input)?;
        let mut dressed = DressedBody::new(toile_assets::rig::fit(&body), body, Vec::new());
        for garment in &self.garments {
            dressed.add(garment.source()?.dress(garment.size.as_deref(), &dressed.body)?);
        }
        self.tuck.iter().try_for_each(|name| dressed.tuck(name))?;
        Ok(dressed)
    }

    /// Builds the world and dresses the wearer as they stand in a frame, with one worker. The number of workers that take the steps from then
    /// on changes no bit.
    ///
    /// # Errors
    /// As [`Self::dress`].
    pub fn build(self, first: &Joints) -> Result<DressedWorld, FittingError> {
        let settings = Settings { workers: 1, ..self.settings() };
        let (mut world, reader) = self.dress()?.build(settings).map_err(FittingError::input)?;
        world.dress(first);
        Ok(DressedWorld { world, reader, request: self, first: *first, still: false })
    }

    /// Measures the shopper of a session and dresses them as they stand. Without joints the body is followed through the depth.
    ///
    /// # Errors
    /// A session in which no person can be measured or dressed; as [`Self::sized_for`].
    pub fn on_shopper(&self, session: &Session) -> Result<DressedWorld, FittingError> {
        let measured = measured::measure(session, self.facts())?;
        let track = measured::track(session, &measured)?;
        self.sized_for(&session.name, &measured)?.build(&track[0])
    }

    /// Dresses the mannequin, which stands as `pose` does: the body that the outermost garment is shown on, each garment in its own middle
    /// size or the one that was asked for.
    ///
    /// # Errors
    /// As [`Self::open`]; no garment, a size that is not made, a garment that cannot be tucked in.
    pub fn on_mannequin(&self, pose: &Joints) -> Result<DressedWorld, FittingError> {
        let (mut garments, mut body) = (Vec::with_capacity(self.garments.len()), None);
        self.check_count()?;
        for garment in &self.garments {
            let source = garment.source()?;
            let (sex, measures, size) = source.shown_on()?;
            let (measures, size) = match &garment.size {
                Some(asked) => (source.body_of(asked)?.unwrap_or(measures), asked.clone()),
                None => (measures, size),
            };
            body = Some((sex, measures));
            garments.push(RequestedGarment::of(source, Some(size)));
        }
        let Some((sex, measures)) = body else {
            return Err(FittingError::Input("no garment is named; name one in [wear]".into()));
        };
        let request = Self::of_body("mannequin", sex, measures, garments).in_quality(self.quality);
        let request = Self { tuck: self.tuck.clone(), ..request };
        Ok(DressedWorld { still: true, ..request.build(pose)? })
    }

    /// The request in a line.
    pub fn words(&self) -> String {
        let worn = |garment: &RequestedGarment| {
            let size = garment.size.as_deref().unwrap_or("the size that fits");
            format!("{} in {size}", garment.name)
        };
        let worn: Vec<String> = self.garments.iter().map(worn).collect();
        format!("session {}, {}, quality {}", self.session, worn.join(" and "), self.quality)
    }
}

/// The garments of a request that names none, inner first: a dress, or trousers and a shirt for a man.
pub const fn shown_first(sex: Option<Sex>) -> &'static [&'static str] {
    match sex {
        Some(Sex::Male) => &["mens-trousers", "mens-shirt"],
        Some(Sex::Female) | None => &["strap-dress"],
    }
}

/// A body and the baked garments that it wears: everything that a world is built of.
#[derive(Debug, Clone)]
pub struct DressedBody {
    /// The wearer's body.
    pub body: Body,
    /// Spheres and capsules that stand for the body in contact.
    pub rig: Rig,
    /// The baked garments, inner first.
    pub garments: Vec<Garment>,
    /// The fit of each requested garment, without its baked garments.
    pub fitted: Vec<FittedGarment>,
    /// The requested garment that each baked one belongs to, an index into `fitted` `[garments]`.
    pub fitted_of: Vec<usize>,
}

impl DressedBody {
    /// A body in garments that were baked for it, without their fit.
    pub const fn new(rig: Rig, body: Body, garments: Vec<Garment>) -> Self {
        Self { body, rig, garments, fitted: Vec::new(), fitted_of: Vec::new() }
    }

    /// Puts a garment on over the others.
    fn add(&mut self, mut fitted: FittedGarment) {
        self.fitted_of.extend(fitted.garments.iter().map(|_| self.fitted.len()));
        self.garments.append(&mut fitted.garments);
        self.fitted.push(fitted);
    }

    /// Tucks in a garment by its name.
    ///
    /// # Errors
    /// A garment that is not worn, or has nothing to be tucked into.
    fn tuck(&mut self, name: &str) -> Result<(), FittingError> {
        let Some(place) = self.garments.iter().rposition(|g| g.name == name) else {
            let worn: Vec<&str> = self.garments.iter().map(|g| g.name.as_str()).collect();
            let worn = worn.join(", ");
            return Err(FittingError::Input(format!(
                "{name} is not worn, so that it cannot be tucked in; name one of {worn}"
            )));
        };
        tuck_in(&mut self.garments, place).map_err(FittingError::input)
    }

    /// The tightness of each baked garment, -1 (loose) .. 1 (tight), at the zones where it is known `[garments]`.
    pub fn tightness(&self) -> Vec<Vec<(Girth, f32)>> {
        let of = |fitted: &usize| {
            let zones = self.fitted[*fitted].fit.iter().flat_map(|fit| &fit.zones);
            zones.filter_map(|z| Some((z.zone, z.tightness?))).collect()
        };
        self.fitted_of.iter().map(of).collect()
    }

    /// Builds the world, which stands at rest; the reader takes its snapshots.
    ///
    /// # Errors
    /// Colliders or a skin that cannot be used, a thread that the system does not give.
    pub fn build(self, settings: Settings) -> Result<(World, Reader<Snapshot>), WorldError> {
        World::new(self.body, &self.rig, self.garments, settings)
    }
}

/// A world with its dressed wearer, and the request that makes the same world again.
#[derive(Debug)]
pub struct DressedWorld {
    /// The world, with one worker.
    pub world: World,
    /// Reads the snapshots of the world.
    pub reader: Reader<Snapshot>,
    /// The request that it was built from.
    pub request: TryOn,
    /// The joints in which the wearer was dressed.
    pub first: Joints,
    /// Whether the wearer stands still in them, as the mannequin does.
    pub still: bool,
}

impl DressedWorld {
    /// The joints in which the wearer stands still; `None` follows the sensor.
    pub fn stands(&self) -> Option<Joints> {
        self.still.then_some(self.first)
    }
}

/// A quality by its name.
mod quality_name {
    use super::*;

    pub fn serialize<S: serde::Serializer>(quality: &Quality, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(quality.name())
    }

    pub fn deserialize<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Quality, D::Error> {
        String::deserialize(from)?.parse().map_err(serde::de::Error::custom)
    }
}

/// Stature, shoulder breadth, girths of chest, waist and hip by the bits of f32 (m): a decimal might be read as a neighbour.
mod measure_bits {
    use super::*;

    pub fn serialize<S: serde::Serializer>(m: &Measures, to: S) -> Result<S::Ok, S::Error> {
        [m.stature, m.shoulder_breadth, m.chest_girth, m.waist_girth, m.hip_girth].map(f32::to_bits).serialize(to)
    }

    pub fn deserialize<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Measures, D::Error> {
        let [stature, shoulder_breadth, chest_girth, waist_girth, hip_girth] =
            <[u32; 5]>::deserialize(from)?.map(f32::from_bits);
        Ok(Measures { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth })
    }
}

#[cfg(test)]
mod tests;
