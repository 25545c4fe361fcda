//! One worker's share of a pair of garments: which particles of one are near which faces of the other.

use glam::Vec3A;

use super::border_edges::BorderEdges;
use super::contact::{ContactMemory, LayerContact};
use super::contact_list::ContactList;
use super::fold_share::{FoldCounts, FoldScene, FoldShare};
use super::garment_surface::GarmentSurface;
use super::pair::{FASTER, GarmentPair, PairScene, REACH_M};
use crate::bounded::{BoundedVec, Fill};
use crate::cloth::state::get;
use crate::lanes::{Kernel, Lanes, MOST, Mask, Readable, Store, V3, WriteColumn};
use crate::surface::{FindNearest, NearestPoint, NearestVertex, SurfaceMesh};

/// How fast what is nearest may come nearer besides (m/s): it turns, and what is beside it moves otherwise.
const UNSEEN_M_S: f32 = 1.0;

/// How far beyond a border (m) a particle is still over the face: not at all, but for rounding and the bend of the cloth.
const BEYOND_M: f32 = 0.001;

/// Every so many steps the nearest face of each particle is looked for from anew: of one that is near, of one that is not.
const ANEW_STEPS: [u64; 2] = [32, 128];

/// Farther from a surface than this (m) is nothing that is worn.
const FARTHEST_M: f32 = 10.0;

/// How much farther than the nearest point so far a vertex is looked for (m): a spacing of the mesh, because the nearest
/// point is nearer than the nearest vertex.
const LOOKED_M: f32 = 0.02;

/// What is remembered of one particle from step to step.
#[derive(Debug, Clone, Copy, Default)]
struct Remembered {
    triangle: u32,
    /// How far it was from the face when it was last looked at (m).
    distance: f32,
    /// What its contact of the last step has left behind.
    contact: ContactMemory,
}

/// One worker's share of a pair: half of the particles.
#[derive(Debug, Clone)]
pub struct PairShare {
    first: usize,
    remembered: Box<[Remembered]>,
    /// A vertex of the face that each remembers.
    corner: Box<[u32]>,
    /// How far each particle and its face can still move before it needs to be looked at (m).
    slack: Store,
    /// Particles that are looked at in this step, and what is found.
    list: BoundedVec<u32>,
    found: BoundedVec<NearestPoint>,
    /// The contacts of this step.
    pub contacts: ContactList,
    /// Particles looked at in this step.
    pub asked: u64,
    /// What is remembered of folds, where the garment meets itself.
    folds: Option<FoldShare>,
    /// Edges of the garment's borders.
    borders: BorderEdges,
}

impl PairShare {
    /// Room for a share of a pair. At load.
    pub fn new(pair: &GarmentPair, surfaces: &[GarmentSurface], share: usize) -> Self {
        let range = pair.range(share);
        let first = range.start;
        let folds = pair.is_fold().then(|| FoldShare::new(pair.count, share));
        let borders = BorderEdges::new(&surfaces[pair.particles], if folds.is_some() { 0..0 } else { range.clone() });
        let (len, most) = match folds {
            Some(_) => (0, FoldShare::most_contacts(pair.count)),
            None => (range.len(), range.len() + borders.most_contacts()),
        };
        Self {
            folds,
            first,
            remembered: vec![Remembered::default(); len].into(),
            corner: vec![0; len].into(),
            slack: Store::zeros(len),
            list: BoundedVec::new(len),
            found: BoundedVec::new(len),
            contacts: ContactList::new(most),
            borders,
            asked: 0,
        }
    }

    /// Finds the contacts of a step. Once a step, before the first substep.
    pub fn find(&mut self, pair: &GarmentPair, scene: &PairScene<'_>) {
        let first = self.first;
        if self.folds.is_none() {
            self.remember(scene);
        }
        self.contacts.clear();
        if let Some(folds) = &mut self.folds {
            if let Some(surface) = &scene.surfaces[0].folds {
                let of = FoldScene { surface, motion: &scene.motions[0].folds };
                self.asked = folds.find(scene, of, pair.thickness, &mut self.contacts);
            }
            return;
        }
        self.list_near(scene);
        let [of, faces] = scene.columns;
        scene.width.run(FindNearest {
            mesh: &scene.surfaces[1].mesh,
            surface: faces.x.each_ref().map(Readable::reader),
            points: of.x.each_ref().map(Readable::reader),
            list: &self.list,
            found: &mut self.found,
        });
        self.asked = self.list.len() as u64;
        for (&i, found) in self.list.iter().zip(&self.found) {
            let k = i as usize - first;
            let remembered = &mut self.remembered[k];
            remembered.triangle = found.triangle;
            self.corner[k] = scene.surfaces[1].mesh.corners(found.triangle)[0];
            remembered.distance = found.distance2.sqrt().min(FARTHEST_M);
            match touch(pair, scene, i, found) {
                Ok((contact, normal)) => {
                    self.slack.as_mut()[k] = 0.0;
                    self.contacts.push(contact.going_on(remembered.contact, normal), normal);
                }
                Err(Distant(slack)) => self.slack.as_mut()[k] = slack,
            }
        }
        let Self { remembered, borders, contacts, .. } = self;
        let near = |vertex: u32| {
            let known = &remembered[vertex as usize - first];
            (known.distance < REACH_M).then_some(known.triangle)
        };
        borders.find(pair, scene, near, contacts);
    }

    /// Keeps in mind what the contacts of the last step have shown of each particle.
    fn remember(&mut self, scene: &PairScene<'_>) {
        let Self { first, remembered, contacts, .. } = self;
        remembered.iter_mut().for_each(|r| r.contact = ContactMemory::default());
        for (contact, push) in contacts.pairs().filter(|(contact, _)| contact.own == 1) {
            let remembered = &mut remembered[contact.vertices[0] as usize - *first];
            remembered.contact = contact.memory(scene.columns, push.normal);
        }
        self.borders.remember(scene, &self.contacts);
    }

    /// Has no contacts in this step.
    pub fn rest(&mut self) {
        self.contacts.clear();
        self.asked = 0;
        self.folds.iter_mut().for_each(FoldShare::forget);
    }

    /// Lists the particles that may have come near since they were last looked at.
    fn list_near(&mut self, scene: &PairScene<'_>) {
        self.list.clear();
        self.found.clear();
        for group in 0..self.remembered.len().div_ceil(MOST) {
            let members = group * MOST..((group + 1) * MOST).min(self.remembered.len());
            let far = self.remembered[members.start].distance > 2.0 * REACH_M;
            if scene.tick == 0 || (group as u64 + scene.tick).is_multiple_of(ANEW_STEPS[usize::from(far)]) {
                members.for_each(|k| self.look_anew(scene, k));
            }
        }
        scene.width.run(SpendSlack {
            v: scene.columns[0].v,
            first: self.first,
            face_v: scene.columns[1].v,
            corner: &self.corner,
            slack: self.slack.column(),
            seconds: scene.step_seconds,
            list: &mut self.list,
        });
        let Self { list, found, remembered, first, .. } = self;
        let known = |i: &u32| remembered[*i as usize - *first].triangle;
        found.extend(list.iter().map(|i| NearestPoint { triangle: known(i), ..NearestPoint::default() }));
    }

    /// Looks for the nearest face of a particle from anew.
    fn look_anew(&mut self, scene: &PairScene<'_>, k: usize) {
        let remembered = &mut self.remembered[k];
        let GarmentSurface { mesh, clusters, .. } = scene.surfaces[1];
        // At first from however far.
        let within = if scene.tick == 0 { FARTHEST_M } else { remembered.distance + LOOKED_M };
        let found = scene.width.run(NearestVertex {
            clusters,
            boxes: &scene.motions[1].boxes,
            surface: scene.columns[1].x.each_ref().map(Readable::reader),
            point: get(scene.columns[0].x, self.first + k).to_array(),
            within2: within * within,
        });
        if let Some(vertex) = found
            && !mesh.corners(remembered.triangle).contains(&vertex)
            && let Some(&triangle) = mesh.fan(vertex).first()
        {
            remembered.triangle = triangle;
        }
        self.slack.as_mut()[k] = 0.0;
    }

    /// Counts of a garment's folds that did not fit. A particle makes one contact with another garment, so all of those contacts
    /// fit.
    pub fn fold_counts(&self) -> FoldCounts {
        self.folds.as_ref().map(FoldShare::counts).unwrap_or_default()
    }

    /// How full its lists were so far.
    pub fn usage(&self) -> Fill {
        self.list.usage().and(self.found.usage()).and(self.contacts.usage()).and(self.borders.usage())
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.remembered)
            + size_of_val(&*self.corner)
            + self.slack.bytes()
            + self.list.bytes()
            + self.found.bytes()
            + self.contacts.bytes()
            + self.borders.bytes()
            + self.folds.as_ref().map_or(0, FoldShare::bytes)
    }
}

/// How far a particle is from what could become a contact (m).
struct Distant(f32);

/// The contact of a particle with the face that is nearest to it, if it may come to one in this step.
fn touch(
    pair: &GarmentPair,
    scene: &PairScene<'_>,
    i: u32,
    found: &NearestPoint,
) -> Result<(LayerContact, Vec3A), Distant> {
    let [of, faces] = scene.columns;
    let mesh = &scene.surfaces[1].mesh;
    let distance = found.distance2.sqrt();
    if distance.is_nan() || distance > REACH_M {
        return Err(Distant(distance - REACH_M));
    }
    let corners = mesh.corners(found.triangle);
    let at = |columns, k: usize| get(columns, corners[k] as usize) * found.shares[k];
    let away = get(of.x, i as usize) - (at(faces.x, 0) + at(faces.x, 1) + at(faces.x, 2));
    let seen = |k: usize| scene.motions[1].normals[corners[k] as usize] * found.shares[k];
    let front = (seen(0) + seen(1) + seen(2)).normalize_or_zero();
    let height = away.dot(front);
    let beyond2 = away.length_squared() - height * height;
    if mesh.on_border(found.triangle, SurfaceMesh::feature(found.shares)) && beyond2 > BEYOND_M * BEYOND_M {
        return Err(Distant(beyond2.sqrt() - BEYOND_M));
    }
    let normal = pair.normal(scene, i, corners, front, height).ok_or(Distant(0.0))?;
    let apart = away.dot(normal) - pair.thickness;
    let relative = get(of.v, i as usize) - (at(faces.v, 0) + at(faces.v, 1) + at(faces.v, 2));
    let near = scene.near(-relative.dot(normal));
    if apart.is_nan() || apart >= near {
        return Err(Distant(apart - near));
    }
    Ok((LayerContact::with_face(i, corners, found.shares, pair.thickness, away), normal))
}

/// How far particles and what they are nearest to have moved against each other in a step is taken from their slack; those without
/// any left are listed.
struct SpendSlack<'a> {
    /// Velocities of the particles (m/s).
    v: [WriteColumn<'a>; 3],
    /// The first particle.
    first: usize,
    /// Velocities of the surface (m/s), and the vertex of it that each is nearest to.
    face_v: [WriteColumn<'a>; 3],
    corner: &'a [u32],
    /// Slack of each from there on (m).
    slack: WriteColumn<'a>,
    /// Length of the step (s).
    seconds: f32,
    /// Those that are to be looked at.
    list: &'a mut BoundedVec<u32>,
}

impl Kernel for SpendSlack<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let mut from = 0;
        while from < self.slack.len() {
            let n = (self.slack.len() - from).min(L::N);
            let v = V3::<L>::load(self.v, self.first + from, n);
            let relative = v - V3::<L>::gather(self.face_v, &self.corner[from..from + n], n);
            let moved = relative.dot(relative).sqrt() * L::splat(FASTER) + L::splat(UNSEEN_M_S);
            let slack = if n == L::N { L::load(self.slack, from) } else { L::load_part(self.slack, from, n) };
            let left = slack - moved * L::splat(self.seconds);
            if n == L::N {
                left.store(self.slack, from);
            } else {
                left.store_part(self.slack, from, n);
            }
            // Not a number is no slack.
            let mut near = !L::splat(0.0).lt(left).bits() & ((1u64 << n) - 1) as u32;
            while near != 0 {
                self.list.push((self.first + from) as u32 + near.trailing_zeros());
                near &= near - 1;
            }
            from += n;
        }
    }
}
