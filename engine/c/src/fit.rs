//! Size and fit.

use std::ffi::{CString, c_char};

use toile_sdk::{Recommendation, recommend};

use crate::body::BodyHandle;
use crate::border::Out;
use crate::failure::{Code, Failure, call};
use crate::garment::GarmentHandle;
use crate::handle::{Handle, Held, stands_for};
use crate::texts::{lent, pointer};

/// A size, judged on a body.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct FitHandle {
    /// Its number; 0 is the null handle.
    id: u64,
}

/// What a judgement says. Texts are lent by its handle.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct FitSummary {
    /// Name of the garment.
    pub garment: *const c_char,
    /// Code of the size.
    pub size: *const c_char,
    /// Probability that this size suits this person best.
    pub probability: f32,
    /// Whether no size is sure.
    pub uncertain: bool,
    /// The recommendation in sentences.
    pub verdict: *const c_char,
    /// The next best size, where it may be the better one; otherwise null.
    pub runner_up: *const c_char,
    /// Set where no size is made for this person, or guesses stand for measures; otherwise null.
    pub note: *const c_char,
    /// The girth to take by tape, where no size is sure and it would help: "chest", "waist" or "hip"; otherwise null.
    pub advice_zone: *const c_char,
    /// The same in a sentence; otherwise null.
    pub advice: *const c_char,
    /// Zones that toile_fit_zone gives.
    pub zones: usize,
    /// Sizes that toile_fit_size gives.
    pub sizes: usize,
}

/// How a size fits in one zone. Texts are lent by the fit.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Zone {
    /// Its name: "chest".
    pub zone: *const c_char,
    /// Whether the size is chosen by this zone.
    pub primary: bool,
    /// Girth of the garment less that of the body (mm).
    pub ease_mm: f64,
    /// Standard deviation of the ease (mm): that of the body's measure.
    pub sigma_mm: f64,
    /// "tight", "good", "loose", or "unknown" where the body was not seen there.
    pub verdict: *const c_char,
    /// How it feels, from "too tight" over "right" to "too loose"; null where the body was not seen there.
    pub feel: *const c_char,
    /// -1 (loose) .. 1 (tight); NaN where the body was not seen there.
    pub tightness: f32,
    /// The same for a person to read.
    pub sentence: *const c_char,
}

/// A size with the probability that it suits this person best. The text is lent by the fit.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct SizeOdds {
    /// Code of the size.
    pub size: *const c_char,
    /// The probability; those of all sizes sum to 1.
    pub probability: f32,
}

/// What a fit's handle stands for.
#[derive(Debug)]
pub struct FitObject {
    fit: Recommendation,
    garment: CString,
    size: CString,
    verdict: CString,
    runner_up: Option<CString>,
    note: Option<CString>,
    advice: Option<[CString; 2]>,
    zones: Vec<ZoneTexts>,
    sizes: Vec<CString>,
}

#[derive(Debug)]
struct ZoneTexts {
    zone: CString,
    verdict: CString,
    feel: Option<CString>,
    sentence: CString,
}

stands_for!(FitHandle, FitObject, "fit");

impl FitObject {
    pub fn new(fit: Recommendation) -> Self {
        let zones = fit.zones.iter().map(|zone| ZoneTexts {
            zone: lent(zone.zone),
            verdict: lent(zone.verdict),
            feel: zone.feel.map(lent),
            sentence: lent(&zone.sentence),
        });
        Self {
            garment: lent(&fit.garment),
            size: lent(&fit.size),
            verdict: lent(&fit.verdict),
            runner_up: fit.runner_up.as_deref().map(lent),
            note: fit.note.as_deref().map(lent),
            advice: fit.advice.as_ref().map(|advice| [lent(advice.zone), lent(&advice.sentence)]),
            zones: zones.collect(),
            sizes: fit.sizes.iter().map(|odds| lent(&odds.size)).collect(),
            fit,
        }
    }
}

/// The size of a garment that fits a body, or how the one that was asked for does, worn over nothing else.
#[unsafe(no_mangle)]
pub extern "C" fn toile_recommend(body: BodyHandle, garment: GarmentHandle, fit: Out<FitHandle>) -> Code {
    call("toile_recommend", || {
        let place = fit.empty("fit")?;
        let judged = recommend(&body.get()?.body, &garment.get()?.0)?;
        place.set(FitHandle::open(FitObject::new(judged)));
        Ok(())
    })
}

/// What a fit says.
#[unsafe(no_mangle)]
pub extern "C" fn toile_fit_read(fit: FitHandle, summary: Out<FitSummary>) -> Code {
    call("toile_fit_read", || {
        let (place, of) = (summary.place("summary")?, fit.get()?);
        let [advice_zone, advice] = [0, 1].map(|i| pointer(of.advice.as_ref().map(|advice| &advice[i])));
        place.set(FitSummary {
            garment: of.garment.as_ptr(),
            size: of.size.as_ptr(),
            probability: of.fit.probability,
            uncertain: of.fit.uncertain,
            verdict: of.verdict.as_ptr(),
            runner_up: pointer(of.runner_up.as_ref()),
            note: pointer(of.note.as_ref()),
            advice_zone,
            advice,
            zones: of.zones.len(),
            sizes: of.sizes.len(),
        });
        Ok(())
    })
}

/// A zone of a fit by its number from 0, the primary ones first.
#[unsafe(no_mangle)]
pub extern "C" fn toile_fit_zone(fit: FitHandle, index: usize, zone: Out<Zone>) -> Code {
    call("toile_fit_zone", || {
        let (place, of) = (zone.place("zone")?, fit.get()?);
        let found = of.fit.zones.iter().zip(&of.zones).nth(index);
        let (zone, texts) = found.ok_or_else(|| {
            Failure::usage(format!("there is no zone {index}: the fit has {}, counted from 0", of.zones.len()))
        })?;
        place.set(Zone {
            zone: texts.zone.as_ptr(),
            primary: zone.primary,
            ease_mm: zone.ease_mm,
            sigma_mm: zone.sigma_mm,
            verdict: texts.verdict.as_ptr(),
            feel: pointer(texts.feel.as_ref()),
            tightness: zone.tightness.unwrap_or(f32::NAN),
            sentence: texts.sentence.as_ptr(),
        });
        Ok(())
    })
}

/// A size of a fit by its number from 0, smallest first.
#[unsafe(no_mangle)]
pub extern "C" fn toile_fit_size(fit: FitHandle, index: usize, size: Out<SizeOdds>) -> Code {
    call("toile_fit_size", || {
        let (place, of) = (size.place("size")?, fit.get()?);
        let found = of.fit.sizes.iter().zip(&of.sizes).nth(index);
        let (odds, text) = found.ok_or_else(|| {
            Failure::usage(format!("there is no size {index}: the fit has {}, counted from 0", of.sizes.len()))
        })?;
        place.set(SizeOdds { size: text.as_ptr(), probability: odds.probability });
        Ok(())
    })
}

/// Closes a fit.
#[unsafe(no_mangle)]
pub extern "C" fn toile_fit_close(fit: FitHandle) -> Code {
    call("toile_fit_close", || fit.close())
}
