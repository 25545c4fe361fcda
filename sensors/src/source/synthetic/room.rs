//! A fitting room with people in it, as a depth camera sees it, and who is seen at each pixel: the truth that finding the
//! shopper is held to.

use glam::Vec3;

use super::SyntheticCamera;

/// Label of a pixel that shows nothing, or the room. The `i`th person is `PERSON + i`.
pub const NOTHING: u8 = 0;
/// Label of floor and walls.
pub const ROOM: u8 = 1;
/// Label of the first person.
pub const PERSON: u8 = 2;

/// Half of the room's breadth and the distance of its front from the middle (m).
const HALF: f32 = 3.0;

/// Height of its walls (m).
const WALL: f32 = 2.6;

/// A surface: positions (world, m) and triangles.
pub type RoomSurface<'a> = (&'a [Vec3], &'a [[u32; 3]]);

/// A camera's view without noise.
#[derive(Debug, Clone, PartialEq)]
pub struct RoomView {
    /// Depth along the camera's z (m), infinite where nothing is seen `[width * height]`.
    pub z: Vec<f32>,
    /// Label of each pixel `[width * height]`.
    pub label: Vec<u8>,
}

/// Looks at people in a room with a floor at y = 0 and a back wall at `back` (z, m).
pub fn view(camera: &SyntheticCamera, back: f32, people: &[RoomSurface<'_>]) -> RoomView {
    let pixels = camera.intrinsics.pixels();
    let mut view = RoomView { z: vec![f32::INFINITY; pixels], label: vec![NOTHING; pixels] };
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x * HALF, y, z);
    let room = [
        corner(-1.0, 0.0, HALF),
        corner(1.0, 0.0, HALF),
        corner(1.0, 0.0, back),
        corner(-1.0, 0.0, back),
        corner(-1.0, WALL, back),
        corner(1.0, WALL, back),
    ];
    let walls = [[0, 1, 2], [0, 2, 3], [3, 2, 5], [3, 5, 4]];
    let mut z = vec![0.0; pixels];
    let surfaces = std::iter::once((ROOM, (&room[..], &walls[..])));
    for (label, (positions, triangles)) in surfaces.chain((PERSON..).zip(people.iter().copied())) {
        camera.render(positions, triangles, &mut z);
        for ((z, nearest), of) in z.iter().zip(&mut view.z).zip(&mut view.label) {
            if z < nearest {
                (*nearest, *of) = (*z, label);
            }
        }
    }
    view
}
