//! Colliders of a scene: spheres, the capsules between them, planes, and their motion.

use glam::{Vec3, Vec4};

use super::error::SceneError;
use super::source::SceneSource;
use super::table::SceneTable;
use super::track::Track;
use crate::scene::skirt::{self, SkirtMotion};
use toile_base::limits::{MAX_CAPSULES, MAX_PLANES, MAX_SPHERES};

/// A plane: cloth stays on the side that the normal shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScenePlane {
    /// A point on it (m).
    pub point: Vec3,
    /// Unit normal, towards the side on which cloth stays.
    pub normal: Vec3,
}

/// Source of the spheres' motion.
#[derive(Debug, Clone, PartialEq)]
enum SphereMotion {
    Track(Track),
    /// The benchmark's body.
    Body(SkirtMotion),
}

/// The colliders of a scene and how they move.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SceneColliders {
    /// For each sphere what moves it, and its place among the spheres of that.
    spheres: Vec<(usize, usize)>,
    movers: Vec<SphereMotion>,
    /// Pairs of spheres; one that belongs to no pair is paired with itself.
    pub capsules: Vec<[u8; 2]>,
    /// Planes that nothing moves.
    pub planes: Vec<ScenePlane>,
}

impl SceneColliders {
    pub(super) fn load(table: &SceneTable<'_>, source: SceneSource<'_>, pass: bool) -> Result<Self, SceneError> {
        let mut this = Self::default();
        let spheres = table.tables("sphere")?;
        match table.text("track")? {
            Some(_) if !spheres.is_empty() || table.has("motion") => {
                return Err(
                    table.wrong("track", "stands for all spheres; delete the [[colliders.sphere]] tables and motion")
                );
            }
            Some(name) => {
                let track = sphere_track(table, name, source, pass, None)?;
                this.spheres = (0..track.width() / 4).map(|k| (0, k)).collect();
                this.movers.push(SphereMotion::Track(track));
            }
            None if table.has("motion") => {
                if !spheres.is_empty() || table.has("capsules") {
                    let message = "brings spheres and capsules of its own; delete the others";
                    return Err(table.wrong("motion", message));
                }
                let motion = motion(table.choice("motion")?.unwrap_or_default());
                this.spheres = (0..skirt::JOINTS.len()).map(|k| (0, k)).collect();
                this.movers.push(SphereMotion::Body(motion));
            }
            None => spheres.iter().try_for_each(|sphere| this.add(sphere, source, pass))?,
        }
        if this.spheres.len() > MAX_SPHERES {
            let message =
                format!("{} spheres are more than MAX_SPHERES = {MAX_SPHERES}; leave some out", this.spheres.len());
            return Err(table.error(message));
        }
        this.join(table)?;
        for plane in table.tables("plane")? {
            let normal = plane.vector("normal")?.try_normalize();
            let normal = normal.ok_or_else(|| plane.wrong("normal", "has no length; give [0, 1, 0] for a floor"))?;
            this.planes.push(ScenePlane { point: plane.vector("point")?, normal });
        }
        if this.planes.len() > MAX_PLANES {
            let message =
                format!("{} planes are more than MAX_PLANES = {MAX_PLANES}; leave some out", this.planes.len());
            return Err(table.wrong("plane", message));
        }
        Ok(this)
    }

    fn add(&mut self, sphere: &SceneTable<'_>, source: SceneSource<'_>, pass: bool) -> Result<(), SceneError> {
        let track = match sphere.text("track")? {
            Some(_) if sphere.has("centre") || sphere.has("radius") => {
                return Err(sphere.wrong("track", "gives centre and radius; delete those keys"));
            }
            Some(name) => sphere_track(sphere, name, source, pass, Some(1))?,
            None => {
                let (centre, radius) = (sphere.vector("centre")?.as_dvec3(), sphere.needed("radius")?);
                Track::still(&[centre.x, centre.y, centre.z, radius])
            }
        };
        self.spheres.push((self.movers.len(), 0));
        self.movers.push(SphereMotion::Track(track));
        Ok(())
    }

    /// Capsules as the scene joins them, and one of its own for every sphere that is in none.
    fn join(&mut self, table: &SceneTable<'_>) -> Result<(), SceneError> {
        self.capsules = match self.movers.first() {
            Some(SphereMotion::Body(_)) => skirt::CAPSULES.to_vec(),
            _ => table.pairs("capsules", self.spheres.len())?,
        };
        let joined = |s: u8| self.capsules.iter().any(|ends| ends.contains(&s));
        let alone: Vec<[u8; 2]> = (0..self.spheres.len() as u8).filter(|s| !joined(*s)).map(|s| [s, s]).collect();
        self.capsules.extend(alone);
        if self.capsules.len() > MAX_CAPSULES {
            let count = self.capsules.len();
            let message =
                format!("and single spheres are {count}, more than MAX_CAPSULES = {MAX_CAPSULES}; leave some out");
            return Err(table.wrong("capsules", message));
        }
        Ok(())
    }

    /// Number of spheres.
    pub fn spheres(&self) -> usize {
        self.spheres.len()
    }

    /// A sphere at a time (s): centre and radius (m).
    pub fn sphere(&self, k: usize, time: f64) -> Vec4 {
        let (mover, place) = self.spheres[k];
        match &self.movers[mover] {
            SphereMotion::Track(track) => track.sphere(time, place).as_vec4(),
            SphereMotion::Body(motion) => skirt::spheres(*motion, time)[place],
        }
    }
}

/// The motion of the schema's name.
pub(super) fn motion(choice: usize) -> SkirtMotion {
    SkirtMotion::ALL[choice.min(2)]
}

fn sphere_track(
    table: &SceneTable<'_>,
    name: &str,
    source: SceneSource<'_>,
    pass: bool,
    spheres: Option<usize>,
) -> Result<Track, SceneError> {
    let wrong = |message: String| table.wrong("track", format!("{name}: {message}"));
    let text = source.text(name).map_err(|e| wrong(format!("{e}; give the path of a CSV file")))?;
    let fits = |n: usize| match spheres {
        None if n > 0 && n.is_multiple_of(4) => Ok(()),
        Some(count) if n == 4 * count => Ok(()),
        _ => Err(format!("it has {} columns; give time, then x, y, z, r of each sphere", n + 1)),
    };
    let track = Track::parse(&text, fits, pass).map_err(wrong)?;
    let negative = |row: &[f64]| row.chunks_exact(4).any(|sphere| sphere[3] < 0.0);
    match track.find(negative) {
        Some(row) => Err(wrong(format!("row {row} has a radius below 0; give radii of 0 m or more"))),
        None => Ok(track),
    }
}
