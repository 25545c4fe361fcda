//! What the kernels of the cloth trust about a garment, checked once when it is put together.
//!
//! Two workers step one garment. They write to the same arrays without a lock, so no particle may be written by both at
//! once: each particle has one owner, and within a set of constraints the two owners' particles are apart. Kernels take
//! many constraints at a time, so the constraints of a set share no particle either, except along a zigzag or a fiber, which
//! is walked in order.

use std::ops::Range;

use thiserror::Error;

use super::data::GarmentData;
use super::layout::{ConstraintSet, Diagonals, FiberLists, Fibers, Layout, Links, OWNERS, Tuples};
use super::link_curves::CurveTable;
use super::tuck::Tuck;
use crate::skeleton::BONES;

/// Why constraints and particles do not make a garment. Numbers count from 0.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum LayoutError {
    /// An array does not have the length that the others ask for.
    #[error("{what} has {found} entries and needs {needed}; bake the garment again")]
    Length {
        /// The array.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that it needs.
        needed: usize,
    },
    /// An index or a range leads past the end of what it points into.
    #[error("{what} leads to place {found} of only {count}; bake the garment again")]
    Bounds {
        /// The array that holds the index.
        what: &'static str,
        /// The place that it leads to.
        found: usize,
        /// The number of places.
        count: usize,
    },
    /// A particle that no owner has, or two, or another one than the layout says.
    #[error("particle {particle} does not have one owner; bake the garment again")]
    Owner {
        /// The particle.
        particle: usize,
    },
    /// A tether is anchored at a particle that can move.
    #[error("the tether of particle {particle} is anchored at a particle that can move; bake the garment again")]
    Anchor {
        /// The particle that is tethered.
        particle: usize,
    },
    /// Two owners write to the same place of a column.
    #[error("two owners have place {place} of {what}; bake the garment again")]
    Place {
        /// The kind of constraint.
        what: &'static str,
        /// The place.
        place: usize,
    },
    /// Two constraints that are solved at once hold the same particle.
    #[error("two constraints of set {set} of {what} hold particle {particle} at once; bake the garment again")]
    Shared {
        /// The kind of constraint.
        what: &'static str,
        /// The set.
        set: usize,
        /// The particle.
        particle: usize,
    },
}

/// Checks a garment's constraints against its particles.
pub(super) fn check(data: &GarmentData, layout: &Layout) -> Result<(), LayoutError> {
    let n = data.start.len();
    lengths(data, layout)?;
    owners(layout, n)?;
    let mut marks = Marks { seen: vec![0; n], group: 0 };
    links("shear", &layout.shear, &mut marks)?;
    links("weft", &layout.weft, &mut marks)?;
    diagonals(&layout.diagonals, &mut marks)?;
    fibers(&layout.fibers, &mut marks)?;
    lists(&layout.crossing, &mut marks)?;
    bends(layout, n)?;
    link_curves(layout)
}

fn length(what: &'static str, found: usize, needed: usize) -> Result<(), LayoutError> {
    if found == needed { Ok(()) } else { Err(LayoutError::Length { what, found, needed }) }
}

/// A tuck says of each particle whether it is tucked in.
pub(super) fn tuck(tuck: &Tuck, particles: usize) -> Result<(), LayoutError> {
    length("tuck.particles", tuck.particles.len(), particles)
}

/// Checks that the end of a range or the place after an index lies within `count`.
fn bound(what: &'static str, end: usize, count: usize) -> Result<(), LayoutError> {
    if end <= count { Ok(()) } else { Err(LayoutError::Bounds { what, found: end.saturating_sub(1), count }) }
}

fn range(what: &'static str, range: &Range<u32>, count: usize) -> Result<Range<usize>, LayoutError> {
    bound(what, range.end.max(range.start) as usize, count)?;
    Ok(range.start as usize..range.end as usize)
}

fn lengths(data: &GarmentData, layout: &Layout) -> Result<(), LayoutError> {
    let n = data.start.len();
    length("source", data.source.len(), n)?;
    length("inverse_mass", data.inverse_mass.len(), n)?;
    length("parts", data.parts.len(), n)?;
    length("owner", layout.owner.len(), n)?;
    length("fixed_weights", data.fixed_weights.len(), data.fixed.len())?;
    length("tethers.length", layout.tethers.length.len(), layout.tethers.anchor.len())?;
    if !layout.tethers.anchor.is_empty() {
        length("tethers.anchor", layout.tethers.anchor.len(), n)?;
    }
    if let Some(of) = &data.tuck {
        tuck(of, n)?;
    }
    let all = |what, mut indices: Box<dyn Iterator<Item = u32> + '_>| {
        indices.try_for_each(|i| bound(what, i as usize + 1, n))
    };
    all("triangles", Box::new(data.triangles.iter().flatten().copied()))?;
    all("fixed", Box::new(data.fixed.iter().copied()))?;
    let mut bones = data.fixed_weights.iter().flat_map(|w| w.bones);
    bones.try_for_each(|bone| bound("fixed_weights", usize::from(bone) + 1, BONES))?;
    all("strain_edges", Box::new(data.strain_edges.iter().flat_map(|(ends, _)| *ends)))?;
    all("hoop_edges", Box::new(data.hoop_edges.iter().flat_map(|(ends, _)| *ends)))?;
    all("tethers.anchor", Box::new(layout.tethers.anchor.iter().copied()))?;
    // A tether reads its anchor while the other owner moves its own particles.
    let mut tethers = layout.tethers.anchor.iter().zip(&layout.tethers.length);
    let loose = tethers.position(|(anchor, length)| *length > 0.0 && data.inverse_mass[*anchor as usize] > 0.0);
    loose.map_or(Ok(()), |particle| Err(LayoutError::Anchor { particle }))
}

/// The owner of each place of a column, where it has one.
struct PlaceOwners {
    what: &'static str,
    owner: Vec<Option<usize>>,
}

impl PlaceOwners {
    fn new(what: &'static str, places: usize) -> Self {
        Self { what, owner: vec![None; places] }
    }

    /// Gives places to an owner; refuses places that another owner has.
    fn take(&mut self, first: u32, len: u32, owner: usize) -> Result<(), LayoutError> {
        let (first, len, what) = (first as usize, len as usize, self.what);
        bound(what, first + len, self.owner.len())?;
        for (k, place) in self.owner[first..first + len].iter_mut().enumerate() {
            if place.replace(owner).is_some_and(|other| other != owner) {
                return Err(LayoutError::Place { what, place: first + k });
            }
        }
        Ok(())
    }
}

/// Each particle lies in one span, and its owner is the one that the span belongs to.
fn owners(layout: &Layout, n: usize) -> Result<(), LayoutError> {
    let mut spans = vec![false; n];
    for (owner, all) in layout.spans.iter().enumerate() {
        for &(first, len) in all {
            let (first, len) = (first as usize, len as usize);
            bound("spans", first + len, n)?;
            for (k, taken) in spans[first..first + len].iter_mut().enumerate() {
                if *taken || usize::from(layout.owner[first + k]) != owner {
                    return Err(LayoutError::Owner { particle: first + k });
                }
                *taken = true;
            }
        }
    }
    spans.iter().position(|s| !s).map_or(Ok(()), |particle| Err(LayoutError::Owner { particle }))
}

/// The group that last held each particle. A group is what may share particles: one constraint, one zigzag, one owner's fibers.
struct Marks {
    seen: Vec<u32>,
    group: u32,
}

impl Marks {
    /// Begins a set: groups from the returned one on belong to it.
    fn set(&mut self) -> u32 {
        self.group += 1;
        self.group
    }

    /// Marks a particle for the present group of the set that began with `first`; false where another group of it holds it.
    fn take(&mut self, first: u32, particle: usize) -> bool {
        let before = std::mem::replace(&mut self.seen[particle], self.group);
        before < first || before == self.group
    }
}

/// Calls `group` for every group of a set's share: its constraints by particles, each a group of its own, or a zigzag.
fn share_groups<const K: usize>(
    what: &'static str,
    tuples: &Tuples<K>,
    set: &ConstraintSet,
    mut group: impl FnMut(&[[u32; K]]) -> Result<(), LayoutError>,
) -> Result<(), LayoutError> {
    let mut constraints = Vec::new();
    for share in &set.shares {
        for zigzag in &tuples.zigzags[range(what, &share.zigzags, tuples.zigzags.len())?] {
            let pair = |pair: [u32; 2]| std::array::from_fn(|k| pair[k % 2]);
            constraints.clear();
            constraints
                .extend((0..zigzag.straights.len).map(|t| pair(zigzag.straights.first.map(|f| f.saturating_add(t)))));
            constraints.extend((0..zigzag.slants.len).map(|t| pair(zigzag.slant(t))));
            group(&constraints)?;
        }
        for run in &tuples.runs[range(what, &share.runs, tuples.runs.len())?] {
            (0..run.len).try_for_each(|t| group(&[run.first.map(|f| f.saturating_add(t))]))?;
        }
        let loose = range(what, &share.loose, tuples.loose.len())?;
        bound(what, share.loose_at as usize + loose.len(), tuples.places)?;
        tuples.loose[loose].iter().try_for_each(|particles| group(&[*particles]))?;
    }
    Ok(())
}

/// Checks the places of parameters of runs and zigzags.
fn places<const K: usize>(what: &'static str, tuples: &Tuples<K>) -> Result<(), LayoutError> {
    let end = |at: u32, len: u32, alike: bool| at as usize + if alike { 1 } else { len as usize };
    for run in &tuples.runs {
        bound(what, end(run.at, run.len, run.alike), tuples.places)?;
        bound(what, run.serial as usize + run.len as usize, tuples.count)?;
    }
    for run in tuples.zigzags.iter().flat_map(|z| [&z.straights, &z.slants]) {
        bound(what, end(run.at, run.len, run.alike), tuples.places)?;
        bound(what, run.serial as usize + run.len as usize, tuples.count)?;
    }
    Ok(())
}

/// Each link's tension and each place of its parameters is one owner's.
fn links_apart(what: &'static str, tuples: &Tuples<2>) -> Result<(), LayoutError> {
    let (mut serials, mut places) = (PlaceOwners::new(what, tuples.count), PlaceOwners::new(what, tuples.places));
    for set in &tuples.sets {
        for (owner, share) in set.shares.iter().enumerate() {
            let zigzags = &tuples.zigzags[range(what, &share.zigzags, tuples.zigzags.len())?];
            let runs = &tuples.runs[range(what, &share.runs, tuples.runs.len())?];
            for run in zigzags.iter().flat_map(|z| [&z.straights, &z.slants]).chain(runs) {
                serials.take(run.serial, run.len, owner)?;
                places.take(run.at, if run.alike { 1 } else { run.len }, owner)?;
            }
            let loose = share.loose.len() as u32;
            serials.take(share.loose_serial, loose, owner)?;
            places.take(share.loose_at, loose, owner)?;
        }
    }
    Ok(())
}

fn links(what: &'static str, links: &Links, marks: &mut Marks) -> Result<(), LayoutError> {
    let tuples = &links.tuples;
    length(what, links.rest.len(), tuples.places)?;
    length(what, links.compliance.len(), tuples.places)?;
    places(what, tuples)?;
    links_apart(what, tuples)?;
    let n = marks.seen.len();
    for (number, set) in tuples.sets.iter().enumerate() {
        let first = marks.set();
        share_groups(what, tuples, set, |group| {
            marks.set();
            for particle in group.iter().flatten().map(|p| *p as usize) {
                bound(what, particle + 1, n)?;
                if !marks.take(first, particle) {
                    return Err(LayoutError::Shared { what, set: number, particle });
                }
            }
            Ok(())
        })?;
    }
    Ok(())
}

fn diagonals(diagonals: &Diagonals, marks: &mut Marks) -> Result<(), LayoutError> {
    const WHAT: &str = "diagonals";
    length(WHAT, diagonals.compliance.len(), diagonals.rest.len())?;
    let (n, mut places) = (marks.seen.len(), PlaceOwners::new(WHAT, diagonals.rest.len()));
    for (number, family) in diagonals.families.iter().enumerate() {
        let first = marks.set();
        for (owner, share) in family.iter().enumerate() {
            // One owner walks all of its fibers: they are one group.
            marks.set();
            let starts = &diagonals.starts[range(WHAT, &share.starts, diagonals.starts.len())?];
            let mut held: Vec<usize> = starts.iter().map(|p| *p as usize).collect();
            for run in &diagonals.runs[range(WHAT, &share.runs, diagonals.runs.len())?] {
                places.take(run.at, if run.alike { 1 } else { run.len }, owner)?;
                let ends = run.first.map(|f| f as usize..f as usize + run.len as usize);
                held.extend(ends.into_iter().flatten());
            }
            for particle in held {
                bound(WHAT, particle + 1, n)?;
                if !marks.take(first, particle) {
                    return Err(LayoutError::Shared { what: WHAT, set: number, particle });
                }
            }
        }
    }
    Ok(())
}

fn fibers(fibers: &Fibers, marks: &mut Marks) -> Result<(), LayoutError> {
    const WHAT: &str = "fibers";
    length(WHAT, fibers.compliance.len(), fibers.rest.len())?;
    let n = marks.seen.len();
    let (mut serials, mut places) = (PlaceOwners::new(WHAT, fibers.links), PlaceOwners::new(WHAT, fibers.rest.len()));
    let first = marks.set();
    for owner in 0..OWNERS {
        marks.set();
        for bundle in fibers.bundles.iter().filter(|b| usize::from(b.owner) == owner) {
            let rows = &fibers.rows[range(WHAT, &bundle.rows, fibers.rows.len())?];
            let links = rows.len().saturating_sub(1);
            let links = links as u32;
            // Saturating: a product that wraps would pass the bound.
            let all = links.saturating_mul(bundle.lanes);
            serials.take(bundle.serial, all, owner)?;
            places.take(bundle.at, if bundle.alike { links } else { all }, owner)?;
            for row in rows {
                bound(WHAT, row.lanes as usize, bundle.lanes as usize)?;
                for particle in row.first as usize..row.first as usize + row.lanes as usize {
                    bound(WHAT, particle + 1, n)?;
                    if !marks.take(first, particle) {
                        return Err(LayoutError::Shared { what: WHAT, set: 0, particle });
                    }
                }
            }
        }
    }
    let stray = fibers.bundles.iter().find(|b| usize::from(b.owner) >= OWNERS);
    stray.map_or(Ok(()), |b| bound(WHAT, usize::from(b.owner) + 1, OWNERS))
}

/// Fewest particles of a fiber by index list: two, which one link joins.
const LEAST_ROWS: usize = 2;

fn lists(lists: &FiberLists, marks: &mut Marks) -> Result<(), LayoutError> {
    const WHAT: &str = "crossing";
    length(WHAT, lists.compliance.len(), lists.rest.len())?;
    let (n, mut places) = (marks.seen.len(), PlaceOwners::new(WHAT, lists.rest.len()));
    for (number, set) in lists.sets.iter().enumerate() {
        let first = marks.set();
        for (owner, share) in set.iter().enumerate() {
            for list in &lists.lists[range(WHAT, share, lists.lists.len())?] {
                let (lanes, rows) = (list.lanes as usize, list.rows as usize);
                // The solver eliminates from the first link to the last one, so a fiber has one at least.
                if rows < LEAST_ROWS {
                    return Err(LayoutError::Length { what: "a fiber of crossing", found: rows, needed: LEAST_ROWS });
                }
                bound(WHAT, list.first as usize + lanes * rows, lists.index.len())?;
                places.take(list.at, list.lanes.saturating_mul(list.links()), owner)?;
                for lane in 0..lanes {
                    // A fiber may come back to its own first particle; lanes are apart.
                    marks.set();
                    for particle in (0..rows).map(|row| lists.index[list.first as usize + row * lanes + lane] as usize)
                    {
                        bound(WHAT, particle + 1, n)?;
                        if !marks.take(first, particle) {
                            return Err(LayoutError::Shared { what: WHAT, set: number, particle });
                        }
                    }
                }
            }
        }
    }
    Ok(())
}

/// Bending only adds forces to the particles of one owner at a time, so its sets may share particles.
fn bends(layout: &Layout, n: usize) -> Result<(), LayoutError> {
    fn stencils<const K: usize>(
        what: &'static str,
        tuples: &Tuples<K>,
        coefficients: &[Box<[f32]>; K],
        n: usize,
    ) -> Result<(), LayoutError> {
        coefficients.iter().try_for_each(|c| length(what, c.len(), tuples.places))?;
        places(what, tuples)?;
        for set in &tuples.sets {
            share_groups(what, tuples, set, |group| {
                group.iter().flatten().try_for_each(|p| bound(what, *p as usize + 1, n))
            })?;
        }
        Ok(())
    }
    stencils("bends", &layout.bends.tuples, &layout.bends.coefficients, n)?;
    stencils("skewed", &layout.skewed.tuples, &layout.skewed.coefficients, n)?;
    let hubs = &layout.hubs;
    for group in &hubs.groups {
        let (points, count) = (group.points as usize, group.count as usize);
        bound("hubs", group.particles as usize + points * count, hubs.particles.len())?;
        bound("hubs", group.coefficients as usize + points * group.sums as usize * count, hubs.coefficients.len())?;
        bound("hubs", group.number as usize + count, hubs.count)?;
    }
    hubs.sets.iter().flatten().try_for_each(|set| range("hubs", set, hubs.groups.len()).map(|_| ()))?;
    hubs.particles.iter().try_for_each(|p| bound("hubs", *p as usize + 1, n))?;
    let friction = &layout.friction;
    length("friction", friction.coefficients.len(), friction.particles.len())?;
    for slot in &friction.slots {
        bound("friction", slot.first as usize + slot.len as usize, friction.particles.len())?;
        slot.chords.iter().chain([&slot.centre]).try_for_each(|p| bound("friction", *p as usize + 1, n))?;
    }
    friction.particles.iter().try_for_each(|p| bound("friction", *p as usize + 1, n))
}

/// A table of stretch curves is empty, or has one row for each place of parameters.
fn link_curves(layout: &Layout) -> Result<(), LayoutError> {
    let link_curves = &layout.link_curves;
    let of = |what: &'static str, table: &CurveTable, places: usize| {
        let columns = [&table.lower, &table.lower_slope, &table.upper, &table.upper_slope, &table.friction];
        let needed = if table.is_empty() { 0 } else { places };
        columns.into_iter().try_for_each(|column| length(what, column.len(), needed))
    };
    of("link_curves.diagonals", &link_curves.diagonals, layout.diagonals.rest.len())?;
    of("link_curves.shear", &link_curves.shear, layout.shear.rest.len())?;
    of("link_curves.weft", &link_curves.weft, layout.weft.rest.len())?;
    of("link_curves.fibers", &link_curves.fibers, layout.fibers.rest.len())?;
    of("link_curves.crossing", &link_curves.crossing, layout.crossing.rest.len())
}
