//! Report on a foreign mesh: findings, repairs, and the use of each piece.

use serde::Serialize;

/// Vertices that a repair names at most: enough to find the place in a modelling program.
const NAMED: usize = 8;

/// One kind of repair.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Repair {
    /// The fault and the repair.
    pub what: &'static str,
    /// How often.
    pub count: usize,
    /// The first vertices that it touched, by the file's own numbers, counted from 1.
    pub vertices: Vec<u32>,
}

impl Repair {
    /// A repair of so many places; `vertices` are the file's own numbers.
    pub fn new(what: &'static str, count: usize, vertices: impl IntoIterator<Item = u32>) -> Self {
        let mut named: Vec<u32> = Vec::new();
        for v in vertices {
            if named.len() == NAMED {
                break;
            }
            if !named.contains(&v) {
                named.push(v);
            }
        }
        Self { what, count, vertices: named }
    }
}

/// Use of a piece of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Behaviour {
    /// Moves as cloth where it is not held.
    Simulated,
    /// Follows the skin beneath it.
    Skinned,
    /// Rides on the body without bending: a button, a buckle.
    Rigid,
}

impl Behaviour {
    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simulated => "simulated",
            Self::Skinned => "skinned",
            Self::Rigid => "rigid",
        }
    }
}

/// One connected piece of a mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PieceReport {
    /// The file's number of its first vertex, counted from 1.
    pub vertex: u32,
    /// Its vertices.
    pub vertices: usize,
    /// Those of them that move as cloth.
    pub moving: usize,
    /// Its use.
    pub behaviour: Behaviour,
    /// Why, in a few words.
    pub why: String,
    /// Length of half of its edges or less (mm).
    pub edge_mm: f32,
    /// Stretch or compression of its edges when it is put on, 99 % of them or less (0.01 is 1 %).
    pub start_strain: f32,
}

/// The body that a mesh is made for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MadeForReport {
    /// How it is known, in a few words.
    pub how: String,
    /// Stature (mm).
    pub stature_mm: f32,
    /// Girth of chest or bust (mm).
    pub chest_girth_mm: f32,
    /// Girth of the waist (mm).
    pub waist_girth_mm: f32,
    /// Girth of the hip (mm).
    pub hip_girth_mm: f32,
}

/// Report on a foreign mesh.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeshReport {
    /// The file, as the user gave it.
    pub file: String,
    /// Unit and axes that its numbers were taken to be in.
    pub unit: String,
    /// The body that it is made for.
    pub made_for: MadeForReport,
    /// The repairs, in the order in which they were made.
    pub repairs: Vec<Repair>,
    /// Its pieces, the largest first.
    pub pieces: Vec<PieceReport>,
    /// Notes for the user, one sentence each.
    pub notes: Vec<String>,
}

impl MeshReport {
    /// The report for a person: a line for what was repaired, one a piece that is worth naming, then the notes.
    pub fn lines(&self) -> Vec<String> {
        let MadeForReport { how, stature_mm, .. } = &self.made_for;
        let mut lines = vec![format!("{}: {}; made for {how}, {:.0} mm tall", self.file, self.unit, stature_mm)];
        if !self.repairs.is_empty() {
            let repairs = self.repairs.iter().map(|r| format!("{} {}{}", r.count, r.what, at(&r.vertices)));
            lines.push(format!("repaired: {}", repairs.collect::<Vec<_>>().join("; ")));
        }
        for piece in self.pieces.iter().take(NAMED) {
            let PieceReport { vertex, vertices, moving, behaviour, why, .. } = piece;
            let behaviour = behaviour.name();
            lines.push(format!(
                "the piece at vertex {vertex}: {behaviour} ({why}), {moving} of {vertices} vertices move"
            ));
        }
        if self.pieces.len() > NAMED {
            lines.push(format!("and {} smaller pieces", self.pieces.len() - NAMED));
        }
        lines.extend(self.notes.iter().cloned());
        lines
    }
}

fn at(vertices: &[u32]) -> String {
    match vertices {
        [] => String::new(),
        [first, ..] => format!(" (vertex {first}{})", if vertices.len() > 1 { ", ..." } else { "" }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_repair_names_each_vertex_once_and_few_of_them() {
        let repair = Repair::new("duplicate vertices joined", 20, (1..=20).flat_map(|v| [v, v]));
        assert_eq!((repair.count, repair.vertices), (20, vec![1, 2, 3, 4, 5, 6, 7, 8]));
    }
}
