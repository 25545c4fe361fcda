//! A dressed body in motion.

use std::collections::BTreeMap;

use glam::Vec3;
use toile_base::body::Body as BodyShape;
use toile_base::frame::Joints;
use toile_base::garment::Garment as BakedGarment;
use toile_base::skeleton::Joint;
use toile_engine::cloth::step::measure;
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot as FrameSnapshot, World};
use toile_fitting::dress::garment_source::{FittedGarment, SourceKind};
use toile_fitting::dress::player::Player;
use toile_fitting::dress::try_on::{DressedBody, TryOn};
use toile_view::drawn_frame::DrawnFrame;
use toile_view::figure::Appearance;
use toile_view::fit_map::{self, JudgedTightness};

use super::options::{DressOptions, Motion, check_count, checked, first_joints};
use super::vertex_order::VertexOrder;
use super::worn::{GarmentStats, WornGarment};
use crate::body::Body;
use crate::error::{Error, Result};
use crate::fit::Recommendation;
use crate::garment::Garment;
use crate::picture::{self, Look, Picture, View};

/// What moves the body.
#[derive(Debug)]
enum Mover {
    /// It stays in these joints, or goes where the caller has it.
    Still(Box<Joints>),
    /// It follows a track.
    Follows(Box<Player<'static>>),
}

/// A dressed body.
#[derive(Debug)]
pub(super) struct DressedScene {
    world: World,
    reader: Reader<FrameSnapshot>,
    mover: Mover,
    worn: Vec<WornGarment>,
    orders: Vec<VertexOrder>,
    /// The cloths of each garment `[garments]`.
    cloths: Vec<std::ops::Range<usize>>,
    judged: Vec<JudgedTightness>,
    wanted: Option<u64>,
}

impl DressedScene {
    pub fn dress(body: &Body, garments: &[Garment], options: &DressOptions) -> Result<Self> {
        check_count(garments.len())?;
        let settings = options.settings()?;
        let first = first_joints(&options.motion, &body.shape().skeleton)?;
        let requested = garments.iter().map(Garment::requested).collect();
        let request = TryOn::of_body("", body.sex(), body.shape().measures, requested);
        let request = TryOn { tuck: options.tuck.clone(), ..request };
        let dressed = request.put_on(body.shape().clone(), body.known())?;
        let judged = dressed.tightness();
        let DressedBody { garments: baked, fitted, fitted_of, .. } = &dressed;
        let mut cloths = Vec::with_capacity(garments.len());
        for number in 0..garments.len() {
            let begin = fitted_of.partition_point(|of| *of < number);
            cloths.push(begin..fitted_of.partition_point(|of| *of <= number));
        }
        let orders = garments.iter().zip(fitted).zip(&cloths);
        let orders: Vec<VertexOrder> = orders.map(|((garment, worn), of)| order(garment, worn, baked, of)).collect();
        let described_all = garments.iter().zip(fitted).zip(orders.iter().zip(&cloths));
        let worn = described_all
            .map(|((garment, worn), (order, of))| described(garment, worn, &baked[of.clone()], order))
            .collect();
        let (mut world, reader) = dressed.build(settings).map_err(Error::input)?;
        world.dress_and_show(&first);
        let (mover, wanted) = match &options.motion {
            Motion::Track(track) => {
                let player = Player::new(track.clone());
                let steps = player.steps();
                (Mover::Follows(Box::new(player)), Some(steps))
            }
            _ => (Mover::Still(Box::new(first)), None),
        };
        Ok(Self { world, reader, mover, worn, orders, cloths, judged, wanted })
    }

    pub fn step(&mut self) {
        let joints = match &mut self.mover {
            Mover::Still(joints) => **joints,
            Mover::Follows(player) => player.step(),
        };
        self.world.step(&joints);
    }

    pub fn step_to(&mut self, joints: &Joints) -> Result<()> {
        let Mover::Still(at) = &mut self.mover else {
            return Err(Error::usage(
                "this scene follows a track; dress the body in joints, and not in a track, to move it by step_to",
            ));
        };
        **at = *checked(joints)?;
        self.world.step(at);
        Ok(())
    }

    pub fn steps(&self) -> u64 {
        self.world.tick()
    }

    pub fn wanted(&self) -> Option<u64> {
        self.wanted
    }

    pub fn worn(&self) -> &[WornGarment] {
        &self.worn
    }

    pub fn order(&self, garment: usize) -> &VertexOrder {
        &self.orders[garment]
    }

    pub fn positions(&self, garment: usize) -> impl Iterator<Item = Vec3> + '_ {
        self.orders[garment].positions(self.world.cloths())
    }

    pub fn pinned(&self, garment: usize) -> impl Iterator<Item = bool> + '_ {
        let garments = self.world.garments();
        self.orders[garment].each(move |cloth, particle| garments[cloth].inverse_mass[particle] == 0.0, |_| true)
    }

    pub fn stats(&self, garment: usize) -> GarmentStats {
        let mut stats = GarmentStats::default();
        for number in self.cloths[garment].clone() {
            let (mut cloth, baked) = (self.world.cloths()[number].clone(), &self.world.garments()[number]);
            let strain = measure::strain(&mut cloth, baked);
            let deep = measure::penetration(&mut cloth, baked, self.world.colliders());
            stats.add(strain, deep, &cloth);
        }
        stats
    }

    pub fn body(&self) -> &BodyShape {
        self.world.body()
    }

    /// The body's vertices and normals as they are now.
    pub fn skin(&mut self) -> (Vec<Vec3>, Vec<Vec3>) {
        let skin = &self.reader.latest().skin;
        let mut positions = vec![Vec3::ZERO; skin.vertices()];
        let mut normals = positions.clone();
        skin.read(&mut positions, &mut normals);
        (positions, normals)
    }

    pub fn fit_map(&self, garment: usize) -> Vec<f32> {
        let maps = fit_map::of_world(&self.world, &self.judged);
        self.orders[garment].each(|cloth, particle| maps[cloth][particle], |_| f32::NAN).collect()
    }

    pub fn pictures(&mut self, views: &[View], size: [u32; 2], look: Look) -> Result<Vec<Picture>> {
        let size = picture::checked_size(size)?;
        let mut drawn = DrawnFrame::new(&self.world, Appearance::default());
        let maps = fit_map::of_world(&self.world, &self.judged);
        drawn.update(self.reader.latest());
        let surfaces = drawn.surfaces((look == Look::FitMap).then_some(&maps));
        let ahead = self.world.pose().local[Joint::Pelvis.index()] * Vec3::Z;
        Ok(picture::draw(&surfaces, true, ahead.x.atan2(ahead.z), views, size))
    }

    pub fn state_hash(&self) -> u64 {
        self.world.state_hash()
    }

    /// What the steps had to repair, a sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let rolled: BTreeMap<&str, u64> = self
            .world
            .cloths()
            .iter()
            .zip(self.world.garments())
            .map(|(c, g)| (g.name.as_str(), c.events.rolled_back))
            .collect();
        let rolled = rolled.into_iter().filter(|(_, count)| *count > 0);
        let mut all: Vec<String> =
            rolled.map(|(name, count)| format!("{name}: {count} steps were not finite and were rolled back")).collect();
        if self.world.broken() > 0 {
            all.push(format!(
                "{} steps broke off in a worker; the garments kept their last places",
                self.world.broken()
            ));
        }
        all
    }
}

fn order(garment: &Garment, worn: &FittedGarment, baked: &[BakedGarment], of: &std::ops::Range<usize>) -> VertexOrder {
    match &garment.source().kind {
        SourceKind::Mesh(own) => {
            VertexOrder::of_file(&own.file_order, &baked[of.clone()], &worn.mesh_vertices, of.start)
        }
        _ => VertexOrder::drafted(&baked[of.start], of.start),
    }
}

fn described(garment: &Garment, worn: &FittedGarment, baked: &[BakedGarment], order: &VertexOrder) -> WornGarment {
    let first = baked.first();
    WornGarment {
        name: garment.name().to_owned(),
        size: first.map(|g| g.size.clone()).unwrap_or_default(),
        fabric: first.map(|g| g.fabric.name.clone()).unwrap_or_default(),
        vertices: order.vertices(),
        faces: order.triangles.len(),
        layers: baked.len(),
        fit: worn.fit.clone().map(Recommendation::of),
        notes: worn.mesh.iter().flat_map(|report| report.lines()).collect(),
    }
}
