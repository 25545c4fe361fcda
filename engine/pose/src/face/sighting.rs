//! Sightings of a head in the photographs: places of its surface, the pixels where each was seen, and the equations that follow.

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::prior::Observation;
use super::view::FaceView;

/// Robust distance of a point (standard deviations): one that was marked elsewhere counts little.
pub(super) const ROBUST: f64 = 4.0;

/// Nearest that a place may lie before a camera (m).
const NEAREST: f64 = 0.05;

/// Where a head stands: rotation, place and size of the mannequin's.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeadPose {
    pub turn: DQuat,
    pub place: DVec3,
    pub size: f64,
}

impl HeadPose {
    /// A place of the head (m, from its middle) in the world.
    pub(super) fn to_world(self, p: DVec3) -> DVec3 {
        self.place + self.turn * (p * self.size)
    }
}

/// A place of the head that a photograph shows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sighting {
    /// Number of the photograph among all, from 0.
    pub view: usize,
    /// The place on the mannequin's head, and on this one as far as it is known (m, from the middle).
    pub drawn: DVec3,
    pub own: DVec3,
    /// What an expression adds (m).
    pub by: DVec3,
    /// Where it was seen, as by a lens that bends nothing (px, from the principal point).
    pub at: DVec2,
    /// Of an outline: the way across it. Where along an outline a place was seen is unknown.
    pub across: Option<DVec2>,
    /// Standard deviation, and the distance from which it counts little (px).
    pub sigma: f64,
    pub robust: f64,
}

/// One equation of a sighting.
#[derive(Debug, Clone, Copy)]
pub(super) struct SightingEquation {
    /// Number of the sighting.
    pub of: usize,
    /// Where its place is (m, world).
    pub world: DVec3,
    /// How far off it is seen (px), and how that changes with its place (px a metre).
    pub off: f64,
    pub along: DVec3,
    /// How far off the sighting is in all its equations (px).
    pub length: f64,
}

impl Sighting {
    /// Weight of its equations at so many pixels off; `coarse` lets all of them pull, as is wanted far from the solution.
    pub(super) fn weight(&self, length: f64, coarse: bool) -> f64 {
        let least = if coarse { 0.05 * length } else { 0.0 };
        let (sigma, robust) = (self.sigma.max(least), self.robust.max(ROBUST * least));
        1.0 / ((1.0 + (length / robust).powi(2)).powi(2) * sigma * sigma)
    }
}

/// The marked points of all photographs, on a head whose points are here (m).
pub(super) fn marked_points(views: &[FaceView], drawn: &[DVec3], own: &[DVec3]) -> Vec<Sighting> {
    let of_view = |(view, v): (usize, &FaceView)| {
        let one = |(i, marked): (usize, &Option<DVec2>)| {
            let at = v.camera.ray((*marked)?) * v.camera.focal();
            let (sigma, robust) = (v.sigma_px, ROBUST * v.sigma_px);
            Some(Sighting { view, drawn: drawn[i], own: own[i], by: DVec3::ZERO, at, across: None, sigma, robust })
        };
        v.points.iter().enumerate().filter_map(one).collect::<Vec<_>>()
    };
    views.iter().enumerate().flat_map(of_view).collect()
}

/// The equations of all sightings before the cameras: two of a point, one of an outline.
pub(super) fn equations<'a>(
    views: &'a [FaceView],
    sightings: &'a [Sighting],
    pose: HeadPose,
) -> impl Iterator<Item = SightingEquation> + 'a {
    let both = move |(of, s): (usize, &'a Sighting)| {
        let camera = &views[s.view].camera;
        let world = pose.to_world(s.own + s.by);
        let p = camera.to_camera(world);
        let focal = camera.focal();
        let off = p.truncate() / p.z * focal - s.at;
        let rows = camera.rotation().transpose();
        let [x, y] = [(DVec3::X, focal.x, p.x), (DVec3::Y, focal.y, p.y)]
            .map(|(axis, f, along)| rows * ((axis * p.z - DVec3::Z * along) * (f / (p.z * p.z))));
        let equation = |off: f64, along: DVec3, length: f64| SightingEquation { of, world, off, along, length };
        let pair = match s.across {
            None => [Some(equation(off.x, x, off.length())), Some(equation(off.y, y, off.length()))],
            Some(n) => [Some(equation(off.dot(n), x * n.x + y * n.y, off.dot(n).abs())), None],
        };
        pair.into_iter().flatten().filter(move |_| p.z >= NEAREST)
    };
    sightings.iter().enumerate().flat_map(both)
}

/// What the sightings say of the field, linearised at where their places are now.
pub(super) fn observations(views: &[FaceView], sightings: &[Sighting], pose: HeadPose) -> Vec<Observation> {
    let back = DMat3::from_quat(pose.turn).transpose() * pose.size;
    let one = |e: SightingEquation| {
        let s = &sightings[e.of];
        let along = back * e.along;
        let sigma = s.weight(e.length, false).sqrt().recip();
        Observation { place: s.drawn, along, value: along.dot(s.own - s.drawn) - e.off, sigma }
    };
    equations(views, sightings, pose).map(one).collect()
}

/// Root mean square distance of outlines across their way (px).
pub(super) fn across(views: &[FaceView], outlines: &[Sighting], pose: HeadPose) -> f64 {
    let (sum, count) = equations(views, outlines, pose).fold((0.0, 0.0), |(s, n), e| (s + e.off * e.off, n + 1.0));
    (sum / f64::max(count, 1.0)).sqrt()
}

/// Root mean square distance of points (px), and the same distance in thousandths of the focal length; infinite where there is none.
pub(super) fn residual(views: &[FaceView], points: &[Sighting], pose: HeadPose) -> [f64; 2] {
    let (sum, count) = equations(views, points, pose).fold((0.0, 0.0), |(s, n), e| (s + e.off * e.off, n + 0.5));
    let focal = views.iter().map(|v| v.camera.focal().x).fold(f64::MAX, f64::min);
    let off = if count > 0.0 { f64::sqrt(sum / count) } else { f64::INFINITY };
    [off, 1e3 * off / focal]
}
