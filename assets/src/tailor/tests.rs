//! Panels that are hard to mesh or to sew.

use glam::{DVec2, Vec3};

use super::{SewnMesh, TailorError, sew};
use crate::pattern::{Curve, Panel, PanelEdge, Pattern, Seam, SeamSide};
use toile_bake::check::check;
use toile_base::numeric::random::SplitMix64;

fn panel(name: &str, curves: Vec<Curve>) -> Panel {
    let edge = |(number, curve)| PanelEdge { curve, number, label: None };
    let edges = curves.into_iter().enumerate().map(edge).collect();
    Panel { name: name.into(), label: None, edges, grain: DVec2::Y, behind: false, placement: None, trims: Vec::new() }
}

fn polygon(name: &str, points: &[[f64; 2]]) -> Panel {
    let at = |i: usize| DVec2::from(points[i % points.len()]);
    panel(name, (0..points.len()).map(|i| Curve::Line([at(i), at(i + 1)])).collect())
}

fn seam(a: (usize, usize, usize), b: (usize, usize, usize)) -> Seam {
    let side = |(panel, first, count), reversed| SeamSide { panel, first, count, reversed };
    Seam { name: format!("seam {} to {}", a.1, b.1), sides: [side(a, false), side(b, true)] }
}

/// How the faces join, and the angles and areas of all panels.
fn hold(pattern: &Pattern, sewn: &SewnMesh, least_angle: f64) {
    let mut random = SplitMix64::new(5);
    let mut anywhere = || Vec3::new(random.uniform(), random.uniform(), random.uniform());
    let positions: Vec<Vec3> = sewn.members.iter().map(|_| anywhere()).collect();
    assert_eq!(check(&positions, &sewn.faces), Ok(()));
    for (mesh, panel) in sewn.panels.iter().zip(pattern.panels()) {
        let quality = mesh.quality(panel);
        assert!(quality.least_angle >= least_angle.min(quality.sharpest_corner), "{}: {quality:?}", panel.name);
        assert!(quality.area_error.abs() < 1e-3, "{}: {quality:?}", panel.name);
    }
}

/// A quarter of a disc whose straight edges are sewn together: the faces at its tip would fold flat.
#[test]
fn a_cone_keeps_its_tip() {
    let (a, b) = (DVec2::new(0.3, 0.0), DVec2::new(0.0, 0.3));
    let arc = Curve::arc([a, b], 0.3, false, true).unwrap();
    let edges = vec![Curve::Line([DVec2::ZERO, a]), arc, Curve::Line([b, DVec2::ZERO])];
    let pattern = Pattern::checked(vec![panel("cone", edges)], vec![seam((0, 0, 1), (0, 2, 1))]).unwrap();
    for spacing in [0.015, 0.025, 0.05] {
        let sewn = sew(&pattern, spacing).unwrap();
        hold(&pattern, &sewn, 20.0);
        assert_eq!(sewn.members[sewn.seams[0][0] as usize].len(), 1, "the tip is a vertex of its own");
    }
}

/// Two panels with edges of a millimetre between their seams.
#[test]
fn traces_of_drafting_ask_for_no_particles() {
    let points = [[0.0, 0.0], [0.2, 0.0], [0.2, 0.3], [0.199, 0.301], [0.1, 0.31], [0.0, 0.31]];
    let front = polygon("front", &points);
    let back = polygon("back", &points.map(|[x, y]| [-x, y]));
    let seams = vec![seam((0, 1, 1), (1, 1, 1)), seam((0, 2, 1), (1, 2, 1)), seam((0, 3, 1), (1, 3, 1))];
    let turned = |mut s: Seam| {
        s.sides[1].reversed = false;
        s
    };
    let pattern = Pattern::checked(vec![front, back], seams.into_iter().map(turned).collect()).unwrap();
    for spacing in [0.015, 0.025] {
        let sewn = sew(&pattern, spacing).unwrap();
        hold(&pattern, &sewn, 20.0);
        assert_eq!(sewn.seams[1].len(), 1);
        assert!(pattern.shows_inside(0) != pattern.shows_inside(1) || pattern.panels()[1].signed_area() < 0.0);
    }
}

/// One edge sewn to two with a corner between them: the corner is a point of both sides.
#[test]
fn a_corner_of_one_side_is_a_point_of_the_other() {
    let whole = polygon("whole", &[[0.0, 0.0], [0.3, 0.0], [0.3, 0.2], [0.0, 0.2]]);
    let bent = polygon("bent", &[[0.0, 0.0], [0.12, 0.02], [0.3, 0.0], [0.3, -0.2], [0.0, -0.2]]);
    let mut sewn_on = seam((0, 0, 1), (1, 0, 2));
    sewn_on.sides[1].reversed = false;
    let pattern = Pattern::checked(vec![whole, bent], vec![sewn_on]).unwrap();
    let sewn = sew(&pattern, 0.015).unwrap();
    hold(&pattern, &sewn, 20.0);
    let corner = sewn.number[1][sewn.panels[1].boundary.starts[1]];
    assert!(sewn.seams[0].contains(&corner) && sewn.members[corner as usize].len() == 2);
}

/// Cloth cut on the bias, and strips that hold a row or two.
#[test]
fn bias_cuts_and_strips_hold_their_angles() {
    let mut bias = polygon("bias", &[[0.0, 0.0], [0.4, 0.0], [0.35, 0.5], [0.02, 0.45]]);
    bias.grain = DVec2::new(1.0, 1.0).normalize();
    let strips = [0.012, 0.02, 0.033, 0.05, 0.07]
        .map(|w| polygon(&format!("strip {w}"), &[[0.0, 0.0], [0.5, 0.0], [0.5, w], [0.0, w]]));
    let panels = std::iter::once(bias).chain(strips).collect();
    let pattern = Pattern::checked(panels, Vec::new()).unwrap();
    for spacing in [0.015, 0.025] {
        hold(&pattern, &sew(&pattern, spacing).unwrap(), 20.0);
    }
}

#[test]
fn what_cannot_be_meshed_says_which_panel() {
    let square = |side: f64| polygon("cape", &[[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]]);
    let of = |panel: Panel| Pattern::checked(vec![panel], Vec::new()).unwrap();
    assert!(matches!(sew(&of(square(0.5)), 0.001), Err(TailorError::Spacing { .. })));
    assert!(matches!(sew(&of(square(15.0)), 0.015), Err(TailorError::TooMany { .. })));
    assert!(matches!(sew(&of(square(0.011)), 0.05), Err(TailorError::Narrow { .. })));
    let message = sew(&of(square(15.0)), 0.003).unwrap_err().to_string();
    assert!(message.contains("panel cape") && message.contains("larger spacing"), "{message}");
}
