//! The body's capsules and planes in the contact kernels' layout, prepared for every substep of a step.

use toile_base::limits::{MAX_CAPSULES, MAX_PLANES};
use toile_engine::cloth::contact::body::ContactSettings;
use toile_engine::cloth::contact::body::cones::{CapsuleCones, CapsuleEnds, PrepareCones};
use toile_engine::colliders::Colliders;
use toile_engine::lanes::Width;

/// Planes of a garment: the floor and those of the scene.
pub const PLANES: usize = MAX_PLANES + 1;

/// The struct `Cone` of `shaders/contact.wgsl`.
pub type FlatCone = [[f32; 4]; 6];

/// The struct `Ends` there.
pub type FlatEnds = [[f32; 4]; 4];

/// Working storage of a garment's capsules.
#[derive(Debug, Clone)]
pub struct ContactData {
    ends: CapsuleEnds,
    cones: CapsuleCones,
}

impl ContactData {
    /// Nothing to touch yet.
    pub fn new() -> Self {
        Self { ends: CapsuleEnds::NONE, cones: CapsuleCones::NONE }
    }

    /// Prepares a step's capsules: what the whole step sweeps, then those of each substep, `MAX_CAPSULES` of each, into
    /// `cones`; gives the capsules that are to be believed, a bit each.
    pub fn capsules(
        &mut self,
        width: Width,
        colliders: &Colliders,
        how: &ContactSettings,
        cones: &mut [FlatCone],
        ends: &mut [FlatEnds],
    ) -> u32 {
        self.ends.read(colliders);
        for (c, to) in ends.iter_mut().enumerate().take(MAX_CAPSULES) {
            let of = |s: &toile_engine::cloth::contact::body::cones::EndSpheres| {
                [s.centre[0].0[c], s.centre[1].0[c], s.centre[2].0[c], s.radius.0[c]]
            };
            *to =
                [of(&self.ends.start[0]), of(&self.ends.start[1]), of(&self.ends.travel[0]), of(&self.ends.travel[1])];
        }
        let substeps = (cones.len() / MAX_CAPSULES).saturating_sub(1);
        for (set, to) in cones.chunks_exact_mut(MAX_CAPSULES).enumerate() {
            let span = [set.saturating_sub(1), set].map(|s| s as f32 / substeps as f32);
            // The first set is the whole step's, from its middle.
            let [at, share, swell] = if set == 0 { [0.5, 1.0, 0.5] } else { [span[1], span[1] - span[0], 0.0] };
            let (offset, quick) = (how.offset_m, how.quick());
            width.run(PrepareCones { ends: &self.ends, at, share, swell, offset, quick, to: &mut self.cones });
            to.iter_mut().enumerate().for_each(|(c, to)| *to = flat(&self.cones, c));
        }
        self.ends.sound
    }
}

fn flat(cones: &CapsuleCones, c: usize) -> FlatCone {
    let k = cones;
    let with = |three: &[toile_engine::cloth::contact::body::cones::CapsuleRow; 3], w: f32| {
        [three[0].0[c], three[1].0[c], three[2].0[c], w]
    };
    [
        with(&k.a, k.length.0[c]),
        with(&k.axis, k.shortness.0[c]),
        with(&k.across, k.reach.0[c]),
        with(&k.carried, k.taper.0[c]),
        with(&k.turned, k.tangent.0[c]),
        [k.stretch.0[c], k.lean.0[c], k.quick2.0[c], 0.0],
    ]
}

/// The floor, where there is one, and the planes; gives how many.
pub fn planes(colliders: &Colliders, to: &mut [[f32; 4]]) -> u32 {
    let floor = colliders.floor.then_some([0.0, 1.0, 0.0, 0.0]);
    let planes = floor.into_iter().chain(colliders.planes().iter().map(|p| p.to_array()));
    to.iter_mut().zip(planes).map(|(to, plane)| *to = plane).count() as u32
}
