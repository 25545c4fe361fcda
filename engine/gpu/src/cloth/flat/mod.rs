//! Baked garments flattened into the kernels' arrays, one behind the other, in workgroups of 64.

mod bending;
mod diagonals;
mod faces;
mod fibers;
mod links;
mod lists;
mod wind;
mod workgroups;

use toile_base::garment::Garment;
use toile_engine::cloth::contact::body::reach;
use toile_engine::cloth::forces::bending_matrix::BendingMatrix;
use toile_engine::colliders::Colliders;

pub use bending::FlatBending;
pub use diagonals::FlatDiagonals;
pub use faces::FlatFaces;
pub use fibers::FlatFibers;
pub use links::FlatLinks;
pub use lists::FlatLists;
pub use wind::FlatWind;
pub use workgroups::{GarmentSpan, WIDTH, Workgroups};

use super::constants::SOFT_WEFT;

/// A particle that is not skinned, among the pins.
pub const FREE: u32 = u32::MAX;

/// A scene's garments, laid flat.
#[derive(Debug, Clone, Default)]
pub struct Flat {
    /// The garments as they lie: those with the most substeps first.
    pub order: Vec<usize>,
    /// Where each lies, in that order.
    pub spans: Vec<GarmentSpan>,
    /// Where each garment's targets begin, in that order, and how many there are in all.
    pub pins_from: Vec<u32>,
    /// Particles of all garments.
    pub particles: u32,
    /// Place at rest (m) and inverse mass (1/kg) `[particles]`.
    pub start: Vec<[f32; 4]>,
    /// Which target each particle follows, or [`FREE`] `[particles]`.
    pub pins: Vec<u32>,
    /// Skinned particles of all.
    pub targets: u32,
    /// Anchor, and bits of the length (m) of the way to it `[particles]`.
    pub tethers: Vec<[u32; 2]>,
    /// The capsules that each particle can touch at all, a bit each `[particles]`.
    pub reach: Vec<u32>,
    /// Which garments are solved once a substep `[garments]`.
    pub scattered: Vec<bool>,
    /// Workgroups over the particles.
    pub everyone: Workgroups,
    /// Shear links that lie in no fiber.
    pub shear: FlatLinks,
    /// Links along the weft.
    pub weft: FlatLinks,
    /// Fibers along the bias.
    pub diagonals: FlatDiagonals,
    /// Fibers along the warp.
    pub fibers: FlatFibers,
    /// Fibers by index list.
    pub lists: FlatLists,
    /// Bending.
    pub bending: FlatBending,
    /// Triangles and normals, for garments that are drawn.
    pub faces: FlatFaces,
    /// Triangles in the wind.
    pub wind: FlatWind,
}

impl Flat {
    /// Lays garments flat; `colliders` say which capsules are which limb's.
    pub fn new(garments: &[&Garment], colliders: &[&Colliders]) -> Self {
        let mut order: Vec<usize> = (0..garments.len()).collect();
        // By what they ask for at their own pace: any settings keep this order.
        order.sort_by_key(|&k| (std::cmp::Reverse(garments[k].substeps), k));
        let mut flat = Self { order: order.clone(), ..Self::default() };
        for (number, &k) in order.iter().enumerate() {
            flat.add(number as u32, garments[k]);
            flat.reach.extend(garments[k].parts.iter().map(|&part| reach(part, colliders[k])));
        }
        flat
    }

    /// Adds what normals are computed from, for drawing.
    pub fn draw(&mut self, garments: &[&Garment]) {
        for (span, &k) in self.spans.iter().zip(&self.order) {
            self.faces.add(garments[k], *span);
        }
    }

    fn add(&mut self, number: u32, garment: &Garment) {
        let span = GarmentSpan { garment: number, first: self.particles, len: garment.particles() as u32 };
        let (layout, weights) = (garment.layout(), &garment.inverse_mass);
        self.start.extend(garment.start.iter().zip(weights).map(|(p, w)| [p.x, p.y, p.z, *w]));
        self.pins_from.push(self.targets);
        let mut pins = vec![FREE; garment.particles()];
        for (k, &i) in garment.fixed.iter().enumerate() {
            pins[i as usize] = self.targets + k as u32;
        }
        self.pins.extend(pins);
        self.targets += garment.fixed.len() as u32;
        let tethers = layout.tethers.anchor.iter().zip(&layout.tethers.length);
        self.tethers.extend(tethers.map(|(a, l)| [span.first + a, l.to_bits()]));
        self.scattered.push(layout.is_scattered());
        self.everyone.add(number, span.first, span.len, 0);
        self.shear.add(&layout.shear, weights, span, 0);
        self.weft.add(&layout.weft, weights, span, SOFT_WEFT);
        self.diagonals.add(&layout.diagonals, weights, span);
        self.fibers.add(&layout.fibers, span);
        self.lists.add(&layout.crossing, span);
        self.bending.add(&BendingMatrix::new(garment), span);
        self.wind.add(garment, span);
        self.particles += span.len;
        self.spans.push(span);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_assets::scene::skirt::{self, Stretch};
    use toile_bake::bake;

    /// Two skirts, laid flat.
    fn skirts() -> (Garment, Flat) {
        let shape = skirt::shape(21);
        let garment = bake("skirt", "one", &shape, &skirt::fabric(&shape, Stretch::Physical)).expect("it bakes");
        let no_body = Colliders::new(&[], &[], false).expect("nothing is not too much");
        let flat = Flat::new(&[&garment, &garment], &[&no_body, &no_body]);
        (garment, flat)
    }

    /// The items of some workgroups.
    fn items(groups: &Workgroups) -> impl Iterator<Item = usize> {
        groups.groups.iter().flat_map(|g| g[1] as usize..(g[1] + g[2]) as usize)
    }

    fn once(particles: u32, moved: impl Iterator<Item = u32>) {
        let mut seen = vec![false; particles as usize];
        for p in moved {
            assert!(!std::mem::replace(&mut seen[p as usize], true), "particle {p} is moved twice in a dispatch");
        }
    }

    #[test]
    fn no_two_invocations_of_a_dispatch_move_one_particle() {
        let (_, flat) = skirts();
        for links in [&flat.shear, &flat.weft] {
            for half in &links.halves {
                once(flat.particles, items(half).flat_map(|k| [links.ends[k][0], links.ends[k][1]]));
            }
        }
        for family in &flat.diagonals.families {
            let fiber = |k: usize| {
                let [start, slot, links, apart] = flat.diagonals.heads[k];
                let leads = &flat.diagonals.leads;
                std::iter::once(start).chain((0..links).map(move |l| leads[(slot + l * apart) as usize]))
            };
            once(flat.particles, items(family).flat_map(fiber));
        }
        let fibers = &flat.fibers;
        let rows = fibers.bundles.iter().flat_map(|b| &fibers.rows[b[2] as usize..(b[2] + b[3]) as usize]);
        once(flat.particles, rows.flat_map(|r| r[0]..r[0] + r[1]));
    }

    #[test]
    fn no_two_fibers_of_a_set_share_a_particle() {
        // Triangles that lie anyhow have their fibers by index list.
        let shape = skirt::irregular(14, 1);
        let garment = bake("skirt", "one", &shape, &skirt::fabric(&shape, Stretch::Physical)).expect("it bakes");
        let no_body = Colliders::new(&[], &[], false).expect("nothing is not too much");
        let flat = Flat::new(&[&garment, &garment], &[&no_body, &no_body]);
        assert!(!flat.lists.heads.is_empty(), "none of its fibers crosses another");
        for set in &flat.lists.sets {
            let fiber = |k: usize| {
                let head = flat.lists.heads[k];
                (0..head[2]).map(move |row| (head[0] + row * head[1]) as usize)
            };
            once(flat.particles, items(set).flat_map(fiber).map(|at| flat.lists.index[at]));
        }
    }

    #[test]
    fn nothing_of_a_bake_is_lost() {
        let (garment, flat) = skirts();
        let layout = garment.layout();
        let count = |halves: &[Workgroups]| halves.iter().flat_map(items).count();
        assert_eq!(count(&flat.weft.halves), 2 * layout.weft.tuples.count);
        assert_eq!(count(&flat.shear.halves), 2 * layout.shear.tuples.count);
        let links: u32 = flat.diagonals.heads.iter().map(|h| h[2]).sum();
        assert_eq!(links as usize, 2 * layout.diagonals.count());
        let mut entries = 0;
        BendingMatrix::new(&garment).for_each_row(|_, row| entries += row.count());
        assert!(entries > 0 && flat.bending.entries.len() == 2 * entries);
        assert_eq!(flat.bending.starts.len(), flat.particles as usize + 1);
        assert_eq!(flat.targets as usize, 2 * garment.fixed.len());
        assert_eq!(items(&flat.wind.groups).count(), 2 * garment.triangles.len());
        assert_eq!(flat.wind.starts.len(), flat.particles as usize + 1);
        for (i, around) in flat.wind.starts.windows(2).enumerate() {
            let around = &flat.wind.around[around[0] as usize..around[1] as usize];
            let corners = flat.wind.faces.iter().filter(|f| f[..3].contains(&(i as u32)));
            assert_eq!(around.len(), corners.count(), "particle {i}");
            assert!(around.iter().all(|f| flat.wind.faces[*f as usize][..3].contains(&(i as u32))));
        }
    }

    #[test]
    fn the_first_garments_groups_are_a_prefix() {
        let mut groups = Workgroups::default();
        groups.add(0, 0, 130, 7);
        groups.add(2, 200, 64, 7);
        assert_eq!(groups.groups, [[0, 0, 64, 7], [0, 64, 64, 7], [0, 128, 2, 7], [2, 200, 64, 7]]);
        assert_eq!([0, 1, 2, 3, 9].map(|n| groups.of(n)), [0, 3, 3, 4, 4]);
        assert_eq!(Workgroups::default().of(3), 0);
        let others = groups.without(&[true, false, false]);
        assert_eq!(others.groups, [[2, 200, 64, 7]]);
        assert_eq!([0, 1, 2, 3, 9].map(|n| others.of(n)), [0, 0, 0, 1, 1]);
        assert_eq!(groups.without(&[false; 3]), groups);
    }
}
