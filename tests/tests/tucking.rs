//! Tests of tucking: a T-shirt in trousers.

use glam::{DVec3, Vec3A};
use toile_engine::cloth::contact::garments::tuck_in;
use toile_engine::surface::SurfaceMesh;
use toile_engine::world::World;
use toile_fitting::crossings::CrossingTest;
use toile_workspace::dressed;

/// Edges and faces that may pass through each other, of some 20,000 edges: about a hundred and forty do, most of them at the
/// waistband's edge, over which the shirt hangs. Contact knows no edges.
const MOST_CROSSINGS: usize = 170;

/// How far from the waistband's edge three of four are, and all (m).
const AT_EDGE_M: [f32; 2] = [0.05, 0.16];

/// Trousers, and a T-shirt over them or tucked in, on the shopper who stands.
fn standing(tucked: bool) -> World {
    let body = dressed::shopper();
    let mut garments = vec![dressed::dress("wide-leg-trousers", &body), dressed::dress("tee", &body)];
    if tucked {
        tuck_in(&mut garments, 1).unwrap();
    }
    let track = dressed::track(&body, 0.0, 0.1);
    let mut world = dressed::world(body, garments);
    world.dress(&track[0]);
    world
}

/// How far the shirt's particles near the hem are in front of the trousers (m).
fn hem_in_front(world: &World) -> Vec<f32> {
    let (trousers, shirt) = (&world.cloths()[0].positions, &world.cloths()[1].positions);
    let garment = &world.garments()[1];
    let mesh = SurfaceMesh::new(&world.garments()[0].triangles, trousers.len());
    let hem = garment.start.iter().map(|p| p.y).fold(f32::MAX, f32::min) + 0.05;
    let at = |v: u32| trousers[v as usize];
    let in_front = |p: Vec3A| {
        let off = |v: &u32| at(*v).distance_squared(p);
        let nearest = (0..trousers.len() as u32).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
        (p - at(nearest)).dot(mesh.vertex_normal(nearest, at))
    };
    (0..shirt.len()).filter(|&i| garment.start[i].y < hem).map(|i| in_front(shirt[i])).collect()
}

/// Heights of the edges that pass through the other garment (m).
fn crossings(world: &World) -> Vec<f32> {
    let triangles: Vec<_> = world.garments().iter().map(|g| &*g.triangles).collect();
    let exact = |p: &Vec3A| p.as_dvec3();
    let at: Vec<Vec<DVec3>> = world.cloths().iter().map(|c| c.positions.iter().map(exact).collect()).collect();
    let all: Vec<&[DVec3]> = at.iter().map(|p| &p[..]).collect();
    let found = CrossingTest::new(&triangles).between(&all);
    found.iter().map(|c| all[c.edge_mesh][c.edge[0] as usize].y as f32).collect()
}

#[test]
fn a_tucked_shirt_ends_inside_of_the_trousers_and_one_that_is_not_outside() {
    for tucked in [true, false] {
        let world = standing(tucked);
        let hem = hem_in_front(&world);
        let inside = hem.iter().filter(|front| **front < 0.0).count();
        let crossed = crossings(&world);
        let right = if tucked { inside } else { hem.len() - inside };
        assert!(right * 100 >= 98 * hem.len(), "tucked in: {tucked}, {inside} of {} inside", hem.len());
        if tucked {
            assert!(crossed.len() <= MOST_CROSSINGS, "{} crossings", crossed.len());
            let band = world.cloths()[0].positions.iter().map(|p| p.y).fold(0.0, f32::max);
            let within = |most: f32| crossed.iter().filter(|y| (*y - band).abs() < most).count();
            let [near, all] = AT_EDGE_M.map(within);
            assert!(4 * near >= 3 * all && all == crossed.len(), "below the waistband {band} m: {crossed:?}");
        }
    }
}
