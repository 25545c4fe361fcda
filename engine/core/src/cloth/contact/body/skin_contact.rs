//! Contact with the skin: particles against the triangles of the body that is seen.
//!
//! Once a step each particle walks to the nearest point of the skin as it stood at the start; what may come to touch it in
//! this step meets the plane there, which moves as that point of the skin does. Smooth normals make the planes of
//! neighbours one surface. Where a particle lies by the skin, the cones of the same limb do not push it, unless the two are
//! more than [`DISAGREE_M`] apart: then the skin is in the wrong place, or the nearest point of it is, and the cones win.

use glam::Vec3A;
use toile_base::garment::Part;

use super::ContactSettings;
use super::near::ParticleBlock;
use super::skin_asking::{AskingList, DISAGREE_M, LookAnew, PartList, turn};
use super::touch::{ContactSurface, Friction, push};
use crate::body_surface::{BodyPart, BodySurface, PartSurface};
use crate::bounded::{BoundedVec, Fill};
use crate::cloth::state::{ParticleColumns, get, set};
use crate::lanes::{Kernel, Lanes, MOST, Mask, ReadColumn, Readable, Store, V3, Width, WriteColumn, reciprocal_root};
use crate::surface::{FindNearest, NearestPoint, SurfaceMesh};

/// How much nearer than the offset a plane is made (m).
const MARGIN_M: f32 = 0.002;

/// How much faster than at its start a particle may be within a step (1).
const FASTER: f32 = 1.5;

/// How far beyond a border of a part (m) a particle is still over it.
const BEYOND_M: f32 = 0.002;

/// Fastest that cloth is pushed out of skin that it is found in (m/s): 10 mm in a hundredth of a second.
const PUSH_M_S: f32 = 1.0;

/// Numbers of a plane: normal, offset along it at the start of the step and how far that moves, the skin's motion (m).
const NUMBERS: usize = 8;

/// What one worker's particles have to do with the skin.
#[derive(Debug, Clone)]
pub struct SkinContacts {
    lists: Box<[PartList]>,
    asking: AskingList,
    /// The limb by whose skin each particle lies, where it does `[particles of the garment]`.
    by: Box<[Option<BodyPart>]>,
    /// Particles that may touch the skin in this step, and the planes there.
    particles: BoundedVec<u32>,
    planes: [Store; NUMBERS],
    /// Walks of the particles of a part while they are measured: the next step goes on from where it was itself.
    measured: Box<[NearestPoint]>,
    tick: u64,
    /// Whether the skin was asked in this step.
    asked: bool,
}

impl SkinContacts {
    /// Room for the particles of some blocks. At load.
    pub fn new(blocks: &[ParticleBlock], parts: &[Part]) -> Self {
        let mut particles: Vec<u32> = blocks.iter().flat_map(|b| (0..b.len()).map(|lane| b.particle(lane))).collect();
        particles.sort_unstable();
        let part = |i: u32| parts.get(i as usize).copied().unwrap_or_default();
        let mut kinds: Vec<Part> = Vec::new();
        for &i in &particles {
            if part(i) != Part::Hollow && !kinds.contains(&part(i)) {
                kinds.push(part(i));
            }
        }
        let lists = kinds.into_iter().map(|kind| {
            let mine: Box<[u32]> = particles.iter().copied().filter(|&i| part(i) == kind).collect();
            PartList::new(kind, mine)
        });
        let lists: Box<[PartList]> = lists.collect();
        let longest = lists.iter().map(|l| l.particles.len()).max().unwrap_or(0);
        Self {
            asking: AskingList::new(longest),
            lists,
            measured: vec![NearestPoint::default(); longest].into(),
            by: vec![None; parts.len()].into(),
            planes: [(); NUMBERS].map(|()| Store::zeros(particles.len().next_multiple_of(MOST))),
            particles: BoundedVec::new(particles.len()),
            tick: 0,
            asked: false,
        }
    }

    /// By which limb's skin a particle lies.
    #[inline(always)]
    pub fn by(&self, particle: u32) -> Option<BodyPart> {
        self.by[particle as usize]
    }

    /// Whether any particle lies by the skin in this step.
    pub fn any(&self) -> bool {
        self.asked
    }

    /// Finds what may touch the skin in this step. Once a step.
    pub fn find(&mut self, width: Width, cols: ParticleColumns<'_>, body: Option<&BodySurface>, how: &ContactSettings) {
        self.particles.clear();
        let asked = std::mem::replace(&mut self.asked, body.is_some());
        let Some(body) = body else {
            if asked {
                self.by.fill(None);
                self.lists.iter().flat_map(|l| &l.particles).for_each(|&i| set(cols.skin, i as usize, Vec3A::ZERO));
            }
            return;
        };
        let every = how.skin_every.max(1);
        let Self { lists, asking, by, particles, planes, tick, .. } = self;
        let mut to = PlaneList { particles, planes: planes.each_mut().map(Store::column) };
        for list in lists {
            for &i in &list.particles {
                by[i as usize] = None;
                set(cols.skin, i as usize, Vec3A::ZERO);
            }
            let Some(surface) = body.of(list.part) else { continue };
            // All if no search walked in the step before.
            let walking = if asked { turn(list.particles.len(), *tick, every) } else { 0..list.particles.len() };
            let anew = LookAnew { among: walking.clone(), walk: *tick / u64::from(every), all: *tick == 0 };
            anew.look(width, cols, (body, surface), list);
            asking.list(width, cols, list, surface.moved, how);
            let walking = asking.range(&walking);
            width.run(FindNearest {
                mesh: &surface.mesh,
                surface: body.start(),
                points: cols.x.each_ref().map(Readable::reader),
                list: &asking.particles[walking.clone()],
                found: &mut asking.found[walking.clone()],
            });
            asking.note(cols, list, walking);
            let AskingList { particles, found, .. } = &*asking;
            width.run(LieBySkin { cols, body, surface, particles, found, how, by, to: &mut to });
        }
        *tick += 1;
    }

    /// Pushes what is behind its plane as that stands at the end of the substep. `span` is the substep's part of the step, 0..1.
    pub fn solve(&self, width: Width, cols: ParticleColumns<'_>, span: [f32; 2], how: &ContactSettings) {
        if !self.particles.is_empty() {
            let planes = self.planes.each_ref().map(|c| ReadColumn::new(c.as_slice()));
            width.run(MeetSkin { cols, particles: &self.particles, planes, span, how });
        }
    }

    /// Walks to the nearest points of the skin at the end of the step; gives each particle that lies by it, and how deep it is
    /// behind (m). For measuring, which changes nothing that a step reads.
    pub fn depths(
        &mut self,
        width: Width,
        cols: ParticleColumns<'_>,
        body: &BodySurface,
        mut depth: impl FnMut(u32, f32),
    ) {
        let Self { lists, measured, by, .. } = self;
        for PartList { part, particles, found, .. } in lists.iter() {
            let (Some(surface), Some(now)) = (body.of(*part), measured.get_mut(..found.len())) else { continue };
            now.copy_from_slice(found);
            width.run(FindNearest {
                mesh: &surface.mesh,
                surface: body.end(),
                points: cols.x.each_ref().map(Readable::reader),
                list: particles,
                found: &mut *now,
            });
            for (&i, found) in particles.iter().zip(now.iter()) {
                if by[i as usize].is_some() {
                    let feature = SurfaceMesh::feature(found.shares);
                    let normal = surface.mesh.normal(found.triangle, feature, |v| body.vertex(v));
                    let corners = surface.mesh.corners(found.triangle);
                    let q: Vec3A = (0..3).map(|k| body.vertex(corners[k]) * found.shares[k]).sum();
                    depth(i, (q - get(cols.x, i as usize)).dot(normal));
                }
            }
        }
    }

    /// How full its lists were so far.
    pub fn usage(&self) -> Fill {
        self.asking.usage().and(self.particles.usage())
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.lists.iter().map(PartList::bytes).sum::<usize>()
            + self.asking.bytes()
            + size_of_val(&*self.by)
            + size_of_val(&*self.measured)
            + self.particles.bytes()
            + self.planes.iter().map(Store::bytes).sum::<usize>()
    }
}

/// The planes of a step as they are made.
struct PlaneList<'a> {
    particles: &'a mut BoundedVec<u32>,
    planes: [WriteColumn<'a>; NUMBERS],
}

/// By which limb's skin each of some particles lies, and the planes that they may meet in this step.
struct LieBySkin<'a, 'b> {
    cols: ParticleColumns<'a>,
    body: &'a BodySurface,
    surface: &'a PartSurface,
    particles: &'a [u32],
    found: &'a [NearestPoint],
    how: &'a ContactSettings,
    by: &'a mut [Option<BodyPart>],
    to: &'a mut PlaneList<'b>,
}

/// Where the nearest points of some particles are at the start of the step, how far they move in it (m), and the normals.
struct SkinPoints<L> {
    start: V3<L>,
    carried: V3<L>,
    normal: V3<L>,
}

impl Kernel for LieBySkin<'_, '_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self) {
        let mut from = 0;
        while from < self.particles.len() {
            let n = (self.particles.len() - from).min(L::N);
            self.some::<L>(from, n);
            from += n;
        }
    }
}

impl LieBySkin<'_, '_> {
    #[inline(always)]
    fn some<L: Lanes>(&mut self, from: usize, n: usize) {
        let (index, found) = (&self.particles[from..from + n], &self.found[from..from + n]);
        let dt = L::splat(self.how.step_seconds);
        let v = V3::<L>::gather(self.cols.v, index, n);
        let w = L::gather(self.cols.w, index, n);
        let mut distance2 = [0.0; MOST];
        distance2.iter_mut().zip(found).for_each(|(d, f)| *d = f.distance2);
        let reach = L::splat(DISAGREE_M) + L::splat(FASTER) * dt * v.dot(v).sqrt();
        // Not so where it is not a number.
        let near = L::from_array(&distance2).lt(reach * reach).and(L::splat(0.0).lt(w));
        let near = near.bits() & ((1u64 << n) - 1) as u32;
        if near == 0 {
            index.iter().for_each(|&i| self.by[i as usize] = None);
            return;
        }
        let on = self.points::<L>(found, n);
        let away = V3::<L>::gather(self.cols.x, index, n) - on.start;
        let height = away.dot(on.normal);
        let beside2 = away.dot(away) - height * height;
        let inside = L::splat(-DISAGREE_M).lt(height).bits() & near;
        let beside = L::splat(BEYOND_M * BEYOND_M).lt(beside2).bits();
        let approach = (on.carried - v * dt).dot(on.normal).max(L::splat(0.0));
        let apart = L::splat(self.how.offset_m) - L::gather(self.cols.given, index, n);
        let touches = (height - (apart + L::splat(MARGIN_M))).lt(L::splat(FASTER) * approach).bits();
        let offset = on.start.dot(on.normal) + apart;
        let [normal, carried] = [on.normal, on.carried];
        let across = carried.dot(normal);
        let numbers = [normal.x, normal.y, normal.z, offset, across, carried.x, carried.y, carried.z];
        let numbers = [
            numbers[0].to_array(),
            numbers[1].to_array(),
            numbers[2].to_array(),
            numbers[3].to_array(),
            numbers[4].to_array(),
            numbers[5].to_array(),
            numbers[6].to_array(),
            numbers[7].to_array(),
        ];
        for lane in 0..n {
            let (i, found) = (index[lane], &found[lane]);
            self.by[i as usize] = None;
            let mesh = &self.surface.mesh;
            let over = beside >> lane & 1 == 0 || !mesh.on_border(found.triangle, SurfaceMesh::feature(found.shares));
            if inside >> lane & 1 == 0 || !over {
                continue;
            }
            let [a, b, c] = found.shares;
            let heaviest = if a >= b && a >= c { 0 } else { 1 + usize::from(c > b) };
            self.by[i as usize] = Some(self.body.limb(mesh.corners(found.triangle)[heaviest]));
            set(self.cols.skin, i as usize, Vec3A::new(numbers[0][lane], numbers[1][lane], numbers[2][lane]));
            if touches >> lane & 1 == 1 {
                let at = self.to.particles.len();
                if self.to.particles.push(i) {
                    for (column, numbers) in self.to.planes.iter().zip(&numbers) {
                        column.set(at, numbers[lane]);
                    }
                }
            }
        }
    }

    /// The points of the skin that are nearest.
    #[inline(always)]
    fn points<L: Lanes>(&self, found: &[NearestPoint], n: usize) -> SkinPoints<L> {
        let mut corners = [[0u32; MOST]; 3];
        let mut shares = [[0.0f32; MOST]; 3];
        for (lane, f) in found.iter().enumerate() {
            let of = self.surface.mesh.corners(f.triangle);
            for k in 0..3 {
                (corners[k][lane], shares[k][lane]) = (of[k], f.shares[k]);
            }
        }
        let zero = V3 { x: L::splat(0.0), y: L::splat(0.0), z: L::splat(0.0) };
        let (mut start, mut end, mut normal) = (zero, zero, zero);
        for k in 0..3 {
            let share = L::from_array(&shares[k]);
            start = start + V3::<L>::gather(self.body.start(), &corners[k], n) * share;
            end = end + V3::<L>::gather(self.body.end(), &corners[k], n) * share;
            normal = normal + V3::<L>::gather(self.body.normals(), &corners[k], n) * share;
        }
        let length2 = normal.dot(normal).max(L::splat(1e-12));
        SkinPoints { start, carried: end - start, normal: normal * reciprocal_root(length2) }
    }
}

/// Particles against their planes.
struct MeetSkin<'a> {
    cols: ParticleColumns<'a>,
    particles: &'a [u32],
    planes: [ReadColumn<'a>; NUMBERS],
    span: [f32; 2],
    how: &'a ContactSettings,
}

impl Kernel for MeetSkin<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { cols, particles, planes, span, how } = self;
        let friction = Friction { hold: L::splat(how.friction_static), slide: L::splat(how.friction_kinetic) };
        let [to, part] = [span[1], span[1] - span[0]].map(L::splat);
        let most = L::splat(PUSH_M_S * how.step_seconds * (span[1] - span[0]));
        let zero = L::splat(0.0);
        let mut from = 0;
        while from < particles.len() {
            let n = (particles.len() - from).min(L::N);
            let index = &particles[from..from + n];
            // Planes are kept for whole vectors.
            let normal = V3 { x: L::load(planes[0], from), y: L::load(planes[1], from), z: L::load(planes[2], from) };
            let x = V3::<L>::gather(cols.x, index, n);
            let depth = L::load(planes[3], from) + L::load(planes[4], from) * to - x.dot(normal);
            let lanes = ((1u64 << n) - 1) as u32;
            let touched = zero.lt(depth).bits() & lanes;
            if touched != 0 {
                let moved =
                    V3 { x: L::load(planes[5], from), y: L::load(planes[6], from), z: L::load(planes[7], from) };
                let carried = moved * part;
                let (mut x, mut previous) = (x, V3::<L>::gather(cols.previous, index, n));
                let approach = (carried - (x - previous)).dot(normal).max(zero);
                let on = ContactSurface { normal, depth: depth.min(approach + most), carried };
                push(&mut x, &mut previous, &on, friction, L::Mask::of(touched));
                x.scatter(cols.x, index, n);
                previous.scatter(cols.previous, index, n);
            }
            from += n;
        }
    }
}
