//! Changes of a garment's constraints by which one model of the cloth is left out, or one is added.

use toile_base::fabric::Fabric;
use toile_base::garment::layout::{ENDED, Layout};
use toile_base::garment::link_curves::{CurveParameters, CurveTable, ONE_SLOPE};
use toile_base::garment::{Garment, LayoutError};

/// Returns the garment with its fabric or its constraints changed.
///
/// # Errors
/// [`LayoutError`] where the change leaves constraints that do not fit together.
pub(super) fn changed(
    garment: &Garment,
    change: impl FnOnce(&mut Fabric, &mut Layout),
) -> Result<Garment, LayoutError> {
    let (mut data, mut layout) = garment.clone().into_parts();
    change(&mut data.fabric, &mut layout);
    Garment::new(data, layout)
}

/// Leaves out the resistance to bending, and its friction.
pub(super) fn bending(layout: &mut Layout) {
    (layout.bends, layout.skewed, layout.hubs) = (Default::default(), Default::default(), Default::default());
    bend_friction(layout);
}

/// Leaves out the friction in bending.
pub(super) fn bend_friction(layout: &mut Layout) {
    layout.friction = Default::default();
}

/// Leaves out the friction in shear and stretch.
pub(super) fn link_friction(layout: &mut Layout) {
    change_curves(layout, |[lower, below, upper, above, _]| [lower, below, upper, above, 0.0]);
}

/// Leaves out the second slopes of stretch and shear. Threads that buckle still do.
pub(super) fn second_slopes(layout: &mut Layout) {
    let [_, _, far, one, _] = ONE_SLOPE;
    change_curves(layout, |[lower, below, _, above, friction]| {
        let locks = below > 1.0;
        let [lower, below] = if locks && above > 1.0 { [-far, one] } else { [lower, below] };
        [lower, below, far, one, friction]
    });
}

/// Leaves out buckling: threads that are pushed together carry as much as they pull.
pub(super) fn buckling(layout: &mut Layout) {
    let [far, one, ..] = ONE_SLOPE;
    change_curves(layout, |[lower, below, upper, above, friction]| {
        let [lower, below] = if below < 1.0 { [far, one] } else { [lower, below] };
        [lower, below, upper, above, friction]
    });
}

/// Leaves out the resistance to shear.
pub(super) fn shear(layout: &mut Layout) {
    (layout.diagonals, layout.shear) = (Default::default(), Default::default());
    (layout.link_curves.diagonals, layout.link_curves.shear) = (Default::default(), Default::default());
}

/// Leaves out the stretch of threads.
pub(super) fn stretch(layout: &mut Layout) {
    let curves = &mut layout.link_curves;
    (curves.weft, curves.fibers, curves.crossing) = Default::default();
    let all = [&mut layout.weft.compliance, &mut layout.fibers.compliance, &mut layout.crossing.compliance];
    all.into_iter().flat_map(|c| c.iter_mut()).filter(|c| **c < ENDED).for_each(|c| *c = 0.0);
}

fn change_curves(layout: &mut Layout, change: impl Fn(CurveParameters) -> CurveParameters) {
    let curves = &mut layout.link_curves;
    for table in [&mut curves.diagonals, &mut curves.shear, &mut curves.weft, &mut curves.fibers, &mut curves.crossing]
    {
        for at in 0..table.len() {
            let CurveTable { lower, lower_slope, upper, upper_slope, friction } = table;
            let columns = [lower, lower_slope, upper, upper_slope, friction];
            let curve = change(columns.each_ref().map(|c| c[at]));
            columns.into_iter().zip(curve).for_each(|(c, value)| c[at] = value);
        }
    }
}
