//! A seam file: what a draft without sewing leaves open. TOML, beside the draft.
//!
//! It names the panels, each with the piece that it is cut from, and the seams between runs of their edges. A run goes from
//! one position to another, counted in the edges of the draft from 0: 4 is the beginning of edge 4, and 7.5 the middle of
//! edge 7. Both runs of a seam are sewn from their first position to their second.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec2, DVec3};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::error::{PatternFault, meant};
use super::json::name;
use super::piece::{EdgeRange, Half, Piece, UnfoldedPiece};
use crate::pattern::limits::{MAX_PANELS, MAX_SEAMS};
use crate::pattern::{Panel, PanelPlacement, Pattern, PatternFlaw, Seam, SeamSide};
use crate::toml_keys::place;

/// A seam file as it stands.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeamFile {
    panel: Vec<PanelEntry>,
    #[serde(default)]
    seam: Vec<SeamEntry>,
}

/// One `[[panel]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct PanelEntry {
    /// Its name in the seams.
    name: String,
    /// The piece of the draft that it is cut from.
    piece: String,
    /// Number of the edge on which the cloth is folded when it is cut.
    fold: Option<usize>,
    /// True for the mirror image of the piece: the left sleeve, where the right one is drawn.
    #[serde(default)]
    mirrored: bool,
    /// Direction of the warp, where it is not the draft's own.
    grain: Option<[f64; 2]>,
    /// The part of the body that it is for.
    label: Option<String>,
    /// The side of the body, or of the arm, that it lies on.
    side: Option<PanelSide>,
}

/// Where a panel lies: what of the body is behind it, seen from outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum PanelSide {
    Front,
    Back,
    Left,
    Right,
}

impl PanelSide {
    /// The placement of a panel that is drawn as seen from outside, upright; how high it hangs, its seams say.
    fn placement(self) -> PanelPlacement {
        let turn = match self {
            Self::Front => 0.0,
            Self::Back => PI,
            Self::Left => FRAC_PI_2,
            Self::Right => -FRAC_PI_2,
        };
        PanelPlacement { translation: DVec3::ZERO, rotation: DQuat::from_rotation_y(turn) }
    }
}

/// One `[[seam]]`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct SeamEntry {
    name: String,
    sew: RunEntry,
    to: RunEntry,
}

/// One side of a seam.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct RunEntry {
    panel: String,
    edges: [f64; 2],
    #[serde(default)]
    half: Half,
}

impl SeamFile {
    /// Reads a seam file.
    pub fn parse(text: &str) -> Result<Self, PatternFault> {
        let mut file: Self = from_toml(text)?;
        for panel in &mut file.panel {
            panel.name = name(&panel.name);
            panel.piece = name(&panel.piece);
        }
        for seam in &mut file.seam {
            seam.name = name(&seam.name);
            [&mut seam.sew, &mut seam.to].into_iter().for_each(|run| run.panel = name(&run.panel));
        }
        Ok(file)
    }

    /// The panels and seams of a draft.
    pub fn sew(&self, pieces: &[Piece]) -> Result<Pattern, PatternFault> {
        let too_many =
            |what, count, most, limit| PatternFlaw::TooMany { place: "the seam file".into(), what, count, most, limit };
        if self.panel.len() > MAX_PANELS {
            return Err(too_many("panels", self.panel.len(), MAX_PANELS, "MAX_PANELS").into());
        }
        if self.seam.len() > MAX_SEAMS {
            return Err(too_many("seams", self.seam.len(), MAX_SEAMS, "MAX_SEAMS").into());
        }
        let mut unfolded =
            self.panel.iter().map(|entry| unfold(entry, pieces)).collect::<Result<Vec<_>, PatternFault>>()?;
        let runs = self.seam.iter().flat_map(|seam| [(&seam.name, &seam.sew), (&seam.name, &seam.to)]);
        let runs = runs.map(|(seam, run)| self.run(seam, run)).collect::<Result<Vec<_>, PatternFault>>()?;
        for (panel, range) in &runs {
            unfolded[*panel].1.divide(range);
        }
        let side = |(panel, range): (usize, EdgeRange), seam: &str| {
            let (first, count, reversed) = unfolded[panel]
                .1
                .find(&range)
                .map_err(|reason| format!("seam {seam}: of panel {}, {reason}", self.panel[panel].name))?;
            Ok::<SeamSide, PatternFault>(SeamSide { panel, first, count, reversed })
        };
        let seams = self.seam.iter().zip(runs.chunks_exact(2)).map(|(seam, runs)| {
            let sides = [side(runs[0], &seam.name)?, side(runs[1], &seam.name)?];
            Ok(Seam { name: format!("seam {}", seam.name), sides })
        });
        let seams = seams.collect::<Result<Vec<Seam>, PatternFault>>()?;
        let panels = self.panel.iter().zip(unfolded).map(|(entry, (grain, unfolded))| Panel {
            name: entry.name.clone(),
            label: entry.label.clone(),
            edges: unfolded.into_edges(),
            grain,
            behind: false,
            placement: entry.side.map(PanelSide::placement),
            trims: Vec::new(),
        });
        Ok(Pattern::checked(panels.collect(), seams)?)
    }

    /// The panel of a run and its range.
    fn run(&self, seam: &str, run: &RunEntry) -> Result<(usize, EdgeRange), PatternFault> {
        let [from, to] = run.edges;
        if !(from.is_finite() && to.is_finite() && from >= 0.0 && to >= 0.0 && (from - to).abs() > 1e-3) {
            return Err(PatternFault::Content(format!(
                "seam {seam}: edges = [{from}, {to}] is no run of edges; give two different positions from 0"
            )));
        }
        let names = self.panel.iter().map(|p| p.name.as_str());
        let Some(panel) = names.clone().position(|name| name == run.panel) else {
            let cure = meant(&run.panel, names, "add a [[panel]] of that name");
            return Err(PatternFlaw::NoPanel { seam: format!("seam {seam}"), name: run.panel.clone(), cure }.into());
        };
        Ok((panel, EdgeRange { from, to, half: run.half }))
    }
}

/// A panel's grain and its edges before they are divided.
fn unfold(entry: &PanelEntry, pieces: &[Piece]) -> Result<(DVec2, UnfoldedPiece), PatternFault> {
    let Some(piece) = pieces.iter().find(|p| p.name == entry.piece) else {
        let known: Vec<&str> = pieces.iter().map(|p| p.name.as_str()).collect();
        return Err(PatternFault::Content(format!(
            "panel {} is cut from piece {}, which the draft has not; name one of {}",
            entry.name,
            entry.piece,
            known.join(", ")
        )));
    };
    let mut grain = entry.grain.map(DVec2::from).or(piece.grain).unwrap_or(DVec2::Y).normalize_or_zero();
    if entry.mirrored {
        grain.x = -grain.x;
    }
    let unfolded = UnfoldedPiece::new(piece, entry.fold.or(piece.fold), entry.mirrored);
    Ok((grain, unfolded.map_err(|reason| format!("panel {}: {reason}", entry.name))?))
}

/// A draft without a seam file: every piece is a panel, and nothing is sewn.
pub fn unsewn(pieces: &[Piece]) -> Result<Pattern, PatternFault> {
    let panel = |piece: &Piece| {
        let edges = UnfoldedPiece::new(piece, piece.fold, false);
        let edges = edges.map_err(|reason| format!("piece {}: {reason}", piece.name))?.into_edges();
        let grain = piece.grain.unwrap_or(DVec2::Y);
        Ok(Panel {
            name: piece.name.clone(),
            label: None,
            edges,
            grain,
            behind: false,
            placement: None,
            trims: Vec::new(),
        })
    };
    let panels = pieces.iter().map(panel).collect::<Result<Vec<Panel>, PatternFault>>()?;
    Ok(Pattern::checked(panels, Vec::new())?)
}

/// Reads a TOML text, an error with its line and column.
fn from_toml<T: DeserializeOwned>(text: &str) -> Result<T, PatternFault> {
    toml::from_str(text).map_err(|e| {
        let (line, column) = place(text, e.span().map_or(0, |s| s.start));
        let reason = e.message().split_whitespace().collect::<Vec<_>>().join(" ");
        PatternFault::Content(format!(
            "line {line}, column {column}: {reason}; see docs/garments.md for what a seam file holds"
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pattern::Curve;

    fn pieces() -> Vec<Piece> {
        let p = [[0.0, 1.0], [0.0, 0.0], [0.5, 0.0], [0.5, 1.0]].map(DVec2::from);
        let lines: Vec<Curve> = (0..4).map(|i| Curve::Line([p[i], p[(i + 1) % 4]])).collect();
        vec![Piece::of_steps("half", &lines, None).unwrap()]
    }

    const TUBE: &str = r#"
        panel = [{ name = "front", piece = "half", fold = 0 }, { name = "back", piece = "half", fold = 0 }]
        seam = [
            { name = "right", sew = { panel = "front", edges = [2, 3] }, to = { panel = "back", edges = [2, 3], half = "mirrored" } },
            { name = "left", sew = { panel = "front", edges = [2, 3], half = "mirrored" }, to = { panel = "back", edges = [2, 3] } },
        ]"#;

    fn sewn(text: &str) -> Result<Pattern, String> {
        SeamFile::parse(text).and_then(|file| file.sew(&pieces())).map_err(|fault| fault.of("x.toml").to_string())
    }

    #[test]
    fn two_halves_on_the_fold_become_a_tube() {
        let pattern = sewn(TUBE).unwrap();
        assert_eq!((pattern.panels().len(), pattern.seams().len()), (2, 2));
        assert!(!pattern.shows_inside(0) && !pattern.shows_inside(1));
    }

    #[test]
    fn each_fault_names_its_place_and_its_cure() {
        let cases = [
            ("fold = 0 }, { name = \"back\"", "fold = 9 }, { name = \"back\"", "panel front: its fold is edge 9"),
            ("piece = \"half\", fold = 0 }]", "piece = \"hlaf\" }]", "name one of half"),
            (
                "sew = { panel = \"front\", edges = [2, 3] }",
                "sew = { panel = \"frnt\", edges = [2, 3] }",
                "did you mean front?",
            ),
            ("edges = [2, 3], half = \"mirrored\" } },", "edges = [2, 2] } },", "no run of edges"),
            (
                "sew = { panel = \"front\", edges = [2, 3] }",
                "sew = { panel = \"front\", edges = [8, 9] }",
                "its edges are 1 to 3",
            ),
            ("edges = [2, 3], half = \"mirrored\" } },", "edges = [3, 2], half = \"mirrored\" } },", "swap the ends"),
            ("name = \"right\"", "nam = \"right\"", "line 4"),
            (
                "edges = [2, 3] }, to = { panel = \"back\", edges = [2, 3], half",
                "edges = [nan, 3] }, to = { panel = \"back\", edges = [2, 3], half",
                "no run",
            ),
        ];
        for (from, to, wanted) in cases {
            let text = TUBE.replacen(from, to, 1);
            assert_ne!(text, TUBE, "{from}");
            let message = sewn(&text).unwrap_err();
            assert!(message.contains(wanted) && message.contains(';'), "{message}");
        }
    }
}
