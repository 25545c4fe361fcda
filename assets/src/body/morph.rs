//! Morphs: fields of displacement, one a slider, that add up to a body (Ugur 2008, section 4.4).
//!
//! A girth's slider scales its segment away from the segment's axis; a length's stretches a stretch of the body along
//! its bone and carries all beyond it. Every field is linear in its slider, so that a body is the base, plus the fields
//! times the sliders, all times one scale; soles stay on the floor and the two sides are each other's mirror image.

use glam::Vec3;

use super::base::BaseBody;
use super::fields;
use super::segments::Neighbourhood;
use super::slider::SLIDERS;
use toile_base::skeleton::{JOINTS, Joint, Skeleton};

/// A setting of all sliders, then the scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Setting {
    pub sliders: [f32; SLIDERS],
    pub scale: f32,
}

/// The fields of one base body.
pub(super) struct Morphs {
    /// The base, with its sides made each other's exact mirror image.
    pub base: BaseBody,
    pub near: Neighbourhood,
    /// Start of each vertex's moves, and the end `[vertices + 1]`.
    start: Vec<u32>,
    /// The slider that moves a vertex, and the move by a unit.
    moves: Vec<(u32, Vec3)>,
    /// How the joints move a unit of each slider.
    joints: [[Vec3; JOINTS]; SLIDERS],
}

/// Displacements smaller than this a unit are left out: a nanometre at most in any body.
const NOTHING: f32 = 1e-9;

impl Morphs {
    /// Works out the fields of a base body.
    pub(super) fn new(mut base: BaseBody) -> Self {
        let near = Neighbourhood::new(&base.positions, &base.triangles);
        mirror_exactly(&mut base, &near.mirror);
        let mut all = fields::displacements(&base, &near);
        for field in &mut all {
            for (v, &mirror) in near.mirror.iter().enumerate() {
                match (base.positions[v].x, mirror as usize) {
                    (0.0, _) => field[v].x = 0.0,
                    (x, other) if x < 0.0 => field[v] = mirrored(field[other]),
                    _ => {}
                }
            }
        }
        let joints = std::array::from_fn(|k| joint_moves(&base, &all[k]));
        let (mut start, mut moves) = (vec![0], Vec::new());
        for v in 0..base.positions.len() {
            let here = all.iter().map(|field| field[v]).enumerate();
            moves.extend(here.filter(|(_, d)| d.abs().max_element() > NOTHING).map(|(k, d)| (k as u32, d)));
            start.push(moves.len() as u32);
        }
        Self { base, near, start, moves, joints }
    }

    /// The sliders that move a vertex, and by how much a unit before scaling.
    pub(super) fn moves(&self, vertex: usize) -> &[(u32, Vec3)] {
        &self.moves[self.start[vertex] as usize..self.start[vertex + 1] as usize]
    }

    /// Position of a vertex on a body.
    pub(super) fn place(&self, vertex: usize, setting: &Setting) -> Vec3 {
        let moved = self
            .moves(vertex)
            .iter()
            .fold(self.base.positions[vertex], |p, &(k, d)| p + d * setting.sliders[k as usize]);
        moved * setting.scale
    }

    /// All vertices of a body.
    pub(super) fn positions(&self, setting: &Setting) -> Vec<Vec3> {
        (0..self.base.positions.len()).map(|v| self.place(v, setting)).collect()
    }

    /// How the joints move a unit of a slider, before scaling.
    pub(super) fn joint_moves(&self, slider: usize) -> &[Vec3; JOINTS] {
        &self.joints[slider]
    }

    /// The joints of a body: each goes with the surface around it.
    pub(super) fn skeleton(&self, setting: &Setting) -> Skeleton {
        let mut rest = self.base.skeleton.rest;
        for (moves, &by) in self.joints.iter().zip(&setting.sliders) {
            rest.iter_mut().zip(moves).for_each(|(joint, m)| *joint += *m * by);
        }
        rest.iter_mut().for_each(|joint| *joint *= setting.scale);
        Skeleton { rest }
    }
}

fn mirrored(p: Vec3) -> Vec3 {
    Vec3::new(-p.x, p.y, p.z)
}

fn mirror_exactly(base: &mut BaseBody, mirror: &[u32]) {
    for (v, &other) in mirror.iter().enumerate() {
        if other as usize == v {
            base.positions[v].x = 0.0;
        } else if base.positions[v].x < 0.0 {
            base.positions[v] = mirrored(base.positions[other as usize]);
        }
    }
    for joint in Joint::ALL {
        let left = base.skeleton.at(joint);
        match joint.mirror() {
            own if own == joint => base.skeleton.rest[joint.index()].x = 0.0,
            other if other > joint => base.skeleton.rest[other.index()] = mirrored(left),
            _ => {}
        }
    }
}

/// Each joint's move: the mean of the field around it, nearer vertices counting for more.
fn joint_moves(base: &BaseBody, field: &[Vec3]) -> [Vec3; JOINTS] {
    let mut moves = [Vec3::ZERO; JOINTS];
    for joint in Joint::ALL {
        if joint.mirror() < joint {
            moves[joint.index()] = mirrored(moves[joint.mirror().index()]);
            continue;
        }
        let centre = base.skeleton.at(joint);
        let off = |p: &Vec3| p.distance_squared(centre);
        let nearest = base.positions.iter().map(off).fold(f32::MAX, f32::min);
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        for (p, d) in base.positions.iter().zip(field) {
            // Twice as far as the nearest counts e^-3 of it: about one ring of the limb around the joint.
            let share = (1.0 - off(p) / nearest.max(1e-6)).exp();
            sum += *d * share;
            total += share;
        }
        moves[joint.index()] = sum / total;
        if joint.mirror() == joint {
            moves[joint.index()].x = 0.0;
        }
    }
    moves
}
