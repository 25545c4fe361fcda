use glam::Vec3;
use toile_bake::Shape;
use toile_bake::bake;
use toile_bake::shape::NO_VERTEX;
use toile_base::fabric::Fabric;
use toile_base::fabric::friction_element::read_loop;
use toile_base::fabric::link_curve::LinkCurve;
use toile_base::fabric::stretch_curve::ShearLock;
use toile_base::garment::Part;
use toile_base::mesh::SkinWeights;

use super::*;
use crate::cloth::state::State;
use crate::lanes::Width;

/// Links side by side, each between a particle of the upper row and one of the lower.
const LINKS: u32 = 21;
const REST: f32 = 0.01;
const SOFT: f32 = 1.0 / 300.0;

fn link_curve() -> LinkCurve {
    LinkCurve { knees: [-0.004, 0.02], behind: [0.01, 12.0], half_width: 1.2, ..LinkCurve::plain(300.0) }
}

/// The table of the same curve; for friction, the elongation at which the link would carry it.
fn table(link_curve: &LinkCurve) -> CurveTable {
    let ([lower, upper], [below, above]) = (link_curve.knees, link_curve.behind);
    let one = [lower, below, upper, above, link_curve.half_width / link_curve.slope].map(|v| v as f32);
    CurveTable::new(&(0..LINKS).map(|_| one))
}

/// Each link at a strain of its own, in the round `k` of a motion back and forth.
fn strain(link: u32, k: u32) -> f64 {
    0.03 * (0.37 * f64::from(k) + 0.5 * f64::from(link)).sin()
}

#[test]
fn links_carry_the_force_of_their_f64_curve() {
    let table = table(&link_curve());
    let links: Vec<(u32, [u32; 2])> = (0..LINKS).map(|i| (i, [i, LINKS + i])).collect();
    // One by one, they are in no row.
    let scattered = CurveRows { rows: [].into(), ..loose(&links) };
    for rows in [CurveRows::new(links), scattered] {
        for width in Width::ALL.into_iter().filter(|w| w.available()) {
            let mut layout = Layout::default();
            layout.link_curves.weft = table.clone();
            (layout.weft.rest, layout.weft.compliance) =
                (vec![REST; LINKS as usize].into(), vec![SOFT; LINKS as usize].into());
            let mut state = CurveState::new(&layout);
            let mut exact = [link_curve(); LINKS as usize];
            for k in 0..60 {
                let at = |i: u32| {
                    Vec3::new(
                        0.3 * (i % LINKS) as f32,
                        if i < LINKS { 0.0 } else { -REST * (1.0 + strain(i - LINKS, k) as f32) },
                        0.0,
                    )
                };
                let positions: Vec<Vec3> = (0..2 * LINKS).map(at).collect();
                let mut particles = State::new(&positions, &[1.0; 2 * LINKS as usize]);
                let to = state.columns()[WEFT];
                for owner in 0..OWNERS {
                    width.run(FollowCurves {
                        columns: particles.columns(),
                        rows: &rows,
                        owner,
                        table: &table,
                        baked: [&layout.weft.rest, &layout.weft.compliance],
                        to,
                        per_dt2: 1e4,
                        gain: Some(CurveGain { damped: 1.0, passes: Passes::Many }),
                    });
                }
                for (i, exact) in exact.iter_mut().enumerate() {
                    let e = strain(i as u32, k);
                    let length = f64::from(REST) * (1.0 + e);
                    let got = (length - f64::from(to.rest.get(i))) / f64::from(to.compliance.get(i));
                    let got = got.max(f64::from(to.least.get(i)) * 1e4);
                    // A link of 300 N/m and 1 cm carries 3 N a strain of 1 %, as cloth of 300 N/m does a metre wide.
                    let wanted = exact.force(e) * f64::from(REST) / (300.0 * f64::from(SOFT));
                    assert!(
                        (got - wanted).abs() < 3e-4 * 300.0 * f64::from(REST),
                        "{width} lanes, {i} in {k}: {got} for {wanted}"
                    );
                }
            }
        }
    }
}

fn loose(links: &[(u32, [u32; 2])]) -> CurveRows {
    let end = |k: usize| links.iter().map(|l| l.1[k]).collect();
    let loose = [end(0), end(1), links.iter().map(|l| l.0).collect()];
    CurveRows { rows: [].into(), loose, shares: [[0..0, 0..16], [0..0, 16..links.len()]] }
}

/// Points and faces of a sheet of columns and rows; as triangles, their diagonals alternate.
fn sheet([columns, rows]: [u32; 2], [width, height]: [f32; 2], triangles: bool) -> (Vec<Vec3>, Vec<[u32; 4]>) {
    let place = |i: u32| Vec3::new(width * (i % (columns + 1)) as f32, -height * (i / (columns + 1)) as f32, 0.0);
    let (mut faces, points) = (Vec::new(), (0..(columns + 1) * (rows + 1)).map(place).collect());
    for cell in 0..columns * rows {
        let (c, r) = (cell % columns, cell / columns);
        let a = r * (columns + 1) + c;
        let [b, d, e] = [a + columns + 1, a + columns + 2, a + 1];
        match (triangles, (c + r) % 2) {
            (false, _) => faces.push([a, b, d, e]),
            (true, 0) => faces.extend([[a, b, d, NO_VERTEX], [a, d, e, NO_VERTEX]]),
            (true, _) => faces.extend([[a, b, e, NO_VERTEX], [b, d, e, NO_VERTEX]]),
        }
    }
    (points, faces)
}

/// A sheet of cloth that has link curves, pinned nowhere.
fn cloth((positions, faces): (Vec<Vec3>, Vec<[u32; 4]>), fabric: &Fabric) -> Garment {
    let mut shape = Shape { faces, ..Shape::default() };
    for p in positions {
        shape.push(p, p, false, Part::All);
        shape.weights.push(SkinWeights { bones: [0; 4], weights: [1.0, 0.0, 0.0, 0.0] });
    }
    bake("sheet", "one", &shape, fabric).unwrap()
}

/// Shear force for a width (N/m) of all of the cloth at an angle of shear, by what its links carry: the work that they do a
/// radian, over the area.
fn shear_force(garment: &Garment, state: &mut CurveState, rows: &[CurveRows; KINDS], angle: f64, area: f64) -> f64 {
    // Threads keep their lengths: half of the angle each way.
    let half = (0.5 * angle) as f32;
    let turned = |p: &Vec3| Vec3::new(p.x * half.cos() + p.y * half.sin(), p.y * half.cos() + p.x * half.sin(), 0.0);
    let places: Vec<Vec3> = garment.start.iter().map(turned).collect();
    let mut particles = State::new(&places, &garment.inverse_mass);
    let layout = garment.layout();
    let baked =
        [[&layout.diagonals.rest, &layout.diagonals.compliance], [&layout.shear.rest, &layout.shear.compliance]];
    let mut work = 0.0;
    for kind in [0, SHEAR].into_iter().filter(|&kind| !layout.link_curves.tables()[kind].is_empty()) {
        let to = state.columns()[kind];
        for owner in 0..OWNERS {
            Width::widest().run(FollowCurves {
                columns: particles.columns(),
                rows: &rows[kind],
                owner,
                table: layout.link_curves.tables()[kind],
                baked: baked[kind].map(|c| &**c),
                to,
                per_dt2: 1e4,
                gain: None,
            });
        }
        let links = if kind == 0 { bias(layout) } else { tuples(&layout.shear) };
        for (at, [a, b]) in links {
            let place = |i: u32| places[i as usize].as_dvec3();
            let flat = |i: u32| garment.start[i as usize].as_dvec3();
            let (d, cut) = (place(b) - place(a), flat(b) - flat(a));
            let carries =
                (d.length() - f64::from(to.rest.get(at as usize))) / f64::from(to.compliance.get(at as usize));
            // How much longer it gets a radian, of the shape as cut.
            work += carries * cut.x * cut.y / cut.length();
        }
    }
    work / area
}

#[test]
fn a_loop_of_shear_gives_stiffness_and_width_back_on_any_mesh() {
    let mut fabric = toile_assets::fabric::built_in("denim-tropical").unwrap();
    (fabric.stretch_warp_n_m, fabric.stretch_weft_n_m) = (1e7, 1e7);
    fabric.stretch = Default::default();
    fabric.shear_lock = Some(ShearLock { degrees: 6.0, beyond_n_m: 1_000.0 });
    let (g, width) = (f64::from(fabric.shear_n_m), f64::from(fabric.hysteresis.shear_n_m));
    for (mesh, name) in [
        (sheet([12, 10], [0.02; 2], false), "quads"),
        (sheet([12, 10], [0.02, 0.025], false), "oblong quads"),
        (sheet([12, 10], [0.02; 2], true), "triangles"),
    ] {
        let last = mesh.0[mesh.0.len() - 1];
        let area = f64::from(last.x * -last.y);
        let garment = cloth(mesh, &fabric);
        let (mut state, rows) = (CurveState::new(garment.layout()), CurveRows::of(&garment));
        let read = read_loop(8f64.to_radians(), [0.5, 2.5].map(f64::to_radians), |angle| {
            shear_force(&garment, &mut state, &rows, angle, area)
        });
        let off = [read.slope / g - 1.0, read.width / width - 1.0];
        assert!(off.iter().all(|off| off.abs() < 0.01), "{name}: {off:?}");
    }
}

#[test]
fn fabrics_without_numbers_have_no_curves() {
    let garment = cloth(sheet([6, 6], [0.02; 2], false), &toile_assets::fabric::built_in("cotton-lawn").unwrap());
    assert!(!garment.layout().link_curves.acts());
    assert_eq!(CurveState::new(garment.layout()).bytes(), 0);
}
