//! MakeHuman's clothes: a `.mhclo` file beside an OBJ binds each vertex of it to the base mesh.
//!
//! A row `i j k u v w x y z` puts a vertex at `u V[i] + v V[j] + w V[k] + (x, y, z)` times a scale for each axis, V being the base's
//! vertices (dm); a row of one number puts it on that vertex. The scale of an axis is the distance along it between two
//! vertices of the base, divided by what it was where the clothes were made.

use std::path::{Path, PathBuf};

use glam::Vec3;

use super::MakehumanOptions;
use super::files::targets;
use super::mesh::MakehumanMesh;
use crate::file::{self, FileKind};
use crate::import::avatar::{AvatarError, Flaw};
use toile_base::body::Sex;
use toile_base::numeric::statistics::median;

/// Vertices of the base mesh `hm08`, helpers and cubes included.
const BASE_VERTICES: u32 = 19_158;

/// The largest clothes of MakeHuman have 40,000 rows of 100 characters.
const CLOTHES_FILE: FileKind =
    FileKind { name: "a MakeHuman clothes file", max_bytes: 32 << 20, cure: "reduce the mesh that it is for" };

/// Folders, from that of the clothes or one above it, in which the base lies: beside them, as the shared data has it, and as
/// MakeHuman and MPFB do.
const BASE_FOLDERS: [&str; 5] = ["", "makehuman-hm08", "body/makehuman-hm08", "3dobjs", "data/3dobjs"];

/// How many folders above the clothes are looked into.
const FOLDERS_ABOVE: usize = 4;

/// Bodies that clothes are made on: the base and MakeHuman's macro targets of one kind of people.
const PEOPLE: [&str; 6] = [
    "caucasian-female-young",
    "caucasian-male-young",
    "african-female-young",
    "african-male-young",
    "asian-female-young",
    "asian-male-young",
];

/// One vertex of the clothes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Binding {
    vertices: [u32; 3],
    weights: [f32; 3],
    offset: Vec3,
}

/// A distance on the base that clothes grow with.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ScaleRule {
    ends: [u32; 2],
    divisor: f32,
}

/// A `.mhclo` file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Clothes {
    bindings: Vec<Binding>,
    scales: [Option<ScaleRule>; 3],
    /// Ranges of the base's vertices that the clothes hide, both ends included.
    pub hidden: Vec<[u32; 2]>,
    /// Sex of their wearer, if the file says it.
    pub sex: Option<Sex>,
    /// The file of its material, where it names one.
    pub material: Option<String>,
}

/// The body that clothes are made on.
#[derive(Debug, Clone, PartialEq)]
pub struct ClothesBody {
    /// Its targets and rig.
    pub options: MakehumanOptions,
    /// How far its clothes lie from those of the OBJ file, half of the vertices (dm).
    pub median_error: f32,
}

impl Clothes {
    /// Reads a file.
    ///
    /// # Errors
    /// [`AvatarError`], which names the file, what is wrong in it, and the cure.
    pub fn read(path: &Path) -> Result<Self, AvatarError> {
        let text = file::read_text(path, &CLOTHES_FILE).map_err(|e| Flaw::Read { reason: e.reason() }.of(path))?;
        Self::parse(&text).map_err(|reason| Flaw::Syntax { reason }.of(path))
    }

    /// Reads a text.
    ///
    /// # Errors
    /// The line, what is wrong in it, and the cure.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut clothes = Self::default();
        let (mut in_rows, mut in_hidden) = (false, false);
        for (i, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default().trim();
            let mut words = line.split_whitespace();
            let wrong = |what: &str| format!("line {}: {what}; copy MakeHuman's own file again", i + 1);
            match words.next() {
                None => {}
                Some(word) if word.starts_with(|c: char| c.is_ascii_digit() || c == '-') && (in_rows || in_hidden) => {
                    if in_rows {
                        clothes.bindings.push(binding(line).ok_or_else(|| wrong("no vertex of hm08 and its offsets"))?);
                    } else {
                        clothes.hidden.extend(ranges(line).ok_or_else(|| wrong("no vertices of hm08"))?);
                    }
                }
                Some("verts") => (in_rows, in_hidden) = (true, false),
                Some("delete_verts") => (in_rows, in_hidden) = (false, true),
                Some(key) => {
                    (in_rows, in_hidden) = (false, false);
                    clothes.key(key, &words.collect::<Vec<_>>()).map_err(wrong)?;
                }
            }
        }
        if clothes.bindings.is_empty() {
            return Err("it binds no vertex to the base; copy MakeHuman's own file again".into());
        }
        Ok(clothes)
    }

    fn key(&mut self, key: &str, words: &[&str]) -> Result<(), &'static str> {
        match (key, words) {
            ("x_scale" | "y_scale" | "z_scale", [a, b, divisor]) => {
                let vertex = |w: &str| w.parse().ok().filter(|v| *v < BASE_VERTICES);
                let divisor = divisor.parse().ok().filter(|d: &f32| d.is_finite() && *d > 1e-3);
                let rule = (|| Some(ScaleRule { ends: [vertex(a)?, vertex(b)?], divisor: divisor? }))();
                let axis = usize::from(key.as_bytes()[0] - b'x');
                self.scales[axis] = Some(rule.ok_or("no scale between two vertices of hm08")?);
            }
            ("x_scale" | "y_scale" | "z_scale", _) => return Err("no scale between two vertices of hm08"),
            ("basemesh", [name]) if *name != "hm08" => return Err("clothes for another base mesh than hm08"),
            ("tag", ["Female" | "female"]) => self.sex = Some(Sex::Female),
            ("material", [name]) => self.material = Some((*name).to_owned()),
            ("tag", ["Male" | "male"]) => self.sex = Some(Sex::Male),
            _ => {}
        }
        Ok(())
    }

    /// Vertices of the clothes.
    pub fn vertices(&self) -> usize {
        self.bindings.len()
    }

    /// Position of the clothes on a base (dm).
    fn place(&self, base: &[Vec3]) -> Vec<Vec3> {
        let at = |v: u32| base.get(v as usize).copied().unwrap_or_default();
        let mut scale = Vec3::ONE;
        for (k, rule) in self.scales.iter().enumerate() {
            if let Some(ScaleRule { ends: [a, b], divisor }) = rule {
                scale[k] = (at(*a)[k] - at(*b)[k]).abs() / divisor;
            }
        }
        let place =
            |b: &Binding| b.vertices.iter().zip(b.weights).map(|(v, w)| at(*v) * w).sum::<Vec3>() + b.offset * scale;
        self.bindings.iter().map(place).collect()
    }

    /// The body of a base's folder on which these clothes lie nearest to where the OBJ file has them (dm).
    ///
    /// # Errors
    /// A base or a target that cannot be read.
    pub fn made_on(&self, folder: &Path, obj: &[Vec3]) -> Result<ClothesBody, AvatarError> {
        let plain = MakehumanMesh::read(folder)?.positions;
        let mut best: Option<ClothesBody> = None;
        let people = std::iter::once(None).chain(PEOPLE.into_iter().map(Some));
        for name in people {
            let chosen: Vec<(String, f32)> = name.into_iter().map(|n| (n.to_owned(), 1.0)).collect();
            let mut positions = plain.clone();
            match targets(folder, &chosen, &mut positions) {
                Err(AvatarError { flaw: Flaw::NoTarget { .. }, .. }) => continue,
                other => other?,
            }
            let mut errors: Vec<f32> = self.place(&positions).iter().zip(obj).map(|(p, q)| p.distance(*q)).collect();
            let median_error = median(&mut errors).unwrap_or(f32::INFINITY);
            if best.as_ref().is_none_or(|b| median_error < b.median_error) {
                let options = MakehumanOptions { targets: chosen, ..MakehumanOptions::default() };
                best = Some(ClothesBody { options, median_error });
            }
        }
        Ok(best.unwrap_or(ClothesBody { options: MakehumanOptions::default(), median_error: f32::INFINITY }))
    }
}

/// The folder of the base mesh for clothes: beside them or above, as `BASE_FOLDERS` says.
pub fn base_folder(clothes: &Path) -> Option<PathBuf> {
    let clothes = std::path::absolute(clothes).ok()?;
    let above = clothes.ancestors().skip(1).take(FOLDERS_ABOVE + 1);
    let folders = above.flat_map(|above| BASE_FOLDERS.map(|f| above.join(f)));
    folders.into_iter().find(|f| f.join("base.obj").is_file() && f.join("rig.game_engine.json").is_file())
}

fn binding(line: &str) -> Option<Binding> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let vertex = |w: &str| w.parse::<u32>().ok().filter(|v| *v < BASE_VERTICES);
    let number = |w: &str| w.parse::<f32>().ok().filter(|x| x.is_finite() && x.abs() < 1e3);
    match words[..] {
        [v] => Some(Binding { vertices: [vertex(v)?; 3], weights: [1.0, 0.0, 0.0], offset: Vec3::ZERO }),
        [i, j, k, u, v, w, x, y, z] => Some(Binding {
            vertices: [vertex(i)?, vertex(j)?, vertex(k)?],
            weights: [number(u)?, number(v)?, number(w)?],
            offset: Vec3::new(number(x)?, number(y)?, number(z)?),
        }),
        _ => None,
    }
}

/// Single vertices and ranges `a - b`.
fn ranges(line: &str) -> Option<Vec<[u32; 2]>> {
    let mut out: Vec<[u32; 2]> = Vec::new();
    let mut range = false;
    for word in line.split_whitespace() {
        if word == "-" {
            range = true;
            continue;
        }
        let v = word.parse::<u32>().ok().filter(|v| *v < BASE_VERTICES)?;
        match (range, out.last_mut()) {
            (true, Some(last)) => last[1] = v,
            (true, None) => return None,
            (false, _) => out.push([v, v]),
        }
        range = false;
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::plain::parse_obj;

    const TEXT: &str = "# made\nbasemesh hm08\ntag Female\nx_scale 0 1 2.0\ny_scale 0 1 1\nmaterial a.mhmat\nverts 0\n\
        0 1 2 0.5 0.25 0.25 1 1 1\n2\n\ndelete_verts\n3 5 - 9 12\n";

    #[test]
    fn rows_scales_and_hidden_vertices_are_read() {
        let clothes = Clothes::parse(TEXT).unwrap();
        assert_eq!((clothes.vertices(), clothes.sex), (2, Some(Sex::Female)));
        assert_eq!(clothes.material.as_deref(), Some("a.mhmat"));
        assert_eq!(clothes.hidden, [[3, 3], [5, 9], [12, 12]]);
        let base = [Vec3::ZERO, Vec3::new(4.0, 3.0, 0.0), Vec3::new(0.0, 0.0, 4.0)];
        // Offsets grow by 4/2 along x and by 3/1 along y.
        assert_eq!(clothes.place(&base), [Vec3::new(3.0, 3.75, 2.0), base[2]]);
    }

    #[test]
    fn broken_files_are_refused_by_their_line() {
        for (from, to, expected) in [
            ("0 1 2 0.5", "0 1 99999 0.5", "line 8"),
            ("0.25 0.25 1", "0.25 nan 1", "line 8"),
            ("x_scale 0 1 2.0", "x_scale 0 1 0", "line 4"),
            ("hm08", "alpha7", "line 2"),
            ("3 5", "- 5", "line 12"),
            ("verts 0", "vertices 0", "binds no vertex"),
        ] {
            let message = Clothes::parse(&TEXT.replace(from, to)).unwrap_err();
            assert!(message.contains(expected) && message.contains("; ") && !message.contains('\n'), "{message}");
        }
        for end in 0..TEXT.len() {
            _ = Clothes::parse(&TEXT[..end]);
        }
    }

    /// The shared outfits lie where their OBJ files have them, on the body that they were made on.
    #[test]
    fn the_body_that_clothes_were_made_on_is_found() {
        let Some(data) = crate::recordings::folder() else { return };
        for (name, target) in [
            ("female_elegantsuit01", "caucasian-female-young"),
            ("female_sportsuit01", "caucasian-female-young"),
            ("male_casualsuit04", "caucasian-male-young"),
        ] {
            let file = data.join("garments/makehuman").join(name);
            let clothes = Clothes::read(&file.with_extension("mhclo")).unwrap();
            let obj = parse_obj(&std::fs::read_to_string(file.with_extension("obj")).unwrap()).unwrap();
            assert_eq!(clothes.vertices(), obj.positions.len());
            let folder = base_folder(&file.with_extension("mhclo")).unwrap();
            let found = clothes.made_on(&folder, &obj.positions).unwrap();
            assert_eq!(found.options.targets[0].0, target, "{name}");
            assert!(found.median_error < 1e-3, "{name}: {} dm", found.median_error);
        }
    }
}
