//! The list of torture cases.

use super::outcome::TrialFindings;
use super::pieces::Pieces;
use super::{elements, long_rest, poison, ratios, start, surround};
use crate::random::CaseRandom;

/// A case: something that cloth must survive.
#[derive(Debug, Clone, Copy)]
pub struct TortureCase {
    /// Its name on the command line.
    pub name: &'static str,
    /// What is done, in a few words.
    pub about: &'static str,
    pub(super) run: fn(&Pieces, &mut CaseRandom, u64) -> TrialFindings,
}

/// Every case, in the order of the table.
pub const CASES: [TortureCase; 25] = [
    TortureCase { name: "random-box", about: "every vertex anywhere in a box of 1 m", run: start::random_box },
    TortureCase {
        name: "crumpled-lawn",
        about: "the same with thin cloth, in which folds may stay",
        run: start::crumpled,
    },
    TortureCase { name: "flattened", about: "pressed into a plane", run: start::flattened },
    TortureCase { name: "inverted", about: "mirrored in a plane through its middle", run: start::inverted },
    TortureCase { name: "stretched", about: "stretched 5 times", run: start::stretched },
    TortureCase {
        name: "collapsed-fiber",
        about: "all particles of a fiber in one place",
        run: start::collapsed_fiber,
    },
    TortureCase { name: "collapsed-cloth", about: "all free particles in one place", run: start::collapsed_cloth },
    TortureCase { name: "long-step", about: "substeps 4 times as long, while it swings", run: start::long_step },
    TortureCase {
        name: "one-iteration",
        about: "one substep, every set once, while it swings",
        run: start::one_iteration,
    },
    TortureCase { name: "mass-ratio", about: "masses from 1 to 100,000 at random", run: ratios::mass_ratio },
    TortureCase { name: "stiffness-ratio", about: "warp and weft 1 : 10,000", run: ratios::stiffness_ratio },
    TortureCase {
        name: "heavy-chain",
        about: "20 links, the last particle 100,000 times heavier",
        run: ratios::heavy_chain,
    },
    TortureCase { name: "even-chain", about: "20 particles of 1 kg: the force at the top", run: ratios::even_chain },
    TortureCase { name: "strand", about: "the TinyVBD strand: 1,000 kg swing on 19 links", run: ratios::strand },
    TortureCase { name: "teleport", about: "a capsule jumps through the cloth and back", run: surround::teleport },
    TortureCase { name: "squeeze", about: "two capsules meet with the cloth between them", run: surround::squeeze },
    TortureCase { name: "too-small", about: "a tube on a body twice as wide", run: surround::too_small },
    TortureCase { name: "spin", about: "10 turns a second about any axis, 2 s", run: surround::spin },
    TortureCase {
        name: "bad-elements",
        about: "sides without length and faces without area",
        run: elements::bad_elements,
    },
    TortureCase { name: "bad-surroundings", about: "NaN and infinity in colliders", run: poison::surroundings },
    TortureCase { name: "bad-bones", about: "NaN and infinity in the bones that pins follow", run: poison::bones },
    TortureCase {
        name: "bad-settings",
        about: "NaN and infinity in gravity, wind and settings",
        run: poison::settings,
    },
    TortureCase {
        name: "bad-root-settings",
        about: "the same in the root's settings and substeps",
        run: poison::root_settings,
    },
    TortureCase { name: "bad-state", about: "NaN and infinity in positions and velocities", run: poison::state },
    TortureCase {
        name: "long-rest",
        about: "a minute at rest: a step takes as long as before",
        run: long_rest::long_rest,
    },
];
