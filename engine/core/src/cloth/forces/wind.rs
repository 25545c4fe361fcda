//! Wind: drag and lift on triangles, both sides alike.
//!
//! The force is that on a flat plate (Wejchert and Haumann 1991, "Animation aerodynamics", with the lift of Keckeisen et
//! al. 2004, "Wind and thermal"): with u the velocity of the air relative to the triangle, s its speed, n the unit normal
//! on the lee side and c = u.n / s >= 0,
//!
//!   F = 1/2 rho A s c (Cd u + Cl (s n - c u))
//!
//! Drag lies along u and counts the area that faces the wind, A c. Lift is at right angles to u, 1/2 rho A s^2 Cl c
//! sqrt(1 - c^2): none head-on, none edge-on. n turns with u, so the winding of a triangle means nothing.
//!
//! F is evaluated once a step and a third of it goes to each corner. 1/2 rho A s is held below m / ((Cd + Cl) dt), m
//! being the mass that moves with the triangle: then neither the part of u along n nor the one across it is turned
//! round within the step, however fast the air and however light the cloth. That happens far outside of what cloth
//! meets: at 20 m/s, 100 g/m2 and the coefficients of `skirt` the factor is 1/60 of the bound.
//!
//! Sums depend on their order, so it is fixed at load: [`Faces`] sorts the triangles into runs whose three corners all
//! advance by one, which are read and written as rows; and loose ones, which are gathered and added one by one. A run
//! is done in chunks of 64, all of them to their first corner, then to the second, then to the third; that is
//! the same sum at every width.

use glam::{Vec3, Vec3A};

use crate::cloth::state::{self, ParticleColumns};
use crate::lanes::{Kernel, Lanes, MOST, ReadColumn, Readable, Store, V3, Width, WriteColumn, reciprocal_root};

/// Density of dry air at 20 C and 1,013 hPa (kg/m3).
pub const AIR_DENSITY: f32 = 1.204;

/// Triangles of a run whose forces are summed corner by corner.
const CHUNK: usize = 64;

/// Shortest run that is worth a row; what is shorter is loose.
const SHORTEST_RUN: u32 = 4;

/// The air around the cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wind {
    /// Velocity of the air (m/s).
    pub velocity: Vec3A,
    /// Drag coefficient Cd of a piece of cloth that faces the wind.
    pub drag: f32,
    /// Lift coefficient Cl.
    pub lift: f32,
}

impl Wind {
    /// 1 / ((Cd + Cl) dt) for a step of `dt` seconds (1/s): what presses a triangle stays below its mass times this.
    #[inline(always)]
    pub fn bound(&self, dt: f32) -> f32 {
        let most = self.drag.abs() + self.lift.abs();
        1.0 / (most * dt).max(f32::MIN_POSITIVE)
    }
}

/// Triangles `first + k`, k in `0..len`: no particle twice at one corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct TriangleRun {
    first: [u32; 3],
    len: u32,
}

impl TriangleRun {
    fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + use<> {
        let first = self.first;
        (0..self.len).map(move |k| first.map(|i| i + k))
    }
}

/// Triangles that one share adds up.
#[derive(Debug, Clone, Default)]
struct FaceGroup {
    runs: Box<[TriangleRun]>,
    /// Corners of the loose triangles, a list a corner.
    loose: [Box<[u32]>; 3],
    /// The mass that moves with each triangle (kg) `[runs, then loose]`.
    mass: Box<[f32]>,
}

toile_base::named! {
    /// Which part of the triangles: the first two may be done at once, the third after both.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum WindPart {
        /// All corners owned by worker 0.
        First,
        /// All corners owned by worker 1.
        Second,
        /// Corners of both.
        Crossing,
    }
}

/// A garment's triangles as the wind needs them. Made at load.
#[derive(Debug, Clone)]
pub struct Faces {
    groups: [FaceGroup; 3],
    /// Particles of each owner, as ranges.
    owned: [Box<[[u32; 2]]>; 2],
}

impl Faces {
    /// Sorts the triangles of a garment. `rest` are its particles (m), `inverse_mass` their inverse masses (1/kg, 0
    /// where the body carries them), `owner` which worker (0 or 1) each belongs to.
    pub fn new(triangles: &[[u32; 3]], rest: &[Vec3], inverse_mass: &[f32], owner: &[u8]) -> Self {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| rest[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        let mut around = vec![0.0f32; rest.len()];
        triangles.iter().for_each(|t| t.iter().for_each(|&i| around[i as usize] += area(t)));
        // A corner gives three times the part of its mass that is the triangle's by area; the lightest decides. Where
        // the body carries all three nothing moves and any mass will do.
        let moved = |t: &[u32; 3]| {
            let corner =
                |&i: &u32| 3.0 * area(t) / (inverse_mass[i as usize] * around[i as usize]).max(f32::MIN_POSITIVE);
            t.iter().map(corner).fold(f32::MAX, f32::min)
        };
        let mut groups: [Vec<[u32; 3]>; 3] = Default::default();
        for &triangle in triangles {
            // The winding means nothing, so corners in rising order: then neighbours have alike offsets.
            let mut t = triangle;
            t.sort_unstable();
            let owners = t.map(|i| owner[i as usize]);
            let group = if owners == [0; 3] {
                0
            } else if owners == [1; 3] {
                1
            } else {
                2
            };
            groups[group].push(t);
        }
        let owned = [0, 1].map(|worker| ranges(owner, worker));
        Self { groups: groups.map(|triangles| FaceGroup::new(triangles, &moved)), owned }
    }

    /// Writes the accelerations (m/s2) of one part of the triangles, for a step of `dt` seconds. The first two parts
    /// also clear what their owners' particles had.
    pub fn blow(
        &self,
        width: Width,
        part: WindPart,
        wind: &Wind,
        dt: f32,
        at: ParticleColumns<'_>,
        to: [WriteColumn<'_>; 3],
    ) {
        if let Some(owned) = self.owned.get(part as usize) {
            width.run(ClearAccelerations { owned, to });
        }
        width.run(BlowTriangles { group: &self.groups[part as usize], wind, dt, at, to });
    }

    /// Corners of every triangle, and the mass that moves with it (kg): part by part, in each the runs, then the loose ones.
    pub fn triangles(&self) -> impl Iterator<Item = ([u32; 3], f32)> {
        self.groups.iter().flat_map(|group| {
            let [a, b, c] = &group.loose;
            let loose = a.iter().zip(b).zip(c).map(|((a, b), c)| [*a, *b, *c]);
            group.runs.iter().flat_map(TriangleRun::triangles).chain(loose).zip(group.mass.iter().copied())
        })
    }

    /// Calls `add` for every corner of every triangle in the order in which [`Faces::blow`] adds up its parts one after the
    /// other, with the triangle's number among [`Faces::triangles`] and the particle.
    pub fn sums(&self, mut add: impl FnMut(u32, u32)) {
        let mut done = 0;
        for group in &self.groups {
            for run in &group.runs {
                for from in (0..run.len).step_by(CHUNK) {
                    let len = (run.len - from).min(CHUNK as u32);
                    for first in run.first {
                        (from..from + len).for_each(|k| add(done + k, first + k));
                    }
                }
                done += run.len;
            }
            for k in 0..group.loose[0].len() {
                group.loose.iter().for_each(|corner| add(done + k as u32, corner[k]));
            }
            done += group.loose[0].len() as u32;
        }
    }

    /// How many triangles lie in runs, and how many are loose.
    pub fn count(&self) -> [usize; 2] {
        let runs = self.groups.iter().flat_map(|g| &g.runs).map(|r| r.len as usize).sum();
        [runs, self.groups.iter().map(|g| g.loose[0].len()).sum()]
    }

    /// Heap memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        let group = |g: &FaceGroup| {
            let loose: usize = g.loose.iter().map(|l| size_of_val(&**l)).sum();
            size_of_val(&*g.runs) + loose + size_of_val(&*g.mass)
        };
        self.groups.iter().map(group).sum::<usize>() + self.owned.iter().map(|o| size_of_val(&**o)).sum::<usize>()
    }
}

/// The particles of one worker as ranges `[from, to]`, `to` not among them.
fn ranges(owner: &[u8], worker: u8) -> Box<[[u32; 2]]> {
    let mut ranges: Vec<[u32; 2]> = Vec::new();
    for (i, _) in (0u32..).zip(owner).filter(|(_, o)| **o == worker) {
        match ranges.last_mut() {
            Some(last) if last[1] == i => last[1] += 1,
            _ => ranges.push([i, i + 1]),
        }
    }
    ranges.into()
}

impl FaceGroup {
    fn new(mut triangles: Vec<[u32; 3]>, moved: &impl Fn(&[u32; 3]) -> f32) -> Self {
        triangles.sort_unstable_by_key(|t| [t[1] - t[0], t[2] - t[0], t[0]]);
        let mut all: Vec<TriangleRun> = Vec::new();
        for t in triangles {
            match all.last_mut() {
                Some(run) if run.first.map(|i| i + run.len) == t => run.len += 1,
                _ => all.push(TriangleRun { first: t, len: 1 }),
            }
        }
        let (runs, short): (Vec<TriangleRun>, Vec<TriangleRun>) = all.into_iter().partition(|r| r.len >= SHORTEST_RUN);
        let loose: Vec<[u32; 3]> = short.iter().flat_map(TriangleRun::triangles).collect();
        Self {
            mass: runs
                .iter()
                .flat_map(TriangleRun::triangles)
                .chain(loose.iter().copied())
                .map(|t| moved(&t))
                .collect(),
            loose: [0, 1, 2].map(|corner| loose.iter().map(|t| t[corner]).collect()),
            runs: runs.into(),
        }
    }
}

/// An acceleration a particle (m/s2): the wind's, and what the root's motion adds.
#[derive(Debug, Clone, PartialEq)]
pub struct Accelerations {
    numbers: Store,
    starts: [usize; 3],
    len: usize,
}

impl Accelerations {
    /// Accelerations of so many particles, all 0.
    pub fn new(particles: usize) -> Self {
        // As in `State`: no two columns lie alike within 4 KiB, or a processor takes what is stored in one for what is
        // loaded from the other.
        let stride = (particles + 336).next_multiple_of(1_024) + 336;
        let starts = [160, 160 + stride, 160 + 2 * stride];
        Self { numbers: Store::zeros(starts[2] + particles), starts, len: particles }
    }

    /// The three coordinates as kernels see them.
    pub fn columns(&mut self) -> [WriteColumn<'_>; 3] {
        let all = self.numbers.column();
        self.starts.map(|start| all.part(start, self.len))
    }

    /// Acceleration of one particle (m/s2).
    pub fn of(&self, particle: usize) -> Vec3A {
        Vec3A::from_array(self.starts.map(|start| self.numbers.as_slice()[start + particle]))
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.numbers.bytes()
    }
}

struct ClearAccelerations<'a> {
    owned: &'a [[u32; 2]],
    to: [WriteColumn<'a>; 3],
}

impl Kernel for ClearAccelerations<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        for &[from, to] in self.owned {
            let mut at = from as usize;
            while at < to as usize {
                let n = L::N.min(to as usize - at);
                V3::<L>::splat(Vec3A::ZERO).store(self.to, at, n);
                at += n;
            }
        }
    }
}

struct BlowTriangles<'a> {
    group: &'a FaceGroup,
    wind: &'a Wind,
    dt: f32,
    at: ParticleColumns<'a>,
    to: [WriteColumn<'a>; 3],
}

/// What is the same for every triangle of a step.
#[derive(Clone, Copy)]
struct Air<L> {
    velocity: V3<L>,
    drag: L,
    lift: L,
    /// 1 / ((Cd + Cl) dt) (1/s).
    bound: L,
}

impl<L: Lanes> Air<L> {
    #[inline(always)]
    fn new(wind: &Wind, dt: f32) -> Self {
        Self {
            velocity: V3::splat(wind.velocity),
            drag: L::splat(wind.drag),
            lift: L::splat(wind.lift),
            bound: L::splat(wind.bound(dt)),
        }
    }

    /// A third of the force on each triangle (N); the equation is at the top of the file.
    #[inline(always)]
    fn force(&self, x: [V3<L>; 3], v: [V3<L>; 3], mass: L) -> V3<L> {
        let third = L::splat(1.0 / 3.0);
        let u = self.velocity - (v[0] + v[1] + v[2]) * third;
        let normal = (x[1] - x[0]).cross(x[2] - x[0]);
        let (uu, un) = (u.dot(u), u.dot(normal));
        // With N the normal of twice the area's length: |u| |N|, and one over it. That is all the roots there are,
        // because 1/2 rho A s = 1/4 rho |u| |N| and s n = N u.u / (|u| |N|).
        let square = uu * normal.dot(normal);
        let inverse = reciprocal_root(square);
        let lee = un * inverse;
        let c = lee.max(-lee).min(L::splat(1.0));
        let pressed = (L::splat(0.25 * AIR_DENSITY) * square * inverse).min(mass * self.bound);
        let k = pressed * third;
        u * (k * c * (self.drag - self.lift * c)) + normal * (k * lee * self.lift * uu * inverse)
    }
}

impl Kernel for BlowTriangles<'_> {
    type Out = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let air = Air::<L>::new(self.wind, self.dt);
        let mut scratch = [0.0; CHUNK * 3];
        let (a, rest) = scratch.split_at_mut(CHUNK);
        let (b, c) = rest.split_at_mut(CHUNK);
        let force = [WriteColumn::new(a), WriteColumn::new(b), WriteColumn::new(c)];
        let masses = ReadColumn::new(&self.group.mass);
        let rows = TriangleRows::new(self.at, self.to);
        let mut done = 0;
        for run in &self.group.runs {
            let mut from = 0;
            while from < run.len as usize {
                let len = CHUNK.min(run.len as usize - from);
                let [a, b, c] = run.first;
                let corners = [a as usize + from, b as usize + from, c as usize + from];
                rows.press(&air, corners, len, masses, done, force);
                rows.add::<L>(corners[0], len, force);
                rows.add::<L>(corners[1], len, force);
                rows.add::<L>(corners[2], len, force);
                from += len;
                done += len;
            }
        }
        rows.loose(&air, &self.group.loose, masses, done, force);
    }
}

/// What a row of triangles reads and writes, all of one length. Passed by value: the compiler then knows that writing a
/// particle does not change where the columns lie.
#[derive(Clone, Copy)]
struct TriangleRows<'a> {
    x: [WriteColumn<'a>; 3],
    v: [WriteColumn<'a>; 3],
    w: WriteColumn<'a>,
    to: [WriteColumn<'a>; 3],
}

impl<'a> TriangleRows<'a> {
    #[inline(always)]
    fn new(at: ParticleColumns<'a>, to: [WriteColumn<'a>; 3]) -> Self {
        let len = at.w.len();
        let cut = |[x, y, z]: [WriteColumn<'a>; 3]| [x.part(0, len), y.part(0, len), z.part(0, len)];
        Self { x: cut(at.x), v: cut(at.v), w: at.w.part(0, len), to: cut(to) }
    }

    /// The forces of a piece of a run, its masses from `done` on.
    #[inline(always)]
    fn press<L: Lanes>(
        self,
        air: &Air<L>,
        [a, b, c]: [usize; 3],
        len: usize,
        masses: ReadColumn<'_>,
        done: usize,
        force: [WriteColumn<'_>; 3],
    ) {
        let mut k = 0;
        while k < len {
            let n = L::N.min(len - k);
            let corners = [a + k, b + k, c + k];
            let mass = part(masses, done + k, n);
            // A whole vector wherever the columns have one: what it holds past `n` is not used.
            let f = if self.reaches(c + k, L::N) {
                self.forces(air, corners, L::N, mass)
            } else {
                self.forces(air, corners, n, mass)
            };
            f.store(force, k, L::N);
            k += n;
        }
    }

    /// Whether `n` numbers from `at` on are there; the first corner's index is the least, the third's the greatest.
    #[inline(always)]
    fn reaches(self, at: usize, n: usize) -> bool {
        n <= self.w.len() && at <= self.w.len() - n
    }

    /// A third of the forces on `n` triangles of a run.
    #[inline(always)]
    fn forces<L: Lanes>(self, air: &Air<L>, [a, b, c]: [usize; 3], n: usize, mass: L) -> V3<L> {
        let x = [V3::load(self.x, a, n), V3::load(self.x, b, n), V3::load(self.x, c, n)];
        let v = [V3::load(self.v, a, n), V3::load(self.v, b, n), V3::load(self.v, c, n)];
        air.force(x, v, mass)
    }

    /// Adds the forces of a piece of a run to one corner.
    #[inline(always)]
    fn add<L: Lanes>(self, corner: usize, len: usize, force: [WriteColumn<'_>; 3]) {
        let whole = len - len % L::N;
        let mut k = 0;
        while k < whole {
            self.add_some::<L>(corner + k, L::N, V3::load(force, k, L::N));
            k += L::N;
        }
        if k < len {
            self.add_some::<L>(corner + k, len - k, V3::load(force, k, L::N));
        }
    }

    /// Adds `n` forces to particles in a row.
    #[inline(always)]
    fn add_some<L: Lanes>(self, at: usize, n: usize, force: V3<L>) {
        (V3::load(self.to, at, n) + force * part(self.w, at, n)).store(self.to, at, n);
    }

    /// The loose triangles: forces several at a time, sums one after the other, because they may share particles.
    #[inline(always)]
    fn loose<L: Lanes>(
        self,
        air: &Air<L>,
        [a, b, c]: &[Box<[u32]>; 3],
        masses: ReadColumn<'_>,
        done: usize,
        force: [WriteColumn<'_>; 3],
    ) {
        let mut at = 0;
        while at < a.len() {
            let n = L::N.min(a.len() - at);
            let (a, b, c) = (&a[at..at + n], &b[at..at + n], &c[at..at + n]);
            let x = [V3::gather(self.x, a, n), V3::gather(self.x, b, n), V3::gather(self.x, c, n)];
            let v = [V3::gather(self.v, a, n), V3::gather(self.v, b, n), V3::gather(self.v, c, n)];
            air.force(x, v, part(masses, done + at, n)).store(force, 0, n);
            for k in 0..n {
                let f = state::get(force, k);
                self.add_one(a[k], f);
                self.add_one(b[k], f);
                self.add_one(c[k], f);
            }
            at += n;
        }
    }

    /// Adds a force to one particle.
    #[inline(always)]
    fn add_one(self, particle: u32, force: Vec3A) {
        let i = particle as usize;
        state::set(self.to, i, state::get(self.to, i) + force * self.w.get(i));
    }
}

/// `n <= N` numbers of a column.
#[inline(always)]
fn part<L: Lanes>(from: impl Readable, at: usize, n: usize) -> L {
    if n == L::N { L::load(from, at) } else { L::load_part(from, at, n) }
}

const _: () = assert!(CHUNK.is_multiple_of(MOST));

#[cfg(test)]
mod tests;
