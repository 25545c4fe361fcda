//! One piece of cloth of a scene: its mesh placed, its fabric, what holds it, what it weighs.

use glam::{EulerRot, Quat, Vec3};

use super::error::SceneError;
use super::pins::{PinSource, SceneLoader};
use super::source::SceneSource;
use super::table::SceneTable;
use super::{primitive, weld};
use crate::import::gltf::parse_gltf;
use crate::import::obj::FREE;
use crate::import::plain::{PlainMesh, parse_obj};
use toile_bake::Shape;
use toile_bake::check::check;
use toile_bake::overrides::Overrides;
use toile_bake::shape::{Face, NO_VERTEX};
use toile_base::fabric::Fabric;
use toile_base::garment::Solver;
use toile_base::mesh::SkinWeights;

/// A garment's extent may lie between these (m): what is smaller or larger was given in another unit.
const EXTENT_M: [f32; 2] = [0.005, 200.0];

/// The mesh as the user gave it, after it was placed: what dumps are written by.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct UserMesh {
    /// Start position of each vertex, in the user's order (m) `[user's vertices]`.
    pub start: Vec<Vec3>,
    /// Faces in the user's order, by the user's vertices.
    pub faces: Vec<Face>,
    /// The shape's vertex of each; [`NO_VERTEX`] where no face uses it, so that it never moves.
    pub to_shape: Vec<u32>,
}

/// One piece of cloth, ready to be baked.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneGarment {
    /// Its name in reports and dumped files.
    pub name: String,
    /// The shape; fixed vertices have one bone, the number of their pin group.
    pub shape: Shape,
    /// The fabric; where the cloth hangs by its weft, warp and weft are exchanged here and in the shape.
    pub fabric: Fabric,
    /// The user's mesh.
    pub mesh: UserMesh,
    /// Velocity of the free vertices at the start (m/s).
    pub velocity: Vec3,
    /// Whether it is tucked into the next garment under it that has a waistband.
    pub tuck: bool,
    /// Mass of the whole cloth (kg), pinned parts included.
    pub mass_kg: f64,
}

impl SceneGarment {
    pub(super) fn load(
        table: &SceneTable<'_>,
        number: usize,
        loading: &mut SceneLoader<'_>,
    ) -> Result<Self, SceneError> {
        let name = table.text("name")?.map_or_else(|| format!("cloth-{number}"), str::to_owned);
        if !name.chars().all(|c| c.is_alphanumeric() || "-_. ".contains(c)) || name.starts_with('.') {
            return Err(table.wrong("name", "names files, so give letters, digits, - and _ only"));
        }
        let mut fabric = fabric(table, loading.source)?;
        let mut plain = mesh(table, loading.source)?;
        place(table, &mut plain)?;
        let (mut shape, to_shape) = weld::shape(&plain, table.flag("weld")?);
        let mesh = UserMesh { start: plain.positions.clone(), faces: plain.faces.clone(), to_shape };
        check_shape(table, &plain, &mesh, &shape)?;
        pin(table, loading, &plain, &mesh, &mut shape)?;
        hang(&mut shape, &mut fabric);
        let mass_kg = weigh(table, &mesh, &fabric, &mut shape)?;
        if let Some(solver) = table.table("solver")? {
            let known = [Solver::GaussSeidel, Solver::SemiImplicit, Solver::ZeroStretch];
            let chosen = |key| Ok::<_, SceneError>(solver.choice(key)?.map(|i| known[i]));
            let (warp, weft) = (chosen("warp")?, chosen("weft")?);
            shape.solver = Overrides { warp, weft, waistband: chosen("waistband")?, hem: chosen("hem")?, bias: None };
        }
        Ok(Self { name, shape, fabric, mesh, velocity: table.vector("velocity")?, tuck: table.flag("tuck")?, mass_kg })
    }
}

/// The keys of which one says what a garment's mesh is.
const MESHES: [&str; 4] = ["mesh", "grid", "tube", "skirt"];

/// The key that names a garment's mesh, for messages.
fn mesh_key(table: &SceneTable<'_>) -> &'static str {
    MESHES.into_iter().find(|key| table.has(key)).unwrap_or("mesh")
}

fn mesh(table: &SceneTable<'_>, source: SceneSource<'_>) -> Result<PlainMesh, SceneError> {
    let given = MESHES.into_iter().filter(|key| table.has(key)).count();
    if given != 1 {
        let message = format!("[garment] has {given} of {}; give exactly one of them", MESHES.join(", "));
        return Err(table.error(message));
    }
    if let Some(grid) = table.table("grid")? {
        return primitive::grid(&grid);
    }
    if let Some(tube) = table.table("tube")? {
        return primitive::tube(&tube);
    }
    if let Some(skirt) = table.table("skirt")? {
        return primitive::skirt(&skirt);
    }
    let name = table.text("mesh")?.unwrap_or_default();
    let wrong = |message: String| table.wrong("mesh", format!("{name}: {message}"));
    let bytes = source.read(name).map_err(|e| wrong(format!("{e}; give the path of an OBJ, glTF or GLB file")))?;
    let ending = name.rsplit('.').next().unwrap_or_default().to_lowercase();
    match ending.as_str() {
        "obj" => {
            let text = String::from_utf8(bytes).map_err(|_| wrong("it is not text; export it as OBJ".into()))?;
            parse_obj(&text).map_err(wrong)
        }
        "gltf" | "glb" => {
            let folder = name.rfind('/').map_or("", |at| &name[..=at]);
            let beside = |uri: &str| source.read(&format!("{folder}{uri}")).map_err(|e| format!("{uri}: {e}"));
            parse_gltf(&bytes, &beside).map_err(wrong)
        }
        _ => Err(wrong("its ending says no format that is read; give a file named .obj, .gltf or .glb".into())),
    }
}

/// Scales, turns and moves the mesh, each only where the scene asks for it, so that untouched coordinates keep their
/// bits.
fn place(table: &SceneTable<'_>, mesh: &mut PlainMesh) -> Result<(), SceneError> {
    let scale = table.number("scale")? as f32;
    let [x, y, z] = table.vector("rotation_deg")?.to_array().map(f32::to_radians);
    let position = table.vector("position")?;
    // About x first, then y, then z.
    let turn = Quat::from_euler(EulerRot::ZYX, z, y, x);
    for p in &mut mesh.positions {
        if scale != 1.0 {
            *p *= scale;
        }
        if turn != Quat::IDENTITY {
            *p = turn * *p;
        }
        if position != Vec3::ZERO {
            *p += position;
        }
    }
    let finite = || mesh.positions.iter().filter(|p| p.is_finite());
    let low = finite().fold(Vec3::INFINITY, |a, p| a.min(*p));
    let high = finite().fold(Vec3::NEG_INFINITY, |a, p| a.max(*p));
    let extent = (high - low).max_element();
    if !mesh.faces.is_empty() && !(EXTENT_M[0]..=EXTENT_M[1]).contains(&extent) {
        let message = format!("is {extent} m large; set garment.scale to bring it to metres, 0.001 for millimetres");
        return Err(table.wrong(mesh_key(table), message));
    }
    Ok(())
}

/// The checks of baking, reported at the scene's line before anything is built on the shape.
fn check_shape(table: &SceneTable<'_>, plain: &PlainMesh, mesh: &UserMesh, shape: &Shape) -> Result<(), SceneError> {
    check(&shape.cut, &shape.faces).map_err(|e| {
        // Several of the file's vertices may be one of the shape's; the first of them is named.
        let own = |v: u32| mesh.to_shape.iter().position(|to| *to == v).unwrap_or_default();
        table.wrong(mesh_key(table), format!("cannot be cloth: {}", plain.flaw(&e, own, |face| face)))
    })
}

fn fabric(table: &SceneTable<'_>, source: SceneSource<'_>) -> Result<Fabric, SceneError> {
    let built_in = |table: &SceneTable<'_>, key: &str, name: &str| {
        crate::fabric::built_in(name).map_err(|e| table.wrong(key, format!("is unknown: {e}")))
    };
    const DEFAULT: &str = "cotton-lawn";
    let Some(own) = (if table.is_table("fabric") { table.table("fabric")? } else { None }) else {
        return built_in(table, "fabric", table.text("fabric")?.unwrap_or(DEFAULT));
    };
    let mut fabric = match own.text("file")? {
        Some(_) if own.has("base") => return Err(own.wrong("file", "stands beside base; give one of them")),
        Some(name) => {
            let wrong = |e: String| own.wrong("file", format!("{name}: {e}"));
            let text = source.text(name).map_err(|e| wrong(format!("{e}; give the path of a fabric file")))?;
            crate::fabric::parse(name, &text).map_err(|e| wrong(e.to_string()))?
        }
        None => built_in(&own, "base", own.text("base")?.unwrap_or(DEFAULT))?,
    };
    for (key, ..) in Fabric::RANGES {
        if let Some(value) = own.maybe_number(key)? {
            fabric.set_figure(key, value as f32);
        }
    }
    Ok(fabric)
}

/// The user's vertices that a table names, by index or by box.
fn chosen(table: &SceneTable<'_>, mesh: &UserMesh) -> Result<Vec<usize>, SceneError> {
    let mut found = table.vertices("vertices", mesh.start.len())?.unwrap_or_default();
    if let Some([low, high]) = table.corners("box")? {
        let inside = |p: &Vec3| p.cmpge(low).all() && p.cmple(high).all();
        let before = found.len();
        found.extend(mesh.start.iter().enumerate().filter(|(_, p)| inside(p)).map(|(i, _)| i));
        if found.len() == before {
            return Err(table.wrong("box", "holds no vertex; the cloth starts elsewhere, so move the box or the cloth"));
        }
    }
    Ok(found)
}

/// Fixes what the material suffix and the pin tables hold, and gives each vertex the group that moves it.
fn pin(
    table: &SceneTable<'_>,
    loading: &mut SceneLoader<'_>,
    plain: &PlainMesh,
    mesh: &UserMesh,
    shape: &mut Shape,
) -> Result<(), SceneError> {
    let mut group = vec![None; shape.cut.len()];
    let mut hold = |v: u32, by: u8| {
        if let Some(to) = group.get_mut(v as usize) {
            *to = Some(by);
        }
    };
    let of_faces = |held: &dyn Fn(&str) -> bool| {
        let name = |f: usize| plain.face_materials[f].map_or("", |m| plain.materials[m].as_str());
        let faces = (0..plain.faces.len()).filter(|f| held(name(*f)));
        let corners = faces.flat_map(|f| plain.faces[f]).filter(|v| *v != NO_VERTEX);
        corners.map(|v| mesh.to_shape[v as usize]).collect::<Vec<_>>()
    };
    // The convention of files: where any material ends in Free, what touches another one stays.
    if plain.materials.iter().any(|m| m.ends_with(FREE)) {
        of_faces(&|name| !name.ends_with(FREE)).into_iter().for_each(|v| hold(v, 0));
    }
    for pin in table.tables("pin")? {
        if !["vertices", "box", "material"].iter().any(|key| pin.has(key)) {
            return Err(pin.error("[garment.pin] holds nothing; give vertices, box or material"));
        }
        let by = match pin.text("track")? {
            Some(_) if pin.has("motion") => return Err(pin.wrong("motion", "stands beside track; give one of them")),
            Some(name) => loading.pin_group(&pin, PinSource::Track(name))?,
            None => match pin.choice("motion")? {
                Some(i) => loading.pin_group(&pin, PinSource::Motion(i))?,
                None => 0,
            },
        };
        chosen(&pin, mesh)?.into_iter().for_each(|v| hold(mesh.to_shape[v], by));
        if let Some(suffix) = pin.text("material")? {
            let found = of_faces(&|name| name.ends_with(suffix));
            if found.is_empty() {
                let known = plain.materials.join(", ");
                return Err(pin.wrong("material", format!("ends no material; the mesh has {known}.")));
            }
            found.into_iter().for_each(|v| hold(v, by));
        }
    }
    if group.iter().all(Option::is_some) {
        return Err(table.error("[garment] is pinned as a whole, so nothing of it moves; pin fewer vertices"));
    }
    shape.fixed = group.iter().map(Option::is_some).collect();
    let weights = |by: &Option<u8>| SkinWeights { bones: [by.unwrap_or(0); 4], weights: [1.0, 0.0, 0.0, 0.0] };
    shape.weights = group.iter().map(weights).collect();
    Ok(())
}

/// Turns the faces so that the warp, whose fibers are solved directly, runs away from the pins: a flag hangs from its pole
/// sideways. The fabric's figures are exchanged with them, so that each thread keeps its stiffness.
fn hang(shape: &mut Shape, fabric: &mut Fabric) {
    let holds = |a: u32, b: u32| usize::from(shape.fixed[a as usize] != shape.fixed[b as usize]);
    let quads = || shape.faces.iter().filter(|f| f[3] != NO_VERTEX);
    let weft: usize = quads().map(|&[a, b, c, d]| holds(a, b) + holds(d, c)).sum();
    let warp: usize = quads().map(|&[a, b, c, d]| holds(a, d) + holds(b, c)).sum();
    if weft <= warp {
        return;
    }
    shape.split.resize(shape.faces.len(), false);
    let mut uvs = shape.uvs.iter_mut();
    for (face, split) in shape.faces.iter_mut().zip(&mut shape.split) {
        let uv = uvs.next();
        if face[3] == NO_VERTEX {
            continue;
        }
        face.rotate_left(1);
        if let Some(uv) = uv {
            uv.rotate_left(1);
        }
        *split = !*split;
    }
    std::mem::swap(&mut fabric.stretch_warp_n_m, &mut fabric.stretch_weft_n_m);
    std::mem::swap(&mut fabric.bend_warp_un_m, &mut fabric.bend_weft_un_m);
}

/// Mass of the shape (kg): by the fabric, or as the scene says; patches on top of it.
fn weigh(table: &SceneTable<'_>, mesh: &UserMesh, fabric: &Fabric, shape: &mut Shape) -> Result<f64, SceneError> {
    let mut mass = vec![0.0f64; shape.cut.len()];
    for t in shape.triangles() {
        let [a, b, c] = t.map(|v| shape.cut[v as usize].as_dvec3());
        let third = (b - a).cross(c - a).length() * 0.5 * f64::from(fabric.density_kg_m2) / 3.0;
        t.iter().for_each(|v| mass[*v as usize] += third);
    }
    let by_fabric: f64 = mass.iter().sum();
    let whole = table.maybe_number("mass")?.map_or(1.0, |wanted| wanted / by_fabric);
    let mut times = vec![whole; mass.len()];
    for patch in table.tables("mass_patch")? {
        if !patch.has("vertices") && !patch.has("box") {
            return Err(patch.error("[garment.mass_patch] weighs nothing; give vertices or box"));
        }
        let factor = patch.needed("factor")?;
        let mut inside: Vec<u32> = chosen(&patch, mesh)?.into_iter().map(|v| mesh.to_shape[v]).collect();
        inside.sort_unstable();
        inside.dedup();
        inside.into_iter().filter(|v| *v != NO_VERTEX).for_each(|v| times[v as usize] *= factor);
    }
    if times.iter().any(|t| *t != 1.0) {
        shape.heavier = times.iter().map(|t| *t as f32).collect();
    }
    Ok(mass.iter().zip(&times).map(|(m, t)| m * t).sum())
}
