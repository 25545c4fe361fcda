//! A mesh becomes surfaces: at each edge two faces at most, all turned the same way round, outside out.

use std::collections::BTreeMap;

use glam::Vec3;

use super::mesh::{ForeignMesh, sides};
use super::report::Repair;
use super::sets::DisjointSets;
use toile_bake::check::corners;
use toile_bake::shape::{Face, NO_VERTEX};

/// Faces that continue each other, and the edges between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaceLink {
    /// The two faces.
    pub faces: [u32; 2],
    /// The edge between them, the smaller vertex first.
    pub edge: [u32; 2],
    /// Whether both run along it in the same direction, so that one of them looks the other way.
    pub opposed: bool,
}

/// A face at an edge, and whether it runs from the edge's smaller vertex to the larger.
type EdgeSide = (u32, bool);

/// The faces at each edge.
fn edges(faces: &[Face]) -> BTreeMap<[u32; 2], Vec<EdgeSide>> {
    let mut edges: BTreeMap<[u32; 2], Vec<EdgeSide>> = BTreeMap::new();
    for (i, face) in faces.iter().enumerate() {
        for [a, b] in sides(face) {
            edges.entry([a.min(b), a.max(b)]).or_default().push((i as u32, a < b));
        }
    }
    edges
}

/// The links of a mesh whose edges have two faces at most.
pub fn links(faces: &[Face]) -> Vec<FaceLink> {
    let two = edges(faces).into_iter().filter(|(_, at)| at.len() == 2);
    two.map(|(edge, at)| FaceLink { faces: [at[0].0, at[1].0], edge, opposed: at[0].1 == at[1].1 }).collect()
}

/// The edges with one face, each from one vertex to the next as its face runs.
pub fn borders(faces: &[Face]) -> Vec<[u32; 2]> {
    let one = edges(faces).into_iter().filter(|(_, at)| at.len() == 1);
    one.map(|([a, b], at)| if at[0].1 { [a, b] } else { [b, a] }).collect()
}

/// Makes surfaces of a mesh without duplicates; gives what was done.
pub fn settle(mesh: &mut ForeignMesh) -> Vec<Repair> {
    let (mut links, crowded) = continuing(mesh);
    let turned = turn(mesh, &mut links);
    let split = split(mesh, &links);
    let source = |v: &u32| mesh.source[*v as usize];
    let crowded =
        Repair::new("edges of more than two faces parted", crowded.len(), crowded.iter().flatten().map(source));
    let turned = Repair::new(
        "faces turned the way of their neighbours",
        turned.len(),
        turned.iter().map(|f| source(&mesh.faces[*f][0])),
    );
    let split = Repair::new("vertices between surfaces that touch doubled", split.len(), split);
    [crowded, turned, split].into_iter().filter(|r| r.count > 0).collect()
}

/// Which faces continue each other. Where more than two meet at an edge, the two that lie flattest do, and the others end there.
fn continuing(mesh: &ForeignMesh) -> (Vec<FaceLink>, Vec<[u32; 2]>) {
    let (mut links, mut crowded) = (Vec::new(), Vec::new());
    for (edge, at) in edges(&mesh.faces).into_iter().filter(|(_, at)| at.len() > 1) {
        let pairs = (0..at.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
        let flat = |&(i, j): &(usize, usize)| {
            let turn = if at[i].1 == at[j].1 { -1.0 } else { 1.0 };
            turn * mesh.normal(at[i].0 as usize).dot(mesh.normal(at[j].0 as usize))
        };
        // At an edge of a hundred faces it does not matter which two of the first ones are taken.
        let best = pairs.take(MOST_PAIRS).max_by(|a, b| flat(a).total_cmp(&flat(b)));
        let Some((i, j)) = best else { continue };
        links.push(FaceLink { faces: [at[i].0, at[j].0], edge, opposed: at[i].1 == at[j].1 });
        if at.len() > 2 {
            crowded.push(edge);
        }
    }
    (links, crowded)
}

/// Pairs of faces that are tried at one edge.
const MOST_PAIRS: usize = 64;

/// Turns faces until those that continue each other run the same way round and each surface looks outwards; links across
/// which that cannot be (a Moebius band) are taken away. Gives the faces that were turned against most of their surface.
fn turn(mesh: &mut ForeignMesh, links: &mut Vec<FaceLink>) -> Vec<usize> {
    let mut beside: Vec<Vec<(u32, bool)>> = vec![Vec::new(); mesh.faces.len()];
    for FaceLink { faces: [f, g], opposed, .. } in links.iter() {
        beside[*f as usize].push((*g, *opposed));
        beside[*g as usize].push((*f, *opposed));
    }
    let mut turned: Vec<Option<bool>> = vec![None; mesh.faces.len()];
    let mut odd = Vec::new();
    for first in 0..mesh.faces.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut surface = vec![first];
        let mut next = 0;
        while next < surface.len() {
            let f = surface[next];
            next += 1;
            for &(g, opposed) in &beside[f] {
                if turned[g as usize].is_none() {
                    turned[g as usize] = Some(opposed != (turned[f] == Some(true)));
                    surface.push(g as usize);
                }
            }
        }
        odd.extend(turn_surface(mesh, &surface, &turned));
    }
    let same = |f: u32, g: u32| turned[f as usize] == turned[g as usize];
    links.retain(|link| link.opposed != same(link.faces[0], link.faces[1]));
    links.iter_mut().for_each(|link| link.opposed = false);
    odd.sort_unstable();
    odd
}

/// Turns the faces of one surface over, and then all of them if they look inwards. Gives the minority.
fn turn_surface(mesh: &mut ForeignMesh, surface: &[usize], turned: &[Option<bool>]) -> Vec<usize> {
    let (odd, even): (Vec<usize>, Vec<usize>) = surface.iter().partition(|f| turned[**f] == Some(true));
    odd.iter().for_each(|f| mesh.turn(*f));
    let middle = surface.iter().map(|f| mesh.middle(*f)).sum::<Vec3>() / surface.len() as f32;
    let outwards: f32 = surface.iter().map(|f| mesh.area_normal(*f).dot(mesh.middle(*f) - middle)).sum();
    if outwards < 0.0 {
        surface.iter().for_each(|f| mesh.turn(*f));
    }
    if odd.len() <= even.len() { odd } else { even }
}

/// Gives every surface its own vertices: around a vertex, only faces that continue each other share it.
fn split(mesh: &mut ForeignMesh, links: &[FaceLink]) -> Vec<u32> {
    let place = |face: &Face, v: u32| face.iter().position(|w| *w == v).unwrap_or(0) as u32;
    let mut fans = DisjointSets::new(4 * mesh.faces.len());
    for FaceLink { faces: [f, g], edge, .. } in links {
        for v in edge {
            let corner = |f: u32| 4 * f + place(&mesh.faces[f as usize], *v);
            fans.join(corner(*f), corner(*g));
        }
    }
    // The first fan of a vertex keeps it; each other one gets a copy.
    let mut first = vec![NO_VERTEX; mesh.positions.len()];
    let mut copies: BTreeMap<u32, u32> = BTreeMap::new();
    let mut doubled = Vec::new();
    for f in 0..mesh.faces.len() {
        for k in 0..corners(&mesh.faces[f]).len() {
            let v = mesh.faces[f][k] as usize;
            let fan = fans.find((4 * f + k) as u32);
            if first[v] == NO_VERTEX {
                first[v] = fan;
            }
            if first[v] != fan {
                let next = mesh.positions.len() as u32;
                let copy = *copies.entry(fan).or_insert(next);
                if copy == next {
                    mesh.positions.push(mesh.positions[v]);
                    mesh.source.push(mesh.source[v]);
                    doubled.push(mesh.source[v]);
                }
                mesh.faces[f][k] = copy;
            }
        }
    }
    doubled
}

/// The vertices of each connected piece, the largest piece first.
pub fn pieces(mesh: &ForeignMesh) -> Vec<Vec<u32>> {
    let mut sets = DisjointSets::new(mesh.positions.len());
    mesh.faces.iter().flat_map(sides).for_each(|[a, b]| sets.join(a, b));
    let mut of: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    (0..mesh.positions.len() as u32).for_each(|v| of.entry(sets.find(v)).or_default().push(v));
    let mut pieces: Vec<Vec<u32>> = of.into_values().collect();
    pieces.sort_by_key(|piece| (std::cmp::Reverse(piece.len()), piece[0]));
    pieces
}

/// The borders of a mesh as loops of vertices, each as its faces run.
pub fn loops(mesh: &ForeignMesh) -> Vec<Vec<u32>> {
    // After `settle` one border at most leaves a vertex.
    let mut next: BTreeMap<u32, u32> = borders(&mesh.faces).into_iter().map(|[a, b]| (a, b)).collect();
    let mut loops = Vec::new();
    while let Some((first, mut v)) = next.pop_first() {
        let mut ring = vec![first];
        while let Some(after) = next.remove(&v) {
            ring.push(v);
            v = after;
        }
        loops.push(ring);
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::plain::parse_obj;
    use toile_bake::check::check;

    fn settled(text: &str) -> (ForeignMesh, Vec<(&'static str, usize)>) {
        let mut mesh = ForeignMesh::of(&parse_obj(text).unwrap());
        let done = settle(&mut mesh).into_iter().map(|r| (r.what, r.count)).collect();
        assert_eq!(check(&mesh.positions, &mesh.faces), Ok(()));
        (mesh, done)
    }

    /// A tube of eight quads.
    fn tube(turned: &[usize]) -> String {
        let mut text = String::new();
        for (y, k) in [0, 1].into_iter().flat_map(|y| (0..8).map(move |k| (y, k))) {
            let (s, c) = (k as f32 * std::f32::consts::FRAC_PI_4).sin_cos();
            text += &format!("v {s} {y} {c}\n");
        }
        for k in 0..8 {
            let (a, b) = (k + 1, (k + 1) % 8 + 1);
            let ring = if turned.contains(&k) { [a, a + 8, b + 8, b] } else { [a, b, b + 8, a + 8] };
            text += &format!("f {} {} {} {}\n", ring[0], ring[1], ring[2], ring[3]);
        }
        text
    }

    #[test]
    fn a_sound_tube_is_left_and_has_two_borders() {
        let (mesh, done) = settled(&tube(&[]));
        assert!(done.is_empty());
        let found = loops(&mesh);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [8, 8]);
        assert!(mesh.normal(0).dot(mesh.middle(0) - Vec3::Y * 0.5) > 0.0);
    }

    #[test]
    fn faces_from_the_other_side_are_turned_and_a_tube_inside_out_too() {
        assert_eq!(settled(&tube(&[2, 5])).1, [("faces turned the way of their neighbours", 2)]);
        let (mesh, done) = settled(&tube(&[0, 1, 2, 3, 4, 5, 6, 7]));
        assert!(done.is_empty() && mesh.normal(0).dot(mesh.middle(0) - Vec3::Y * 0.5) > 0.0);
    }

    #[test]
    fn a_fin_is_parted_from_the_surface_that_it_stands_on() {
        let fin = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nv 1 0 1\nv 1 1 1\n\
            f 1 2 3 4\nf 2 5 6 3\nf 2 7 8 3\n";
        let (mesh, done) = settled(fin);
        let names = ["edges of more than two faces parted", "vertices between surfaces that touch doubled"];
        assert_eq!(done, [(names[0], 1), (names[1], 2)]);
        let found = pieces(&mesh);
        assert_eq!(found.iter().map(Vec::len).collect::<Vec<_>>(), [6, 4]);
        // The copies are still known by the file's numbers.
        assert!(found[1].iter().all(|v| [2, 3, 7, 8].contains(&mesh.source[*v as usize])));
    }

    #[test]
    fn surfaces_that_touch_in_a_point_and_a_moebius_band_are_parted() {
        let bow = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n";
        let (mesh, done) = settled(bow);
        assert_eq!((pieces(&mesh).len(), done.len()), (2, 1));
        let band = tube(&[]).replace("f 8 1 9 16", "f 8 9 1 16");
        let (mesh, _) = settled(&band);
        assert_eq!(loops(&mesh).len(), 1, "the band is cut open");
    }
}
