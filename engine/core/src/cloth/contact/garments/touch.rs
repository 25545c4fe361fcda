//! Touch lists: for each particle of a garment the contacts that act on it, level by level, in a fixed order.
//!
//! Particles gather what contacts do to them; no contact writes to a particle. So sums have one order, whichever worker adds them
//! up. They are listed in two parts, so that two workers gather at once.

use toile_base::garment::Garment;
use toile_base::garment::layout::OWNERS;
use toile_base::limits::MAX_GARMENTS;

use super::contact::{LayerContact, VERTICES};
use super::fold_share::FoldShare;
use super::garment_surface::GarmentSurface;
use super::pair::GarmentPair;
use crate::bounded::{BoundedVec, Fill};

/// One contact that acts on a particle.
#[derive(Debug, Clone, Copy, Default)]
pub struct Touch {
    /// Which of its contacts.
    pub contact: u32,
    /// The share of the contact's vertex: above 0 on its first side.
    pub share: f32,
    /// Which list of contacts.
    pub list: u16,
    /// Whether what is touched lies above in it.
    pub above: bool,
    /// Whether it is between two garments.
    pub between: bool,
}

/// A particle that is touched, and where its touches are.
#[derive(Debug, Clone, Copy, Default)]
pub struct Touched {
    /// Which.
    pub particle: u32,
    /// Where its touches begin, and end.
    touches: [u32; 2],
}

/// Levels that there may be: as many as garments, and one more.
const MOST_LEVELS: usize = MAX_GARMENTS + 1;

/// The lists of one garment.
#[derive(Debug, Clone)]
pub struct TouchLists {
    garment: usize,
    /// The particles of each owner, first and behind the last of each run.
    spans: [Box<[[u32; 2]]>; OWNERS],
    /// By level, then by owner and particle.
    touches: BoundedVec<Touch>,
    touched: BoundedVec<Touched>,
    /// Where in `touched` each part of each level begins and ends. The garment's own level has every particle that anything touches at
    /// any level.
    ranges: [[[u32; 2]; OWNERS]; MOST_LEVELS],
    /// How many touches each particle has, at one level and at all `[particles]` each.
    counts: [Box<[u32]>; 2],
    /// Sum of the shares of the contacts on each particle that are solved at once: at its own level, and above
    /// `[particles]` each.
    load: [Box<[f32]>; 2],
    /// How high it lies; 0 is on nothing but the body.
    height: usize,
    /// Whether the body may give way under any of its particles.
    pub gives: bool,
}

/// The level at which a garment at some height is put on what it lies on: what lies on the body only is put back by it last,
/// and shares the first with what lies on it.
fn own_level(height: usize) -> usize {
    height.max(1)
}

impl TouchLists {
    /// Room for the touches of a garment. At load.
    pub fn new(
        garment: usize,
        height: usize,
        garments: &[Garment],
        surfaces: &[GarmentSurface],
        pairs: &[GarmentPair],
    ) -> Self {
        let particles = garments[garment].particles();
        let most = |p: &GarmentPair| {
            let contacts = match p.is_fold() {
                true => 2 * FoldShare::most_contacts(particles),
                false => p.most_contacts(&surfaces[p.particles]),
            };
            if p.particles == garment || p.faces == garment { VERTICES * contacts } else { 0 }
        };
        let run = |&(first, len): &(u32, u32)| [first, first + len];
        let spans = garments[garment].layout().spans.each_ref().map(|owner| owner.iter().map(run).collect());
        Self {
            garment,
            spans,
            touches: BoundedVec::new(pairs.iter().map(most).sum()),
            touched: BoundedVec::new(MOST_LEVELS * particles),
            ranges: Default::default(),
            counts: [(); 2].map(|()| vec![0; particles].into()),
            load: [(); 2].map(|()| vec![0.0; particles].into()),
            height,
            gives: true,
        }
    }

    /// Lists the contacts of a step; `lists` are those of the first share of every pair, then of the second.
    pub fn fill<'c>(&mut self, pairs: &[GarmentPair], lists: impl Fn(usize) -> &'c [LayerContact]) {
        self.touches.clear();
        self.touched.clear();
        self.load.iter_mut().for_each(|load| load.fill(0.0));
        self.counts[1].fill(0);
        self.ranges = Default::default();
        // Its own level lists all that anything touches, so that it comes last.
        let own = self.own_level();
        let top = pairs.iter().map(|p| p.level).max().unwrap_or(0);
        (0..=top).filter(|level| *level != own).chain([own]).for_each(|level| self.fill_level(level, pairs, &lists));
    }

    fn fill_level<'c>(&mut self, level: usize, pairs: &[GarmentPair], lists: &impl Fn(usize) -> &'c [LayerContact]) {
        let is_own = level == self.own_level();
        let garment = self.garment;
        let of = |list: usize| &pairs[list % pairs.len()];
        let mine = |p: &GarmentPair| p.level == level && (p.particles == garment || p.faces == garment);
        let which = || (0..2 * pairs.len()).filter(|&list| mine(of(list)));
        if !is_own && which().all(|list| lists(list).is_empty()) {
            return;
        }
        let each = |act: &mut dyn FnMut(u32, Touch)| {
            for list in which() {
                let pair = of(list);
                let (above, between) = (pair.has_above(garment), !pair.is_fold());
                for (c, contact) in lists(list).iter().enumerate() {
                    let sides = [pair.particles, pair.faces];
                    for side in (0..2).filter(|side| sides[*side] == garment) {
                        for (i, share) in contact.of_side(side).filter(|(_, share)| *share != 0.0) {
                            act(i, Touch { contact: c as u32, share, list: list as u16, above, between });
                        }
                    }
                }
            }
        };
        let Self { spans, touches, touched, counts: [count, at_all], load, .. } = self;
        count.fill(0);
        each(&mut |i, touch| {
            count[i as usize] += 1;
            at_all[i as usize] += 1;
            load[usize::from(!is_own)][i as usize] += touch.share.abs();
        });
        let mut next = touches.len() as u32;
        for (owner, spans) in spans.iter().enumerate() {
            let begin = touched.len() as u32;
            for i in spans.iter().flat_map(|[first, end]| *first..*end) {
                let n = &mut count[i as usize];
                if *n > 0 || (is_own && at_all[i as usize] > 0) {
                    touched.push(Touched { particle: i, touches: [next, next + *n] });
                }
                // From here on where its next touch goes.
                next += std::mem::replace(n, next);
            }
            self.ranges[level][owner] = [begin, touched.len() as u32];
        }
        // What one worker owns is halved, so that both gather.
        let [[begin, end], second] = &mut self.ranges[level];
        if spans[1].is_empty() {
            let middle = u32::midpoint(*begin, *end);
            (*second, *end) = ([middle, *end], middle);
        }
        touches.resize(next as usize, Touch::default());
        each(&mut |i, touch| {
            let place = &mut count[i as usize];
            // None where the list could not hold all.
            if let Some(to) = touches.get_mut(*place as usize) {
                *to = touch;
            }
            *place += 1;
        });
    }

    /// The level at which it is put on what it lies on.
    pub fn own_level(&self) -> usize {
        own_level(self.height)
    }

    /// How high it lies; 0 is on nothing but the body.
    pub fn height(&self) -> usize {
        self.height
    }

    /// One of two parts of the particles that are touched at a level, at the garment's own level of all that are touched at any: an owner's,
    /// or half of those of a garment that has one owner.
    pub fn touched(&self, level: usize, part: usize) -> &[Touched] {
        let [begin, end] = self.ranges[level][part];
        &self.touched[begin as usize..end as usize]
    }

    /// Whether anything touches a particle of the garment, at any level.
    pub fn touches(&self, particle: usize) -> bool {
        self.counts[1][particle] > 0
    }

    /// Whether anything touches any particle.
    pub fn any(&self) -> bool {
        !self.touches.is_empty()
    }

    /// The touches of a particle, of those that are listed for a level.
    pub fn of(&self, touched: &Touched) -> &[Touch] {
        let [begin, end] = touched.touches.map(|at| (at as usize).min(self.touches.len()));
        &self.touches[begin..end]
    }

    /// Sum of the shares of the contacts of a level on each particle `[particles]`.
    pub fn load(&self, level: usize) -> &[f32] {
        &self.load[usize::from(level != self.own_level())]
    }

    /// How full they were so far.
    pub fn usage(&self) -> Fill {
        self.touches.usage().and(self.touched.usage())
    }

    /// Memory that it holds (bytes).
    pub fn bytes(&self) -> usize {
        self.load.iter().map(|load| size_of_val(&**load)).sum::<usize>()
            + self.counts.iter().map(|count| size_of_val(&**count)).sum::<usize>()
            + self.spans.iter().map(|span| size_of_val(&**span)).sum::<usize>()
            + self.touches.bytes()
            + self.touched.bytes()
    }
}
