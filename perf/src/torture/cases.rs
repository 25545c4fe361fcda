//! The list of torture cases.

use super::outcome::TrialFindings;
use super::pieces::Pieces;
use super::{elements, folded, layered, long_rest, poison, ratios, start, surround};
use crate::random::CaseRandom;

/// A case: something that cloth must survive.
#[derive(Debug, Clone, Copy)]
pub struct TortureCase {
    /// Its name on the command line.
    pub name: &'static str,
    /// What is done, in a few words.
    pub about: &'static str,
    /// Whether the oracle can step it: no cloth meets cloth in it, nothing that is no number is given, and nothing is timed.
    pub exact: bool,
    pub(super) run: fn(&Pieces, &mut CaseRandom, u64) -> TrialFindings,
}

/// Every case, in the order of the table.
pub const CASES: [TortureCase; 30] = [
    case("random-box", "every vertex anywhere in a box of 1 m", start::random_box),
    case("crumpled-lawn", "the same with thin cloth, in which folds may stay", start::crumpled),
    case("flattened", "pressed into a plane", start::flattened),
    case("inverted", "mirrored in a plane through its middle", start::inverted),
    case("stretched", "stretched 5 times", start::stretched),
    case("collapsed-fiber", "all particles of a fiber in one place", start::collapsed_fiber),
    case("collapsed-cloth", "all free particles in one place", start::collapsed_cloth),
    case("long-step", "substeps 4 times as long, while it swings", start::long_step),
    case("one-iteration", "one substep, every set once, while it swings", start::one_iteration),
    case("mass-ratio", "masses from 1 to 100,000 at random", ratios::mass_ratio),
    case("stiffness-ratio", "warp and weft 1 : 10,000", ratios::stiffness_ratio),
    case("heavy-chain", "20 links, the last particle 100,000 times heavier", ratios::heavy_chain),
    case("even-chain", "20 particles of 1 kg: the force at the top", ratios::even_chain),
    case("strand", "the TinyVBD strand: 1,000 kg swing on 19 links", ratios::strand),
    case("teleport", "a capsule jumps through the cloth and back", surround::teleport),
    case("squeeze", "two capsules meet with the cloth between them", surround::squeeze),
    case("too-small", "a tube on a body twice as wide", surround::too_small),
    case("spin", "10 turns a second about any axis, 2 s", surround::spin),
    case("crossing", "a corner or the lower edge drawn through the cloth itself", folded::crossing).by_the_engine(),
    case("crushing", "five walls crush it to 4 to 10 cm and let go", folded::crushing).by_the_engine(),
    case("ball", "every vertex anywhere in a ball of 3 to 8 cm, or drawn together into it", folded::ball)
        .by_the_engine(),
    case("layers", "sheets inside of those that they are worn over, by up to 10 mm", layered::layers).by_the_engine(),
    case("thrown", "sheets thrown at each other", layered::thrown).by_the_engine(),
    case("bad-elements", "sides without length and faces without area", elements::bad_elements),
    case("bad-surroundings", "NaN and infinity in colliders", poison::surroundings).by_the_engine(),
    case("bad-bones", "NaN and infinity in the bones that pins follow", poison::bones).by_the_engine(),
    case("bad-settings", "NaN and infinity in gravity, wind and settings", poison::settings).by_the_engine(),
    case("bad-root-settings", "the same in the root's settings and substeps", poison::root_settings).by_the_engine(),
    case("bad-state", "NaN and infinity in positions and velocities", poison::state).by_the_engine(),
    case("long-rest", "a minute at rest: a step takes as long as before", long_rest::long_rest).by_the_engine(),
];

const fn case(
    name: &'static str,
    about: &'static str,
    run: fn(&Pieces, &mut CaseRandom, u64) -> TrialFindings,
) -> TortureCase {
    TortureCase { name, about, exact: true, run }
}

impl TortureCase {
    const fn by_the_engine(self) -> Self {
        Self { exact: false, ..self }
    }
}
