//! A draped pattern as a garment's shape: what of it the skin carries, and the part of the body that each vertex meets.

use glam::Vec3;

use super::drape::DrapedPattern;
use super::outlines::coordinates;
use super::panels::Around;
use super::skin_field::SkinField;
use super::springs::shape;
use crate::rig::skin::SkinByHeight;
use toile_bake::Shape;
use toile_bake::weights;
use toile_base::body::Body;
use toile_base::garment::Part;
use toile_base::skeleton::Joint;

/// What lies nearer to the skin than this (m) on a shoulder rests there.
const RESTS_M: f32 = 0.008;

/// How far beyond the joint of a shoulder cloth rests on it (m): what lies farther out lies on the arm, which comes down.
const BEYOND_SHOULDER_M: f32 = 0.02;

/// Skin steeper than this (cosine of its normal with the vertical) carries nothing.
const CARRIES: f32 = 0.6;

impl DrapedPattern {
    /// The garment's shape on the body that it was draped on: rest lengths from its flat faces.
    pub fn shape(&self, body: &Body, field: &SkinField) -> Shape {
        let mut out = shape(&self.sewn, self.at.clone());
        self.turn_warp_down(&mut out);
        let skin = SkinByHeight::new(body);
        // Between an arm and the trunk cloth would be pinched; what hangs free below meets hands as well. Before and behind the
        // armhole it lies on both: the shoulder's tip would come through cloth that met the trunk alone.
        let sleeves = self.arranged.panels.iter().any(|p| matches!(p.around, Around::LeftArm | Around::RightArm));
        // What has no sleeves and lies over an arm, as a poncho does, meets that as well.
        let on_trunk =
            |p: Vec3| self.arranged.shoulders && (sleeves || (p.y > body.levels.waist && !skin.is_over_arm(p)));
        let armpit = |p: Vec3| self.arranged.shoulders && skin.in_armpit(p);
        let part = |(v, p): (usize, &Vec3)| match self.limb(v) {
            limb if armpit(*p) => {
                if skin.is_pinched(*p) {
                    Part::Hollow
                } else {
                    limb
                }
            }
            Part::All if on_trunk(*p) => Part::Trunk,
            limb => limb,
        };
        out.parts = self.at.iter().enumerate().map(part).collect();
        out.fixed = self.fixed(body, field);
        let upper = self.arranged.shoulders;
        let carries = |_: Vec3, bone| weights::trunk(bone) || (upper && weights::shoulders(bone));
        out.weights = vec![Default::default(); self.at.len()];
        let held: Vec<usize> = (0..self.at.len()).filter(|&v| out.fixed[v]).collect();
        let at: Vec<Vec3> = held.iter().map(|&v| self.at[v]).collect();
        for (v, weights) in held.into_iter().zip(weights::transfer(body, &at, carries)) {
            out.weights[v] = weights;
        }
        if self.arranged.inside_out {
            turn_out(&mut out);
        }
        out
    }

    /// Vertices that do not move over the skin.
    fn fixed(&self, body: &Body, field: &SkinField) -> Vec<bool> {
        if !self.arranged.shoulders {
            return self.held.clone();
        }
        let tip = body.skeleton.at(Joint::LeftShoulder).x.abs() + BEYOND_SHOULDER_M;
        let rests = |p: &Vec3| {
            let near = field.nearest(*p).is_some_and(|n| n.distance < RESTS_M && n.normal.y > CARRIES);
            near && p.y > body.levels.chest && p.x.abs() < tip
        };
        let trunk =
            |v: usize| self.sewn.members[v].iter().all(|m| self.arranged.panels[m[0] as usize].around == Around::Trunk);
        self.at.iter().enumerate().map(|(v, p)| trunk(v) && rests(p)).collect()
    }

    /// The limb that the panels of a vertex are laid around, [`Part::All`] where that is none.
    fn limb(&self, v: usize) -> Part {
        let members = &self.sewn.members[v];
        let panels = || members.iter().map(|m| (m, &self.arranged.panels[m[0] as usize]));
        if panels().all(|(_, p)| p.around == Around::LeftArm) {
            return Part::LeftArm;
        }
        if panels().all(|(_, p)| p.around == Around::RightArm) {
            return Part::RightArm;
        }
        if let Some(legs) = &self.arranged.legs {
            let side = legs.left[members[0][0] as usize];
            let low = |m: &[u32; 2]| coordinates(&self.sewn, &self.arranged.panels, *m).y < legs.crotch;
            if members.iter().all(|m| legs.left[m[0] as usize] == side && low(m)) {
                match side {
                    Some(true) => return Part::LeftLeg,
                    Some(false) => return Part::RightLeg,
                    None => {}
                }
            }
        }
        Part::All
    }

    /// Turns the flat faces of panels that hang upside down, so that warp runs down.
    fn turn_warp_down(&self, shape: &mut Shape) {
        let mut falls = vec![0.0f32; self.sewn.panels.len()];
        for (i, face) in shape.faces.iter().enumerate() {
            let [p, q, r] = [0, 1, 2].map(|k| self.at[face[k] as usize]);
            let flat = shape.flat[i];
            let (e, f) = (flat[1] - flat[0], flat[2] - flat[0]);
            // The way along the face on which the warp's coordinate falls.
            let down = ((q - p) * f.x - (r - p) * e.x) / e.perp_dot(f);
            falls[self.sewn.face_panels[i] as usize] += down.y * e.perp_dot(f);
        }
        for (flat, panel) in shape.flat.iter_mut().zip(&self.sewn.face_panels) {
            if falls[*panel as usize] > 0.0 {
                *flat = flat.map(|p| -p);
            }
        }
        for trim in &mut shape.trims {
            if falls[trim.panel as usize] > 0.0 {
                *trim = trim.upside_down();
            }
        }
    }
}

/// Turns all faces over: counter-clockwise seen from the other side, weft and warp as before.
fn turn_out(shape: &mut Shape) {
    for (face, flat) in shape.faces.iter_mut().zip(&mut shape.flat) {
        face.swap(0, 1);
        flat.swap(0, 1);
        if face[3] != toile_bake::shape::NO_VERTEX {
            face.swap(2, 3);
            flat.swap(2, 3);
        } else {
            flat[3] = flat[0];
        }
        *flat = flat.map(|p| glam::Vec2::new(-p.x, p.y));
    }
    shape.split.iter_mut().zip(&shape.faces).for_each(|(s, f)| *s = f[3] != toile_bake::shape::NO_VERTEX && !*s);
    shape.trims.iter_mut().for_each(|trim| *trim = trim.from_behind());
    shape.uvs.clone_from(&shape.flat);
}
