//! Panels sewn together: one mesh, in which the vertices of both sides of a seam are one.

use std::collections::BTreeMap;

use glam::{DVec2, Vec2};

use super::error::TailorError;
use super::limits::{MAX_IMPROVEMENT, MAX_OUTLINE_POINTS, MAX_PARTICLES, SPACING_M};
use super::panel_mesh::{MeshBudget, PanelMesh, mesh};
use super::sampling::sample;
use crate::pattern::{Pattern, Seam};
use toile_bake::check::corners;
use toile_bake::shape::{Face, NO_VERTEX};
use toile_base::garment::trim::ClothTrim;

/// How often panels are meshed again because their seams would fold a face.
const MAX_REPAIRS: usize = 4;

/// A pattern sewn: the faces of all panels between common vertices. Its shape at rest is flat, panel by panel, and stands
/// in `flat`; where it starts on a body is not yet known.
#[derive(Debug, Clone, PartialEq)]
pub struct SewnMesh {
    /// The panels' own meshes, in the order of the pattern.
    pub panels: Vec<PanelMesh>,
    /// The vertices of panels that became one, each as panel and its vertex `[vertices]`. Most have one, those of a seam
    /// two, where seams meet there are more.
    pub members: Vec<Vec<[u32; 2]>>,
    /// The vertex that each vertex of a panel became `[panels][vertices of the panel]`.
    pub number: Vec<Vec<u32>>,
    /// Faces between common vertices, counter-clockwise seen from outside; a quad's first side runs along the weft.
    pub faces: Vec<Face>,
    /// Panel of each face `[faces]`.
    pub face_panels: Vec<u32>,
    /// The corners of each face at rest (m): weft along x, warp along y `[faces]`. What [`toile_bake::Shape`] calls
    /// texture coordinates.
    pub flat: Vec<[Vec2; 4]>,
    /// True where a quad is split along b-d `[faces]`.
    pub split: Vec<bool>,
    /// What is put on the panels, on the cloth as `flat` has it.
    pub trims: Vec<ClothTrim>,
    /// The vertices along each seam, from its beginning to its end `[seams]`.
    pub seams: Vec<Vec<u32>>,
}

/// Meshes every panel of a pattern at a spacing (m) and sews them.
///
/// # Errors
/// One sentence: the panel, what is wrong where, and the cure.
pub fn sew(pattern: &Pattern, spacing: f64) -> Result<SewnMesh, TailorError> {
    if !SPACING_M.contains(&spacing) {
        return Err(TailorError::Spacing { spacing });
    }
    let mut outlines = 0.0;
    for panel in pattern.panels() {
        outlines += panel.lengths().iter().map(|l| 1.0 + l / spacing).sum::<f64>();
        if outlines > MAX_OUTLINE_POINTS as f64 {
            return Err(TailorError::TooMany { panel: panel.name.clone() });
        }
    }
    let boundaries = sample(pattern, spacing);
    let mut extra: Vec<Vec<DVec2>> = vec![Vec::new(); boundaries.len()];
    let mut panels: Vec<PanelMesh> = Vec::new();
    let mut allowed = MeshBudget { particles: MAX_PARTICLES, effort: MAX_IMPROVEMENT / boundaries.len().max(1) };
    for (panel, boundary) in pattern.panels().iter().zip(&boundaries) {
        let meshed = mesh(panel, boundary, spacing, &[], allowed)?;
        allowed.particles = allowed.particles.saturating_sub(meshed.points.len());
        panels.push(meshed);
    }
    for _ in 0..MAX_REPAIRS {
        let sewn = join(pattern, &panels);
        let folds = folds(&sewn);
        if folds.is_empty() {
            return Ok(sewn);
        }
        for (panel, at) in folds {
            extra[panel].push(at);
        }
        for (i, panel) in pattern.panels().iter().enumerate().filter(|(i, _)| !extra[*i].is_empty()) {
            panels[i] =
                mesh(panel, &boundaries[i], spacing, &extra[i], MeshBudget { particles: MAX_PARTICLES, ..allowed })?;
        }
    }
    let sewn = join(pattern, &panels);
    match folds(&sewn).first() {
        None => Ok(sewn),
        Some(&(panel, at)) => {
            Err(TailorError::Folded { panel: pattern.panels()[panel].name.clone(), x: at.x, y: at.y })
        }
    }
}

/// Joins the vertices of all seams.
fn join(pattern: &Pattern, panels: &[PanelMesh]) -> SewnMesh {
    let mut first = vec![0usize];
    panels.iter().for_each(|p| first.push(first[first.len() - 1] + p.points.len()));
    let mut groups = Groups { above: (0..first[panels.len()]).collect() };
    let along = |k: usize, seam: &Seam| {
        let side = &seam.sides[k];
        let points = panels[side.panel].boundary.along(side);
        points.into_iter().map(|v| first[side.panel] + v).collect::<Vec<usize>>()
    };
    let sides: Vec<[Vec<usize>; 2]> = pattern.seams().iter().map(|s| [along(0, s), along(1, s)]).collect();
    for [a, b] in &sides {
        debug_assert_eq!(a.len(), b.len(), "both sides of a seam have as many points");
        a.iter().zip(b).for_each(|(a, b)| groups.join(*a, *b));
    }
    let mut number = vec![NO_VERTEX; first[panels.len()]];
    let mut members: Vec<Vec<[u32; 2]>> = Vec::new();
    for (p, panel) in panels.iter().enumerate() {
        for v in 0..panel.points.len() {
            let top = groups.top(first[p] + v);
            if number[top] == NO_VERTEX {
                number[top] = members.len() as u32;
                members.push(Vec::new());
            }
            let id = number[top];
            number[first[p] + v] = id;
            members[id as usize].push([p as u32, v as u32]);
        }
    }
    let seams = sides.iter().map(|[a, _]| a.iter().map(|v| number[*v]).collect()).collect();
    let number = (0..panels.len()).map(|p| number[first[p]..first[p + 1]].to_vec()).collect();
    let mut sewn = SewnMesh {
        panels: panels.to_vec(),
        number,
        members,
        faces: Vec::new(),
        face_panels: Vec::new(),
        flat: Vec::new(),
        split: Vec::new(),
        trims: Vec::new(),
        seams,
    };
    for (p, panel) in panels.iter().enumerate() {
        let inside = pattern.shows_inside(p);
        add_faces(&mut sewn, panel, p, inside);
        sewn.trims.extend(pattern.panels()[p].trims.iter().map(|trim| trim.on_cloth(p as u32, panel.axes, inside)));
    }
    sewn
}

/// Adds a panel's faces; where its drawing shows the inside they run the other way round.
fn add_faces(sewn: &mut SewnMesh, panel: &PanelMesh, index: usize, inside: bool) {
    for (face, split) in panel.faces.iter().zip(&panel.split) {
        let [a, b, c, d] = *face;
        let face = match (inside, d) {
            (false, _) => *face,
            (true, NO_VERTEX) => [b, a, c, d],
            (true, _) => [b, a, d, c],
        };
        let at = |v: u32| {
            let p = panel.points[if v == NO_VERTEX { face[0] } else { v } as usize];
            let weft = if inside { -p.dot(panel.axes[0]) } else { p.dot(panel.axes[0]) };
            Vec2::new(weft as f32, p.dot(panel.axes[1]) as f32)
        };
        sewn.flat.push(face.map(at));
        let number = &sewn.number[index];
        let face = face.map(|v| if v == NO_VERTEX { v } else { number[v as usize] });
        sewn.faces.push(face);
        sewn.face_panels.push(index as u32);
        // The other diagonal has the other names when the first two corners are exchanged.
        sewn.split.push(d != NO_VERTEX && *split != inside);
    }
}

/// A side of a face, by its panel's own vertices.
struct FaceSide {
    panel: usize,
    ends: [u32; 2],
}

/// Where seams would fold a face flat, or would bring more than two faces to an edge: the panel, and a place at the middle
/// of the edge (m), at which a further point keeps both apart.
fn folds(sewn: &SewnMesh) -> Vec<(usize, DVec2)> {
    let mut around: BTreeMap<[u32; 2], Vec<FaceSide>> = BTreeMap::new();
    for (panel, own) in sewn.panels.iter().enumerate().flat_map(|(p, panel)| panel.faces.iter().map(move |f| (p, f))) {
        let own = corners(own);
        let number = |v: u32| sewn.number[panel][v as usize];
        for i in 0..own.len() {
            for j in (i + 1)..own.len() {
                let ends = [own[i], own[j]];
                let key = ends.map(number);
                let side = j == i + 1 || (i == 0 && j + 1 == own.len());
                // A diagonal matters only where both of its ends are one.
                if side || key[0] == key[1] {
                    around.entry([key[0].min(key[1]), key[0].max(key[1])]).or_default().push(FaceSide { panel, ends });
                }
            }
        }
    }
    let wrong = around.iter().filter(|(key, sides)| key[0] == key[1] || sides.len() > 2);
    let mut found: Vec<(usize, [u32; 2])> = wrong
        .flat_map(|(_, sides)| sides)
        .filter(|side| !on_outline(side.ends, sewn.panels[side.panel].boundary.points.len() as u32))
        .map(|side| (side.panel, [side.ends[0].min(side.ends[1]), side.ends[0].max(side.ends[1])]))
        .collect();
    found.sort_unstable();
    found.dedup();
    let middle = |(panel, [a, b]): (usize, [u32; 2])| {
        let at = |v: u32| sewn.panels[panel].points[v as usize];
        (panel, 0.5 * (at(a) + at(b)))
    };
    found.into_iter().map(middle).collect()
}

/// Whether two vertices follow each other on an outline of so many.
fn on_outline([a, b]: [u32; 2], outline: u32) -> bool {
    a < outline && b < outline && ((a + 1) % outline == b || (b + 1) % outline == a)
}

/// Groups of vertices that are one.
struct Groups {
    above: Vec<usize>,
}

impl Groups {
    fn top(&mut self, mut i: usize) -> usize {
        while self.above[i] != i {
            self.above[i] = self.above[self.above[i]];
            i = self.above[i];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.top(a), self.top(b));
        self.above[a.max(b)] = a.min(b);
    }
}
