//! A mesh of the user's own on a shopper: laid, held, judged, and reported.

use std::sync::Arc;

use glam::Vec3;
use toile_base::garment::look::MeshPicture;
use toile_base::texture::Texture;

use super::hold::Holding;
use super::judge::{self, MOST_MOVING, PieceMeasures};
use super::lay::{LaidMesh, LayInput, lay};
use super::mesh::ForeignMesh;
use super::own_mesh::OwnMesh;
use super::place::Below;
use super::report::{Behaviour, MeshReport, PieceReport};
use super::surface::{loops, pieces};
use crate::import::obj::warp_upright;
use crate::texture::Atlas;
use toile_bake::Shape;
use toile_bake::shape::NO_VERTEX;
use toile_base::body::Body;

/// Borders below the crotch that lie this far beside the middle (m) are those of trouser legs.
const LEG_BESIDE_M: f32 = 0.04;

/// Cloth within this distance of a trim (m) is held with it, so that it stays where it is sewn on.
const SEWN_M: f32 = 0.02;

/// The picture or colour of each face of a mesh.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Painted {
    /// The pictures of all materials.
    pub pictures: Vec<Arc<Texture>>,
    /// Picture of each face, counted from 1; 0 is none `[faces]`.
    pub of_face: Vec<u8>,
}

/// A mesh on a shopper.
#[derive(Debug, Clone, PartialEq)]
pub struct WornMesh {
    /// All of it as one shape, without a picture.
    pub shape: Shape,
    /// The pictures of its faces.
    pub painted: Option<Painted>,
    /// Vertices of what is worn in one layer, sorted; the innermost layer first.
    pub layers: Vec<Vec<u32>>,
    /// Its report.
    pub report: MeshReport,
}

impl OwnMesh {
    /// Puts the mesh on a shopper as it is made: nothing is stretched to fit.
    pub fn wear(&self, shopper: &Body) -> WornMesh {
        self.wear_cut(&self.mesh, &self.made_for.body, shopper)
    }

    /// The same with the lengths of another cut of the same mesh, for the body `from`.
    pub fn wear_cut(&self, cut: &ForeignMesh, from: &Body, shopper: &Body) -> WornMesh {
        let pieces = pieces(cut);
        let below = self.below();
        let piece = numbers(&pieces, cut.positions.len());
        let input = LayInput { weights: &self.weights, below: &below, piece: &piece };
        let mut laid = lay(cut, &input, from, shopper);
        let (held, reports) = self.decide(cut, &mut laid, shopper, &pieces);
        let layers = layers(&laid, &piece, &reports, &pieces);
        let shape = shape(cut, laid, held);
        let painted = (!cut.pictures.is_empty()).then(|| Painted {
            pictures: cut.pictures.clone(),
            of_face: cut.materials.iter().map(|m| m.picture).collect(),
        });
        let mut notes = self.notes.clone();
        notes.extend(no_cloth(&reports));
        notes.extend(other_girths(from, shopper));
        let report = MeshReport {
            file: self.path.clone(),
            unit: self.axes.words(),
            made_for: self.made_for.report(),
            repairs: self.repairs.clone(),
            pieces: reports,
            notes,
        };
        WornMesh { shape, painted, layers, report }
    }

    /// What is held of each piece, and why.
    fn decide(
        &self,
        cut: &ForeignMesh,
        laid: &mut LaidMesh,
        shopper: &Body,
        pieces: &[Vec<u32>],
    ) -> (Vec<bool>, Vec<PieceReport>) {
        let neighbours = cut.neighbours();
        let measured = measured(cut, laid, pieces);
        let trims = trims(&measured);
        let mut holding = Holding::new(cut, laid, shopper, &neighbours);
        let sticks = cut.says_what_moves.then(|| sticks(cut));
        let mut verdicts = Vec::new();
        let mut moving = 0;
        for ((piece, is_trim), measures) in pieces.iter().zip(&trims).zip(&measured) {
            let by = match &sticks {
                Some(sticks) => {
                    piece.iter().for_each(|v| holding.held[*v as usize] = sticks[*v as usize]);
                    "as its materials say"
                }
                None if *is_trim => "",
                None => holding.hold(piece),
            };
            let free = piece.iter().filter(|v| !holding.held[**v as usize]).count();
            let verdict = if *is_trim {
                (Behaviour::Rigid, "small".to_owned())
            } else if let Some(flaw) = measures.flaw() {
                (Behaviour::Skinned, flaw)
            } else if judge::is_tight(free, piece.len()) {
                (Behaviour::Skinned, "it lies on the skin".to_owned())
            } else if moving + free > MOST_MOVING {
                (Behaviour::Skinned, format!("more than {MOST_MOVING} vertices would move"))
            } else {
                moving += free;
                (Behaviour::Simulated, by.to_owned())
            };
            if verdict.0 != Behaviour::Simulated {
                piece.iter().for_each(|v| holding.held[*v as usize] = true);
            }
            verdicts.push(verdict);
        }
        let mut held = holding.held;
        let trimmed = pieces.iter().zip(&trims).filter(|(_, trim)| **trim);
        trimmed.for_each(|(piece, _)| judge::stiffen(&mut laid.weights, piece));
        sew_on(laid, pieces, &trims, &mut held);
        let report = |((piece, measures), verdict): ((&Vec<u32>, &PieceMeasures), (Behaviour, String))| {
            let first = piece.iter().map(|v| cut.source[*v as usize]).min().unwrap_or_default();
            let moving = piece.iter().filter(|v| !held[**v as usize]).count();
            measures.report(first, piece.len(), moving, verdict)
        };
        let reports = pieces.iter().zip(&measured).zip(verdicts).map(report).collect();
        (held, reports)
    }
}

/// What touches a face whose material does not move.
fn sticks(cut: &ForeignMesh) -> Vec<bool> {
    let mut held = vec![false; cut.positions.len()];
    let fixed = (0..cut.faces.len()).filter(|f| !cut.materials[*f].free);
    fixed.flat_map(|f| toile_bake::check::corners(&cut.faces[f])).for_each(|v| held[*v as usize] = true);
    held
}

/// What each piece hangs around below the crotch: legs where it ends beside the middle.
pub(super) fn below(mesh: &ForeignMesh, pieces: &[Vec<u32>], crotch: f32) -> Vec<Below> {
    let mut of = vec![Below::Skirt; mesh.positions.len()];
    let middle = |ring: &Vec<u32>| ring.iter().map(|v| mesh.positions[*v as usize]).sum::<Vec3>() / ring.len() as f32;
    let is_leg = |ring: &Vec<u32>| {
        let p = middle(ring);
        p.y < crotch && p.x.abs() > LEG_BESIDE_M
    };
    let legs: Vec<u32> = loops(mesh).into_iter().filter(is_leg).map(|ring| ring[0]).collect();
    for piece in pieces.iter().filter(|piece| legs.iter().any(|v| piece.binary_search(v).is_ok())) {
        piece.iter().for_each(|v| of[*v as usize] = Below::Legs);
    }
    of
}

/// The number of each vertex's piece.
fn numbers(pieces: &[Vec<u32>], vertices: usize) -> Vec<u32> {
    let mut of = vec![0; vertices];
    for (k, piece) in pieces.iter().enumerate() {
        piece.iter().for_each(|v| of[*v as usize] = k as u32);
    }
    of
}

/// Properties of each piece.
fn measured(cut: &ForeignMesh, laid: &LaidMesh, pieces: &[Vec<u32>]) -> Vec<PieceMeasures> {
    let of = numbers(pieces, cut.positions.len());
    let mut faces: Vec<Vec<usize>> = vec![Vec::new(); pieces.len()];
    (0..cut.faces.len()).for_each(|f| faces[of[cut.faces[f][0] as usize] as usize].push(f));
    pieces.iter().zip(&faces).map(|(piece, faces)| PieceMeasures::of(cut, laid, piece, faces)).collect()
}

/// The pieces that are trims: small ones, of a mesh that has a larger one.
fn trims(measured: &[PieceMeasures]) -> Vec<bool> {
    let found: Vec<bool> = measured.iter().map(PieceMeasures::is_trim).collect();
    if found.iter().all(|trim| *trim) { vec![false; found.len()] } else { found }
}

/// Holds the cloth that trims are sewn on.
fn sew_on(laid: &LaidMesh, pieces: &[Vec<u32>], trims: &[bool], held: &mut [bool]) {
    let sewn: Vec<Vec3> = pieces
        .iter()
        .zip(trims)
        .filter(|(_, trim)| **trim)
        .flat_map(|(p, _)| p)
        .map(|v| laid.worn[*v as usize])
        .collect();
    if sewn.is_empty() {
        return;
    }
    for (p, held) in laid.worn.iter().zip(held.iter_mut()).filter(|(_, held)| !**held) {
        *held = sewn.iter().any(|q| q.distance_squared(*p) < SEWN_M * SEWN_M);
    }
}

/// The vertices of each layer. What is no layer of its own goes with the piece that it lies next to.
fn layers(laid: &LaidMesh, piece: &[u32], reports: &[PieceReport], pieces: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let mut depth = laid.order.depth.clone();
    let is_trim = |p: usize| reports[p].behaviour == Behaviour::Rigid;
    for p in (0..pieces.len()).filter(|p| is_trim(*p)) {
        let at = laid.worn[pieces[p][0] as usize];
        let others = (0..laid.worn.len()).filter(|v| !is_trim(piece[*v] as usize));
        let far = |v: &usize| laid.worn[*v].distance_squared(at);
        if let Some(next) = others.min_by(|a, b| far(a).total_cmp(&far(b))) {
            depth[p] = laid.order.depth[piece[next] as usize];
        }
    }
    let deepest = depth.iter().copied().max().unwrap_or(0);
    let of = |d: u8| (0..piece.len() as u32).filter(|v| depth[piece[*v as usize] as usize] == d).collect::<Vec<u32>>();
    (0..=deepest).map(of).filter(|layer| !layer.is_empty()).collect()
}

impl WornMesh {
    /// The shape of each layer, the innermost first.
    pub fn shapes(&self) -> Vec<Shape> {
        let part = |layer: &Vec<u32>| {
            let (mut part, faces) = part_of(&self.shape, layer);
            part.picture = self.painted.as_ref().and_then(|all| picture(&part, all, &faces));
            part
        };
        self.layers.iter().map(part).collect()
    }
}

/// The picture of a shape whose faces are these of the whole mesh, in one atlas.
fn picture(shape: &Shape, painted: &Painted, faces: &[usize]) -> Option<MeshPicture> {
    let Painted { pictures, of_face } = painted;
    if shape.uvs.len() != shape.faces.len() {
        return None;
    }
    let of_face: Vec<u8> = faces.iter().map(|f| of_face[*f]).collect();
    // Faces without a picture show the fabric: a picture that covers nothing.
    let bare = of_face.contains(&0);
    let nothing = bare.then(|| Arc::new(Texture { width: 1, height: 1, texels: vec![[0; 4]] }));
    let all: Vec<Arc<Texture>> = nothing.into_iter().chain(pictures.iter().cloned()).collect();
    let atlas = Atlas::of(&all)?;
    let number: Vec<[u8; 4]> = of_face.iter().map(|k| [if bare { *k } else { k - 1 }; 4]).collect();
    let corners = shape.corners(&shape.uvs);
    let placed = corners.into_iter().zip(shape.corners(&number)).map(|(uvs, [k, ..])| atlas.place(usize::from(k), uvs));
    Some(MeshPicture { corners: placed.collect(), texture: atlas.texture })
}

/// The part of a shape on some of its vertices, sorted, that no face leaves; and which faces those are.
fn part_of(shape: &Shape, layer: &[u32]) -> (Shape, Vec<usize>) {
    if layer.len() == shape.cut.len() {
        return (shape.clone(), (0..shape.faces.len()).collect());
    }
    let place = |v: u32| layer.binary_search(&v).map_or(NO_VERTEX, |k| k as u32);
    let mut part = Shape { solver: shape.solver, ..Shape::default() };
    let own = |i: &usize| place(shape.faces[*i][0]) != NO_VERTEX;
    let faces: Vec<usize> = (0..shape.faces.len()).filter(own).collect();
    for &i in &faces {
        part.faces.push(shape.faces[i].map(|v| if v == NO_VERTEX { v } else { place(v) }));
        part.uvs.push(shape.uvs[i]);
    }
    for v in layer.iter().map(|v| *v as usize) {
        part.push(shape.cut[v], shape.worn[v], shape.fixed[v], shape.parts[v]);
        part.weights.push(shape.weights[v]);
    }
    (part, faces)
}

/// Girths that differ by more than this (m) are worth a word.
const OTHER_GIRTH_M: f32 = 0.03;

/// Says where the shopper is larger or smaller than the body that the cut is for.
fn other_girths(from: &Body, shopper: &Body) -> Option<String> {
    let (a, b) = (&from.measures, &shopper.measures);
    let zones = [
        ("chest", a.chest_girth, b.chest_girth),
        ("waist", a.waist_girth, b.waist_girth),
        ("hip", a.hip_girth, b.hip_girth),
    ];
    let other = zones.iter().filter(|(_, a, b)| (a - b).abs() > OTHER_GIRTH_M);
    let words: Vec<String> = other.map(|(zone, a, b)| format!("{zone} {:+.0} mm", (b - a) * 1e3)).collect();
    let words = words.join(", ");
    (!words.is_empty())
        .then(|| format!("the shopper is not of the body that it is made for: {words}; it is not stretched to fit"))
}

/// Says that nothing moves, where it is so.
fn no_cloth(pieces: &[PieceReport]) -> Option<String> {
    let still = pieces.iter().all(|p| p.behaviour != Behaviour::Simulated);
    still.then(|| "nothing of it moves as cloth: it follows the skin as drawn on, and is stretched with it".to_owned())
}

fn shape(cut: &ForeignMesh, laid: LaidMesh, fixed: Vec<bool>) -> Shape {
    let upright = cut.faces.iter().zip(&cut.uvs).map(|(f, uv)| warp_upright(&cut.positions, *f, *uv));
    let (faces, uvs) = upright.unzip();
    Shape {
        cut: cut.positions.clone(),
        worn: laid.worn,
        faces,
        fixed,
        parts: laid.parts,
        weights: laid.weights,
        uvs,
        ..Shape::default()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;
    use toile_base::garment::Part;

    use super::*;

    #[test]
    fn a_mesh_shows_its_pictures_and_its_fabric_where_it_has_none() {
        let mut shape = Shape::default();
        for at in [[0.0, 0.0], [0.04, 0.0], [0.08, 0.0], [0.0, 0.04], [0.04, 0.04], [0.08, 0.04]] {
            let at = Vec3::new(at[0], at[1], 0.0);
            shape.push(at, at, false, Part::All);
        }
        shape.faces = vec![[0, 1, 4, 3], [1, 2, 5, NO_VERTEX]];
        let painted = Painted { pictures: vec![Arc::new(Texture::plain([9, 8, 7]))], of_face: vec![1, 0] };
        assert_eq!(picture(&shape, &painted, &[0, 1]), None, "no texture points");
        shape.uvs = vec![[Vec2::splat(0.5); 4]; 2];
        let picture = picture(&shape, &painted, &[0, 1]).unwrap();
        assert_eq!(picture.corners.len(), 3);
        let texel = |uv: Vec2| {
            let at = uv * picture.texture.width as f32;
            picture.texture.texels
                [(picture.texture.width - 1 - at.y as u32) as usize * picture.texture.width as usize + at.x as usize]
        };
        assert_eq!(texel(picture.corners[0][0]), [9, 8, 7, 255]);
        assert_eq!(texel(picture.corners[2][0])[3], 0, "the fabric's own colour");
    }
}
