//! A try-on by physics: a garment in a size put on a body, settled, and observed there.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use toile_assets::sizes::Girth;
use toile_base::body::{Body, Region};
use toile_base::frame::Joints;
use toile_base::garment::{Garment, Part};
use toile_base::numeric::statistics::quantile;
use toile_base::rig::Rig;
use toile_base::skeleton::Pose;
use toile_engine::cloth::{Cloth, Settings, step::measure};
use toile_engine::triple_buffer::Reader;
use toile_engine::world::{Snapshot, World};
use toile_fitting::dress::player::Player;
use toile_fitting::dress::session;
use toile_fitting::dress::try_on::DressedBody;
use toile_fitting::wearing::{self, CoveredZone, poses};

use crate::error::{Result, StudyError};
use crate::garments::{DrapeStart, TriedGarment};

/// Steps of walking: 4 s.
const WALK_STEPS: usize = 480;

/// Sectors around the body, nearly all of which a closed section of cloth has.
const SECTORS: usize = 16;

/// So many of them have to be there: a placket may gape.
const LEAST_SECTORS: u32 = 14;

/// Share of a garment's particles that are its hem: the lowest as it is put on.
const HEM: f32 = 0.03;

toile_base::named! {
    /// What is done in a garment.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    pub enum TriedPose {
        /// Arms beside the hips.
        Standing = "standing",
        /// Arms over the head.
        ArmsRaised = "arms-raised",
        /// Hips and knees at right angles.
        Sitting = "sitting",
        /// As the shopper of the embedded session, for four seconds.
        Walking = "walking",
    }
}

/// What is seen of a garment that has been put on.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Draped {
    /// Girth of the cloth at the level of chest, waist and hip, unstretched, less the body's there (m).
    pub worn_ease: [Option<f64>; 3],
    /// Mean distance of the cloth from the body there (m).
    pub gap: [Option<f64>; 3],
    /// Stretch of each covered zone.
    pub stretch: [Option<f64>; CoveredZone::ALL.len()],
    /// Stretch that is comfortable.
    pub comfortable: f64,
    /// Mean height of the hem, its mean distance from its middle and the deviation of that (m).
    pub hem: Option<[f64; 3]>,
    /// Mean, 99th percentile of the strain (1).
    pub strain: [f64; 2],
    /// Deepest point inside of the body (m).
    pub penetration: f64,
}

impl Draped {
    /// The zones that are stretched beyond what is comfortable, parted by a space.
    pub fn pulls(&self) -> String {
        const WORDS: [&str; CoveredZone::ALL.len()] = ["sleeves", "chest", "waist", "hip", "legs"];
        let beyond = self.stretch.iter().zip(WORDS).filter(|(s, _)| s.is_some_and(|s| s > self.comfortable));
        beyond.map(|(_, word)| word).collect::<Vec<_>>().join(" ")
    }
}

/// A garment on a body, in motion.
pub struct WornFrame {
    world: World,
    reader: Reader<Snapshot>,
    pose: TriedPose,
    joints: Joints,
}

impl WornFrame {
    /// Puts a garment on and lets it settle for so many steps.
    ///
    /// # Errors
    /// A garment that cannot be laid on this body.
    pub fn put_on(
        (body, rig): (&Body, &Rig),
        (garment, size, start): (&TriedGarment, &str, DrapeStart),
        pose: TriedPose,
        (settings, settle): (Settings, usize),
    ) -> Result<Self> {
        let worn = garment.dress(size, body, start)?;
        let made = DressedBody::new(rig.clone(), body.clone(), worn.garments).build(settings);
        let (mut world, reader) = made.map_err(StudyError::input)?;
        world.measure_every(0);
        let skeleton = &body.skeleton;
        let mut joints = match pose {
            TriedPose::Standing | TriedPose::Walking => poses::joints(skeleton, &poses::arms_down(skeleton)),
            TriedPose::ArmsRaised => poses::joints(skeleton, &poses::arms_raised(skeleton)),
            TriedPose::Sitting => poses::joints(skeleton, &poses::sitting(skeleton)),
        };
        if pose == TriedPose::Walking {
            let track = session::standing(&session::open(None, None)?)?;
            world.dress(&track[0]);
            let mut player = Player::new(&track);
            for _ in 0..WALK_STEPS {
                joints = player.step();
                world.step(&joints);
            }
        } else {
            world.dress(&joints);
        }
        let mut worn = Self { world, reader, pose, joints };
        worn.settle(settle.max(1));
        Ok(worn)
    }

    /// Lets it settle for so many steps more.
    pub fn settle(&mut self, steps: usize) {
        (0..steps).for_each(|_| self.world.step(&self.joints));
    }

    /// Where the vertices of the garments' meshes are (m), garment after garment, whatever order they are solved in.
    pub fn positions(&self) -> Vec<Vec3> {
        let worn = self.world.cloths().iter().zip(self.world.garments());
        let of = |(cloth, garment): (&Cloth, &Garment)| {
            let vertices = garment.source.iter().map(|v| *v as usize + 1).max().unwrap_or(0);
            let mut at = vec![Vec3::ZERO; vertices];
            garment.source.iter().zip(&cloth.positions).for_each(|(v, p)| at[*v as usize] = Vec3::from(*p));
            at
        };
        worn.flat_map(of).collect()
    }

    /// The frame and its newest snapshot.
    pub fn shown(&mut self) -> (&World, &Snapshot) {
        (&self.world, self.reader.latest())
    }

    /// What is seen of it now.
    pub fn look(&mut self) -> Draped {
        let skin = &self.reader.latest().skin;
        let mut posed = vec![Vec3::ZERO; skin.vertices()];
        let mut normals = posed.clone();
        skin.read(&mut posed, &mut normals);
        let world = &self.world;
        let Some((cloth, garment)) = world.cloths().iter().zip(world.garments()).max_by_key(|(_, g)| g.particles())
        else {
            return Draped::default();
        };
        let body = world.body();
        let shift = world.pose().root.y - Pose::rest(&body.skeleton).root.y;
        let stretch = wearing::stretches(cloth, garment, &body.levels).map(|s| s.map(f64::from));
        let mut seen =
            Draped { stretch, comfortable: f64::from(garment.fabric.comfortable_stretch), ..Draped::default() };
        // Levels are horizontal while the trunk is upright and the legs hang.
        if self.pose != TriedPose::Sitting {
            let hoops = hoop_strain(cloth, garment);
            for (i, zone) in Girth::ALL.into_iter().enumerate() {
                let level = shift
                    + match zone {
                        Girth::Chest => body.levels.chest,
                        Girth::Waist => body.levels.waist,
                        Girth::Hip => body.levels.hip,
                    };
                if let Some(section) = cloth_section(cloth, garment, &hoops, level) {
                    seen.worn_ease[i] = Some(section.girth - f64::from(zone.of(&body.measures)));
                    seen.gap[i] = section.gap(&body_section(body, &posed, level));
                }
            }
            seen.hem = hem(cloth, garment);
        }
        for (cloth, garment) in world.cloths().iter().zip(world.garments()) {
            let mut cloth = cloth.clone();
            let strain = measure::strain(&mut cloth, garment);
            seen.strain = [seen.strain[0].max(f64::from(strain.mean)), seen.strain[1].max(f64::from(strain.p99))];
            let deep = measure::penetration(&mut cloth, garment, world.colliders());
            seen.penetration = seen.penetration.max(f64::from(deep));
        }
        seen
    }
}

/// Mean and 99th percentile of how far points have moved (m).
pub fn moved(before: &[Vec3], after: &[Vec3]) -> [f64; 2] {
    let mut all: Vec<f64> = before.iter().zip(after).map(|(a, b)| f64::from(a.distance(*b))).collect();
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    [mean, quantile(&mut all, 0.99).unwrap_or(0.0)]
}

/// Where a plane cuts the cloth.
struct Section {
    /// Its length without stretch (m).
    girth: f64,
    points: Vec<Vec2>,
}

impl Section {
    /// Mean distance of its points from the body's outline (m).
    fn gap(&self, outline: &[[Vec2; 2]]) -> Option<f64> {
        if outline.is_empty() {
            return None;
        }
        let to = |p: &Vec2| outline.iter().map(|[a, b]| distance(*p, *a, *b)).fold(f32::MAX, f32::min);
        Some(self.points.iter().map(|p| f64::from(to(p))).sum::<f64>() / self.points.len() as f64)
    }
}

fn distance(p: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

/// Mean stretch of the hoops through each particle (1).
fn hoop_strain(cloth: &Cloth, garment: &Garment) -> Vec<f32> {
    let mut sum = vec![(0.0f32, 0u32); garment.particles()];
    for ([a, b], rest) in &garment.hoop_edges {
        let s = cloth.positions[*a as usize].distance(cloth.positions[*b as usize]) / rest - 1.0;
        for v in [*a as usize, *b as usize] {
            sum[v] = (sum[v].0 + s, sum[v].1 + 1);
        }
    }
    sum.into_iter().map(|(s, n)| s / n.max(1) as f32).collect()
}

/// The two points at which a level cuts a triangle.
fn cut(corners: [Vec3; 3], level: f32) -> Option<[Vec2; 2]> {
    let mut found = [Vec2::ZERO; 2];
    let mut count = 0;
    for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
        if (a.y < level) != (b.y < level) && count < 2 {
            let p = a.lerp(b, (level - a.y) / (b.y - a.y));
            found[count] = Vec2::new(p.x, p.z);
            count += 1;
        }
    }
    (count == 2).then_some(found)
}

fn cloth_section(cloth: &Cloth, garment: &Garment, strain: &[f32], level: f32) -> Option<Section> {
    let at = |v: u32| Vec3::from(cloth.positions[v as usize]);
    let arm = |v: u32| matches!(garment.parts[v as usize], Part::LeftArm | Part::RightArm);
    let (mut girth, mut points) = (0.0, Vec::new());
    for t in garment.triangles.iter().filter(|t| !t.iter().any(|v| arm(*v))) {
        if let Some([a, b]) = cut(t.map(at), level) {
            let stretched = t.iter().map(|v| strain[*v as usize]).sum::<f32>() / 3.0;
            girth += f64::from(a.distance(b) / (1.0 + stretched));
            points.extend([a, b]);
        }
    }
    let middle = points.iter().copied().sum::<Vec2>() / points.len().max(1) as f32;
    let sector = |p: &Vec2| {
        let turn = ((*p - middle).to_angle() / TAU).rem_euclid(1.0);
        1u32 << ((turn * SECTORS as f32) as usize).min(SECTORS - 1)
    };
    let covered = points.iter().fold(0, |all, p| all | sector(p)).count_ones();
    (covered >= LEAST_SECTORS).then_some(Section { girth, points })
}

/// The outline of trunk and legs at a level.
fn body_section(body: &Body, posed: &[Vec3], level: f32) -> Vec<[Vec2; 2]> {
    let trunk = |v: u32| matches!(body.regions[v as usize], Region::Torso | Region::LeftLeg | Region::RightLeg);
    let whole = body.mesh.triangles.iter().filter(|t| t.iter().all(|v| trunk(*v)));
    whole.filter_map(|t| cut(t.map(|v| posed[v as usize]), level)).collect()
}

fn hem(cloth: &Cloth, garment: &Garment) -> Option<[f64; 3]> {
    let sleeve = |v: usize| matches!(garment.parts[v], Part::LeftArm | Part::RightArm);
    let leg = |v: usize| matches!(garment.parts[v], Part::LeftLeg | Part::RightLeg);
    let mut order: Vec<usize> = (0..garment.particles()).filter(|v| !sleeve(*v)).collect();
    order.sort_by(|a, b| garment.start[*a].y.total_cmp(&garment.start[*b].y));
    order.truncate(((HEM * order.len() as f32) as usize).max(1));
    let points: Vec<Vec3> = order.iter().map(|v| cloth.positions[*v].into()).collect();
    let n = points.len().max(1) as f64;
    let middle = points.iter().copied().sum::<Vec3>() / n as f32;
    // The hems of two legs go around no middle.
    let radii: Vec<f64> = points.iter().map(|p| f64::from((*p - middle).with_y(0.0).length())).collect();
    let mean = radii.iter().sum::<f64>() / n;
    let deviation = (radii.iter().map(|r| (r - mean).powi(2)).sum::<f64>() / n).sqrt();
    let legs = order.iter().any(|v| leg(*v));
    let [mean, deviation] = if legs { [f64::NAN; 2] } else { [mean, deviation] };
    (!points.is_empty()).then_some([f64::from(middle.y), mean, deviation])
}
