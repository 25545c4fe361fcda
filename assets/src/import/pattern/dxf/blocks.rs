//! The blocks of an ASCII DXF file: pairs of lines, a group code and its value (AutoCAD R13 DXF reference).

use std::str::Lines;

use glam::DVec2;

use super::super::error::PatternFault;

/// Metres of a millimetre, which metric files are in, and of an inch.
const METRIC: f64 = 1e-3;
const ENGLISH: f64 = 0.0254;

/// Variable of the header that names the unit, and metres of those of its numbers that patterns are drawn in.
const HEADER_UNIT: &str = "$INSUNITS";
const HEADER_UNITS: [(i64, f64); 4] = [(1, ENGLISH), (4, METRIC), (5, 0.01), (6, 1.0)];

/// What a text of the style begins with, in capital letters.
const UNITS: &str = "UNITS:";
const PIECE_NAME: &str = "PIECE NAME:";

/// A drawn line.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Line {
    /// Number of its layer.
    pub layer: u32,
    /// Its points, in the file's unit.
    pub points: Vec<DVec2>,
    /// Whether the file says that it closes.
    closed: bool,
}

impl Line {
    /// Whether it goes back to its first point.
    pub fn is_closed(&self) -> bool {
        self.points.len() > 2 && (self.closed || self.points.first() == self.points.last())
    }
}

/// A block: one piece.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Block {
    /// Name of the block.
    pub name: String,
    /// Name of the piece, where a text gives it.
    pub title: Option<String>,
    /// Lines and polylines.
    pub lines: Vec<Line>,
    /// Points with their layers.
    pub points: Vec<(u32, DVec2)>,
}

/// Parts of a file that are read.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    /// Metres of its unit: of a millimetre where it does not say.
    pub unit: f64,
    /// Whether it says so, by a text of the style or in its header.
    pub names_unit: bool,
    /// Its blocks.
    pub blocks: Vec<Block>,
}

/// The entity that is being read.
#[derive(Default)]
struct Entity {
    kind: String,
    layer: u32,
    text: String,
    name: String,
    flags: i64,
    /// First and second point, as far as they were read.
    at: [[Option<f64>; 2]; 2],
    /// All first points, of which a lightweight polyline has many.
    points: Vec<DVec2>,
}

impl Entity {
    fn point(&self, k: usize) -> Option<DVec2> {
        let [x, y] = self.at[k];
        Some(DVec2::new(x?, y?))
    }
}

/// Reads all blocks; texts may stand outside of them.
pub fn read(text: &str) -> Result<Blocks, PatternFault> {
    let mut reader = Reader { blocks: Vec::new(), open: None, line: None, unit: None };
    let (mut header, mut variable) = (None, "");
    let mut entity = Entity::default();
    let mut lines = text.lines();
    let mut number = 0;
    while let Some((code, value)) = next_pair(&mut lines, &mut number)? {
        let coordinate = || {
            // Some programs write a decimal comma where their user's country does.
            let finite = value.replace(',', ".").parse::<f64>().ok().filter(|x| x.is_finite());
            finite.ok_or_else(|| format!("line {number}: \"{}\" is no number; export the file again", shown(value)))
        };
        match code {
            0 => {
                reader.take(&mut entity);
                entity = Entity { kind: value.to_uppercase(), ..Entity::default() };
            }
            9 => variable = value,
            70 if variable == HEADER_UNIT => {
                let number = value.parse().unwrap_or(0);
                header = HEADER_UNITS.iter().find(|(n, _)| *n == number).map(|(_, unit)| *unit);
                variable = "";
            }
            1 => entity.text = value.to_owned(),
            2 => entity.name = value.to_owned(),
            8 => entity.layer = value.parse().unwrap_or(0),
            70 => entity.flags = value.parse().unwrap_or(0),
            10 | 11 => entity.at[usize::from(code == 11)][0] = Some(coordinate()?),
            20 | 21 => {
                entity.at[usize::from(code == 21)][1] = Some(coordinate()?);
                if code == 20 {
                    entity.points.extend(entity.point(0));
                }
            }
            _ => {}
        }
    }
    reader.take(&mut entity);
    if reader.open.is_some() || entity.kind != "EOF" {
        return Err(PatternFault::Content("it ends before its EOF; the file is cut short, export it again".into()));
    }
    let unit = reader.unit.or(header);
    Ok(Blocks { unit: unit.unwrap_or(METRIC), names_unit: unit.is_some(), blocks: reader.blocks })
}

/// A value as messages show it: its beginning.
fn shown(value: &str) -> String {
    value.chars().take(24).collect()
}

/// The next group code and value; `number` counts the lines.
fn next_pair<'t>(lines: &mut Lines<'t>, number: &mut usize) -> Result<Option<(u32, &'t str)>, PatternFault> {
    let Some(code) = lines.next() else { return Ok(None) };
    *number += 1;
    let line = *number;
    let found = code.trim().parse::<u32>().ok().filter(|c| *c < 2_000);
    let code = found
        .ok_or_else(|| format!("line {line}: \"{}\" is no DXF group code; export it as ASCII DXF", shown(code)))?;
    let value = lines.next().ok_or_else(|| format!("line {line}: its value is missing; the file is cut short"))?;
    *number += 1;
    Ok(Some((code, value.trim())))
}

struct Reader {
    blocks: Vec<Block>,
    open: Option<Block>,
    /// The polyline whose vertices follow.
    line: Option<Line>,
    unit: Option<f64>,
}

impl Reader {
    /// Takes an entity that has been read to its end.
    fn take(&mut self, entity: &mut Entity) {
        match entity.kind.as_str() {
            "BLOCK" => self.open = Some(Block { name: entity.name.clone(), ..Block::default() }),
            "ENDBLK" => self.blocks.extend(self.open.take()),
            "TEXT" | "MTEXT" => self.take_text(&entity.text),
            "POLYLINE" => {
                self.line = Some(Line { layer: entity.layer, closed: entity.flags & 1 != 0, points: Vec::new() });
            }
            "LWPOLYLINE" => {
                if let Some(block) = &mut self.open {
                    let points = std::mem::take(&mut entity.points);
                    block.lines.push(Line { layer: entity.layer, closed: entity.flags & 1 != 0, points });
                }
            }
            "VERTEX" => {
                if let (Some(line), Some(at)) = (&mut self.line, entity.point(0)) {
                    line.points.push(at);
                }
            }
            "SEQEND" => {
                if let (Some(block), Some(line)) = (&mut self.open, self.line.take()) {
                    block.lines.push(line);
                }
            }
            "LINE" => {
                if let (Some(block), Some(a), Some(b)) = (&mut self.open, entity.point(0), entity.point(1)) {
                    block.lines.push(Line { layer: entity.layer, closed: false, points: vec![a, b] });
                }
            }
            "POINT" => {
                if let (Some(block), Some(at)) = (&mut self.open, entity.point(0)) {
                    block.points.push((entity.layer, at));
                }
            }
            _ => {}
        }
    }

    fn take_text(&mut self, text: &str) {
        let after = |word: &str| {
            let begins = text.get(..word.len()).is_some_and(|t| t.eq_ignore_ascii_case(word));
            begins.then(|| text[word.len()..].trim())
        };
        if let Some(unit) = after(UNITS) {
            self.unit = Some(if unit.eq_ignore_ascii_case("ENGLISH") { ENGLISH } else { METRIC });
        }
        if let (Some(name), Some(block)) = (after(PIECE_NAME), &mut self.open) {
            block.title = Some(name.to_owned());
        }
    }
}
