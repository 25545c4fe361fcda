//! The fields of displacement themselves: what each slider does to each vertex of a base body.

use glam::{Vec2, Vec3};

use super::base::BaseBody;
use super::gauge::neck_axis;
use super::landmarks::Landmark;
use super::segments::Neighbourhood;
use super::slider::{SLIDERS, Slider};
use toile_base::body::{Region, Sex};
use toile_base::skeleton::Joint;

/// How far a segment reaches, as the Gaussian's sigma over the mean way to its neighbours' cores: the share is a half
/// midway to the neighbour, and 12 % at its core.
const REACH: f32 = 0.5;

/// Way along an arm over which it turns from following the trunk's surface to being carried as a whole (m).
const CARRIED: f32 = 0.10;

/// Height to which nothing grows or stretches, in heights of the ankle's joint: feet keep their shape.
const ABOVE_ANKLE: f32 = 1.6;

/// Share of a thigh's growth by which the leg below moves outwards.
const LEG_SHIFT: f32 = 0.35;

/// The segments of trunk and legs, numbered from the head (0) down to the feet; head and feet only hold still.
#[derive(Clone, Copy, PartialEq, Eq)]
enum TrunkSegment {
    Neck = 1,
    Shoulders,
    Chest,
    Underbust,
    Waist,
    Abdomen,
    Hip,
    Thigh,
    Knee,
    Calf,
    Foot,
}

/// The segments of an arm, numbered from the trunk (0) to the hand (4); trunk and hand only hold still.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ArmSegment {
    Upper = 1,
    Fore,
    Wrist,
}

/// Inputs of the fields.
struct FieldBuilder<'a> {
    base: &'a BaseBody,
    near: &'a Neighbourhood,
    trunk: Vec<Vec<f32>>,
    arm: Vec<Vec<f32>>,
    /// Share by which a vertex of an arm is carried as a whole: 0 at the armhole and on the trunk.
    carried: Vec<f32>,
    /// Vertices of the left armhole.
    armhole: Vec<u32>,
}

/// One field a slider, of the left side; the right one is made its mirror image.
pub(super) fn displacements(base: &BaseBody, near: &Neighbourhood) -> Vec<Vec<Vec3>> {
    let making = FieldBuilder::new(base, near);
    let mut fields = vec![vec![Vec3::ZERO; base.positions.len()]; SLIDERS];
    for slider in Slider::ALL {
        let field = &mut fields[slider.index()];
        match slider {
            Slider::ArmLength | Slider::UpperArm | Slider::Forearm | Slider::Wrist => making.arms(slider, field),
            _ => {
                making.trunk(slider, field);
                making.carry(field);
            }
        }
    }
    fields
}

impl<'a> FieldBuilder<'a> {
    fn new(base: &'a BaseBody, near: &'a Neighbourhood) -> Self {
        let arm = |v: u32| matches!(base.regions[v as usize], Region::LeftArm | Region::RightArm);
        let armhole: Vec<u32> = (0..base.positions.len() as u32)
            .filter(|&v| arm(v) && base.positions[v as usize].x > 0.0)
            .filter(|&v| near.ring(v as usize).any(|w| !arm(w as u32)))
            .collect();
        let both = |core: &[(u32, f32)]| -> Vec<(u32, f32)> {
            core.iter().flat_map(|&(v, lead)| [(v, lead), (near.mirror[v as usize], lead)]).collect()
        };
        let rim: Vec<(u32, f32)> = armhole.iter().map(|&v| (v, 0.0)).collect();
        let into = near.distances(&both(&rim));
        let mut carried: Vec<f32> =
            into.iter().enumerate().map(|(v, d)| if arm(v as u32) { ease(d / CARRIED) } else { 0.0 }).collect();
        near.smooth(&mut carried);
        let chain = |cores: Vec<Vec<(u32, f32)>>| {
            let ways: Vec<Vec<f32>> = cores.iter().map(|c| near.distances(&both(c))).collect();
            let reach = reaches(&cores, &ways);
            near.shares(&ways.into_iter().zip(reach).collect::<Vec<_>>())
        };
        let trunk = chain(trunk_cores(base));
        let mut cores = arm_cores(base);
        cores.insert(0, (0..base.positions.len() as u32).filter(|&v| !arm(v)).map(|v| (v, 0.0)).collect());
        Self { base, near, trunk, arm: chain(cores), carried, armhole }
    }

    fn share(&self, segment: TrunkSegment, v: usize) -> f32 {
        self.trunk[segment as usize][v]
    }

    /// The height of a landmark (m).
    fn height(&self, landmark: Landmark) -> f32 {
        self.base.landmarks.mark(landmark).on(&self.base.positions).y
    }

    /// Fields of everything but the arms: what they do to trunk, head and legs.
    fn trunk(&self, slider: Slider, field: &mut [Vec3]) {
        use Slider as S;
        match slider {
            S::LowerLeg => self.lengthen(field, [ABOVE_ANKLE * self.ankle(), self.height(Landmark::Midpatella)]),
            S::UpperLeg => self.lengthen(field, [self.height(Landmark::Midpatella), self.height(Landmark::Crotch)]),
            S::LowerTrunk => {
                self.lengthen(field, [self.height(Landmark::Crotch) + 0.01, self.height(Landmark::NaturalWaist)]);
            }
            S::UpperTrunk => {
                self.lengthen(field, [self.height(Landmark::NaturalWaist), self.height(Landmark::Axilla)]);
            }
            S::NeckLength => self.lengthen_neck(field),
            S::Shoulders => self.widen(field, TrunkSegment::Shoulders),
            S::Neck => self.swell_neck(field),
            S::ChestBreadth => self.widen(field, TrunkSegment::Chest),
            S::ChestDepth => {
                let bust = if self.base.sex == Sex::Female { 0.35 } else { 0.0 };
                self.deepen(
                    field,
                    &[(TrunkSegment::Chest, 1.0), (TrunkSegment::Shoulders, 0.4)],
                    Landmark::BustPoint,
                    bust,
                );
            }
            S::Underbust => self.swell(field, TrunkSegment::Underbust, Landmark::Underbust, 0.0),
            S::Waist => self.swell(field, TrunkSegment::Waist, Landmark::NaturalWaist, 0.15),
            S::AbdomenBreadth => self.widen(field, TrunkSegment::Abdomen),
            S::AbdomenDepth => self.deepen(field, &[(TrunkSegment::Abdomen, 1.0)], Landmark::Omphalion, 0.4),
            S::HipBreadth => self.widen(field, TrunkSegment::Hip),
            S::HipDepth => self.deepen(field, &[(TrunkSegment::Hip, 1.0)], Landmark::Buttock, -0.15),
            S::Thigh => self.swell_leg(field, TrunkSegment::Thigh, Landmark::Thigh, 0.0),
            S::Knee => self.swell_leg(field, TrunkSegment::Knee, Landmark::Midpatella, 0.8),
            S::Calf => self.swell_leg(field, TrunkSegment::Calf, Landmark::Calf, 0.8),
            S::ArmLength | S::UpperArm | S::Forearm | S::Wrist => {}
        }
    }

    fn ankle(&self) -> f32 {
        self.base.skeleton.at(Joint::LeftAnkle).y
    }

    /// Stretches what lies between two heights, and lifts what lies above.
    fn lengthen(&self, field: &mut [Vec3], [low, high]: [f32; 2]) {
        for (d, p) in field.iter_mut().zip(&self.base.positions) {
            d.y = stretch((p.y - low) / (high - low));
        }
    }

    /// Stretches the neck along its slant, from above the shoulders to below the jaw, and lifts the head.
    fn lengthen_neck(&self, field: &mut [Vec3]) {
        let axis = neck_axis(self.base);
        let along = |landmark: Landmark| self.base.landmarks.mark(landmark).on(&self.base.positions).dot(axis);
        let middle = along(Landmark::Infrathyroid);
        let low = along(Landmark::Suprasternale);
        for (v, (d, p)) in field.iter_mut().zip(&self.base.positions).enumerate() {
            let high = middle + 0.6 * (middle - low);
            d.y = if self.base.regions[v] == Region::Head { 1.0 } else { stretch((p.dot(axis) - low) / (high - low)) };
        }
        // Jaw and neck part at the region's border: the step there is spread over the skin around it.
        let mut lift: Vec<f32> = field.iter().map(|d| d.y).collect();
        self.near.smooth(&mut lift);
        field.iter_mut().zip(lift).for_each(|(d, y)| d.y = y);
    }

    /// Scales breadth about the body's middle.
    fn widen(&self, field: &mut [Vec3], segment: TrunkSegment) {
        for (v, d) in field.iter_mut().enumerate() {
            d.x += self.share(segment, v) * self.base.positions[v].x;
        }
    }

    /// Scales depth about the middle of the section at a landmark; `front` shifts the middle backwards by that part of
    /// half the depth, so that the front grows more.
    fn deepen(&self, field: &mut [Vec3], segments: &[(TrunkSegment, f32)], level: Landmark, front: f32) {
        let (centre, half) = self.section(level);
        let pivot = centre.y - front * half.y;
        for (v, d) in field.iter_mut().enumerate() {
            let share: f32 = segments.iter().map(|&(s, by)| by * self.share(s, v)).sum();
            d.z += share * (self.base.positions[v].z - pivot);
        }
    }

    fn swell(&self, field: &mut [Vec3], segment: TrunkSegment, level: Landmark, front: f32) {
        self.widen(field, segment);
        self.deepen(field, &[(segment, 1.0)], level, front);
    }

    fn swell_neck(&self, field: &mut [Vec3]) {
        let (neck, head) = (self.base.skeleton.at(Joint::Neck), self.base.skeleton.at(Joint::Head));
        for (v, d) in field.iter_mut().enumerate() {
            let p = self.base.positions[v];
            let along = ((p.y - neck.y) / (head.y - neck.y)).clamp(-0.5, 1.5);
            let centre = neck.z + along * (head.z - neck.z);
            *d = Vec3::new(p.x, 0.0, p.z - centre) * self.share(TrunkSegment::Neck, v);
        }
    }

    /// Swells one level of the legs. Breadth grows away from a line at `own` of the way from the body's middle to the
    /// leg's: 0 keeps the gap between the thighs in proportion, so that it never closes.
    fn swell_leg(&self, field: &mut [Vec3], segment: TrunkSegment, level: Landmark, own: f32) {
        let (centre, _) = self.section(level);
        for (v, d) in field.iter_mut().enumerate() {
            let p = self.base.positions[v];
            *d = Vec3::new(p.x - own * centre.x * p.x.signum(), 0.0, p.z - centre.y) * self.share(segment, v);
            if segment == TrunkSegment::Thigh {
                let below = self.share(TrunkSegment::Knee, v)
                    + self.share(TrunkSegment::Calf, v)
                    + self.share(TrunkSegment::Foot, v);
                d.x += LEG_SHIFT * centre.x * p.x.signum() * below;
            }
        }
    }

    /// Middle and half extent (x, z) of the section of trunk or left leg at a landmark's height.
    fn section(&self, level: Landmark) -> (Vec2, Vec2) {
        let height = self.height(level);
        let (mut low, mut high) = (Vec2::MAX, Vec2::MIN);
        for t in &self.base.triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                let [p, q] = [a, b].map(|v| self.base.positions[v as usize]);
                let arm = [a, b].iter().any(|&v| self.carried_region(v));
                if arm || p.x < 0.0 || q.x < 0.0 || (p.y >= height) == (q.y >= height) {
                    continue;
                }
                let at = p.lerp(q, (height - p.y) / (q.y - p.y));
                low = low.min(Vec2::new(at.x, at.z));
                high = high.max(Vec2::new(at.x, at.z));
            }
        }
        ((low + high) * 0.5, (high - low) * 0.5)
    }

    fn carried_region(&self, v: u32) -> bool {
        matches!(self.base.regions[v as usize], Region::LeftArm | Region::RightArm)
    }

    /// Lets the arms follow: at the armhole as the trunk's surface does, further out as the armhole does as a whole.
    fn carry(&self, field: &mut [Vec3]) {
        let sum: Vec3 = self.armhole.iter().map(|&v| field[v as usize]).sum();
        let whole = sum / self.armhole.len().max(1) as f32;
        for (v, d) in field.iter_mut().enumerate() {
            if self.base.positions[v].x > 0.0 {
                *d = d.lerp(whole, self.carried[v]);
            }
        }
    }

    /// Fields of the left arm.
    fn arms(&self, slider: Slider, field: &mut [Vec3]) {
        let joint = |j: Joint| self.base.skeleton.at(j);
        let bones = [Joint::LeftShoulder, Joint::LeftElbow, Joint::LeftWrist, Joint::LeftHand].map(joint);
        for (v, d) in field.iter_mut().enumerate() {
            let p = self.base.positions[v];
            if p.x <= 0.0 || !self.carried_region(v as u32) {
                continue;
            }
            let segment = match slider {
                Slider::UpperArm => ArmSegment::Upper,
                Slider::Forearm => ArmSegment::Fore,
                Slider::Wrist => ArmSegment::Wrist,
                _ => {
                    *d = lengthened(&bones, p);
                    continue;
                }
            };
            *d = (p - nearest_on(&bones, p)) * self.arm[segment as usize][v];
        }
    }
}

/// How a point of the left arm moves a metre of the arm's length: both bones in proportion.
fn lengthened(bones: &[Vec3; 4], p: Vec3) -> Vec3 {
    let (upper, fore) = (bones[1] - bones[0], bones[2] - bones[1]);
    let whole = upper.length() + fore.length();
    // The shoulder's round keeps its shape.
    let along = |from: Vec3, bone: Vec3| (p - from).dot(bone) / bone.length_squared();
    let first = stretch((along(bones[0], upper) - 0.25) / 0.75);
    (upper * first + fore * stretch(along(bones[1], fore))) / whole
}

/// The nearest point of a polyline; beyond its ends, of the ends' lines.
fn nearest_on(bones: &[Vec3; 4], p: Vec3) -> Vec3 {
    let on = |k: usize| {
        let bone = bones[k + 1] - bones[k];
        let [least, most] = [[f32::MIN, 1.0], [0.0, 1.0], [0.0, f32::MAX]][k];
        bones[k] + bone * ((p - bones[k]).dot(bone) / bone.length_squared()).clamp(least, most)
    };
    let off = |k: &usize| on(*k).distance_squared(p);
    on((0..3).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0))
}

/// 0 to 1 with level ends.
fn ease(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// 0 to 1, straight but for rounded ends: a stretch that is even, and does not begin at once.
fn stretch(t: f32) -> f32 {
    const END: f32 = 0.25;
    let rise = |t: f32| if t < END { t * t / (2.0 * END) } else { t - 0.5 * END };
    let t = t.clamp(0.0, 1.0);
    let half = |t: f32| rise(t) / (1.0 - END);
    if t <= 0.5 { half(t) } else { 1.0 - half(1.0 - t) }
}

/// How far each segment of a chain reaches: from the ways between its core and its neighbours'.
fn reaches(cores: &[Vec<(u32, f32)>], ways: &[Vec<f32>]) -> Vec<f32> {
    // To the nearer half of the neighbour's core: the first and the last segment's hold all that lies beyond.
    let way = |i: usize, j: usize| {
        let (from, to) = if cores[i].len() > cores[j].len() { (j, i) } else { (i, j) };
        let least = cores[to].iter().map(|&(v, _)| ways[from][v as usize]).fold(f32::MAX, f32::min);
        let back =
            cores[from].iter().map(|&(v, _)| ways[to][v as usize]).sum::<f32>() / cores[from].len().max(1) as f32;
        least.max(back)
    };
    (0..cores.len())
        .map(|i| {
            let gaps: Vec<f32> = [i.checked_sub(1), Some(i + 1)]
                .into_iter()
                .flatten()
                .filter(|&j| j < cores.len())
                .map(|j| way(i, j))
                .collect();
            REACH * gaps.iter().sum::<f32>() / gaps.len() as f32
        })
        .collect()
}

/// The vertices along a plane's cut, with their distance from it.
fn ring(base: &BaseBody, at: Vec3, normal: Vec3, admits: impl Fn(u32) -> bool) -> Vec<(u32, f32)> {
    let height = |v: u32| (base.positions[v as usize] - at).dot(normal);
    let mut core: Vec<(u32, f32)> = Vec::new();
    for t in &base.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            if (height(a) >= 0.0) != (height(b) >= 0.0) && admits(a) && admits(b) {
                core.extend([a, b].map(|v| (v, height(v).abs())));
            }
        }
    }
    core.sort_unstable_by_key(|c| c.0);
    core.dedup_by_key(|c| c.0);
    core
}

/// The cores of the trunk's chain: the head, then in the order of [`TrunkSegment`].
fn trunk_cores(base: &BaseBody) -> Vec<Vec<(u32, f32)>> {
    let at = |l: Landmark| base.landmarks.mark(l).on(&base.positions);
    let region = |v: u32| base.regions[v as usize];
    let trunk = |v: u32| !matches!(region(v), Region::LeftArm | Region::RightArm);
    let all = 0..base.positions.len() as u32;
    let head = all.clone().filter(|&v| region(v) == Region::Head).map(|v| (v, 0.0)).collect();
    let neck = |v: u32| trunk(v) && base.positions[v as usize].x.abs() < 0.16;
    let level = |l: Landmark| ring(base, at(l), Vec3::Y, trunk);
    let sole = ABOVE_ANKLE * base.skeleton.at(Joint::LeftAnkle).y;
    let foot = all.filter(|&v| base.positions[v as usize].y < sole).map(|v| (v, 0.0)).collect();
    vec![
        head,
        ring(base, at(Landmark::Infrathyroid), neck_axis(base), neck),
        level(Landmark::Acromion),
        level(Landmark::BustPoint),
        level(Landmark::Underbust),
        level(Landmark::NaturalWaist),
        level(Landmark::Omphalion),
        level(Landmark::Buttock),
        level(Landmark::Thigh),
        level(Landmark::Midpatella),
        level(Landmark::Calf),
        foot,
    ]
}

/// The cores of an arm's chain in the order of [`ArmSegment`], then the hand.
fn arm_cores(base: &BaseBody) -> Vec<Vec<(u32, f32)>> {
    let arm = |v: u32| base.regions[v as usize] == Region::LeftArm;
    let joint = |j: Joint| base.skeleton.at(j);
    let at = |l: Landmark| base.landmarks.mark(l).on(&base.positions);
    let (elbow, wrist, hand) = (joint(Joint::LeftElbow), joint(Joint::LeftWrist), joint(Joint::LeftHand));
    let upper = (elbow - joint(Joint::LeftShoulder)).normalize();
    let fore = (wrist - elbow).normalize();
    let beyond = |v: u32| (base.positions[v as usize] - wrist.lerp(hand, 0.5)).dot(hand - wrist) > 0.0;
    vec![
        ring(base, at(Landmark::Biceps), upper, arm),
        ring(base, elbow.lerp(wrist, 0.3), fore, arm),
        ring(base, at(Landmark::Stylion), fore, arm),
        (0..base.positions.len() as u32).filter(|&v| arm(v) && beyond(v)).map(|v| (v, 0.0)).collect(),
    ]
}
