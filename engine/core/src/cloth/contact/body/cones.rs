//! The capsules in the layout of the kernels: one row a quantity, one place a capsule, prepared once a substep.

use glam::Vec4;
use toile_base::limits::MAX_CAPSULES;

use crate::colliders::Colliders;
use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, TABLE, V3, WriteColumn};

/// Places of a row: [`MAX_CAPSULES`] padded to the widest lanes.
pub const PLACES: usize = TABLE;

const _: () = assert!(MAX_CAPSULES <= PLACES, "a bit of a u32 names a capsule");

/// Farther than this from the origin (m), or larger, a sphere is an error and its capsules are ignored.
const FARTHEST_M: f32 = 1e4;

/// A capsule's end that moves farther in one step (m), 60 m/s, has been put elsewhere: nothing is swept along its way.
const TELEPORT_M: f32 = 0.5;

/// A capsule's place in the rows, which is below [`PLACES`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CapsuleIndex(u8);

const _: () = assert!(PLACES == u32::BITS as usize, "any bit of a u32 is a place");

impl CapsuleIndex {
    /// The capsule of the lowest bit that is set; none where none is.
    #[inline(always)]
    pub fn lowest(bits: u32) -> Option<Self> {
        (bits != 0).then(|| Self(bits.trailing_zeros() as u8))
    }

    /// Index of the capsule's row, below [`PLACES`].
    #[inline(always)]
    pub fn place(self) -> usize {
        debug_assert!(usize::from(self.0) < PLACES);
        // The mask changes nothing: it spares the check of every row.
        usize::from(self.0) & (PLACES - 1)
    }
}

/// One number a capsule.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct CapsuleRow(pub [f32; PLACES]);

impl CapsuleRow {
    const ZERO: Self = Self([0.0; PLACES]);

    /// One capsule's number in every lane.
    #[inline(always)]
    pub fn splat<L: Lanes>(&self, capsule: CapsuleIndex) -> L {
        L::splat(self.0[capsule.place()])
    }
}

/// The capsule of each lane.
pub trait PickCapsule<L>: Copy {
    /// Its number of a row.
    fn number(self, row: &CapsuleRow) -> L;

    /// Its vector.
    #[inline(always)]
    fn vector(self, rows: &[CapsuleRow; 3]) -> V3<L> {
        V3 { x: self.number(&rows[0]), y: self.number(&rows[1]), z: self.number(&rows[2]) }
    }
}

/// The same in all lanes.
impl<L: Lanes> PickCapsule<L> for CapsuleIndex {
    #[inline(always)]
    fn number(self, row: &CapsuleRow) -> L {
        row.splat(self)
    }
}

/// One a lane, by their places.
impl<L: Lanes> PickCapsule<L> for &[u32; MOST] {
    #[inline(always)]
    fn number(self, row: &CapsuleRow) -> L {
        L::among(&row.0, self)
    }
}

/// One capsule's vector in every lane.
#[inline(always)]
pub fn splat3<L: Lanes>(rows: &[CapsuleRow; 3], capsule: CapsuleIndex) -> V3<L> {
    V3 { x: rows[0].splat(capsule), y: rows[1].splat(capsule), z: rows[2].splat(capsule) }
}

/// A sphere a capsule: centre and radius.
#[derive(Debug, Clone)]
pub struct EndSpheres {
    /// Centre (m).
    pub centre: [CapsuleRow; 3],
    /// Radius (m).
    pub radius: CapsuleRow,
}

impl EndSpheres {
    const ZERO: Self = Self { centre: [CapsuleRow::ZERO; 3], radius: CapsuleRow::ZERO };

    fn set(&mut self, capsule: usize, sphere: Vec4) {
        for (row, v) in self.centre.iter_mut().zip(sphere.to_array()) {
            row.0[capsule] = v;
        }
        self.radius.0[capsule] = sphere.w;
    }
}

/// Both ends of every capsule at the start of the step, and what they add to that until its end.
#[derive(Debug, Clone)]
pub struct CapsuleEnds {
    /// First and second sphere at the start of the step.
    pub start: [EndSpheres; 2],
    /// How far each moves and grows in the step.
    pub travel: [EndSpheres; 2],
    /// A bit for each capsule that is to be believed.
    pub sound: u32,
}

impl CapsuleEnds {
    /// No capsule: the state before the first [`Self::read`].
    pub const NONE: Self = Self { start: [EndSpheres::ZERO; 2], travel: [const { EndSpheres::ZERO }; 2], sound: 0 };

    /// Reads the colliders of this step. A capsule that is not finite at the end of the step is ignored; one that was
    /// not at its start, or has jumped since, stands at its end all the while.
    pub fn read(&mut self, colliders: &Colliders) {
        self.sound = 0;
        for (c, ends) in colliders.capsules().iter().enumerate().take(MAX_CAPSULES) {
            let start = ends.map(|s| colliders.start()[usize::from(s)]);
            let end = ends.map(|s| colliders.end()[usize::from(s)]);
            if !end.iter().all(|s| sound(*s)) {
                continue;
            }
            let swept = (0..2).all(|i| sound(start[i]) && (end[i] - start[i]).truncate().length() < TELEPORT_M);
            for i in 0..2 {
                let from = if swept { start[i] } else { end[i] };
                self.start[i].set(c, from);
                self.travel[i].set(c, end[i] - from);
            }
            self.sound |= 1 << c;
        }
    }
}

fn sound(sphere: Vec4) -> bool {
    sphere.is_finite() && sphere.abs().max_element() < FARTHEST_M && sphere.w >= 0.0
}

/// The capsules at one moment as the distance wants them (see [`RoundCone`](crate::cone::RoundCone) for the geometry).
/// One sphere inside of the other leaves a sphere: an axis without length.
#[derive(Debug, Clone)]
pub struct CapsuleCones {
    /// First centre (m).
    pub a: [CapsuleRow; 3],
    /// Unit vector along the axis.
    pub axis: [CapsuleRow; 3],
    /// Unit vector across it: the way out for a particle on the axis.
    pub across: [CapsuleRow; 3],
    /// Length of the axis (m).
    pub length: CapsuleRow,
    /// Its inverse (1/m), 0 for a sphere.
    pub shortness: CapsuleRow,
    /// Radius at the first centre and contact offset (m).
    pub reach: CapsuleRow,
    /// Radius gained (m) a metre of the axis: minus the sine of the side's slope.
    pub taper: CapsuleRow,
    /// Tangent of the side's slope.
    pub tangent: CapsuleRow,
    /// 1 / cosine^2 of it.
    pub stretch: CapsuleRow,
    /// sine / cosine^2.
    pub lean: CapsuleRow,
    /// How far the first centre moves in the substep (m).
    pub carried: [CapsuleRow; 3],
    /// How much farther the second moves (m).
    pub turned: [CapsuleRow; 3],
    /// A particle that moves farther in a substep than the root of this (m2) may have to be swept; below 0: any.
    pub quick2: CapsuleRow,
}

impl CapsuleCones {
    /// No capsule: the state before the first step.
    pub const NONE: Self = {
        const THREE: [CapsuleRow; 3] = [CapsuleRow::ZERO; 3];
        const ZERO: CapsuleRow = CapsuleRow::ZERO;
        Self {
            a: THREE,
            axis: THREE,
            across: THREE,
            length: ZERO,
            shortness: ZERO,
            reach: ZERO,
            taper: ZERO,
            tangent: ZERO,
            stretch: ZERO,
            lean: ZERO,
            carried: THREE,
            turned: THREE,
            quick2: ZERO,
        }
    };
}

/// Makes the capsules ready.
pub struct PrepareCones<'a> {
    /// End spheres of the capsules over the step.
    pub ends: &'a CapsuleEnds,
    /// Part of the step at which they are wanted, 0..1.
    pub at: f32,
    /// Part of the step that the substep lasts, 0..1.
    pub share: f32,
    /// Radii grow by so much of the travel in the step: 0.5 covers the whole step from its middle.
    pub swell: f32,
    /// Contact offset (m).
    pub offset: f32,
    /// How much of the smallest radius something may travel and still be believed where it ended.
    pub quick: f32,
    /// Where they go.
    pub to: &'a mut CapsuleCones,
}

impl Kernel for PrepareCones<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let mut at = 0;
        while at < PLACES {
            self.some::<L>(at);
            at += L::N;
        }
    }
}

impl PrepareCones<'_> {
    #[inline(always)]
    fn some<L: Lanes>(&mut self, at: usize) {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let (share, offset) = (L::splat(self.share), L::splat(self.offset));
        let (a, ra, ta) = self.end::<L>(0, at);
        let (b, rb, tb) = self.end::<L>(1, at);
        let (gap, d) = (b - a, ra - rb);
        let length = gap.dot(gap).sqrt();
        let cone = (d.max(-d) * L::splat(1.000_01)).max(L::splat(1e-9)).lt(length);
        // A sphere: the larger one at both ends, and an axis without length.
        let second = ra.lt(rb);
        let none = V3 { x: zero, y: zero, z: zero };
        let centre = a.select(cone, b.select(second, a));
        let radius = ra.select(cone, ra.max(rb));
        let carried = ta.select(cone, tb.select(second, ta)) * share;
        let turned = (tb - ta).select(cone, none) * share;
        let inverse = one.div(length).select(cone, zero);
        let axis = (gap * inverse).select(cone, V3 { x: zero, y: one, z: zero });
        let length = length.select(cone, zero);
        let sine = d * inverse;
        let cosine2 = (one - sine * sine).max(zero);
        let stretch = one.div(cosine2);
        let quick = (ra.min(rb) + offset) * L::splat(self.quick) - ta.dot(ta).max(tb.dot(tb)).sqrt() * share;
        let to = &mut *self.to;
        store3(&mut to.a, at, centre);
        store3(&mut to.axis, at, axis);
        store3(&mut to.across, at, across(axis));
        store3(&mut to.carried, at, carried);
        store3(&mut to.turned, at, turned);
        store(&mut to.length, at, length);
        store(&mut to.shortness, at, inverse);
        store(&mut to.reach, at, radius + offset);
        store(&mut to.taper, at, -sine);
        store(&mut to.tangent, at, sine.div(cosine2.sqrt()));
        store(&mut to.stretch, at, stretch);
        store(&mut to.lean, at, sine * stretch);
        store(&mut to.quick2, at, (quick * quick).select(zero.lt(quick), L::splat(-1.0)));
    }

    /// Centre, radius and travel in the step of one end.
    #[inline(always)]
    fn end<L: Lanes>(&self, i: usize, at: usize) -> (V3<L>, L, V3<L>) {
        let (start, travel) = (&self.ends.start[i], &self.ends.travel[i]);
        let t = L::splat(self.at);
        let moved = load3::<L>(&travel.centre, at);
        let swell = moved.dot(moved).sqrt() * L::splat(self.swell);
        let radius = load::<L>(&start.radius, at) + load::<L>(&travel.radius, at) * t + swell;
        (load3::<L>(&start.centre, at) + moved * t, radius, moved)
    }
}

#[inline(always)]
fn load<L: Lanes>(row: &CapsuleRow, at: usize) -> L {
    L::load(ReadColumn::new(&row.0), at)
}

#[inline(always)]
fn load3<L: Lanes>(rows: &[CapsuleRow; 3], at: usize) -> V3<L> {
    V3 { x: load(&rows[0], at), y: load(&rows[1], at), z: load(&rows[2], at) }
}

#[inline(always)]
fn store<L: Lanes>(row: &mut CapsuleRow, at: usize, v: L) {
    v.store(WriteColumn::new(&mut row.0), at);
}

#[inline(always)]
fn store3<L: Lanes>(rows: &mut [CapsuleRow; 3], at: usize, v: V3<L>) {
    let [x, y, z] = rows;
    store(x, at, v.x);
    store(y, at, v.y);
    store(z, at, v.z);
}

/// A unit vector across a unit vector: square to it and to x, or to y where it is close to x.
#[inline(always)]
fn across<L: Lanes>(axis: V3<L>) -> V3<L> {
    let (zero, steep) = (L::splat(0.0), (axis.x * axis.x).lt(L::splat(0.5)));
    let v = V3 { x: zero, y: axis.z, z: -axis.y }.select(steep, V3 { x: -axis.z, y: zero, z: axis.x });
    v * L::splat(1.0).div(v.dot(v).max(L::splat(0.25)).sqrt())
}
