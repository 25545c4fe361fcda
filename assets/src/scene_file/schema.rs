//! Every key of a scene file: what it takes, its unit, its default and its range. The reader checks by this list, and
//! `docs/scene.md` prints it.

/// Kind of value that a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KeyKind {
    /// A number between two bounds.
    Number(f64, f64),
    /// A whole number between two bounds.
    Count(u64, u64),
    /// Three numbers, each at most this far from 0.
    Vector(f64),
    /// A text of any content.
    Text,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// True or false.
    Flag,
    /// A table of the keys listed under this name.
    Table(&'static str),
    /// One table, or several (`[[...]]`), of the keys listed under this name.
    Tables(&'static str),
    /// A text, or a table of the keys listed under this name.
    TextOrTable(&'static str),
    /// Vertices counted from 0, each an index or a range such as "0-31".
    Vertices,
    /// Two corners of a box along the axes, each of three numbers.
    Box,
    /// Pairs of indices.
    Pairs,
}

/// A key of a scene file: where it stands, and what it takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneKey {
    /// The table it stands in; empty for the file itself.
    pub table: &'static str,
    /// Name of the key, as it stands in the file.
    pub name: &'static str,
    /// Kind of value that it takes.
    pub kind: KeyKind,
    /// Its unit; empty where it has none.
    pub unit: &'static str,
    /// What holds where it is left out; `required` where it may not be.
    pub default: &'static str,
    /// Meaning of the key, in a sentence for users.
    pub help: &'static str,
}

const fn key(
    table: &'static str,
    name: &'static str,
    kind: KeyKind,
    unit: &'static str,
    default: &'static str,
    help: &'static str,
) -> SceneKey {
    SceneKey { table, name, kind, unit, default, help }
}

/// Farthest coordinate (m): beyond it f32 cannot tell apart a tenth of a millimetre.
pub const FAR_M: f64 = 1_000.0;

/// Names of the solvers.
pub const SOLVERS: &[&str] = &["gauss-seidel", "semi-implicit", "zero-stretch"];

/// Names of the qualities.
pub const QUALITIES: &[&str] = &["draft", "shop", "fine"];

/// Names of the motions of the benchmark's body.
pub const MOTIONS: &[&str] = &["walk", "fast", "settled"];

use KeyKind::{Box, Choice, Count, Flag, Number, Pairs, Table, Tables, Text, TextOrTable, Vector, Vertices};

/// Every key, table by table.
pub const KEYS: &[SceneKey] = &[
    key("", "name", Text, "", "the file's name", "What reports call the scene."),
    key("", "duration", Number(0.0, 36_000.0), "s", "5", "Length of the run; `--frames` overrides it."),
    key("", "step_hz", Number(10.0, 2_000.0), "1/s", "120", "Steps a second; 30 for a game's frame, for example."),
    key("", "measure_from", Number(0.0, 36_000.0), "s", "0", "Steps before this time are run but not measured."),
    key("", "gravity", Vector(100.0), "m/s2", "[0, -9.81, 0]", "Acceleration of gravity; y is up."),
    key(
        "",
        "bad_rows",
        Choice(&["refuse", "pass"]),
        "",
        "refuse",
        "What happens to numbers of tracks that are not finite: the scene is refused, or they are handed to the \
         engine, whose guards have to cope.",
    ),
    key("", "wind", Table("wind"), "", "no wind", "Air that moves."),
    key("", "settings", Table("settings"), "", "as the engine", "How the cloth is stepped."),
    key("", "garment", Tables("garment"), "", "required", "The pieces of cloth, one or several."),
    key("", "colliders", Table("colliders"), "", "nothing", "What the cloth meets."),
    key("wind", "velocity", Vector(100.0), "m/s", "required", "Velocity of the air."),
    key("wind", "drag", Number(0.0, 10.0), "1", "0.1", "Drag coefficient: force along the air's motion."),
    key("wind", "lift", Number(0.0, 10.0), "1", "0.05", "Lift coefficient: force across it."),
    key("settings", "quality", Choice(QUALITIES), "", "shop", "A tested combination of substeps and iterations."),
    key("settings", "substeps", Count(1, 256), "", "of the quality", "Substeps of a step, in place of the quality's."),
    key("settings", "max_speed", Number(0.1, 1_000.0), "m/s", "15", "A particle's speed limit."),
    key(
        "settings",
        "layers",
        Flag,
        "",
        "true",
        "Whether garments that start within 15 cm of each other keep the order in which they are listed, inner first.",
    ),
    key("settings", "folds", Flag, "", "false", "Whether each garment keeps from passing through itself."),
    key(
        "settings",
        "stretch_damping",
        Number(0.0, 1.0),
        "s",
        "0",
        "Time in which a fiber's own motion along itself fades.",
    ),
    key(
        "settings",
        "lanes",
        Count(1, 16),
        "",
        "the widest",
        "Lanes of the kernels: 1, 4, 8 or 16; all give the same bits.",
    ),
    key("garment", "name", Text, "", "cloth-1, cloth-2, ...", "What reports and dumped files call it."),
    key("garment", "mesh", Text, "", "-", "OBJ, glTF or GLB file, from the scene file's folder."),
    key("garment", "grid", Table("garment.grid"), "", "-", "A rectangle in place of a mesh file."),
    key("garment", "tube", Table("garment.tube"), "", "-", "An open tube or cone in place of a mesh file."),
    key("garment", "skirt", Table("garment.skirt"), "", "-", "The benchmark's skirt in place of a mesh file."),
    key("garment", "weld", Flag, "", "true", "Whether vertices at the very same place are one particle."),
    key("garment", "scale", Number(1e-6, 1e6), "1", "1", "The mesh is multiplied by this; 0.001 for millimetres."),
    key("garment", "rotation_deg", Vector(360.0), "degrees", "[0, 0, 0]", "Then turned about x, then y, then z."),
    key("garment", "position", Vector(FAR_M), "m", "[0, 0, 0]", "Then moved."),
    key("garment", "velocity", Vector(100.0), "m/s", "[0, 0, 0]", "Velocity of its free vertices at the start."),
    key("garment", "fabric", TextOrTable("garment.fabric"), "", "cotton-lawn", "A built-in fabric, or a table."),
    key(
        "garment",
        "tuck",
        Flag,
        "",
        "false",
        "Whether what starts below the waistband of the next garment under it that has one is worn inside of that one.",
    ),
    key("garment", "mass", Number(1e-6, 1e3), "kg", "by the fabric", "Mass of the whole cloth, pinned parts included."),
    key("garment", "solver", Table("garment.solver"), "", "as the bake", "How fibers are solved."),
    key("garment", "mass_patch", Tables("garment.mass_patch"), "", "none", "Vertices that are heavier or lighter."),
    key(
        "garment",
        "pin",
        Tables("garment.pin"),
        "",
        "none",
        "Vertices that are held; the last that names one decides.",
    ),
    key("garment.grid", "rows", Count(2, 512), "", "required", "Vertices down the cloth, along the warp."),
    key("garment.grid", "columns", Count(2, 512), "", "required", "Vertices across it, along the weft."),
    key("garment.grid", "width", Number(1e-3, 100.0), "m", "required", "From the first column to the last, along x."),
    key("garment.grid", "height", Number(1e-3, 100.0), "m", "required", "From row 0 at the top to the last, along y."),
    key(
        "garment.grid",
        "plane",
        Choice(&["upright", "level"]),
        "",
        "upright",
        "Hanging in x and y, or lying in x and z.",
    ),
    key("garment.tube", "rows", Count(2, 512), "", "required", "Vertices down the tube, along the warp."),
    key("garment.tube", "columns", Count(3, 512), "", "required", "Vertices around it; they close to hoops."),
    key("garment.tube", "top_radius", Number(1e-3, 100.0), "m", "required", "Radius of row 0."),
    key("garment.tube", "bottom_radius", Number(1e-3, 100.0), "m", "required", "Radius of the last row."),
    key("garment.tube", "height", Number(1e-3, 100.0), "m", "required", "From row 0 at y = 0 down to the last."),
    key(
        "garment.skirt",
        "side",
        Count(3, 512),
        "",
        "required",
        "Vertices a side: 64 makes 4,096; row 0 is the waistband.",
    ),
    key(
        "garment.skirt",
        "layout",
        Choice(&["grid", "irregular"]),
        "",
        "grid",
        "Quads in rows, or irregular triangles.",
    ),
    key("garment.solver", "warp", Choice(SOLVERS), "", "semi-implicit", "Of fibers along the warp."),
    key("garment.solver", "weft", Choice(SOLVERS), "", "gauss-seidel", "Of fibers along the weft."),
    key(
        "garment.solver",
        "waistband",
        Choice(SOLVERS),
        "",
        "semi-implicit",
        "Of closed hoops that the cloth hangs by.",
    ),
    key("garment.solver", "hem", Choice(SOLVERS), "", "gauss-seidel", "Of closed hoops where it ends."),
    key("garment.fabric", "base", Text, "", "cotton-lawn", "The built-in fabric that other keys of the table change."),
    key("garment.fabric", "file", Text, "", "-", "A fabric file, in place of `base`."),
    key("garment.fabric", "density_kg_m2", Number(0.01, 2.0), "kg/m2", "of the base", "Mass of an area."),
    key(
        "garment.fabric",
        "stretch_warp_n_m",
        Number(10.0, f64::INFINITY),
        "N/m",
        "of the base",
        "Stiffness along the warp; inf does not stretch.",
    ),
    key(
        "garment.fabric",
        "stretch_weft_n_m",
        Number(10.0, f64::INFINITY),
        "N/m",
        "of the base",
        "Stiffness along the weft; inf does not stretch.",
    ),
    key("garment.fabric", "shear_n_m", Number(1.0, 1e5), "N/m", "of the base", "Shear stiffness, a radian."),
    key(
        "garment.fabric",
        "bend_warp_un_m",
        Number(0.0, 1e4),
        "uN m",
        "of the base",
        "Bending rigidity along the warp.",
    ),
    key(
        "garment.fabric",
        "bend_weft_un_m",
        Number(0.0, 1e4),
        "uN m",
        "of the base",
        "Bending rigidity along the weft.",
    ),
    key(
        "garment.fabric",
        "bend_bias_un_m",
        Number(0.0, 1e4),
        "uN m",
        "of the base",
        "Bending rigidity along the bias.",
    ),
    key("garment.fabric", "friction", Number(0.0, 2.0), "1", "of the base", "Coulomb's coefficient against colliders."),
    key("garment.fabric", "damping_per_s", Number(0.0, 100.0), "1/s", "of the base", "Damping of motion through air."),
    key("garment.fabric", "contact_offset_mm", Number(0.1, 20.0), "mm", "of the base", "Gap kept to colliders."),
    key("garment.fabric", "thickness_mm", Number(0.1, 40.0), "mm", "of the base", "Gap that two layers of it keep."),
    key("garment.pin", "vertices", Vertices, "", "-", "The vertices to hold."),
    key("garment.pin", "box", Box, "m", "-", "Holds the vertices that start inside."),
    key("garment.pin", "material", Text, "", "-", "Holds the vertices of faces whose material ends in this."),
    key("garment.pin", "track", Text, "", "they stand", "CSV of the motion: time, x, y, z, qx, qy, qz, qw."),
    key(
        "garment.pin",
        "motion",
        Choice(MOTIONS),
        "",
        "they stand",
        "The root of the benchmark's body, in place of a track.",
    ),
    key("garment.mass_patch", "factor", Number(1e-4, 1e4), "1", "required", "Their mass is multiplied by this."),
    key("garment.mass_patch", "vertices", Vertices, "", "-", "The vertices of the patch."),
    key("garment.mass_patch", "box", Box, "m", "-", "The vertices that start inside."),
    key("colliders", "sphere", Tables("colliders.sphere"), "", "none", "Spheres, counted from 0 in their order."),
    key("colliders", "track", Text, "", "they stand", "CSV of all spheres: time, then x, y, z, r of each."),
    key(
        "colliders",
        "motion",
        Choice(MOTIONS),
        "",
        "-",
        "The benchmark's body: its 16 spheres, 28 capsules and motion.",
    ),
    key("colliders", "capsules", Pairs, "", "none", "Pairs of spheres joined to tapered capsules."),
    key("colliders", "plane", Tables("colliders.plane"), "", "none", "Planes that the cloth stays on one side of."),
    key("colliders.sphere", "centre", Vector(FAR_M), "m", "required", "Its centre."),
    key("colliders.sphere", "radius", Number(0.0, 100.0), "m", "required", "Its radius."),
    key("colliders.sphere", "track", Text, "", "it stands", "CSV of this sphere: time, x, y, z, r."),
    key("colliders.plane", "point", Vector(FAR_M), "m", "[0, 0, 0]", "A point on it."),
    key("colliders.plane", "normal", Vector(1e3), "", "[0, 1, 0]", "The way to the side where the cloth is."),
];

/// The keys of one table.
pub fn of(table: &str) -> impl Iterator<Item = &'static SceneKey> {
    KEYS.iter().filter(move |k| k.table == table)
}

/// The reference of all keys, as `docs/scene.md` has it: one table for each table of a scene file.
pub fn reference() -> String {
    let mut text = String::new();
    let mut tables: Vec<&str> = Vec::new();
    KEYS.iter().for_each(|k| {
        if !tables.contains(&k.table) {
            tables.push(k.table);
        }
    });
    for table in tables {
        let several = KEYS.iter().any(|k| k.kind == Tables(table));
        let title = match (table, several) {
            ("", _) => "The file itself".to_owned(),
            (_, true) => format!("`[[{table}]]`"),
            (_, false) => format!("`[{table}]`"),
        };
        text += &format!("### {title}\n\n| key | takes | default | what it does |\n|---|---|---|---|\n");
        of(table).for_each(|key| text += &(key.row() + "\n"));
        text.push('\n');
    }
    text
}

impl SceneKey {
    /// The key with its table, as messages call it.
    pub fn path(&self) -> String {
        if self.table.is_empty() { self.name.into() } else { format!("{}.{}", self.table, self.name) }
    }

    /// Kind of its value, for messages and the reference.
    pub fn takes(&self) -> String {
        let unit = if ["", "1"].contains(&self.unit) { String::new() } else { format!(" ({})", self.unit) };
        match self.kind {
            Number(low, high) => format!("a number from {low} to {high}{unit}"),
            Count(low, high) => format!("a whole number from {low} to {high}"),
            Vector(limit) => format!("three numbers from -{limit} to {limit}{unit}, such as [0, 1, 0]"),
            Text => "a text in quotes".into(),
            Choice(words) => format!("one of \"{}\"", words.join("\", \"")),
            Flag => "true or false".into(),
            Table(table) => format!("a table [{table}]"),
            Tables(table) => format!("tables [[{table}]]"),
            TextOrTable(table) => format!("a text in quotes, or a table [{table}]"),
            Vertices => "a list of vertices from 0, such as [0, 7, \"10-19\"]".into(),
            Box => format!("two corners{unit}, such as [[-1, 0, -1], [1, 0.1, 1]]"),
            Pairs => "pairs of spheres, such as [[0, 1], [1, 2]]".into(),
        }
    }

    /// The row of this key in the reference: name, what it takes, default, what it does.
    pub fn row(&self) -> String {
        format!("| `{}` | {} | {} | {} |", self.name, self.takes(), self.default, self.help)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_base::fabric::Fabric;

    #[test]
    fn every_table_that_a_key_opens_has_keys_and_no_key_stands_twice() {
        for key in KEYS {
            if let Table(t) | Tables(t) | TextOrTable(t) = key.kind {
                assert!(of(t).count() > 0, "{t}");
            }
            assert_eq!(of(key.table).filter(|k| k.name == key.name).count(), 1, "{}", key.path());
            assert!(!key.help.is_empty() && !key.default.is_empty(), "{}", key.path());
        }
    }

    #[test]
    fn every_figure_of_a_fabric_is_a_key_with_the_same_range() {
        for (name, low, high) in Fabric::RANGES {
            let key = of("garment.fabric").find(|k| k.name == name).unwrap_or_else(|| panic!("{name}"));
            let Number(from, to) = key.kind else { panic!("{name}") };
            assert_eq!([from as f32, to as f32], [low, high], "{name}");
        }
    }
}
