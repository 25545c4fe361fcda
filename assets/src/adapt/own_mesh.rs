//! A mesh of the user's own, read and repaired once, ready to be put on any shopper.

use std::path::Path;

use glam::Vec3;

use super::error::AdaptError;
use super::file_order::FileOrder;
use super::lay::smooth_weights;
use super::made_for::MadeFor;
use super::measures::{GarmentMeasures, MeshSizes};
use super::mesh::ForeignMesh;
use super::report::Repair;
use super::source::{self, MeshFiles};
use super::unit::{self, FileAxes};
use super::{hems, repair, shells, surface};
use crate::import::avatar::ImportOptions;
use crate::import::makehuman::clothes::{Clothes, base_folder};
use crate::import::makehuman::{self, MakehumanOptions};
use toile_bake::check::check;
use toile_base::body::{Measures, Sex};
use toile_base::mesh::SkinWeights;

/// Height of the origin over the soles of MakeHuman's base mesh (dm): -8.190 to the sole of its young women, -8.181 of its men.
const HM08_ORIGIN_DM: f32 = 8.185;

/// Measures of MakeHuman's young women and men of average weight (m): stature, chest, waist and hip as it shows them itself.
const HM08_PEOPLE: [(Sex, [f32; 4]); 2] =
    [(Sex::Female, [1.605, 0.839, 0.718, 0.953]), (Sex::Male, [1.748, 0.974, 0.777, 0.943])];

/// Clothes that lie this near to their OBJ (dm), half of their vertices, were made on that body.
const MADE_ON_DM: f32 = 0.05;

/// A mesh of the user's own.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnMesh {
    /// The file, as the user gave it.
    pub path: String,
    /// The mesh, in metres, repaired.
    pub mesh: ForeignMesh,
    /// The order of its file, by which others know its vertices.
    pub file_order: FileOrder,
    /// The body that it is made for, standing in it.
    pub made_for: MadeFor,
    /// Its measures.
    pub measures: GarmentMeasures,
    /// Its sizes; none where it does not say in which one it is made.
    pub sizes: Option<MeshSizes>,
    /// How the numbers of the file were read.
    pub axes: FileAxes,
    /// The repairs.
    pub repairs: Vec<Repair>,
    /// Notes for the user, one sentence each.
    pub notes: Vec<String>,
    /// Skin weights of the body that it is made for, at each vertex.
    pub weights: Vec<SkinWeights>,
    /// Whose garment it is, where a file says it.
    pub sex: Option<Sex>,
}

impl OwnMesh {
    /// Reads a mesh and what lies beside it, recognises its unit and its body, and repairs it.
    ///
    /// # Errors
    /// One sentence: the file and its fault.
    pub fn read(path: &Path) -> Result<Self, AdaptError> {
        let files = source::read(path)?;
        let sizes = files.measures.sizes()?;
        let mut notes = files.notes.clone();
        let Standing { mut made_for, axes, known_pose } = stand(path, &files, sizes.as_ref(), &mut notes)?;
        let mut mesh = files.mesh;
        mesh.positions.iter_mut().for_each(|p| *p = axes.place(*p));
        let as_drawn = mesh.clone();
        let repairs = repaired(&mut mesh);
        let file_order = FileOrder::of(&as_drawn, &mesh);
        check(&mesh.positions, &mesh.faces)
            .map_err(|flaw| AdaptError::Mesh { path: files.path.clone(), flaw: described(&mesh, &flaw) })?;
        if !known_pose {
            made_for.hold_limbs(&mesh);
        }
        let weights = smooth_weights(&mesh, &made_for.body);
        let sex = sizes.as_ref().and_then(|s| sex_of(s.table.population));
        let sex = sex.or_else(|| files.clothes.as_ref().and_then(|c| c.sex));
        let sex = sex.or_else(|| files.measures.made_for.map(|m| m.sex.into()));
        Ok(Self {
            path: files.path,
            mesh,
            file_order,
            made_for,
            measures: files.measures,
            sizes,
            axes,
            repairs,
            notes,
            weights,
            sex,
        })
    }
}

fn sex_of(population: crate::sizes::Population) -> Option<Sex> {
    match population {
        crate::sizes::Population::Women => Some(Sex::Female),
        crate::sizes::Population::Men => Some(Sex::Male),
        crate::sizes::Population::Mixed => None,
    }
}

/// A flaw that is left after all repairs, by the file's own vertices.
fn described(mesh: &ForeignMesh, flaw: &toile_bake::check::MeshError) -> String {
    let own = |v: u32| mesh.source.get(v as usize).copied().unwrap_or_default();
    flaw.described(
        |v| format!("vertex {}", own(v)),
        |f| mesh.faces.get(f).map_or_else(|| "a face".into(), |face| format!("the face at vertex {}", own(face[0]))),
    )
}

/// Repairs a mesh in metres until it is surfaces of one layer.
fn repaired(mesh: &mut ForeignMesh) -> Vec<Repair> {
    let mut repairs = repair::repair(mesh);
    repairs.extend(surface::settle(mesh));
    repairs.push(shells::drop_inner(mesh));
    repairs.push(hems::peel(mesh));
    // What was taken away may have left faces that touch in a point alone.
    repairs.extend(surface::settle(mesh));
    repairs.retain(|r| r.count > 0);
    repairs
}

/// How a body stands in a mesh.
struct Standing {
    made_for: MadeFor,
    axes: FileAxes,
    /// Whether the body's arms are held as they were when the mesh was made.
    known_pose: bool,
}

fn stand(
    path: &Path,
    files: &MeshFiles,
    sizes: Option<&MeshSizes>,
    notes: &mut Vec<String>,
) -> Result<Standing, AdaptError> {
    if let Some(clothes) = &files.clothes {
        return stand_in_clothes(path, files, clothes, notes);
    }
    let (sex, measures, how) = match (sizes, &files.measures.made_for) {
        (Some(sizes), _) => {
            let how = format!("size {} of the table {}", sizes.made_in, sizes.table.name);
            (sizes.sex(), Measures::from(sizes.body), how)
        }
        (None, Some(body)) => (body.sex.into(), body.measures(), "the body that its file of measures gives".into()),
        (None, None) => {
            notes.push(
                "for whom it is made is not known, so that it is taken to be made for the average woman; a TOML file beside \
                 it says otherwise (docs/meshes.md)"
                    .into(),
            );
            (Sex::Female, Measures::average(Sex::Female), "the average woman".into())
        }
    };
    let made_for = mannequin(files, sex, &measures, how)?;
    let axes = unit::recognise(&files.mesh, &made_for.body, files.measures.unit())
        .map_err(|flaw| AdaptError::Mesh { path: files.path.clone(), flaw })?;
    if axes != FileAxes::PLAIN && files.measures.unit().is_none() {
        let words = axes.words();
        notes.push(format!(
            "its numbers were taken to be {words}, because a body stands in it so; export it in metres, y up, feet at 0"
        ));
    }
    Ok(Standing { made_for, axes, known_pose: false })
}

fn mannequin(files: &MeshFiles, sex: Sex, measures: &Measures, how: String) -> Result<MadeFor, AdaptError> {
    MadeFor::mannequin(sex, measures, how).map_err(|source| AdaptError::Body { path: files.path.clone(), source })
}

/// The body of MakeHuman clothes: that of the base mesh where it is at hand, else a mannequin of such a body's measures.
fn stand_in_clothes(
    path: &Path,
    files: &MeshFiles,
    clothes: &Clothes,
    notes: &mut Vec<String>,
) -> Result<Standing, AdaptError> {
    let metres = UNIT_OF_HM08;
    let Some(folder) = base_folder(path) else {
        notes.push(
            "MakeHuman's base mesh is not at hand (base.obj with its rig and weights, beside the clothes or in \
             makehuman-hm08 above them), so that it was placed on a mannequin of such a body's measures"
                .into(),
        );
        let (sex, [stature, chest_girth, waist_girth, hip_girth]) =
            if clothes.sex == Some(Sex::Male) { HM08_PEOPLE[1] } else { HM08_PEOPLE[0] };
        let shoulder_breadth = Measures::average(sex).shoulder_breadth * stature / Measures::average(sex).stature;
        let measures = Measures { stature, shoulder_breadth, chest_girth, waist_girth, hip_girth };
        let made_for = mannequin(files, sex, &measures, format!("a young {} body of MakeHuman", sex.name()))?;
        let axes = FileAxes { metres, unit: "decimetres", z_up: false, lift: HM08_ORIGIN_DM * metres };
        return Ok(Standing { made_for, axes, known_pose: false });
    };
    let found = clothes.made_on(&folder, &files.mesh.positions)?;
    let name = found.options.targets.first().map_or("base", |(name, _)| name.as_str());
    if found.median_error > MADE_ON_DM {
        notes.push(format!(
            "none of MakeHuman's bodies at hand has its clothes where the OBJ has them; {name} is nearest, {:.0} mm off for half \
             of the vertices",
            found.median_error * 100.0
        ));
    }
    let sex = if name.contains("-male") { Sex::Male } else { Sex::Female };
    let (made_for, lift) = on_base(&folder, &found.options, sex, format!("MakeHuman's {name}"))?;
    let axes = FileAxes { metres, unit: "decimetres", z_up: false, lift };
    Ok(Standing { made_for, axes, known_pose: true })
}

/// Metres in a unit of MakeHuman.
const UNIT_OF_HM08: f32 = 0.1;

/// MakeHuman's own body, standing on the floor as the base stands over its origin; and by how much it was lifted.
fn on_base(folder: &Path, options: &MakehumanOptions, sex: Sex, how: String) -> Result<(MadeFor, f32), AdaptError> {
    let import = ImportOptions { sex, ..ImportOptions::default() };
    let mut body = makehuman::read(folder, options, &import)?.imported.body;
    let origin = makehuman::origin(folder, options, &body)?;
    let aside = Vec3::new(origin.x, 0.0, origin.z);
    let all = body.mesh.positions.iter_mut().chain(&mut body.skeleton.rest);
    all.for_each(|p| *p += aside);
    Ok((MadeFor { body, how }, -origin.y))
}
