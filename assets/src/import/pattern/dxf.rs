//! DXF-AAMA and ASTM D6673: an ASCII DXF file with a BLOCK for each piece, whose layers say what a line is for.
//!
//! Read are layer 1 (boundary), 2 (turn points), 4 (notches), 6 (fold), 7 (grain) and 14 (sew line). Where a sew line
//! closes around the piece it is the outline, otherwise the boundary is, which then must carry no seam allowance. AAMA
//! has no layer for sew lines: programs draw them among the internal lines (8), where the line that goes around most of
//! the piece is one. An edge goes from a turn point or notch to the next; without turn points, from corner to corner.
//! Nothing says what is sewn to what: that stands in a seam file.

mod blocks;

use glam::DVec2;

use super::error::PatternFault;
use super::json::name;
use super::piece::Piece;
use crate::pattern::limits::{LEAST_EDGE_M, MAX_PANELS, MAX_POINTS};
use crate::pattern::{Curve, PatternFlaw};
use blocks::{Block, Line};

/// Layers of the standard (ASTM D6673, table of layers).
const BOUNDARY: u32 = 1;
const TURN_POINTS: u32 = 2;
const NOTCHES: u32 = 4;
const FOLD: u32 = 6;
const GRAIN: u32 = 7;
const INTERNAL: u32 = 8;
const SEW_LINE: u32 = 14;

/// Share of a piece that a line among the internal ones goes around if it is the sew line: allowances of 10 mm leave
/// half of a strip 40 mm wide, and no pocket or facing is as large.
const SEWN_SHARE: f64 = 0.5;

/// From where on a piece is moved to the origin (m): some programs place pieces kilometres away, on a sheet of their own.
const FAR_M: f64 = 10.0;

/// Largest extent of a piece that is believed to be in millimetres where the file names no unit (m): below it the file
/// is in inches or centimetres.
const LEAST_EXTENT_M: f64 = 0.1;

/// A change of direction that is a corner where the file marks none (rad): 30 degrees.
const CORNER: f64 = 0.52;

/// How far a mark may lie beside the outline, and a fold beside its edge (m).
const BESIDE_M: f64 = 2e-3;

/// How near to a point of the outline a mark is that point (m): programs round both.
const SAME_POINT_M: f64 = 1e-3;

/// Whether bytes begin as an ASCII DXF file does: with a comment or a section.
pub fn looks_like(bytes: &[u8]) -> bool {
    let mut lines = bytes.split(|b| *b == b'\n').map(<[u8]>::trim_ascii);
    matches!((lines.next(), lines.next()), (Some(b"999"), Some(_)) | (Some(b"0"), Some(b"SECTION")))
}

/// Reads the pieces of a file.
pub fn pieces(text: &str) -> Result<Vec<Piece>, PatternFault> {
    let file = blocks::read(text)?;
    let cloth: Vec<&Block> = file.blocks.iter().filter(|b| b.lines.iter().any(|l| l.layer == BOUNDARY)).collect();
    if cloth.is_empty() {
        return Err(PatternFault::Content(
            "no BLOCK has a boundary on layer 1; export it as DXF-AAMA or ASTM D6673".into(),
        ));
    }
    if cloth.len() > MAX_PANELS {
        let (place, what, limit) = ("the file".to_owned(), "pieces", "MAX_PANELS");
        return Err(PatternFlaw::TooMany { place, what, count: cloth.len(), most: MAX_PANELS, limit }.into());
    }
    let points: usize =
        cloth.iter().map(|b| b.points.len() + b.lines.iter().map(|l| l.points.len()).sum::<usize>()).sum();
    if points > MAX_POINTS {
        let (place, what, limit) = ("the file".to_owned(), "points", "MAX_POINTS");
        return Err(PatternFlaw::TooMany { place, what, count: points, most: MAX_POINTS, limit }.into());
    }
    let pieces: Vec<Piece> =
        cloth.iter().zip(names(&cloth)).map(|(b, n)| piece(b, &n, file.unit)).collect::<Result<_, _>>()?;
    let extent = pieces.iter().map(Piece::extent).fold(0.0, f64::max);
    if !file.names_unit && extent < LEAST_EXTENT_M {
        let mm = extent * 1e3;
        let what = format!(
            "it names no unit and its largest piece would be {mm:.0} mm; write the text \"Units: ENGLISH\" or scale it"
        );
        return Err(PatternFault::Content(what));
    }
    Ok(pieces)
}

/// Names of the pieces. A piece in several sizes is a block for each, under one title: then blocks' names tell them
/// apart. What still has one name, as in programs that call every piece the same, is numbered in the file's order.
fn names(cloth: &[&Block]) -> Vec<String> {
    let title = |b: &Block| name(b.title.as_ref().unwrap_or(&b.name));
    let alone = |b: &Block| cloth.iter().filter(|other| title(other) == title(b)).count() == 1;
    let given: Vec<String> = cloth.iter().map(|b| if alone(b) { title(b) } else { name(&b.name) }).collect();
    let numbered = |(i, own): (usize, &String)| match given[..i].iter().filter(|n| *n == own).count() {
        0 => own.clone(),
        before => format!("{own}-{}", before + 1),
    };
    given.iter().enumerate().map(numbered).collect()
}

fn piece(block: &Block, name: &str, unit: f64) -> Result<Piece, PatternFault> {
    let wrong = |what: &str| PatternFault::Content(format!("piece {name}: {what}"));
    let on = |layer: u32| block.lines.iter().filter(move |l| l.layer == layer);
    let size = |l: &&Line| {
        let ring = l.points.iter().zip(l.points.iter().cycle().skip(1));
        ring.map(|(a, b)| a.perp_dot(*b)).sum::<f64>().abs()
    };
    let largest = |layer: u32| on(layer).filter(|l| l.is_closed()).max_by(|a, b| size(a).total_cmp(&size(b)));
    let boundary = largest(BOUNDARY);
    let around = |l: &&Line| boundary.is_some_and(|b| (SEWN_SHARE..1.0).contains(&(size(l) / size(&b))));
    let outline = largest(SEW_LINE).or_else(|| largest(INTERNAL).filter(around)).or(boundary);
    let outline = outline.ok_or_else(|| wrong("its boundary is no closed polyline; export closed outlines"))?;
    let origin = far_corner(outline, unit);
    let metres = |p: &DVec2| *p * unit - origin;
    let mut ring: Vec<DVec2> = outline.points.iter().map(metres).collect();
    if !ring.iter().all(|p| p.is_finite()) {
        return Err(wrong("a point of its boundary is not finite; export it again"));
    }
    ring.dedup_by(|a, b| a.distance(*b) < LEAST_EDGE_M);
    while ring.len() > 1 && ring[0].distance(ring[ring.len() - 1]) < LEAST_EDGE_M {
        ring.pop();
    }
    if ring.len() < 3 {
        return Err(wrong("its boundary has fewer than three points; draw its whole outline"));
    }
    let marks = |layer: u32| block.points.iter().filter(move |(l, _)| *l == layer).map(|(_, p)| metres(p));
    let mut ends: Vec<bool> = vec![false; ring.len()];
    marks(TURN_POINTS).for_each(|p| mark(&mut ring, &mut ends, p));
    if !ends.contains(&true) {
        ends = corners(&ring);
    }
    marks(NOTCHES).for_each(|p| mark(&mut ring, &mut ends, p));
    let steps = edges(&ring, &ends);
    let direction = |l: &Line| l.points.last().zip(l.points.first()).and_then(|(b, a)| (*b - *a).try_normalize());
    let grain = on(GRAIN).find_map(direction).map(|g| if g.y < 0.0 { -g } else { g });
    let mut piece = Piece::of_steps(name, &steps, grain)?;
    let on_fold = |l: &Line, c: &Curve| {
        let along = direction(l).unwrap_or_default();
        let off = |p: DVec2| l.points.first().map_or(f64::MAX, |q| (p - metres(q)).perp_dot(along).abs());
        along != DVec2::ZERO && off(c.start()).max(off(c.end())) < BESIDE_M
    };
    piece.fold = on(FOLD).find_map(|l| piece.edges.iter().find(|(_, c)| on_fold(l, c)).map(|(number, _)| *number));
    Ok(piece)
}

/// What is taken off all points of a piece: nothing, unless it lies far away (m).
fn far_corner(outline: &Line, unit: f64) -> DVec2 {
    let corner = outline.points.iter().fold(DVec2::INFINITY, |low, p| low.min(*p)) * unit;
    if corner.abs().max_element() > FAR_M { corner } else { DVec2::ZERO }
}

/// Makes the point of the outline beside a mark the end of an edge; marks elsewhere are passed over.
fn mark(ring: &mut Vec<DVec2>, ends: &mut Vec<bool>, at: DVec2) {
    let on_side = |i: usize| {
        let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
        let t = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        (a.lerp(b, t), i)
    };
    let nearest = (0..ring.len()).map(on_side).min_by(|p, q| p.0.distance(at).total_cmp(&q.0.distance(at)));
    let Some((point, i)) = nearest.filter(|(p, _)| p.distance(at) < BESIDE_M) else { return };
    let next = (i + 1) % ring.len();
    match [i, next].into_iter().find(|&k| ring[k].distance(point) < SAME_POINT_M) {
        Some(k) => ends[k] = true,
        None => {
            ring.insert(i + 1, point);
            ends.insert(i + 1, true);
        }
    }
}

/// Where an outline turns sharply; at least its first point.
fn corners(ring: &[DVec2]) -> Vec<bool> {
    let n = ring.len();
    let sharp = |i: usize| {
        let (to, on) = (ring[i] - ring[(i + n - 1) % n], ring[(i + 1) % n] - ring[i]);
        to.angle_to(on).abs() > CORNER
    };
    let mut found: Vec<bool> = (0..n).map(sharp).collect();
    if found.iter().filter(|f| **f).count() < 2 {
        found[0] = true;
        found[n / 2] = true;
    }
    found
}

/// The outline cut at the marked points, beginning at the first of them.
fn edges(ring: &[DVec2], ends: &[bool]) -> Vec<Curve> {
    let at: Vec<usize> = (0..ring.len()).filter(|&i| ends[i]).collect();
    let run = |k: usize| {
        let (from, to) = (at[k], at[(k + 1) % at.len()]);
        let count = if to > from { to - from } else { to + ring.len() - from };
        let points: Vec<DVec2> = (from..=from + count).map(|i| ring[i % ring.len()]).collect();
        match points[..] {
            [a, b] => Curve::Line([a, b]),
            _ if is_straight(&points) => Curve::Line([points[0], points[points.len() - 1]]),
            _ => Curve::Polyline(points),
        }
    };
    (0..at.len()).map(run).collect()
}

/// Whether points lie on one line to a hundredth of a millimetre.
fn is_straight(points: &[DVec2]) -> bool {
    let (a, b) = (points[0], points[points.len() - 1]);
    let along = (b - a).normalize_or_zero();
    along != DVec2::ZERO && points.iter().all(|p| (*p - a).perp_dot(along).abs() < 1e-5)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A DXF entity of group codes and values.
    fn entity(pairs: &[(u32, &str)]) -> String {
        pairs.iter().map(|(code, value)| format!("{code:3}\n{value}\n")).collect()
    }

    fn polyline(layer: &str, points: &[[&str; 2]]) -> String {
        let mut out = entity(&[(0, "POLYLINE"), (8, layer), (66, "1"), (70, "1")]);
        for [x, y] in points {
            out += &entity(&[(0, "VERTEX"), (8, layer), (10, x), (20, y)]);
        }
        out + &entity(&[(0, "SEQEND")])
    }

    /// A half front in millimetres: fold at x = 0, a neckline of three sides, grain along the fold.
    fn file() -> String {
        let head = entity(&[(0, "SECTION"), (2, "BLOCKS"), (0, "BLOCK"), (8, "1"), (2, "P1")]);
        let text =
            entity(&[(0, "TEXT"), (8, "1"), (1, "Piece Name: FRONT"), (0, "TEXT"), (8, "1"), (1, "Units: METRIC")]);
        let outline =
            [["0", "0"], ["250", "0"], ["250", "400"], ["120", "420"], ["110", "380"], ["80", "350"], ["0", "340"]];
        let turns = [["0", "0"], ["250", "0"], ["250", "400"], ["120", "420"], ["0", "340"]];
        let turns: String = turns.iter().map(|[x, y]| entity(&[(0, "POINT"), (8, "2"), (10, x), (20, y)])).collect();
        let notch = entity(&[(0, "POINT"), (8, "4"), (10, "250.5"), (20, "200")]);
        let line = |layer, x, y| entity(&[(0, "LINE"), (8, layer), (10, x), (20, "10"), (11, x), (21, y)]);
        let foot = entity(&[(0, "ENDBLK"), (0, "ENDSEC"), (0, "EOF")]);
        [head, text, polyline("1", &outline), turns, notch, line("6", "0", "300"), line("7", "50", "300"), foot]
            .concat()
    }

    /// The file with the numbers of some group codes changed.
    fn with_coordinates(text: &str, codes: &[&str], change: impl Fn(f64) -> f64) -> String {
        let lines: Vec<&str> = text.lines().collect();
        let changed = |pair: &[&str]| match pair[1].parse::<f64>() {
            Ok(x) if codes.contains(&pair[0].trim()) => format!("{}\n{}\n", pair[0], change(x)),
            _ => format!("{}\n{}\n", pair[0], pair[1]),
        };
        lines.chunks(2).map(changed).collect()
    }

    fn message(text: &str) -> String {
        pieces(text).unwrap_err().of("x.dxf").to_string()
    }

    #[test]
    fn boundary_turn_points_notches_fold_and_grain_are_read() {
        let pieces = pieces(&file()).unwrap();
        let piece = &pieces[0];
        assert_eq!((piece.name.as_str(), piece.grain, piece.fold), ("FRONT", Some(DVec2::Y), Some(5)));
        assert_eq!(piece.edges.len(), 6);
        assert_eq!(piece.edges[1].1.end(), DVec2::new(0.25, 0.2));
        assert!(matches!(&piece.edges[4].1, Curve::Polyline(p) if p.len() == 4));
    }

    #[test]
    fn without_turn_points_corners_are_found() {
        let without = file().replace("POINT\n  8\n2\n", "POINT\n  8\n3\n");
        let piece = &pieces(&without).unwrap()[0];
        assert!(piece.edges.iter().any(|(_, c)| c.end() == DVec2::new(0.25, 0.0)), "{piece:?}");
    }

    #[test]
    fn a_sew_line_goes_before_the_boundary() {
        let inner = polyline("14", &[["10", "10"], ["240", "10"], ["240", "390"], ["10", "300"]]);
        let with = file().replace("  0\nENDBLK", &format!("{inner}  0\nENDBLK"));
        assert!((pieces(&with).unwrap()[0].edges[0].1.start() - DVec2::splat(0.01)).length() < 0.3);
        assert!(pieces(&with).unwrap()[0].edges.iter().all(|(_, c)| c.start().x < 0.241));
    }

    #[test]
    fn lightweight_polylines_and_decimal_commas_are_read() {
        let block = file();
        let (begin, end) = (block.find("  0\nPOLYLINE").unwrap(), block.find("  0\nPOINT").unwrap());
        let mut line = entity(&[(0, "LWPOLYLINE"), (8, "1"), (90, "4"), (70, "1")]);
        for (x, y) in [("0", "0"), ("250,5", "0"), ("250", "400"), ("0", "340")] {
            line += &entity(&[(10, x), (20, y)]);
        }
        let light = [&block[..begin], &line, &block[end..]].concat();
        assert!(pieces(&light).unwrap()[0].edges.iter().any(|(_, c)| c.end() == DVec2::new(0.2505, 0.0)));
    }

    #[test]
    fn a_piece_in_two_sizes_is_two_pieces() {
        let one = file();
        let block = &one[one.find("  0\nBLOCK\n").unwrap()..one.find("  0\nENDSEC").unwrap()];
        let both = one.replace("  0\nENDSEC", &format!("{}  0\nENDSEC", block.replace("\nP1\n", "\nP2\n")));
        let names: Vec<String> = pieces(&both).unwrap().into_iter().map(|p| p.name).collect();
        assert_eq!(names, ["P1", "P2"]);
    }

    #[test]
    fn pieces_of_one_name_are_numbered() {
        let one = file();
        let block = &one[one.find("  0\nBLOCK\n").unwrap()..one.find("  0\nENDSEC").unwrap()];
        let both = one.replace("  0\nENDSEC", &format!("{block}{block}  0\nENDSEC"));
        let names: Vec<String> = pieces(&both).unwrap().into_iter().map(|p| p.name).collect();
        assert_eq!(names, ["P1", "P1-2", "P1-3"]);
    }

    #[test]
    fn a_sew_line_may_stand_among_internal_lines_and_a_pocket_does_not() {
        let sewn = polyline("8", &[["10", "10"], ["240", "10"], ["240", "390"], ["10", "330"]]);
        let pocket = polyline("8", &[["50", "50"], ["150", "50"], ["150", "150"], ["50", "150"]]);
        let with = |lines: &str| file().replace("  0\nENDBLK", &format!("{lines}  0\nENDBLK"));
        let widest = |text: &str| pieces(text).unwrap()[0].edges.iter().fold(0.0, |x: f64, (_, c)| x.max(c.end().x));
        assert_eq!(widest(&with(&pocket)), 0.25);
        assert_eq!(widest(&with(&format!("{pocket}{sewn}"))), 0.24);
    }

    #[test]
    fn a_piece_far_from_the_origin_is_the_piece_at_the_origin() {
        let far = with_coordinates(&file(), &["20", "21"], |y| y + 1_250_000.0);
        let (far, near) = (&pieces(&far).unwrap()[0], &pieces(&file()).unwrap()[0]);
        assert_eq!((far.fold, far.edges.len()), (near.fold, near.edges.len()));
        let apart = far.edges.iter().zip(&near.edges).map(|((_, a), (_, b))| a.end().distance(b.end()));
        assert!(apart.fold(0.0, f64::max) < 1e-6);
    }

    #[test]
    fn the_header_names_a_unit_and_without_one_small_pieces_are_doubted() {
        let header = |number: &str| entity(&[(9, "$INSUNITS"), (70, number)]);
        let unnamed = file().replace("Units: METRIC", "made today");
        let with = |number: &str| unnamed.replacen("  2\nBLOCKS", &format!("{}  2\nBLOCKS", header(number)), 1);
        let right = |text: &str| pieces(text).unwrap()[0].edges[0].1.end().x;
        assert!((right(&with("1")) - 250.0 * 0.0254).abs() < 1e-9 && (right(&with("5")) - 2.5).abs() < 1e-9);
        assert_eq!(right(&with("99")), 0.25);
        let small = with_coordinates(&unnamed, &["10", "20"], |x| x / 25.4);
        assert!(message(&small).contains("names no unit"));
    }

    #[test]
    fn texts_of_an_old_code_page_are_read() {
        let bytes: Vec<u8> =
            file().replace("FRONT", "R?CKEN").bytes().map(|b| if b == b'?' { 0xdc } else { b }).collect();
        assert!(looks_like(&bytes) && String::from_utf8(bytes.clone()).is_err());
        let text = crate::import::pattern::decode(bytes).unwrap();
        assert_eq!(pieces(&text).unwrap()[0].name, "RÜCKEN");
        assert!(crate::import::pattern::decode(b"{\xff".to_vec()).is_none());
    }

    #[test]
    fn damage_is_an_error_or_pieces_and_never_more() {
        let good = file();
        for end in 0..good.trim_end().len() {
            assert!(pieces(&good[..end]).is_err(), "{end}");
            for byte in [b'0', b'9', b'-', b'e', b'X', b'\n'] {
                let mut bytes = good.clone().into_bytes();
                bytes[end] = byte;
                let _ = String::from_utf8(bytes).map(|text| pieces(&text));
            }
        }
    }

    #[test]
    fn inches_are_converted() {
        let inches = pieces(&file().replace("METRIC", "ENGLISH")).unwrap();
        assert!((inches[0].edges[0].1.end().x - 250.0 * 0.0254).abs() < 1e-9);
    }

    #[test]
    fn faults_say_the_cure() {
        for (from, to, wanted) in [
            ("  0\nPOLYLINE", "  0\nPOLYGON", "no BLOCK has a boundary"),
            (" 10\n250\n", " 10\nx\n", "is no number"),
            (" 10\n250\n", " 10\nnan\n", "is no number"),
            (" 70\n1\n", " 70\n0\n", "no closed polyline"),
            ("  0\nSECTION", "zero\nSECTION", "line 1"),
        ] {
            let text = file().replacen(from, to, 1);
            assert_ne!(text, file(), "{from}");
            assert!(message(&text).contains(wanted) && message(&text).contains(';'), "{}", message(&text));
        }
    }
}
