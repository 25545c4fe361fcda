//! Drawing a base body: grid, form, and the surface where the two meet.

use glam::Vec3;

use crate::form::{Drawing, Form};
use crate::lattice;
use crate::lattice::chart::Chart;
use crate::subdivide::Quads;
use crate::wrap::Wrapping;
use toile_base::body::Region;
use toile_base::skeleton::Skeleton;

/// A base body as it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// Closed surface (m) `[vertices]`.
    pub positions: Vec<Vec3>,
    /// Vertex indices of each face `[quads]`.
    pub quads: Vec<[u32; 4]>,
    /// Piece of the atlas of each face `[quads]`.
    pub charts: Vec<Chart>,
    /// Part of the body `[vertices]`.
    pub regions: Vec<Region>,
    /// Mirror image of each vertex `[vertices]`.
    pub mirrors: Vec<u32>,
    /// Joint centres in the rest pose (m).
    pub skeleton: Skeleton,
}

/// Rounds of evening out on the cage and on the surface.
const CAGE_ROUNDS: usize = 12;
const SURFACE_ROUNDS: usize = 10;

/// Draws a body from the text of its drawing.
pub fn draw(text: &str) -> Result<Drawn, toml::de::Error> {
    let form = Form::new(toml::from_str::<Drawing>(text)?);
    let lattice = lattice::over(&form);
    let coarse = Quads::new(lattice.points.len(), lattice.faces.clone());
    let slide: Vec<f32> = lattice.tags.iter().map(|t| t.slide).collect();
    let mut cage = lattice.points.clone();
    Wrapping { form: &form, quads: &coarse, mirrors: &lattice.mirrors, slide: &slide }.lay(&mut cage, CAGE_ROUNDS);

    let fine = coarse.refined();
    let half = lattice.faces.len() as u32 / 2;
    let mirrors = coarse.refined_mirrors(&lattice.mirrors, |f| (f + half) % (2 * half));
    let mut positions = coarse.refine(&cage);
    let slides: Vec<Vec3> = slide.iter().map(|&s| Vec3::splat(s)).collect();
    let slide: Vec<f32> = coarse.refine(&slides).iter().map(|s| s.x).collect();
    for v in 0..positions.len() {
        let mirror = mirrors[v] as usize;
        if positions[v].x >= 0.0 {
            positions[mirror] = positions[v] * Vec3::new(-1.0, 1.0, 1.0);
        }
    }
    Wrapping { form: &form, quads: &fine, mirrors: &mirrors, slide: &slide }.lay(&mut positions, SURFACE_ROUNDS);
    let charts = lattice.charts.iter().flat_map(|&c| [c; 4]).collect();
    let regions = regions(&coarse, &lattice, &positions);
    positions.iter_mut().for_each(|p| *p *= 1e-3);
    let skeleton = form.skeleton();
    Ok(Drawn { positions, quads: fine.faces().to_vec(), charts, regions, mirrors, skeleton })
}

/// The part of the body of each vertex: by majority of what the cage around it is.
fn regions(coarse: &Quads, lattice: &lattice::Lattice, positions: &[Vec3]) -> Vec<Region> {
    let part = |r: Region| match r {
        Region::Torso => Vec3::ZERO,
        Region::LeftArm | Region::RightArm => Vec3::X,
        Region::LeftLeg | Region::RightLeg => Vec3::Y,
        Region::Head => Vec3::Z,
    };
    let parts: Vec<Vec3> = lattice.tags.iter().map(|t| part(t.region)).collect();
    let shares = coarse.refine(&parts);
    shares.iter().zip(positions).map(|(&part, &p)| region(part, p)).collect()
}

/// The region of a vertex, by its shares of arm, leg and head (x, y, z).
fn region(part: Vec3, position: Vec3) -> Region {
    let left = position.x > 0.0;
    match part {
        p if p.x > 0.5 => [Region::RightArm, Region::LeftArm][usize::from(left)],
        p if p.y > 0.5 => [Region::RightLeg, Region::LeftLeg][usize::from(left)],
        p if p.z > 0.5 => Region::Head,
        _ => Region::Torso,
    }
}
