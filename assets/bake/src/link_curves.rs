//! From a fabric's curves to the stretch curves of its links.
//!
//! A link along a thread has the thread's strain; its knee is the fabric's, and its slopes are those of the mesh's threads
//! ([`stiffness::threads`](super::stiffness::threads)), found once for what is below the knees and once for what is behind them. A
//! link along the bias is lengthened by sin t cos t of the angle of shear, at an angle t to the warp. Friction is stated as the
//! strain at which the link would carry as much elastically.

use super::fibers::{Direction, Edge};
use toile_base::fabric::Fabric;
use toile_base::fabric::link_curve::{ARC_FORCE, ARC_SLOPE};
use toile_base::garment::link_curves::{CurveParameters, ONE_SLOPE};
use toile_base::numeric::portable;

/// What the links of a garment follow.
#[derive(Debug, Clone)]
pub struct CurveMaker {
    /// The fabric as its file states it.
    pub fabric: Fabric,
    /// The mesh's threads below the knees.
    pub threads: Fabric,
    /// The mesh's threads behind them.
    pub beyond: Fabric,
}

/// Least product of sine and cosine of a link that counts as one along the bias: those that lean less are nearly threads.
const LEANS: f32 = 0.05;

impl CurveMaker {
    /// Whether links along the bias, or along threads, have more than one slope at all.
    pub fn acts(&self, bias: bool) -> bool {
        let f = &self.fabric;
        if bias {
            f.shear_lock.is_some() || f.hysteresis.shear_n_m > 0.0
        } else {
            f.stretch.warp.is_some() || f.stretch.weft.is_some() || f.buckling
        }
    }

    /// Curve of an edge as part of a fiber of the given direction.
    pub fn link_curve(&self, edge: &Edge, fiber: Direction) -> CurveParameters {
        let f = &self.fabric;
        match fiber {
            Direction::Warp => {
                let slopes = [self.threads.stretch_warp_n_m, self.beyond.stretch_warp_n_m];
                thread(edge, f.stretch.warp.map(|c| c.figures()), slopes, f.buckling.then_some(f.bend_warp_un_m))
            }
            Direction::Weft => {
                let slopes = [self.threads.stretch_weft_n_m, self.beyond.stretch_weft_n_m];
                thread(edge, f.stretch.weft.map(|c| c.figures()), slopes, f.buckling.then_some(f.bend_weft_un_m))
            }
            Direction::Bias => bias(edge, f),
        }
    }
}

/// Of a thread with a curve (knee in %, load at it, slope behind it, width of the loop), the slopes of its mesh, and its
/// bending (uN m) where it buckles.
fn thread(edge: &Edge, curve: Option<[f32; 4]>, [below, beyond]: [f32; 2], buckles: Option<f32>) -> CurveParameters {
    let mut link_curve = ONE_SLOPE;
    if !below.is_finite() {
        return link_curve;
    }
    if let Some([knee, _, _, width]) = curve {
        (link_curve[2], link_curve[3], link_curve[4]) = (0.01 * knee, beyond / below, 0.5 * width / below);
    }
    if let Some(bend) = buckles.filter(|b| *b > 0.0) {
        // Force and slope of an arc of the link's length, over what the link carries.
        let part = 1e-6 * bend / (below * edge.rest * edge.rest);
        (link_curve[0], link_curve[1]) = (-ARC_FORCE as f32 * part, ARC_SLOPE as f32 * part);
    }
    link_curve
}

fn bias(edge: &Edge, fabric: &Fabric) -> CurveParameters {
    let mut link_curve = ONE_SLOPE;
    let (sin, cos) = portable::sin_cos(edge.angle);
    let longer = (sin * cos).abs();
    if longer < LEANS {
        return link_curve;
    }
    if let Some(lock) = fabric.shear_lock {
        let (knee, slope) = (longer * lock.degrees.to_radians(), lock.beyond_n_m / fabric.shear_n_m);
        link_curve[..4].copy_from_slice(&[-knee, slope, knee, slope]);
    }
    link_curve[4] = longer * 0.5 * fabric.hysteresis.shear_n_m / fabric.shear_n_m;
    link_curve
}
