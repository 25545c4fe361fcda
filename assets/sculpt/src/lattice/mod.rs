//! The cage's grid: rings of quads over trunk, head, limbs, fingers and toes, joined into one closed surface.
//!
//! The left half is laid out and mirrored. Rings of the trunk have 24 columns (13 in a half, both middles included).
//! Three rows and three columns are left open for an arm of 12; half the lowest ring and three vertices along the
//! crotch start a leg of 16. The hand's ring of 12 splits into four fingers of 6 (two between each pair), 8 around two
//! rows of the palm grow the thumb; the foot's 16 split into a big toe of 8 and four toes of 6. The head's 24 close in
//! a patch of 6 by 6. All faces are quads.

mod arm;
mod cage;
pub mod chart;
mod digit;
mod leg;
mod trunk;

pub(crate) use cage::Lattice;

use crate::form::Form;

/// The whole cage over a form.
pub(crate) fn over(form: &Form) -> Lattice {
    let mut half = Lattice::default();
    let trunk = half.lay_trunk(form);
    half.lay_leg(form, &trunk[0]);
    half.lay_arm(form, &trunk);
    half.orient();
    half.mirrored()
}
