//! Scenario: the shoppers of a run with their times, clothes and movements, and the faults; all of it from a seed.

use std::f64::consts::TAU;

use glam::Vec3;
use toile_assets::drafting;
use toile_assets::scene;
use toile_assets::sizes::{Population, SizeTable};
use toile_base::body::{Measures, Sex};
use toile_base::clock::SECOND_NS;
use toile_base::numeric::random::SplitMix64;
use toile_base::skeleton::{JOINTS, Skeleton};
use toile_engine::body::JointFrames;

use super::error::SoakError;
use super::fault_kind::FaultKind;
use super::options::{LEAST_APART_S, SoakOutfit, SoakPlan};

/// Length of a visit (s), least and most.
const VISIT_S: [f32; 2] = [60.0, 420.0];

/// Time between two visits (s), in which the view of the camera is empty.
const GAP_S: [f32; 2] = [3.0, 20.0];

/// Time between two garments of a visit (s).
const WORN_S: [f32; 2] = [25.0, 150.0];

/// Frames of the camera each second.
pub const CAMERA_HZ: u64 = 30;

/// One fault, in time since the run's begin (ns).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SoakFault {
    /// What kind of fault it is.
    pub kind: FaultKind,
    /// When it begins (ns).
    pub from_ns: u64,
    /// When it ends (ns).
    pub until_ns: u64,
}

/// A garment to wear.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct WornSize {
    /// Its name in the wardrobe.
    pub garment: &'static str,
    /// Code of its size.
    pub size: String,
}

/// A shopper before the mirror, in time since the run's begin (ns).
#[derive(Debug, Clone, PartialEq)]
pub struct SoakVisit {
    /// When the shopper comes (ns).
    pub from_ns: u64,
    /// When the shopper goes (ns).
    pub until_ns: u64,
    /// Of which sex their body is.
    pub sex: Sex,
    /// Their measures, and those of the size that they are near to, which surely can be built.
    pub measures: [Measures; 2],
    /// Their bones as the camera's tracker has them (m).
    skeleton: Skeleton,
    /// How fast they move (1), and where they stand (m).
    pace: f64,
    place: Vec3,
}

impl SoakVisit {
    /// Where their joints are at a time, as they are in truth (m).
    pub fn joints(&self, ns: u64) -> [Vec3; JOINTS] {
        // Forth and back, because shoppers do not jump.
        let length = f64::from(scene::LENGTH_S);
        let seconds = ns.saturating_sub(self.from_ns) as f64 * 1e-9;
        let along = (seconds * self.pace) % (2.0 * length);
        let along = if along > length { 2.0 * length - along } else { along };
        let mut at = JointFrames::new(&self.skeleton, &scene::shopper(&self.skeleton, along as f32)).position;
        let sway =
            Vec3::new(0.2 * (TAU * seconds / 19.0).sin() as f32, 0.0, 0.15 * (TAU * seconds / 13.0).sin() as f32);
        at.iter_mut().for_each(|p| *p += self.place + sway);
        at
    }
}

/// A scene that is made and handed over, in time since the run's begin (ns). Its number is its place in the list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneRequest {
    /// When it is asked for: the shopper is dressed as they stand then.
    pub at_ns: u64,
    /// Whose, a place in the visits.
    pub visit: usize,
    /// What they put on, inner first.
    pub outfit: Vec<WornSize>,
    /// Whether they have just come.
    pub afresh: bool,
}

/// All visits and faults of a run, drawn from a seed.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// What was asked for.
    pub plan: SoakPlan,
    /// The shoppers, in their order; the first is there from the begin.
    pub visits: Vec<SoakVisit>,
    /// What they put on, in its order.
    pub requests: Vec<SceneRequest>,
    /// What goes wrong, in its order.
    pub faults: Vec<SoakFault>,
    /// Outfits in a size that there are to wear.
    pub outfits: usize,
}

impl Scenario {
    /// Writes it.
    ///
    /// # Errors
    /// [`SoakError::Crowded`], and a wardrobe whose tables cannot be read.
    pub fn write(plan: SoakPlan) -> Result<Self, SoakError> {
        let faults = faults(&plan)?;
        let mut rng = SplitMix64::new(plan.seed);
        let wardrobe = Wardrobe::read(plan.outfit)?;
        let (mut visits, mut requests, mut from) = (Vec::new(), Vec::new(), 0);
        let mut order: Vec<usize> = Vec::new();
        while from < plan.seconds * SECOND_NS {
            // Every garment in every size once, in an order of its own, before any comes again.
            if order.is_empty() {
                order = shuffled(wardrobe.outfits.len(), &mut rng);
            }
            let first = order.pop().unwrap_or(0);
            let visit = wardrobe.visit(first, from, &mut rng);
            let mut at = from;
            let mut outfit = wardrobe.outfits[first].worn.clone();
            while at < visit.until_ns.min(plan.seconds * SECOND_NS) {
                requests.push(SceneRequest { at_ns: at, visit: visits.len(), outfit, afresh: at == from });
                at += ns(rng.between(WORN_S[0], WORN_S[1]));
                outfit = wardrobe.near(visit.sex, &visit.measures[1], &mut rng);
            }
            from = visit.until_ns + ns(rng.between(GAP_S[0], GAP_S[1]));
            visits.push(visit);
        }
        Ok(Self { plan, visits, requests, faults, outfits: wardrobe.outfits.len() })
    }

    /// The shopper before the camera at a time; `None` if it is empty.
    pub fn visit_at(&self, ns: u64) -> Option<&SoakVisit> {
        let after = self.visits.partition_point(|v| v.from_ns <= ns);
        self.visits[..after].last().filter(|v| ns < v.until_ns)
    }

    /// The last fault that began before a time, if it goes on.
    pub fn fault_at(&self, ns: u64) -> Option<&SoakFault> {
        let after = self.faults.partition_point(|f| f.from_ns <= ns);
        self.faults[..after].last().filter(|f| ns < f.until_ns)
    }

    /// The faults of a kind, in their order.
    pub fn faults_of(&self, kind: FaultKind) -> impl Iterator<Item = &SoakFault> {
        self.faults.iter().filter(move |f| f.kind == kind)
    }
}

/// Garments in sizes that go together.
struct SizedOutfit {
    /// Which of the choices it is.
    choice: usize,
    worn: Vec<WornSize>,
    /// The body that the outermost is cut for.
    body: Measures,
    population: Population,
}

/// What there is to wear.
struct Wardrobe {
    outfits: Vec<SizedOutfit>,
    /// Bones of an average woman and of an average man.
    skeletons: [(f32, Skeleton); 2],
}

/// A garment in its sizes, smallest first, each with the body that it is cut for.
struct GarmentSizes {
    garment: &'static str,
    population: Population,
    sizes: Vec<(String, Measures)>,
}

impl GarmentSizes {
    fn read(garment: &'static str) -> Result<Self, SoakError> {
        let wrong = |e: &dyn std::fmt::Display| SoakError::Scene { number: 0, reason: e.to_string() };
        let sizes = drafting::package(garment).map_err(|e| wrong(&e))?.sizes;
        let sizes = sizes.ok_or_else(|| wrong(&"it has no sizes"))?;
        let table = SizeTable::embedded(&sizes.table).map_err(|e| wrong(&e))?;
        let body = |code: &String| table.size_body(code).map(|body| (code.clone(), body.into())).map_err(|e| wrong(&e));
        let sizes = sizes.girths.iter().map(|girths| body(&girths.size)).collect::<Result<_, _>>()?;
        Ok(Self { garment, population: table.population, sizes })
    }

    /// The size for the body nearest to these measures.
    fn nearest(&self, body: &Measures) -> WornSize {
        let size = self.sizes.iter().min_by(|a, b| apart(&a.1, body).total_cmp(&apart(&b.1, body)));
        WornSize { garment: self.garment, size: size.map_or_else(String::new, |(code, _)| code.clone()) }
    }
}

/// How far the girths by which sizes are told apart are from each other (m).
fn apart(one: &Measures, other: &Measures) -> f32 {
    (one.chest_girth - other.chest_girth).abs() + (one.hip_girth - other.hip_girth).abs()
}

impl Wardrobe {
    fn read(outfit: SoakOutfit) -> Result<Self, SoakError> {
        let wrong = |e: &dyn std::fmt::Display| SoakError::Scene { number: 0, reason: e.to_string() };
        let mut outfits = Vec::new();
        for (choice, names) in outfit.choices().into_iter().enumerate() {
            let all = names.into_iter().map(GarmentSizes::read).collect::<Result<Vec<_>, _>>()?;
            let Some(outermost) = all.last() else { continue };
            for (_, body) in &outermost.sizes {
                let worn = all.iter().map(|garment| garment.nearest(body)).collect();
                outfits.push(SizedOutfit { choice, worn, body: *body, population: outermost.population });
            }
        }
        let average = |sex| {
            let measures = Measures::average(sex);
            toile_assets::body::build(sex, &measures).map(|b| (measures.stature, b.skeleton)).map_err(|e| wrong(&e))
        };
        Ok(Self { outfits, skeletons: [average(Sex::Female)?, average(Sex::Male)?] })
    }

    /// A shopper near to the size of an outfit.
    fn visit(&self, outfit: usize, from_ns: u64, rng: &mut SplitMix64) -> SoakVisit {
        let SizedOutfit { body: near, population, .. } = &self.outfits[outfit];
        let sex = match population {
            Population::Men => Sex::Male,
            Population::Mixed if rng.uniform() < 0.5 => Sex::Male,
            _ => Sex::Female,
        };
        let mut vary = |value: f32, share: f32| value * (1.0 + share * (2.0 * rng.uniform() - 1.0));
        let own = Measures {
            stature: vary(near.stature, 0.06),
            shoulder_breadth: vary(near.shoulder_breadth, 0.02),
            chest_girth: vary(near.chest_girth, 0.02),
            waist_girth: vary(near.waist_girth, 0.03),
            hip_girth: vary(near.hip_girth, 0.02),
        };
        let (stature, average) = &self.skeletons[usize::from(sex == Sex::Male)];
        let skeleton = Skeleton { rest: average.rest.map(|p| p * (own.stature / stature)) };
        let until_ns = from_ns + ns(rng.between(VISIT_S[0], VISIT_S[1]));
        let pace = f64::from(rng.between(0.6, 1.1));
        let place = Vec3::new(rng.between(-0.4, 0.4), 0.0, rng.between(-0.3, 0.3));
        SoakVisit { from_ns, until_ns, sex, measures: [own, *near], skeleton, pace, place }
    }

    /// Something to change into: of the sizes of a choice the nearest, or one beside it.
    fn near(&self, sex: Sex, measures: &Measures, rng: &mut SplitMix64) -> Vec<WornSize> {
        let fits = |p: Population| p == Population::Mixed || (p == Population::Men) == (sex == Sex::Male);
        let mut choices: Vec<usize> = self.outfits.iter().filter(|o| fits(o.population)).map(|o| o.choice).collect();
        choices.dedup();
        let choice = *choices.get(rng.next_u64() as usize % choices.len().max(1)).unwrap_or(&0);
        let sizes: Vec<&SizedOutfit> = self.outfits.iter().filter(|o| o.choice == choice).collect();
        let off = |k: &usize| apart(&sizes[*k].body, measures);
        let nearest = (0..sizes.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
        let beside = (nearest + rng.next_u64() as usize % 3).saturating_sub(1).min(sizes.len() - 1);
        sizes[beside].worn.clone()
    }
}

/// The faults: spread over the run, each kind as often as the others.
fn faults(plan: &SoakPlan) -> Result<Vec<SoakFault>, SoakError> {
    let SoakPlan { seed, seconds, faults, .. } = *plan;
    if faults as u64 * LEAST_APART_S > seconds {
        return Err(SoakError::Crowded { faults, seconds });
    }
    let mut rng = SplitMix64::new(seed ^ 0x000f_a017);
    let apart = seconds as f64 / faults.max(1) as f64;
    let (kinds, mut order) = (FaultKind::of(plan.camera), Vec::new());
    let place = |i: usize| {
        if order.is_empty() {
            order = shuffled(kinds.len(), &mut rng);
        }
        let kind = kinds[order.pop().unwrap_or(0)];
        let begin = (i as f64 + 0.15 + 0.1 * f64::from(rng.uniform())) * apart;
        let from_ns = (begin * SECOND_NS as f64) as u64;
        SoakFault { kind, from_ns, until_ns: from_ns + ns(kind.length(&mut rng)) }
    };
    Ok((0..faults).map(place).collect())
}

fn shuffled(count: usize, rng: &mut SplitMix64) -> Vec<usize> {
    let mut all: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        all.swap(i, rng.next_u64() as usize % (i + 1));
    }
    all
}

fn ns(seconds: f32) -> u64 {
    (f64::from(seconds) * SECOND_NS as f64) as u64
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::soak::{SceneWeight, SoakCamera};

    fn plan(seed: u64, seconds: u64, faults: usize) -> SoakPlan {
        SoakPlan {
            seed,
            seconds,
            faults,
            scene: SceneWeight::Light,
            outfit: SoakOutfit::Dress,
            camera: SoakCamera::Joints,
        }
    }

    fn scenario(seed: u64) -> Scenario {
        Scenario::write(plan(seed, 8 * 3_600, 1_000)).unwrap()
    }

    #[test]
    fn eight_hours_see_every_size_and_every_fault_and_nothing_overlaps() {
        let scenario = scenario(7);
        let worn: BTreeSet<&[WornSize]> = scenario.requests.iter().map(|d| &d.outfit[..]).collect();
        assert_eq!(worn.len(), Wardrobe::read(SoakOutfit::Dress).unwrap().outfits.len());
        for kind in FaultKind::of(SoakCamera::Joints) {
            assert_eq!(scenario.faults_of(kind).count(), 50, "{kind:?}");
        }
        assert!(scenario.visits.windows(2).all(|v| v[0].until_ns + 3 * SECOND_NS <= v[1].from_ns));
        assert!(scenario.requests.windows(2).all(|d| d[0].at_ns < d[1].at_ns));
        let crowded = faults(&plan(1, 600, 100)).unwrap();
        // A second and a half to recover in, at least.
        assert!(crowded.windows(2).all(|f| f[0].until_ns + SECOND_NS * 3 / 2 <= f[1].from_ns), "{crowded:?}");
    }

    #[test]
    fn layers_are_worn_in_sizes_that_go_together_and_every_garment_is_in_the_wardrobe() {
        let layers = Wardrobe::read(SoakOutfit::Layers).unwrap();
        assert!(layers.outfits.iter().all(|outfit| outfit.worn.len() == 3));
        let whole = Wardrobe::read(SoakOutfit::Wardrobe).unwrap();
        let names: BTreeSet<&str> = whole.outfits.iter().map(|outfit| outfit.worn[0].garment).collect();
        assert_eq!(names.len(), drafting::names().len());
    }

    #[test]
    fn a_depth_camera_has_faults_of_its_own_each_as_often_as_the_others() {
        let depth = SoakPlan { camera: SoakCamera::Depth, ..plan(7, 8 * 3_600, 1_000) };
        let all = faults(&depth).unwrap();
        let counts: Vec<usize> = FaultKind::of(SoakCamera::Depth)
            .iter()
            .map(|kind| all.iter().filter(|f| f.kind == *kind).count())
            .collect();
        assert_eq!((counts.len(), counts.iter().sum::<usize>()), (9, 1_000));
        assert!(counts.iter().all(|n| (111..=112).contains(n)), "{counts:?}");
    }

    #[test]
    fn a_seed_decides_on_everything_and_too_many_faults_are_refused() {
        assert_eq!(scenario(3), scenario(3));
        assert_ne!(scenario(3).faults, scenario(4).faults);
        assert_eq!(
            Scenario::write(plan(1, 60, 11)).unwrap_err().to_string(),
            "11 faults do not fit into 60 s; ask for 10 at most, or for a longer run"
        );
    }
}
