//! Motion of pinned vertices: the groups of pins of a scene, each moved by a track or by the benchmark's body.

use glam::Affine3A;

use super::error::SceneError;
use super::source::SceneSource;
use super::table::SceneTable;
use super::track::Track;
use super::{colliders, schema};
use crate::scene::skirt::{self, SkirtMotion};
use toile_base::skeleton::BONES;

/// Most different pin tracks of a scene: one bone each, and one for what stands.
const MAX_PIN_TRACKS: usize = BONES - 1;

/// How a group of pinned vertices moves.
#[derive(Debug, Clone, PartialEq)]
pub enum PinMotion {
    /// By a track of positions and quaternions.
    Track(Track),
    /// As the root of the benchmark's body.
    Body(SkirtMotion),
}

impl PinMotion {
    /// The rigid motion at a time (s): what starts at p is held at its image of p.
    pub fn at(&self, time: f64) -> Affine3A {
        match self {
            Self::Track(track) => track.rigid(time).as_affine3a(),
            Self::Body(motion) => skirt::root(*motion, time),
        }
    }
}

/// Motion of a pin table.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PinSource<'a> {
    /// The name of a track.
    Track(&'a str),
    /// A choice among the schema's motions.
    Motion(usize),
}

/// Data shared while the parts of a scene are read.
pub(crate) struct SceneLoader<'a> {
    pub(super) source: SceneSource<'a>,
    pub(super) pass: bool,
    pub(super) pins: Vec<(String, PinMotion)>,
}

impl SceneLoader<'_> {
    /// The group of the pins that follow a motion; the same one is one group.
    pub(super) fn pin_group(&mut self, pin: &SceneTable<'_>, source: PinSource<'_>) -> Result<u8, SceneError> {
        let name = match source {
            PinSource::Track(name) => name.to_owned(),
            PinSource::Motion(choice) => format!("motion {}", schema::MOTIONS[choice]),
        };
        if let Some(known) = self.pins.iter().position(|(n, _)| *n == name) {
            return Ok(known as u8 + 1);
        }
        if self.pins.len() == MAX_PIN_TRACKS {
            let says = format!("is the {}th; give pins that move alike the same file", self.pins.len() + 1);
            return Err(pin.wrong("track", says));
        }
        let motion = match source {
            PinSource::Track(name) => PinMotion::Track(rigid_track(pin, name, self.source, self.pass)?),
            PinSource::Motion(choice) => PinMotion::Body(colliders::motion(choice)),
        };
        self.pins.push((name, motion));
        Ok(self.pins.len() as u8)
    }
}

/// Reads a track of rigid motion.
fn rigid_track(pin: &SceneTable<'_>, name: &str, source: SceneSource<'_>, pass: bool) -> Result<Track, SceneError> {
    let wrong = |says: String| pin.wrong("track", format!("{name}: {says}"));
    let text = source.text(name).map_err(|e| wrong(format!("{e}; give the path of a CSV file")))?;
    let fits = |n: usize| match n {
        7 => Ok(()),
        _ => Err(format!("it has {} columns; give time, x, y, z, qx, qy, qz, qw", n + 1)),
    };
    let track = Track::parse(&text, fits, pass).map_err(wrong)?;
    let no_turn = |row: &[f64]| !pass && row[3..].iter().map(|q| q * q).sum::<f64>() < 1e-6;
    match track.find(no_turn) {
        Some(row) => Err(wrong(format!("row {row} has a quaternion of zeros; no turn is 0, 0, 0, 1"))),
        None => Ok(track),
    }
}
