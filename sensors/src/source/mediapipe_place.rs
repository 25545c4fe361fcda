//! The place of a person whose world landmarks have the hips at the origin, from the image.
//!
//! Weak perspective: the image is the world landmarks' x and y times a scale, shifted. The scale (px/m) says how far
//! away they are for a camera of an assumed focal length, and the shift where they stand across it, so that a step or a
//! jump is seen. Without world landmarks the image's own x, y and z are taken, in the unit that makes a plausible leg.

use glam::{Vec2, Vec3};
use toile_base::numeric::statistics::median_of;

use super::mediapipe_landmarks::{FOCAL, Image, Landmark, LandmarkPerson, POINTS, tracked};
use toile_base::frame::TrackedJoint;

/// Landmarks of shoulders and hips, the steadiest ones: the scale is taken from the whole body, seen at least so far.
const VISIBLE: f32 = 0.5;

/// Fewest landmarks that give a scale.
const FEWEST: usize = 4;

/// Scales that a person in view can have (px/m): a body from a tenth of a small image to ten times a large one.
const SCALES: std::ops::Range<f32> = 5.0..20_000.0;

/// Stature given to a person of whom only the image is known (m), and hip to ankle over stature (Drillis and Contini
/// 1966).
const ASSUMED_STATURE: f32 = 1.70;
const LEG_OF_STATURE: f32 = 0.491;

const LEGS: [[usize; 3]; 2] = [[23, 25, 27], [24, 26, 28]];

/// The points of all people in one space, world axes (m); not yet levelled nor put on the floor.
pub(super) fn in_space(people: &[LandmarkPerson], notes: &mut Vec<String>) -> Vec<[TrackedJoint; POINTS]> {
    if people.iter().all(|p| p.world.is_none()) {
        return from_images(people, notes);
    }
    if people.iter().any(|p| p.image.is_some()) {
        notes.push(format!(
            "how far the person stands is taken from the image, for a focal length of {FOCAL} of its longer side"
        ));
    } else {
        notes.push("no image landmarks are given: the hips stay in one place, and steps and jumps are lost".to_owned());
    }
    notes.push("the size is the model's guess, not measured".to_owned());
    let mut last = Vec3::ZERO;
    people
        .iter()
        .map(|person| {
            last =
                person.image.as_ref().zip(person.world.as_ref()).and_then(|(i, w)| translation(i, w)).unwrap_or(last);
            let points = person.world.as_ref();
            points.map_or([TrackedJoint::default(); POINTS], |points| {
                points.map(|p| tracked(&p, turned(Vec3::new(p.x, p.y, p.z) + last)))
            })
        })
        .collect()
}

/// Camera axes (x right, y down, z forward) to world axes of a person who faces the camera.
fn turned(camera: Vec3) -> Vec3 {
    Vec3::new(camera.x, -camera.y, -camera.z)
}

/// Where the world landmarks' origin lies, camera axes (m): the least-squares scale and shift of the image over them.
fn translation(image: &Image, world: &[Landmark; POINTS]) -> Option<Vec3> {
    let seen: Vec<usize> =
        (0..POINTS).filter(|k| image.points[*k].visibility.min(world[*k].visibility) >= VISIBLE).collect();
    if seen.len() < FEWEST {
        return None;
    }
    let flat = |k: usize| Vec2::new(world[k].x, world[k].y);
    let mean = |of: &dyn Fn(usize) -> Vec2| seen.iter().map(|k| of(*k)).sum::<Vec2>() / seen.len() as f32;
    let (pixel, metre) = (mean(&|k| image.pixel(k)), mean(&flat));
    let (mut along, mut square) = (0.0, 0.0);
    for k in &seen {
        let m = flat(*k) - metre;
        along += m.dot(image.pixel(*k) - pixel);
        square += m.length_squared();
    }
    let scale = along / square;
    if !SCALES.contains(&scale) {
        return None;
    }
    let centre = Vec2::from_array(image.size) * 0.5;
    Some(((pixel - centre) / scale - metre).extend(image.focal() / scale))
}

/// Without world landmarks: the image's own depth is in units of its width.
fn from_images(people: &[LandmarkPerson], notes: &mut Vec<String>) -> Vec<[TrackedJoint; POINTS]> {
    let point = |image: &Image, k: usize| image.pixel(k).extend(image.points[k].z * image.size[0]);
    let leg = |image: &Image, [hip, knee, ankle]: [usize; 3]| {
        let seen = [hip, knee, ankle].iter().all(|k| image.points[*k].visibility >= VISIBLE);
        let [hip, knee, ankle] = [hip, knee, ankle].map(|k| point(image, k));
        seen.then(|| hip.distance(knee) + knee.distance(ankle))
    };
    let images = || people.iter().filter_map(|p| p.image.as_ref());
    let legs: Vec<f32> = images().flat_map(|i| LEGS.map(|l| leg(i, l))).flatten().collect();
    // A trunk is six tenths of a leg; legs out of view are taken from it.
    let unit = median_of(legs).or_else(|| median_of(images().map(|i| i.height() / 0.6)));
    let scale = ASSUMED_STATURE * LEG_OF_STATURE / unit.unwrap_or(1.0).max(1.0);
    notes.push(format!(
        "no world landmarks are given: the image is scaled by leg length to a person of {ASSUMED_STATURE:.2} m"
    ));
    let place = |image: &Image| std::array::from_fn(|k| tracked(&image.points[k], turned(point(image, k) * scale)));
    people.iter().map(|p| p.image.as_ref().map_or([TrackedJoint::default(); POINTS], place)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat person, and what a camera of the assumed focal length sees of them from `z` metres, shifted by `x` and `y`.
    fn seen(x: f32, y: f32, z: f32) -> LandmarkPerson {
        let world: [Landmark; POINTS] = std::array::from_fn(|k| {
            let (x, y) = ((k % 5) as f32 * 0.1 - 0.2, (k / 5) as f32 * 0.25 - 0.8);
            Landmark { x, y, z: 0.0, visibility: 1.0 }
        });
        let size = [640.0, 480.0];
        let f = FOCAL * 640.0;
        let points =
            world.map(|p| Landmark { x: 0.5 + f * (p.x + x) / z / size[0], y: 0.5 + f * (p.y + y) / z / size[1], ..p });
        LandmarkPerson { time_ns: 0, image: Some(Image { points, size }), world: Some(world) }
    }

    #[test]
    fn a_step_and_a_jump_are_seen_in_the_image() {
        for at in [Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.4, -0.3, 2.5), Vec3::new(-1.0, 0.1, 4.0)] {
            let person = seen(at.x, at.y, at.z);
            let found = translation(person.image.as_ref().unwrap(), person.world.as_ref().unwrap()).unwrap();
            assert!(found.distance(at) < 1e-3, "{found} for {at}");
        }
    }

    #[test]
    fn a_person_out_of_sight_stays_where_they_were() {
        let mut lost = seen(0.0, 0.0, 3.0);
        lost.image.as_mut().unwrap().points.iter_mut().for_each(|p| p.visibility = 0.1);
        let people = [seen(0.5, 0.0, 2.0), lost];
        let points = in_space(&people, &mut Vec::new());
        assert!(points[0][0].position.distance(points[1][0].position) < 1e-4);
    }

    #[test]
    fn the_image_alone_gives_a_person_of_the_assumed_size() {
        let mut person = seen(0.0, 0.0, 2.0);
        person.world = None;
        let image = person.image.as_ref().unwrap();
        let points =
            in_space(&[LandmarkPerson { time_ns: 0, image: Some(Image { ..*image }), world: None }], &mut Vec::new());
        let [hip, knee, ankle] = [23, 25, 27].map(|k: usize| points[0][k].position);
        let [right, bend, foot] = [24, 26, 28].map(|k: usize| points[0][k].position);
        let legs = [hip.distance(knee) + knee.distance(ankle), right.distance(bend) + bend.distance(foot)];
        let wanted = ASSUMED_STATURE * LEG_OF_STATURE;
        assert!(legs.iter().any(|l| (l - wanted).abs() < 1e-3), "{legs:?}");
    }
}
