//! Head and hair on a skin as it was posed.

use glam::{Mat3, Vec3};
use toile_base::body::Body;
use toile_base::skeleton::Joint;

/// A head in the place of the drawn one, and what it wears: both follow the head's bone.
///
/// A posed skin does not say how its bones stand, and need not: three vertices that the head's bone alone carries do.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlacedHead {
    /// Those three vertices; none where the body keeps its own head.
    anchors: Option<[u32; 3]>,
    /// The first of them (m) and their frame, at rest.
    origin: Vec3,
    frame: Mat3,
    /// Vertices of the body that are drawn elsewhere, how far off (m), and the change of their normals.
    moved: Vec<(u32, Vec3, Vec3)>,
    /// Vertices of the body, after which the hair's come.
    body: usize,
    /// The hair at rest: places (m) and unit normals.
    hair: Vec<(Vec3, Vec3)>,
}

impl PlacedHead {
    /// Of a body that is drawn at rest with these places (m) and normals, the hair's after its own.
    pub(super) fn new(body: &Body, rest: &[Vec3], normals: &[Vec3]) -> Self {
        let Some(anchors) = anchors(body) else { return Self::default() };
        let drawn = body.mesh.positions.iter().zip(&body.normals);
        let changes = (0..).zip(drawn.zip(rest.iter().zip(normals)));
        let moved = changes.map(|(v, ((p, n), (at, normal)))| (v, *at - *p, *normal - *n));
        let [a, b, c] = anchors.map(|v| body.mesh.positions[v as usize]);
        let vertices = body.mesh.positions.len();
        Self {
            anchors: Some(anchors),
            origin: a,
            frame: frame(a, b, c),
            moved: moved.filter(|(_, way, tilt)| *way != Vec3::ZERO || *tilt != Vec3::ZERO).collect(),
            body: vertices,
            hair: rest.iter().copied().zip(normals.iter().copied()).skip(vertices).collect(),
        }
    }

    /// Vertices of the hair, which come after the body's.
    pub fn hair(&self) -> usize {
        self.hair.len()
    }

    /// Brings head and hair to where the body's head is: its vertices hold its posed skin (m, unit normals).
    pub fn place(&self, positions: &mut [Vec3], normals: &mut [Vec3]) {
        let Some(anchors) = self.anchors else { return };
        if positions.len().min(normals.len()) < self.body + self.hair.len() {
            return;
        }
        let [a, b, c] = anchors.map(|v| positions[v as usize]);
        let turn = frame(a, b, c) * self.frame.transpose();
        for (v, way, tilt) in &self.moved {
            let (p, n) = (&mut positions[*v as usize], &mut normals[*v as usize]);
            *p += turn * *way;
            *n = (*n + turn * *tilt).normalize_or(*n);
        }
        let drawn = positions[self.body..].iter_mut().zip(&mut normals[self.body..]);
        for ((rest, normal), (p, n)) in self.hair.iter().zip(drawn) {
            (*p, *n) = (a + turn * (*rest - self.origin), turn * *normal);
        }
    }
}

/// Axes that three points carry along.
fn frame(a: Vec3, b: Vec3, c: Vec3) -> Mat3 {
    let along = (b - a).normalize_or(Vec3::X);
    let out = along.cross(c - a).normalize_or(Vec3::Z);
    Mat3::from_cols(along, out.cross(along), out)
}

/// The highest, the leftmost and the foremost vertex that the head's bone alone carries.
fn anchors(body: &Body) -> Option<[u32; 3]> {
    let head = Joint::Head.index() as u8;
    let carried = |v: &u32| body.weights[*v as usize].iter().all(|(bone, _)| bone == head);
    let alone: Vec<u32> = (0..body.mesh.positions.len() as u32).filter(carried).collect();
    let most = |axis: fn(Vec3) -> f32| {
        let of = |v: &u32| axis(body.mesh.positions[*v as usize]);
        alone.iter().copied().max_by(|a, b| of(a).total_cmp(&of(b)))
    };
    Some([most(|p| p.y)?, most(|p| p.x)?, most(|p| p.z)?])
}
