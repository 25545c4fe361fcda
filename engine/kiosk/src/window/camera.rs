//! The camera: frames the body in the part of the display that the panel leaves free.

use glam::Vec3;
use toile_base::numeric::statistics;
use toile_view::scene::{Bounds, OrbitCamera};

/// Arm's reach beside the body (m): it stays in the picture when the shopper lifts their arms.
const HALF_REACH_M: f32 = 0.5;

/// Half of the width of a body with its arms at rest (statures), where there is no room for more.
const HALF_REST: f32 = 0.185;

/// Narrower than this, width over height, there is none.
const NARROW: f32 = 0.6;

/// How much nearer the camera comes there than a portrait is taken from.
const NEARER: f32 = 0.83;

/// Height that is shown over a body, in statures.
const HEADROOM: f32 = 1.03;

/// The box around a standing body of this stature at a place on the floor, with the reach of its arms.
pub fn standing_bounds(stature: f32, at: Vec3) -> Bounds {
    bounds(stature, at, HALF_REACH_M)
}

fn bounds(stature: f32, at: Vec3, half: f32) -> Bounds {
    let reach = Vec3::new(half, 0.0, half * 0.5);
    Bounds { min: at - reach, max: at + reach + Vec3::Y * stature * HEADROOM }
}

/// A camera that frames a standing body of this stature at a place on the floor, turned by `yaw` (rad), within a part of the
/// display: left, top, right, bottom as shares of it; `aspect` is the display's width over its height.
pub fn camera(stature: f32, at: Vec3, yaw: f32, free: [f32; 4], aspect: f32) -> OrbitCamera {
    let [left, top, right, bottom] = free;
    let (wide, tall) = ((right - left).clamp(0.05, 1.0), (bottom - top).clamp(0.05, 1.0));
    let free_aspect = aspect * wide / tall;
    let is_narrow = free_aspect < NARROW;
    let bounds = if is_narrow { bounds(stature, at, HALF_REST * stature) } else { standing_bounds(stature, at) };
    // As if the free part were the whole picture ...
    let near = OrbitCamera::framing(&bounds, yaw, free_aspect);
    // ... of which the display shows more, all around.
    let distance = near.distance / tall * if is_narrow { NEARER } else { 1.0 };
    let seen = 2.0 * distance * (0.5 * near.fov_y).tan();
    let (sin, cos) = yaw.sin_cos();
    let right_hand = Vec3::new(cos, 0.0, -sin);
    let aside = (0.5 - 0.5 * (left + right)) * seen * aspect;
    let above = (0.5 - 0.5 * (top + bottom)) * seen;
    let target = near.target + right_hand * aside - Vec3::Y * above;
    // The camera stays at its height and looks down a little: from the height of the target it would see along the floor.
    OrbitCamera { target, distance, height: near.height + above, ..near }
}

/// Where a body stands on the floor: the median of its vertices, which an arm that is held out does not move as it does their mean or their box. `sorted`
/// is a buffer that is used again.
pub fn middle(positions: &[Vec3], sorted: &mut Vec<f32>) -> Option<Vec3> {
    let mut median = |axis: usize| {
        sorted.clear();
        sorted.extend(positions.iter().map(|p| p[axis]).filter(|value| value.is_finite()));
        statistics::median(sorted)
    };
    Some(Vec3::new(median(0)?, 0.0, median(2)?))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use glam::Vec2;

    #[test]
    fn an_arm_that_is_held_out_moves_the_middle_by_less_than_a_hand() {
        // A trunk and legs about an axis, and an arm of a sixth of the vertices.
        let body = (0..1_000).map(|i| {
            let turn = i as f32 * 2.4;
            Vec3::new(0.3 + 0.15 * turn.cos(), i as f32 * 1.7e-3, 1.0 + 0.1 * turn.sin())
        });
        let arm = (0..200).map(|i| Vec3::new(0.45 + i as f32 * 3e-3, 1.4, 1.0));
        let (body, mut sorted): (Vec<Vec3>, _) = (body.chain(arm).collect(), Vec::new());
        let at = middle(&body, &mut sorted).unwrap();
        assert!((at - Vec3::new(0.3, 0.0, 1.0)).length() < 0.06, "{at}");
        let broken: Vec<Vec3> = body.iter().map(|p| if p.y > 1.0 { Vec3::NAN } else { *p }).collect();
        assert!(middle(&broken, &mut sorted).unwrap().is_finite());
        assert_eq!(middle(&[], &mut sorted), None);
    }

    /// Where a point is seen, as shares of the display from its upper left corner.
    fn seen(camera: &OrbitCamera, aspect: f32, point: Vec3) -> Vec2 {
        let (sin, cos) = camera.yaw.sin_cos();
        let eye = camera.target + Vec3::new(sin, 0.0, cos) * camera.distance + Vec3::Y * camera.height;
        let forward = (camera.target - eye).normalize();
        let right = Vec3::new(cos, 0.0, -sin);
        let up = right.cross(forward);
        let to = point - eye;
        let half = (0.5 * camera.fov_y).tan() * to.dot(forward);
        Vec2::new(0.5 + 0.5 * to.dot(right) / (half * aspect), 0.5 - 0.5 * to.dot(up) / half)
    }

    /// Share of the display's height that a body takes, the least of many bodies and sides.
    pub fn least_share(free: [f32; 4], aspect: f32) -> f32 {
        let share = |stature: f32, yaw: f32| {
            let camera = camera(stature, Vec3::ZERO, yaw, free, aspect);
            seen(&camera, aspect, Vec3::ZERO).y - seen(&camera, aspect, Vec3::Y * stature).y
        };
        let all =
            [1.5, 1.75, 1.95].into_iter().flat_map(|stature| [0.0, 0.8, 3.1, -1.6].map(|yaw| share(stature, yaw)));
        all.fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn the_body_stands_whole_in_what_the_panel_leaves_free_from_every_side() {
        for (free, aspect) in [
            ([0.0, 0.0, 1.0, 0.4], 9.0 / 16.0),
            ([0.0, 0.0, 1.0, 0.6], 9.0 / 16.0),
            ([0.0, 0.0, 0.58, 1.0], 16.0 / 9.0),
            ([0.0, 0.0, 0.51, 1.0], 9.0 / 16.0),
            ([0.0, 0.0, 1.0, 0.64], 4.5 / 16.0),
            ([0.0, 0.0, 1.0, 0.85], 4.5 / 16.0),
            ([0.0, 0.0, 1.0, 1.0], 1.0),
        ] {
            for stature in [1.5, 1.95] {
                for yaw in [0.0, 0.8, 3.1, -1.6] {
                    let at = Vec3::new(0.3, 0.0, 1.2);
                    let camera = camera(stature, at, yaw, free, aspect);
                    let (head, feet) = (at + Vec3::Y * stature, at);
                    for point in [head, feet] {
                        let p = seen(&camera, aspect, point);
                        assert!(
                            p.x > free[0] && p.x < free[2] && p.y > free[1] && p.y < free[3],
                            "{free:?} {yaw}: {p}"
                        );
                    }
                    let tall = seen(&camera, aspect, feet).y - seen(&camera, aspect, head).y;
                    assert!(tall > 0.5 * (free[3] - free[1]), "{free:?}: it fills only {tall}");
                    let eye = camera.target.y + camera.height;
                    assert!(eye > 0.5 * stature, "the eye at {eye} sees along the floor");
                }
            }
        }
    }
}
