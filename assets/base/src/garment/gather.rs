//! Gathering: cloth that is tucked in is narrowed to the way around that it is laid at, as pleats narrow it, and not pressed
//! together. A shirt is wider than the waistband that it goes into; with its full width it would come out of it in bulges.

use std::sync::Arc;

use glam::Vec3;

use super::baked::Garment;
use super::check;
use super::data::GarmentData;
use super::direction::Direction;
use super::layout::{ConstraintRun, Diagonals, FiberLists, Links};
use super::part::Part;
use super::tuck::{SLIPS_M, Tuck};

/// Cloth is not gathered to less than this share of its width (1).
const LEAST_WIDTH: f32 = 0.5;

/// Above the waistband cloth gets its full width back over this length (m): in one row it would be a shelf that hangs over.
pub const WIDENS_M: f32 = 0.08;

/// How far below the waistband it is seen how much is gathered there (m).
const SEEN_M: f32 = 0.04;

/// Where tucked cloth lies.
struct Laid<'a> {
    start: &'a [Vec3],
    parts: &'a [Part],
    tuck: &'a Tuck,
    /// Width at the waistband as a share of what was cut (1).
    width: f32,
}

impl<'a> Laid<'a> {
    fn new(garment: &'a Garment, tuck: &'a Tuck) -> Self {
        let mut laid = Self { start: &garment.start, parts: &garment.parts, tuck, width: 1.0 };
        let near = |(ends, _): &&([u32; 2], f32)| laid.are_inside(*ends) && laid.above_band(*ends) > -SEEN_M;
        let lengths = garment.hoop_edges.iter().filter(near).map(|(ends, rest)| [laid.length(*ends), *rest]);
        let [now, cut] = lengths.fold([0.0; 2], |[a, b], [now, cut]| [a + now, b + cut]);
        laid.width = if cut > 0.0 { (now / cut).clamp(LEAST_WIDTH, 1.0) } else { 1.0 };
        laid
    }

    fn length(&self, [a, b]: [u32; 2]) -> f32 {
        self.start[a as usize].distance(self.start[b as usize])
    }

    /// How far above the waistband the higher of two particles starts (m).
    fn above_band(&self, [a, b]: [u32; 2]) -> f32 {
        self.start[a as usize].y.max(self.start[b as usize].y) - self.tuck.band
    }

    /// Whether both particles of a link lie below the waistband.
    fn are_inside(&self, ends: [u32; 2]) -> bool {
        ends.iter().all(|&v| self.tuck.particles[v as usize]) && self.above_band(ends) <= 0.0
    }

    /// Length of a link between two particles (m), which is `rest` as cut.
    fn gathered(&self, ends: [u32; 2], rest: f32) -> f32 {
        if self.are_inside(ends) {
            return rest.min(self.length(ends)).max(LEAST_WIDTH * rest);
        }
        let is_sleeve = ends.iter().any(|&v| matches!(self.parts[v as usize], Part::LeftArm | Part::RightArm));
        let above = self.above_band(ends) - SLIPS_M;
        if is_sleeve || above >= WIDENS_M {
            return rest;
        }
        rest * (self.width + (1.0 - self.width) * (above / WIDENS_M).max(0.0))
    }
}

impl Garment {
    /// Shortens what runs across the warp in the tucked part to what it is where it starts; nothing where nothing is tucked. At
    /// load.
    pub fn gather(&mut self) {
        let Some(tuck) = self.tuck.clone() else { return };
        let (own, parts) = (self.start.clone(), self.parts.clone());
        let width = Laid::new(self, &tuck).width;
        let laid = Laid { start: &own, parts: &parts, tuck: &tuck, width };
        let Self { layout, data: GarmentData { strain_edges, hoop_edges, .. } } = self;
        // Of a garment that anything else holds, the constraints become others: a cloth that was made of them does not take these.
        let layout = Arc::make_mut(layout);
        for links in [&mut layout.weft, &mut layout.shear] {
            unshare(links);
            let rest = &mut links.rest;
            links.tuples.for_each(|at, ends| rest[at] = laid.gathered(ends, rest[at]));
        }
        gather_diagonals(&mut layout.diagonals, &laid);
        gather_lists(&mut layout.crossing, &laid);
        // What is measured along the weft; the warp has the length that it was cut with.
        let hoops: std::collections::HashSet<[u32; 2]> = hoop_edges.iter().map(|(ends, _)| *ends).collect();
        let weft = strain_edges.iter_mut().filter(|(ends, _)| hoops.contains(ends));
        weft.chain(hoop_edges.iter_mut()).for_each(|(ends, rest)| *rest = laid.gathered(*ends, *rest));
        debug_assert_eq!(
            check::check(&self.data, &self.layout),
            Ok(()),
            "lengths change, and no place and no particle"
        );
    }
}

/// Parameters that links get of their own, in their order.
#[derive(Default)]
struct OwnParameters {
    rest: Vec<f32>,
    compliance: Vec<f32>,
}

impl OwnParameters {
    /// Takes those at some places; gives where the first of them now is.
    fn take(&mut self, places: impl Iterator<Item = usize>, rest: &[f32], compliance: &[f32]) -> u32 {
        let first = self.rest.len() as u32;
        for place in places {
            self.rest.push(rest[place]);
            self.compliance.push(compliance[place]);
        }
        first
    }

    fn take_run(&mut self, run: &mut ConstraintRun<2>, rest: &[f32], compliance: &[f32]) {
        let was = *run;
        run.at = self.take((0..was.len).map(|t| was.place(t)), rest, compliance);
        run.alike = false;
    }
}

/// Gives each link parameters of its own.
fn unshare(links: &mut Links) {
    let Links { tuples, rest, compliance } = links;
    let mut own = OwnParameters::default();
    for zigzag in &mut tuples.zigzags {
        own.take_run(&mut zigzag.straights, rest, compliance);
        own.take_run(&mut zigzag.slants, rest, compliance);
    }
    tuples.runs.iter_mut().for_each(|run| own.take_run(run, rest, compliance));
    for share in tuples.sets.iter_mut().flat_map(|set| &mut set.shares) {
        let first = share.loose_at as usize;
        share.loose_at = own.take(first..first + share.loose.len(), rest, compliance);
    }
    tuples.places = own.rest.len();
    (*rest, *compliance) = (own.rest.into(), own.compliance.into());
}

fn gather_diagonals(diagonals: &mut Diagonals, laid: &Laid<'_>) {
    let Diagonals { runs, rest, compliance, .. } = diagonals;
    let mut own = OwnParameters::default();
    runs.iter_mut().for_each(|run| own.take_run(run, rest, compliance));
    (*rest, *compliance) = (own.rest.into(), own.compliance.into());
    for run in &*runs {
        for t in 0..run.len {
            let at = run.place(t);
            rest[at] = laid.gathered(run.first.map(|f| f + t), rest[at]);
        }
    }
}

fn gather_lists(lists: &mut FiberLists, laid: &Laid<'_>) {
    for list in lists.lists.iter().filter(|list| list.direction != Direction::Warp) {
        for (link, lane) in (0..list.links()).flat_map(|link| (0..list.lanes).map(move |lane| (link, lane))) {
            let particle = |row: u32| lists.index[(list.first + row % list.rows * list.lanes + lane) as usize];
            let at = (list.at + link * list.lanes + lane) as usize;
            lists.rest[at] = laid.gathered([particle(link), particle(link + 1)], lists.rest[at]);
        }
    }
}
