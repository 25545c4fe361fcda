//! Limits of draping and its targets, each with its unit and its reason.

/// Spacings of the first levels (m), before the final one: as INRIA MIRAGES 2006 has them. Seams are closed on the first.
pub const LEVELS_M: [f64; 2] = [0.05, 0.025];

/// How far cloth is laid from the skin before it is sewn (m): twice what contact keeps, so that nothing starts in it.
pub const CLEARANCE_M: f32 = 0.012;

/// How far cloth is kept from the skin (m): what a straight edge of 15 mm between two particles cuts off a limb of 40 mm radius
/// is .7 mm, and contact in the frame keeps 2 to 3 mm.
pub const CONTACT_M: f32 = 0.004;

/// Widest gap that a seam may keep on the first level (mm), two of its edges: what is less, the sewn cloth draws together.
pub const MAX_OPEN_MM: f64 = 100.0;

/// Largest mean stretch of the threads of a panel (1): beyond what a knit takes before it is damaged.
pub const MAX_STRETCH: f64 = 0.25;

/// Coefficient of friction of cloth on skin (1): cotton on a dry forearm has .3 to .5.
pub const FRICTION: f32 = 0.4;

/// Cell of the grid of distances to the skin (m): an interpolated distance is off by less than .5 mm on a wrist.
pub const CELL_M: f32 = 0.01;

/// How far outside of the skin distances are kept (m): two edges of the first level.
pub const BAND_M: f32 = 0.03;
