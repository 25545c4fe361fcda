//! The scene of a picture: borrowed surfaces, and the camera that looks at them.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Vec2, Vec3};

use crate::cloth_look::ClothLook;
use crate::fit_map;

/// Linear RGB of the mannequin: a light grey-beige, neutral beside any garment.
pub const MANNEQUIN: Vec3 = Vec3::new(0.60, 0.53, 0.465);

/// Linear RGB where a surface's own colour is missing or not finite.
const NO_COLOUR: Vec3 = Vec3::splat(0.5);

/// Vertical field of view of the preset cameras (rad): a portrait lens, about 85 mm on full frame standing upright.
const PORTRAIT_FOV: f32 = 0.42;

/// Share of the frame's width and height that the preset cameras leave for the subject.
const FILL: Vec2 = Vec2::new(0.86, 0.87);

/// Everything in one picture. World: metres, right-handed, y up, the floor at y = 0.
#[derive(Debug, Clone, Copy)]
pub struct PictureScene<'a> {
    /// Body and garments. Triangles with a missing or non-finite vertex or without area are skipped.
    pub surfaces: &'a [PictureSurface<'a>],
    /// Whether the subject stands on a floor (y = 0) that takes its shadow; otherwise before a plain wall.
    pub floor: bool,
}

/// One triangle mesh, counter-clockwise seen from outside.
#[derive(Debug, Clone, Copy)]
pub struct PictureSurface<'a> {
    /// Vertex positions (m) `[vertices]`.
    pub positions: &'a [Vec3],
    /// Unit vertex normals `[vertices]`; where one is missing or zero the triangle is shaded flat.
    pub normals: &'a [Vec3],
    /// Vertex indices `[triangles]`.
    pub triangles: &'a [[u32; 3]],
    /// Base colours, linear RGB.
    pub colours: Colours<'a>,
    /// How the surface reflects light.
    pub material: Material,
    /// Print, seams and trims of the cloth.
    pub look: Option<ClothLook<'a>>,
}

/// Base colours of a surface, linear RGB, each 0..1.
#[derive(Debug, Clone, Copy)]
pub enum Colours<'a> {
    /// One colour for all vertices.
    One(Vec3),
    /// One a vertex `[vertices]`, blended across triangles.
    PerVertex(&'a [Vec3]),
    /// The fit map's colour of a scalar a vertex, -1 (loose) .. 1 (tight) `[vertices]`. The scalar is blended, not the
    /// colour, so the eight steps keep clean borders on any mesh.
    Tightness(&'a [f32]),
}

impl Colours<'_> {
    /// Colour between three vertices; mid grey where one is missing or not finite.
    pub(crate) fn blend(&self, corners: [u32; 3], weights: [f32; 3]) -> Vec3 {
        let of = |colours: &[Vec3]| -> Vec3 {
            let at = |i: u32| colours.get(i as usize).copied().unwrap_or(Vec3::NAN);
            (0..3).map(|k| at(corners[k]) * weights[k]).sum()
        };
        let colour = match self {
            Self::One(colour) => *colour,
            Self::PerVertex(colours) => of(colours),
            Self::Tightness(values) => {
                let at = |i: u32| values.get(i as usize).copied().unwrap_or(f32::NAN);
                fit_map::colour((0..3).map(|k| at(corners[k]) * weights[k]).sum())
            }
        };
        if colour.is_finite() { colour.clamp(Vec3::ZERO, Vec3::ONE) } else { NO_COLOUR }
    }
}

/// How a surface meets light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Material {
    /// A matte mannequin: diffuse under a soft highlight.
    Skin,
    /// Woven cloth: two-sided, diffuse, with a soft sheen at grazing angles.
    Cloth,
    /// Two-sided, diffuse alone, so that the colours of a map match their legend.
    Diffuse,
}

/// An axis-aligned box (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Least coordinates (m).
    pub min: Vec3,
    /// Greatest coordinates (m).
    pub max: Vec3,
}

impl Bounds {
    /// The box of no points: growing it by one makes it that point.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box of all finite points.
    pub fn of(points: &[Vec3]) -> Self {
        points.iter().filter(|p| p.is_finite()).fold(Self::EMPTY, |b, &p| b.grown(p))
    }

    /// The box with one more point in it.
    pub fn grown(self, p: Vec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The least box around both.
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// True if no point is in it.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    fn corners(self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, lo: f32, hi: f32| if i >> bit & 1 == 0 { lo } else { hi };
            Vec3::new(pick(0, self.min.x, self.max.x), pick(1, self.min.y, self.max.y), pick(2, self.min.z, self.max.z))
        })
    }
}

/// A camera on an orbit around its target. Yaw 0 stands before the subject (who faces +z), yaw 90 degrees on their
/// left (+x).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrbitCamera {
    /// The point in the middle of the picture (m).
    pub target: Vec3,
    /// Turn around the vertical (rad), from +z towards +x.
    pub yaw: f32,
    /// Height of the camera over the target (m).
    pub height: f32,
    /// Horizontal distance of the camera from the target (m).
    pub distance: f32,
    /// Vertical field of view (rad).
    pub fov_y: f32,
}

impl OrbitCamera {
    /// From the front, the box framed in a picture of `aspect` = width / height.
    pub fn front(bounds: &Bounds, aspect: f32) -> Self {
        Self::framing(bounds, 0.0, aspect)
    }

    /// From the subject's left side, at the same distance as [`OrbitCamera::front`].
    pub fn side(bounds: &Bounds, aspect: f32) -> Self {
        Self::framing(bounds, FRAC_PI_2, aspect)
    }

    /// From behind, at the same distance as [`OrbitCamera::front`].
    pub fn back(bounds: &Bounds, aspect: f32) -> Self {
        Self::framing(bounds, PI, aspect)
    }

    /// From any side. The distance does not depend on the yaw, so that views of one subject share one scale: it is
    /// the least at which front, side and back all fit.
    pub fn framing(bounds: &Bounds, yaw: f32, aspect: f32) -> Self {
        let whole = !bounds.is_empty() && bounds.min.is_finite() && bounds.max.is_finite();
        let bounds = if whole { *bounds } else { Bounds { min: Vec3::ZERO, max: Vec3::ONE } };
        let tall = bounds.max.y - bounds.min.y;
        // The camera is a little above the middle, which shows the floor without converging verticals.
        let camera = |yaw: f32, distance: f32| Self {
            target: (bounds.min + bounds.max) * 0.5,
            yaw,
            height: 0.16 * tall,
            distance,
            fov_y: PORTRAIT_FOV,
        };
        let fits = |distance: f32| {
            [0.0, FRAC_PI_2, PI].iter().all(|&yaw| {
                let eye = camera(yaw, distance).view(aspect);
                bounds.corners().iter().all(|&p| eye.sees(p, FILL))
            })
        };
        // Fitting is monotonic in the distance: bisect between far too near and far too far.
        let (mut near, mut far) = (0.0, 40.0 * (bounds.max - bounds.min).length().max(0.01));
        for _ in 0..24 {
            let middle = 0.5 * (near + far);
            if fits(middle) { far = middle } else { near = middle }
        }
        camera(yaw, far)
    }

    /// The camera's frame, ready to make rays.
    pub(crate) fn view(&self, aspect: f32) -> CameraFrame {
        let (sin, cos) = self.yaw.sin_cos();
        let back = Vec3::new(sin, 0.0, cos);
        let origin = self.target + back * self.distance.max(1e-3) + Vec3::Y * self.height;
        let forward = (self.target - origin).normalize_or(-back);
        let right = Vec3::new(cos, 0.0, -sin);
        let half = (0.5 * self.fov_y).tan();
        CameraFrame { origin, forward, right, up: right.cross(forward), half: Vec2::new(half * aspect, half) }
    }
}

/// A camera's frame: its position, its axes, and the half extents of the picture at distance one.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CameraFrame {
    pub origin: Vec3,
    pub forward: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub half: Vec2,
}

impl CameraFrame {
    /// Direction through a point of the picture, both coordinates 0..1 from the upper left.
    pub fn direction(&self, at: Vec2) -> Vec3 {
        let x = (2.0 * at.x - 1.0) * self.half.x;
        let y = (1.0 - 2.0 * at.y) * self.half.y;
        (self.forward + self.right * x + self.up * y).normalize()
    }

    /// Width of the view at the depth of a point (m).
    pub fn width_at(&self, point: Vec3) -> f32 {
        2.0 * self.half.x * (point - self.origin).dot(self.forward).max(0.0)
    }

    /// True if a point falls within the middle `share` of the picture.
    fn sees(&self, point: Vec3, share: Vec2) -> bool {
        let to = point - self.origin;
        let depth = to.dot(self.forward);
        let limit = self.half * share * depth;
        depth > 0.0 && to.dot(self.right).abs() <= limit.x && to.dot(self.up).abs() <= limit.y
    }
}
