//! Reading a body as a tape, a calliper and a rod would, and how each reading changes with the surface.
//!
//! A girth is the perimeter of the convex hull of a plane's slice. Its gradient follows the slice: a hull's corner `h`
//! lies on an edge from `a` to `b` at the plane through `o` with normal `n`; the perimeter changes with `h` by the sum
//! `g` of the unit vectors from its two neighbours, and `h` moves with `a`, `b` and `o` so that it stays on both.

use glam::{Vec2, Vec3};

use super::base::BaseBody;
use super::landmarks::{Landmark, Mark};
use super::people::Allowance;
use super::reading::{MeshMeasure, READINGS};
use super::tape::{hull_corners, perimeter_f64};
use toile_base::body::Region;
use toile_base::skeleton::Joint;

/// How far from its plane on the base body an edge may lie and still be cut on a calibrated one (m).
const MARGIN: f32 = 0.06;

/// How one reading changes with the vertices: pairs of a vertex and the gradient there.
pub(super) type Gradient = Vec<(u32, Vec3)>;

/// A plane that rides on a landmark, and the edges that it may cut.
struct SliceCut {
    normal: Vec3,
    /// Directions within the plane that count as x and y there.
    axes: [Vec3; 2],
    at: Mark,
    edges: Vec<[u32; 2]>,
}

/// A point of a slice: on the edge from one vertex to another.
#[derive(Clone, Copy)]
struct SliceCorner {
    ends: [u32; 2],
    share: f32,
    place: Vec2,
}

/// Everything that reading a sex's bodies takes, worked out once.
pub(super) struct Gauge {
    /// Vertices whose places the readings depend on, rising.
    pub needed: Vec<u32>,
    marks: [Mark; super::landmarks::LANDMARKS],
    cuts: Vec<SliceCut>,
    back: Vec<u32>,
    allowance: Allowance,
}

/// The slices, in the order of [`Gauge::cuts`].
const CUTS: [(Landmark, MeshMeasure); 11] = [
    (Landmark::Infrathyroid, MeshMeasure::NeckGirth),
    (Landmark::NeckFront, MeshMeasure::NeckBaseGirth),
    (Landmark::BustPoint, MeshMeasure::ChestGirth),
    (Landmark::Underbust, MeshMeasure::UnderbustGirth),
    (Landmark::NaturalWaist, MeshMeasure::WaistGirth),
    (Landmark::Omphalion, MeshMeasure::OmphalionGirth),
    (Landmark::Buttock, MeshMeasure::HipGirth),
    (Landmark::Thigh, MeshMeasure::ThighGirth),
    (Landmark::Calf, MeshMeasure::CalfGirth),
    (Landmark::Biceps, MeshMeasure::UpperArmGirth),
    (Landmark::Stylion, MeshMeasure::WristGirth),
];

impl Gauge {
    pub(super) fn new(base: &BaseBody, allowance: Allowance) -> Self {
        let cuts: Vec<SliceCut> = CUTS.iter().map(|(landmark, _)| SliceCut::new(base, *landmark)).collect();
        let height = |l: Landmark| base.landmarks.mark(l).on(&base.positions).y;
        let (low, high) = (height(Landmark::Omphalion) - MARGIN, height(Landmark::Cervicale) + MARGIN);
        let behind = |p: &Vec3| p.x == 0.0 && p.z < 0.0 && p.y > low && p.y < high;
        let back = (0..base.positions.len() as u32).filter(|&v| behind(&base.positions[v as usize])).collect();
        let mut gauge = Self { needed: Vec::new(), marks: base.landmarks.marks, cuts, back, allowance };
        gauge.needed = gauge.back.clone();
        gauge.needed.extend(gauge.marks.iter().flat_map(|m| m.ends));
        gauge.needed.extend(gauge.cuts.iter().flat_map(|c| c.edges.iter().flatten()));
        gauge.needed.sort_unstable();
        gauge.needed.dedup();
        gauge
    }

    /// All readings of a surface (m), and their gradients when they are asked for.
    pub(super) fn read(&self, positions: &[Vec3], mut gradients: Option<&mut [Gradient; READINGS]>) -> [f32; READINGS] {
        let mut read = [0.0; READINGS];
        let mut set = |reading: MeshMeasure, value: f32, gradient: Gradient| {
            read[reading.index()] = value;
            if let Some(all) = &mut gradients {
                all[reading.index()] = gradient;
            }
        };
        for (reading, landmark) in HEIGHTS {
            let mark = self.mark(landmark);
            set(reading, mark.on(positions).y, spread(mark, Vec3::Y));
        }
        for (cut, (_, girth)) in self.cuts.iter().zip(CUTS) {
            let corners = cut.corners(positions);
            let (value, gradient) = cut.girth(positions, &corners);
            set(girth, value, gradient);
            for (extent, axis) in EXTENTS.iter().filter(|e| e.0 == girth).flat_map(|e| [(e.1, 0), (e.2, 1)]) {
                let (value, gradient) = cut.extent(positions, &corners, axis);
                set(extent, value, gradient);
            }
        }
        self.lengths(positions, &mut set);
        read
    }

    fn mark(&self, landmark: Landmark) -> Mark {
        self.marks[landmark.index()]
    }

    /// Breadth of the shoulders, and the lengths of arm and back.
    fn lengths(&self, positions: &[Vec3], set: &mut impl FnMut(MeshMeasure, f32, Gradient)) {
        let tip = self.mark(Landmark::Acromion);
        let half = tip.on(positions).x;
        set(MeshMeasure::ShoulderBreadth, 2.0 * half, spread(tip, 2.0 * Vec3::X));
        let chain = [Landmark::Acromion, Landmark::Olecranon, Landmark::Stylion].map(|l| self.mark(l));
        let [shoulder, elbow, wrist] = chain.map(|m| m.on(positions));
        let (upper, fore) = (elbow - shoulder, wrist - elbow);
        let arm = upper.length() + fore.length();
        let (u, f) = (upper.normalize_or_zero(), fore.normalize_or_zero());
        let pull = [-u, u - f, f];
        let along: Gradient = chain.iter().zip(pull).flat_map(|(&m, g)| spread(m, g)).collect();
        set(MeshMeasure::ArmLength, arm + self.allowance.arm, along.clone());
        let sleeve = [along, spread(tip, Vec3::X)].concat();
        set(MeshMeasure::SleeveLength, half + arm + self.allowance.sleeve, sleeve);
        for (reading, landmark) in
            [(MeshMeasure::BackLength, Landmark::NaturalWaist), (MeshMeasure::WaistBackLength, Landmark::Omphalion)]
        {
            let (value, gradient) = self.back_to(positions, landmark);
            set(reading, value, gradient);
        }
    }

    /// A tape from the 7th cervical vertebra down the spine to the height of a landmark, across the hollows.
    fn back_to(&self, positions: &[Vec3], landmark: Landmark) -> (f32, Gradient) {
        let level = self.mark(landmark).on(positions).y;
        let top = self.mark(Landmark::Cervicale);
        let start = top.on(positions);
        let side = |p: Vec3| Vec2::new(p.z, p.y);
        let mut points: Vec<(Vec2, Option<u32>)> = vec![(side(start), None)];
        let (mut below, mut above) = ((f32::MIN, 0), (f32::MAX, 0));
        for &v in &self.back {
            let p = positions[v as usize];
            if p.y > level && p.y < above.0 {
                above = (p.y, v);
            } else if p.y <= level && p.y > below.0 {
                below = (p.y, v);
            }
        }
        let ends = [below.1, above.1];
        let share = (level - below.0) / (above.0 - below.0).max(f32::MIN_POSITIVE);
        let [low, high] = ends.map(|v| positions[v as usize]);
        let end = side(low.lerp(high, share));
        let chord = (end - side(start)) / (end.y - start.y);
        for &v in &self.back {
            let p = side(positions[v as usize]);
            // The tape lies on what stands out behind the straight line.
            if p.y > level && p.y < start.y && p.x < start.z + chord.x * (p.y - start.y) {
                points.push((p, Some(v)));
            }
        }
        points.push((end, None));
        let flat: Vec<Vec2> = points.iter().map(|p| p.0).collect();
        // The tape is the hull without the chord from its lower end to its upper: all else lies behind that chord.
        let corners = hull_corners(&flat);
        let chord = flat[0].distance(flat[flat.len() - 1]);
        let mut gradient = Vec::new();
        let n = corners.len();
        for (k, &i) in corners.iter().enumerate() {
            let mut pull = Vec2::ZERO;
            for j in [corners[(k + n - 1) % n], corners[(k + 1) % n]] {
                let is_chord = (i == 0 && j == flat.len() - 1) || (j == 0 && i == flat.len() - 1);
                if !is_chord {
                    pull += (flat[i] - flat[j]).normalize_or_zero();
                }
            }
            let pull = Vec3::new(0.0, pull.y, pull.x);
            match points[i].1 {
                Some(v) => gradient.push((v, pull)),
                None if i == 0 => gradient.extend(spread(top, pull)),
                None => ride(positions, (ends, share), (Vec3::Y, self.mark(landmark)), pull, &mut gradient),
            }
        }
        ((perimeter_f64(&corners.iter().map(|&i| flat[i]).collect::<Vec<_>>()) - f64::from(chord)) as f32, gradient)
    }
}

/// Heights above the floor.
const HEIGHTS: [(MeshMeasure, Landmark); 5] = [
    (MeshMeasure::Stature, Landmark::Crown),
    (MeshMeasure::CervicaleHeight, Landmark::Cervicale),
    (MeshMeasure::OmphalionHeight, Landmark::Omphalion),
    (MeshMeasure::CrotchHeight, Landmark::Crotch),
    (MeshMeasure::KneeHeight, Landmark::Midpatella),
];

/// Breadth and depth that are read in a girth's slice.
const EXTENTS: [(MeshMeasure, MeshMeasure, MeshMeasure); 3] = [
    (MeshMeasure::ChestGirth, MeshMeasure::ChestBreadth, MeshMeasure::ChestDepth),
    (MeshMeasure::OmphalionGirth, MeshMeasure::OmphalionBreadth, MeshMeasure::OmphalionDepth),
    (MeshMeasure::HipGirth, MeshMeasure::HipBreadth, MeshMeasure::HipDepth),
];

/// A gradient at a mark, shared between the ends of its edge.
fn spread(mark: Mark, gradient: Vec3) -> Gradient {
    let [a, b] = mark.ends;
    if a == b {
        return vec![(a, gradient)];
    }
    vec![(a, gradient * (1.0 - mark.share)), (b, gradient * mark.share)]
}

/// The plane in which a girth is taken: its normal, upwards or down the limb.
fn normal(base: &BaseBody, landmark: Landmark) -> Vec3 {
    let at = |l: Landmark| base.landmarks.mark(l).on(&base.positions);
    let bone = |from: Joint, to: Joint| (base.skeleton.at(to) - base.skeleton.at(from)).normalize();
    match landmark {
        // Square to the neck, whose axis runs from its root to the head's joint.
        Landmark::Infrathyroid => neck_axis(base),
        Landmark::NeckFront => Vec3::X.cross(at(Landmark::NeckFront) - at(Landmark::Cervicale)).normalize() * -1.0,
        Landmark::Biceps => bone(Joint::LeftShoulder, Joint::LeftElbow),
        Landmark::Stylion => bone(Joint::LeftElbow, Joint::LeftWrist),
        _ => Vec3::Y,
    }
}

/// Direction of the neck: it leans forwards.
pub(super) fn neck_axis(base: &BaseBody) -> Vec3 {
    let (neck, head) = (base.skeleton.at(Joint::Neck), base.skeleton.at(Joint::Head));
    Vec3::new(0.0, head.y - neck.y, head.z - neck.z).normalize()
}

impl SliceCut {
    fn new(base: &BaseBody, landmark: Landmark) -> Self {
        let normal = normal(base, landmark);
        let at = base.landmarks.mark(landmark);
        let origin = at.on(&base.positions);
        let right = if normal.y.abs() > 0.7 { Vec3::X } else { Vec3::Z };
        let right = (right - normal * right.dot(normal)).normalize();
        let height = |v: u32| (base.positions[v as usize] - origin).dot(normal);
        let goes = |v: u32| passes(base, landmark, v, origin);
        let mut edges = Vec::new();
        for t in &base.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let near = height(a).min(height(b)) < MARGIN && height(a).max(height(b)) > -MARGIN;
                if a < b && near && goes(a) && goes(b) {
                    edges.push([a, b]);
                }
            }
        }
        Self { normal, axes: [right, normal.cross(right)], at, edges }
    }

    /// Where the plane cuts the surface; a vertex on the plane counts as above it.
    fn corners(&self, positions: &[Vec3]) -> Vec<SliceCorner> {
        let level = self.at.on(positions).dot(self.normal);
        let mut corners = Vec::with_capacity(self.edges.len() / 4);
        for &ends in &self.edges {
            let [a, b] = ends.map(|v| positions[v as usize]);
            let (low, high) = (a.dot(self.normal) - level, b.dot(self.normal) - level);
            if (low >= 0.0) != (high >= 0.0) {
                let share = low / (low - high);
                let p = a.lerp(b, share);
                corners.push(SliceCorner { ends, share, place: Vec2::new(p.dot(self.axes[0]), p.dot(self.axes[1])) });
            }
        }
        corners
    }

    fn girth(&self, positions: &[Vec3], corners: &[SliceCorner]) -> (f32, Gradient) {
        let flat: Vec<Vec2> = corners.iter().map(|c| c.place).collect();
        let hull = hull_corners(&flat);
        let n = hull.len();
        let mut gradient = Vec::with_capacity(4 * n);
        for k in 0..n {
            let (before, here, after) = (flat[hull[(k + n - 1) % n]], flat[hull[k]], flat[hull[(k + 1) % n]]);
            let pull = (here - before).normalize_or_zero() + (here - after).normalize_or_zero();
            self.pull(positions, &corners[hull[k]], pull, &mut gradient);
        }
        (perimeter_f64(&hull.iter().map(|&i| flat[i]).collect::<Vec<_>>()) as f32, gradient)
    }

    /// How wide the slice is along one of its axes.
    fn extent(&self, positions: &[Vec3], corners: &[SliceCorner], axis: usize) -> (f32, Gradient) {
        let by = |a: &&SliceCorner, b: &&SliceCorner| a.place[axis].total_cmp(&b.place[axis]);
        let (Some(least), Some(most)) = (corners.iter().min_by(by), corners.iter().max_by(by)) else {
            return (0.0, Vec::new());
        };
        let mut gradient = Vec::with_capacity(8);
        self.pull(positions, most, Vec2::AXES[axis], &mut gradient);
        self.pull(positions, least, -Vec2::AXES[axis], &mut gradient);
        (most.place[axis] - least.place[axis], gradient)
    }

    /// Adds what a pull on a slice's point does to the edge under it and to the plane's landmark.
    fn pull(&self, positions: &[Vec3], corner: &SliceCorner, pull: Vec2, to: &mut Gradient) {
        let g = self.axes[0] * pull.x + self.axes[1] * pull.y;
        ride(positions, (corner.ends, corner.share), (self.normal, self.at), g, to);
    }
}

/// Adds the gradient of a point that lies on an edge, at a share of it, and in a plane with a normal and a landmark.
fn ride(positions: &[Vec3], (ends, share): ([u32; 2], f32), (normal, at): (Vec3, Mark), pull: Vec3, to: &mut Gradient) {
    let [a, b] = ends.map(|v| positions[v as usize]);
    let slope = pull.dot(b - a) / normal.dot(b - a);
    let on_edge = pull - slope * normal;
    to.push((ends[0], on_edge * (1.0 - share)));
    to.push((ends[1], on_edge * share));
    to.extend(spread(at, slope * normal));
}

/// Whether a vertex belongs to what the tape goes round.
fn passes(base: &BaseBody, landmark: Landmark, vertex: u32, origin: Vec3) -> bool {
    let (p, region) = (base.positions[vertex as usize], base.regions[vertex as usize]);
    let arm = matches!(region, Region::LeftArm | Region::RightArm);
    match landmark {
        Landmark::Biceps | Landmark::Stylion => region == Region::LeftArm && p.distance(origin) < 0.2,
        Landmark::Thigh | Landmark::Calf => !arm && p.x >= 0.0,
        Landmark::Infrathyroid | Landmark::NeckFront => !arm && p.x.abs() < 0.16,
        _ => !arm,
    }
}
