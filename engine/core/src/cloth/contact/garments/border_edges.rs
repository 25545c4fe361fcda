//! Edges of borders: where those of one garment lie across edges of another.
//!
//! Particles before faces keep two surfaces apart except at a border, beyond which there is no face: there a hem lies on a ridge
//! between two particles by its edge alone. Which side each belongs on is known from the wearing order, so both edges are looked at along
//! the normal of the contact: where one lies across the other, as seen from there, they keep apart. No two edges are asked for how near
//! they are, and it makes no difference how far one has got through the other.

use std::ops::Range;

use glam::Vec3A;
use toile_base::numeric::portable;

use super::contact::{CONTACTS_AN_EDGE, ContactMemory, LayerContact};
use super::contact_list::ContactList;
use super::garment_surface::GarmentSurface;
use super::pair::{GarmentPair, PairScene};
use crate::bounded::{BoundedVec, Fill};
use crate::cloth::state::get;
use crate::surface::NO_TRIANGLE;

/// Deeper than this (m) an edge is not through another one but beside it: as far as neighbours are apart.
const DEEPEST_M: f32 = 0.015;

/// Sine of the angle between two edges, as seen along the normal, under which they lie along each other and not across.
const ACROSS: f32 = 0.05;

/// Most triangles that are walked over to the one before an edge's first end: the nearest was found a few steps ago.
const MOST_HOPS: usize = 4;

/// Most triangles that an edge lies across: both meshes have edges of about one length, so that it is two or three.
const MOST_ACROSS: usize = 6;

/// The edges of a garment's borders whose first vertices are among some of its particles.
#[derive(Debug, Clone)]
pub struct BorderEdges {
    edges: Box<[[u32; 2]]>,
    /// What the contacts of each in the last step have left behind `[edges]`.
    remembered: Box<[ContactMemory]>,
    /// Of each contact of this step, in their order, which edge made it.
    made: BoundedVec<u32>,
}

/// An edge that looks for others, along a normal.
struct Looking {
    /// Its ends (m).
    ends: [Vec3A; 2],
    /// From the other garment to the side on which it belongs.
    normal: Vec3A,
}

/// Where two edges lie across each other, as seen along a normal.
#[derive(Clone, Copy)]
struct Across {
    /// How far along the one that looks (1), and along the other.
    along: [f32; 2],
    /// From the other to the one that looks (m): along the normal.
    away: Vec3A,
}

impl BorderEdges {
    /// Those of a range of particles. At load.
    pub fn new(surface: &GarmentSurface, particles: Range<usize>) -> Self {
        let own = surface.border_edges.iter().filter(|edge| particles.contains(&(edge[0] as usize)));
        let edges: Box<[[u32; 2]]> = own.copied().collect();
        let made = BoundedVec::new(CONTACTS_AN_EDGE * edges.len());
        Self { remembered: vec![ContactMemory::default(); edges.len()].into(), made, edges }
    }

    /// Most contacts that they make in a step.
    pub fn most_contacts(&self) -> usize {
        CONTACTS_AN_EDGE * self.edges.len()
    }

    /// Keeps in mind where each sticks, from their contacts of the last step.
    pub fn remember(&mut self, scene: &PairScene<'_>, contacts: &ContactList) {
        self.remembered.fill(ContactMemory::default());
        let own = contacts.pairs().filter(|(contact, _)| contact.own == 2);
        for ((contact, push), &edge) in own.zip(&self.made) {
            let remembered = &mut self.remembered[edge as usize];
            *remembered = remembered.with(contact.memory(scene.columns, push.normal));
        }
    }

    /// Finds their contacts with the edges of the other garment. `near` is the triangle that is nearest to a vertex, if any is
    /// near.
    pub fn find(
        &mut self,
        pair: &GarmentPair,
        scene: &PairScene<'_>,
        near: impl Fn(u32) -> Option<u32>,
        contacts: &mut ContactList,
    ) {
        self.made.clear();
        for (e, (&edge, &remembered)) in self.edges.iter().zip(&self.remembered).enumerate() {
            let Some(triangle) = near(edge[0]) else { continue };
            let Some((normal, found)) = find_of(pair, scene, edge, triangle) else { continue };
            for (_, contact) in found {
                if contacts.push(contact.going_on(remembered, normal), normal) {
                    self.made.push(e as u32);
                }
            }
        }
    }

    /// How full their list was so far.
    pub fn usage(&self) -> Fill {
        self.made.usage()
    }

    /// Memory that they hold (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.edges) + size_of_val(&*self.remembered) + self.made.bytes()
    }
}

/// Contacts of one edge with how deep each is (m), the deepest first.
type Deepest = heapless::Vec<(f32, LayerContact), CONTACTS_AN_EDGE>;

/// The contacts of one edge and their normal, from the triangle that is nearest to its first end: of those that it lies across the
/// deepest.
fn find_of(pair: &GarmentPair, scene: &PairScene<'_>, edge: [u32; 2], triangle: u32) -> Option<(Vec3A, Deepest)> {
    let (mesh, [of, faces]) = (&scene.surfaces[1].mesh, scene.columns);
    let corners = mesh.corners(triangle);
    let front = corners.iter().map(|&v| scene.motions[1].normals[v as usize]).sum::<Vec3A>().normalize_or_zero();
    let ends = edge.map(|v| get(of.x, v as usize));
    let height = (ends[0] - get(faces.x, corners[0] as usize)).dot(front);
    if pair.wearing_at(edge[0], corners) != pair.wearing_at(edge[1], corners) {
        return None;
    }
    let normal = pair.normal(scene, edge[0], corners, front, height)?;
    let looking = Looking { ends, normal };
    let mut deepest = Deepest::new();
    looking.each_across(scene, looking.before(scene, triangle), |other, across| {
        let depth = pair.thickness - across.away.dot(normal);
        let speed = |columns: [_; 3], [a, b]: [u32; 2], t: f32| {
            get(columns, a as usize) * (1.0 - t) + get(columns, b as usize) * t
        };
        let relative = speed(of.v, edge, across.along[0]) - speed(faces.v, other, across.along[1]);
        // Not so where anything is not a number.
        if depth > -scene.near(-relative.dot(normal)) && depth < pair.thickness + DEEPEST_M {
            let contact = LayerContact::with_edge([edge, other], across.along, pair.thickness, across.away);
            let place = deepest.iter().position(|(d, _)| *d < depth).unwrap_or(deepest.len());
            if deepest.is_full() && place < deepest.len() {
                deepest.pop();
            }
            // What is no deeper than those that there is room for is left out.
            let _ = deepest.insert(place, (depth, contact));
        }
    });
    Some((normal, deepest))
}

impl Looking {
    /// The triangle before the edge's first end, found by walking from one that is near.
    fn before(&self, scene: &PairScene<'_>, from: u32) -> u32 {
        let mesh = &scene.surfaces[1].mesh;
        let mut triangle = from;
        for _ in 0..MOST_HOPS {
            let corners = mesh.corners(triangle).map(|v| get(scene.columns[1].x, v as usize));
            // How far the end is behind each edge, as seen along the normal, by which side of it the third corner is.
            let behind = |k: usize| {
                let [c, d, third] = [corners[(k + 1) % 3], corners[(k + 2) % 3], corners[k]];
                let inwards = portable::cross(d - c, self.normal);
                (self.ends[0] - c).dot(inwards) * (third - c).dot(inwards).signum()
            };
            let most = (0..3).map(|k| (behind(k), mesh.across(triangle)[k])).min_by(|a, b| a.0.total_cmp(&b.0));
            match most {
                Some((behind, next)) if behind < 0.0 && next != NO_TRIANGLE => triangle = next,
                _ => break,
            }
        }
        triangle
    }

    /// Gives each edge that this one lies across, as it passes from triangle to triangle.
    fn each_across(&self, scene: &PairScene<'_>, from: u32, mut act: impl FnMut([u32; 2], Across)) {
        let mesh = &scene.surfaces[1].mesh;
        let (mut triangle, mut reached, mut through) = (from, f32::NEG_INFINITY, [u32::MAX; 2]);
        for _ in 0..MOST_ACROSS {
            let (corners, mut next) = (mesh.corners(triangle), NO_TRIANGLE);
            for k in 0..3 {
                let (c, d) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
                let other = [c.min(d), c.max(d)];
                if other == through {
                    continue;
                }
                let Some(across) = self.across(other.map(|v| get(scene.columns[1].x, v as usize))) else { continue };
                act(other, across);
                if across.along[0] > reached {
                    (reached, next, through) = (across.along[0], mesh.across(triangle)[k], other);
                }
            }
            if next == NO_TRIANGLE {
                break;
            }
            triangle = next;
        }
    }

    /// Where this edge lies across another one, if it does.
    fn across(&self, [c, d]: [Vec3A; 2]) -> Option<Across> {
        let [p, q] = self.ends;
        let (own, other, from) = (q - p, d - c, c - p);
        let (beside_own, beside_other) = (portable::cross(own, self.normal), portable::cross(other, self.normal));
        let sine = own.dot(beside_other);
        let along = [from.dot(beside_other) / sine, from.dot(beside_own) / sine];
        let clear = sine * sine > ACROSS * ACROSS * beside_own.length_squared() * beside_other.length_squared();
        let within = along.iter().all(|t| (0.0..=1.0).contains(t));
        (clear && within).then(|| Across { along, away: own * along[0] - from - other * along[1] })
    }
}
