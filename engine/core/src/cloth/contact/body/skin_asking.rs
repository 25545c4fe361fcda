//! Which particles may lie by the skin: each is looked at again when it and the skin may have come near since.

use std::ops::Range;

use toile_base::garment::Part;

use super::ContactSettings;
use crate::body_surface::{BodySurface, PartSurface};
use crate::bounded::{BoundedVec, Fill};
use crate::cloth::state::{ParticleColumns, get};
use crate::lanes::{Kernel, Lanes, MOST, Mask, ReadColumn, Store, V3, Width, WriteColumn};
use crate::surface::{NearestPoint, NearestVertex};

/// Farther from the skin than this (m), or deeper inside it, a particle lies by the cones.
pub const DISAGREE_M: f32 = 0.02;

/// How much faster than at its start a particle may be within a step (1).
const FASTER: f32 = 1.5;

/// Every so many steps the nearest point is looked for from anew: of a particle that is near, of one that is not.
const ANEW_STEPS: [u64; 2] = [64, 128];

/// How much farther than the nearest point so far a vertex is looked for (m): a long edge of a body's mesh.
const LOOKED_M: f32 = 0.04;

/// Farther from a body than this (m) is nothing that is worn.
const FARTHEST_M: f32 = 10.0;

/// Particles of one part of the body.
#[derive(Debug, Clone)]
pub struct PartList {
    /// Which part.
    pub part: Part,
    /// Its particles.
    pub particles: Box<[u32]>,
    /// The nearest point of each.
    pub found: Box<[NearestPoint]>,
    /// How far each was from the skin when it was last looked at, less what the skin has moved since (m).
    left: Store,
    /// Where each was then (m).
    looked: [Store; 3],
}

/// Particles of a part that may have come near to the skin since they were last looked at.
#[derive(Debug, Clone)]
pub struct AskingList {
    /// Their places in the part's list.
    places: BoundedVec<u32>,
    /// The particles.
    pub particles: BoundedVec<u32>,
    /// For each the triangle to start from, then what was found.
    pub found: BoundedVec<NearestPoint>,
}

impl PartList {
    /// Of some particles, none of which was looked at yet. At load.
    pub fn new(part: Part, particles: Box<[u32]>) -> Self {
        let len = particles.len();
        let found = vec![NearestPoint::default(); len].into();
        Self { part, found, particles, left: Store::zeros(len), looked: [(); 3].map(|()| Store::zeros(len)) }
    }
}

/// Which of so many particles walk in a step, where each does every so many.
pub fn turn(count: usize, tick: u64, every: u8) -> Range<usize> {
    let share = count.div_ceil(MOST).div_ceil(usize::from(every)) * MOST;
    let from = ((tick % u64::from(every)) as usize * share).min(count);
    from..(from + share).min(count)
}

/// Looks for the nearest points of some particles from anew: a sixteenth of them in each step.
pub struct LookAnew {
    /// Those of the list that may look; whole groups of [`MOST`].
    pub among: Range<usize>,
    /// How often each has walked.
    pub walk: u64,
    /// Whether all of them look, from however far.
    pub all: bool,
}

impl LookAnew {
    /// Looks.
    pub fn look(
        self,
        width: Width,
        cols: ParticleColumns<'_>,
        (body, surface): (&BodySurface, &PartSurface),
        list: &mut PartList,
    ) {
        let PartList { particles, found, left, .. } = list;
        let groups = particles.chunks(MOST).zip(found.chunks_mut(MOST)).zip(left.as_mut().chunks_mut(MOST));
        let first = self.among.start / MOST;
        let among = groups.enumerate().skip(first).take(self.among.len().div_ceil(MOST));
        for (group, ((ids, found), left)) in among {
            let distance = |f: &NearestPoint| f.distance2.sqrt();
            let far = found.iter().all(|f| distance(f) > 4.0 * DISAGREE_M);
            let number = group as u64 + self.walk;
            if !self.all && !number.is_multiple_of(ANEW_STEPS[usize::from(far)]) {
                continue;
            }
            left.fill(0.0);
            for (&i, found) in ids.iter().zip(found) {
                let within = if self.all { FARTHEST_M } else { distance(found) + LOOKED_M };
                let vertex = width.run(NearestVertex {
                    clusters: &surface.clusters,
                    boxes: &surface.boxes,
                    surface: body.start(),
                    point: get(cols.x, i as usize).to_array(),
                    within2: within * within,
                });
                // A triangle of another mesh than the one that was walked on before is none.
                let known = (found.triangle as usize) < surface.mesh.len();
                if !known {
                    found.triangle = 0;
                }
                if let Some(v) = vertex
                    && !surface.mesh.corners(found.triangle).contains(&v)
                    && let Some(&triangle) = surface.mesh.fan(v).first()
                {
                    found.triangle = triangle;
                }
            }
        }
    }
}

impl PartList {
    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        let looked = self.looked.iter().map(Store::bytes).sum::<usize>();
        size_of_val(&*self.particles) + size_of_val(&*self.found) + self.left.bytes() + looked
    }
}

impl AskingList {
    /// Makes an empty list with room for `most` particles. At load.
    pub fn new(most: usize) -> Self {
        Self { places: BoundedVec::new(most), particles: BoundedVec::new(most), found: BoundedVec::new(most) }
    }

    /// Lists the particles of a part that may lie by the skin in this step, by how far they and the skin, which moved so far in the
    /// step before (m), have come since they were last looked at.
    pub fn list(
        &mut self,
        width: Width,
        cols: ParticleColumns<'_>,
        list: &mut PartList,
        moved: f32,
        how: &ContactSettings,
    ) {
        self.places.clear();
        let PartList { particles, found, left, looked, .. } = list;
        let looked = looked.each_ref().map(|c| ReadColumn::new(c.as_slice()));
        let places = &mut self.places;
        width.run(Approach { cols, particles, left: left.column(), looked, moved, how, places });
        self.particles.clear();
        self.found.clear();
        self.particles.extend(self.places.iter().map(|&k| particles[k as usize]));
        self.found.extend(self.places.iter().map(|&k| found[k as usize]));
    }

    /// Those whose places in the part's list are among some.
    pub fn range(&self, among: &Range<usize>) -> Range<usize> {
        let before = |end: usize| self.places.partition_point(|&k| (k as usize) < end);
        before(among.start)..before(among.end)
    }

    /// Notes what was found by some.
    pub fn note(&self, cols: ParticleColumns<'_>, list: &mut PartList, of: Range<usize>) {
        let places = self.places[of.clone()].iter().zip(&self.particles[of.clone()]);
        for ((&k, &i), found) in places.zip(&self.found[of]) {
            let k = k as usize;
            list.found[k] = *found;
            list.left.as_mut()[k] = found.distance2.sqrt();
            let x = get(cols.x, i as usize).to_array();
            list.looked.iter_mut().zip(x).for_each(|(to, x)| to.as_mut()[k] = x);
        }
    }

    /// How full it was so far.
    pub fn usage(&self) -> Fill {
        self.places.usage().and(self.particles.usage()).and(self.found.usage())
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.places.bytes() + self.particles.bytes() + self.found.bytes()
    }
}

/// Takes from what is left between particles and skin what the skin has moved; lists those that may be near.
struct Approach<'a> {
    cols: ParticleColumns<'a>,
    particles: &'a [u32],
    left: WriteColumn<'a>,
    looked: [ReadColumn<'a>; 3],
    moved: f32,
    how: &'a ContactSettings,
    places: &'a mut BoundedVec<u32>,
}

impl Kernel for Approach<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let fast = L::splat(FASTER * self.how.step_seconds);
        let mut from = 0;
        while from < self.particles.len() {
            let n = (self.particles.len() - from).min(L::N);
            let index = &self.particles[from..from + n];
            let left = if n == L::N { L::load(self.left, from) } else { L::load_part(self.left, from, n) };
            let left = left - L::splat(self.moved);
            if n == L::N {
                left.store(self.left, from);
            } else {
                left.store_part(self.left, from, n);
            }
            let came = V3::<L>::gather(self.cols.x, index, n) - V3::<L>::load(self.looked, from, n);
            let v = V3::<L>::gather(self.cols.v, index, n);
            let reach = L::splat(DISAGREE_M) + fast * v.dot(v).sqrt() + came.dot(came).sqrt();
            // Not a number is no way that is left.
            let mut near = !reach.lt(left).bits() & ((1u64 << n) - 1) as u32;
            while near != 0 {
                self.places.push(from as u32 + near.trailing_zeros());
                near &= near - 1;
            }
            from += n;
        }
    }
}
