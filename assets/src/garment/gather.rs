//! Gathering: cloth that is tucked in is narrowed to the way around that it is laid at, as pleats narrow it, and not pressed
//! together. A shirt is wider than the waistband that it goes into; with its full width it would come out of it in bulges.

use super::layout::{ConstraintRun, Diagonals, FiberLists, Links};
use super::{Direction, Garment};
use glam::Vec3;

/// Cloth is not gathered to less than this share of its width (1).
const LEAST_WIDTH: f32 = 0.5;

/// Where tucked cloth lies.
struct Laid<'a> {
    start: &'a [Vec3],
    tucked: &'a [bool],
}

impl Laid<'_> {
    /// Length of a link between two particles (m), which is `rest` as cut.
    fn gathered(&self, [a, b]: [u32; 2], rest: f32) -> f32 {
        let [a, b] = [a as usize, b as usize];
        if !(self.tucked[a] && self.tucked[b]) {
            return rest;
        }
        rest.min(self.start[a].distance(self.start[b])).max(LEAST_WIDTH * rest)
    }
}

impl Garment {
    /// Shortens what runs across the warp in the tucked part to what it is where it starts; nothing where nothing is tucked. At
    /// load.
    pub fn gather(&mut self) {
        let Self { tuck: Some(tuck), start, layout, strain_edges, hoop_edges, .. } = self else { return };
        let laid = Laid { start, tucked: &tuck.particles };
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

#[cfg(test)]
mod tests {
    use crate::body::{Body, Measures, Sex};
    use crate::garment::Tuck;
    use crate::wardrobe;

    #[test]
    fn what_is_tucked_in_gets_the_width_at_which_it_lies_and_the_rest_keeps_its_own() {
        let shopper = Body::build(Sex::Female, &Measures::average(Sex::Female)).unwrap();
        let shirt = wardrobe::style("t-shirt").unwrap().dress("M", &shopper).unwrap();
        let mut same = shirt.clone();
        same.gather();
        assert_eq!(same, shirt, "nothing is tucked in");
        let hem = shopper.levels.waist - 0.05;
        let mut tucked = shirt.clone();
        let particles: Box<[bool]> = shirt.start.iter().map(|p| p.y < hem).collect();
        let inside = |[a, b]: [u32; 2]| particles[a as usize] && particles[b as usize];
        tucked.start.iter_mut().zip(&particles).filter(|(_, inside)| **inside).for_each(|(p, _)| {
            (p.x, p.z) = (0.8 * p.x, 0.8 * p.z);
        });
        tucked.tuck = Some(Tuck { into: 0, particles: particles.clone() });
        tucked.gather();
        // The shirt starts a little wider or narrower than it is cut, because this shopper is not of its size.
        let as_cut = |garment: &crate::garment::Garment| {
            let of = |within: bool| {
                let links = garment.hoop_edges.iter().filter(|(ends, _)| inside(*ends) == within);
                links.map(|(_, rest)| *rest).sum::<f32>()
            };
            [of(true), of(false)]
        };
        let ([before, rest], [after, kept]) = (as_cut(&shirt), as_cut(&tucked));
        assert!((0.7..0.95).contains(&(after / before)) && rest == kept, "{before} {after} {rest} {kept}");
        // The layout has them too: as many links, each as long as before or shorter.
        let lengths = |garment: &crate::garment::Garment| {
            let mut all = Vec::new();
            let links = &garment.layout.weft;
            links.tuples.for_each(|at, ends| all.push((ends, links.rest[at], links.compliance[at])));
            all
        };
        let (old, new) = (lengths(&shirt), lengths(&tucked));
        assert_eq!(old.len(), new.len());
        for ((ends, was, soft), (same_ends, is, same_soft)) in old.into_iter().zip(new) {
            assert_eq!((ends, soft), (same_ends, same_soft));
            assert!(is <= was && (inside(ends) || is == was), "{ends:?}: {was} became {is}");
        }
    }
}
