//! Tolerances of the tests: the distance of an f32 figure from the exact rule, each with its reason.

/// Momentum that may come from nothing, as a share of all momenta added up regardless of their direction (1): each of
/// some thousand corrections a step is rounded to 6e-8, and half a second has 60 steps.
pub const MOMENTUM: f64 = 5e-4;

/// Angular momentum likewise (1): corrections act along links as they lie before the last of them, which is right to the
/// first order of a substep only.
pub const ANGULAR_MOMENTUM: f64 = 1e-2;

/// Energy that may come from nothing, as a share of what there was (1): velocities are taken from differences of
/// positions, whose last bit at 1 m is worth 3e-5 m/s in a substep of 2 ms.
pub const ENERGY: f64 = 1e-3;

/// How far what is at rest may stray from where it is (m): some last bits of f32 at 1 m, 6e-8 m each.
pub const REST_M: f32 = 2e-6;

/// How far a cloth that nothing holds and nothing slows may drift in a second (m): the last bit of a position is worth 1e-5
/// m/s in a substep, and what 1,500 substeps (`fine`) add up is a walk at random.
pub const DRIFT_M: f32 = 3e-3;

/// Length of a link that must not stretch over its length as cut, less 1: Gauss-Seidel sweeps over the weft come after
/// its last solve in a substep, and in cloth that is flung at 3 m/s each pulls a little on it.
pub const ZERO_STRETCH: f32 = 1e-2;

/// How differently a cloth and its mirror image may move in half a second, over the cloth's length (1): sets are solved in
/// the order of the columns, and what differs in one pass is a share of what the pass corrects.
pub const MIRROR: f32 = 1e-2;

/// How differently a cloth and one of another size may move in half a second, over their lengths (1): nothing but
/// rounding and limits in metres can tell them apart.
pub const SCALE: f32 = 1e-3;

/// Share by which the masses of a garment may differ from its area times its density (1): a sum of up to 500 numbers
/// of f32.
pub const MASS: f64 = 1e-5;

/// Strain of a garment as it was cut (1): coordinates below 1 m are rounded to 6e-8 m, and links are no shorter than 1 cm.
pub const REST_STRAIN: f64 = 2e-5;

/// Bending energy of a flat garment, over that of the same folded in half (1).
pub const REST_BENDING: f64 = 1e-8;

/// Bending energy of a flat garment that cannot be folded (J): coordinates rounded to 6e-8 m turn faces of 1 cm by 6e-6 rad,
/// which is 4e-16 J for each of up to ten bends of 2e-5 N m.
pub const ROUNDING_BENDING_J: f64 = 4e-15;

/// How deep a particle may end in a collider (m): it is put on the surface, and links then pull on it until the next step.
pub const PENETRATION_M: f32 = 1e-4;

/// By how much the drift of a cloth along a floor may grow in a step (m/s): the rounding of velocities, as for energy.
pub const DRIFT_M_S: f32 = 1e-4;

/// Mean distance between skin and capsules with joints bent (mm): at rest it is 3 mm, and skin that is blended between two
/// bones leaves both near the joint.
pub const BENT_MEAN_MM: f32 = 5.0;

/// 95th percentile of the same (mm): skin of the groin and the seat is stretched and folded by a hip that bends by 60
/// degrees, and follows no bone there.
pub const BENT_P95_MM: f32 = 18.0;

/// How far skin may come out of the capsules where a joint bends (mm).
pub const BENT_OUTSIDE_MM: f32 = 40.0;
