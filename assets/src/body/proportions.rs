//! Positions of our own bodies' landmarks between joints and extremes, used to measure an imported body.

use super::base::BaseBody;
use super::landmarks::Landmark;
use toile_base::skeleton::Joint;

/// Places of landmarks as shares of ways that every body has. Each is 0 at the first and 1 at the second end named.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Proportions {
    /// An acromion's way from the body's middle, over its joint's.
    pub acromion: f32,
    /// Buttock's height, from crotch to acromion.
    pub seat: f32,
    /// Bust point's height, from crotch to acromion.
    pub bust: f32,
    /// Natural waistline's height, from buttock to bust point.
    pub waist: f32,
    /// Underbust's height, from bust point to natural waist.
    pub underbust: f32,
    /// 7th cervical vertebra's height, from the neck's joint to the head's.
    pub cervicale: f32,
    /// Middle of the kneecap's height, from the knee's joint to the hip's.
    pub midpatella: f32,
}

impl Proportions {
    /// Those of a base body.
    pub(super) fn of(base: &BaseBody) -> Self {
        let mark = |l: Landmark| base.landmarks.mark(l).on(&base.positions);
        let joint = |j: Joint| base.skeleton.at(j);
        let share = |at: f32, from: f32, to: f32| (at - from) / (to - from);
        let height = |l: Landmark| mark(l).y;
        let [crotch, tip] = [height(Landmark::Crotch), height(Landmark::Acromion)];
        let [seat, bust, waist] = [Landmark::Buttock, Landmark::BustPoint, Landmark::NaturalWaist].map(height);
        Self {
            acromion: mark(Landmark::Acromion).x / joint(Joint::LeftShoulder).x,
            seat: share(seat, crotch, tip),
            bust: share(bust, crotch, tip),
            waist: share(waist, seat, bust),
            underbust: share(height(Landmark::Underbust), bust, waist),
            cervicale: share(height(Landmark::Cervicale), joint(Joint::Neck).y, joint(Joint::Head).y),
            midpatella: share(height(Landmark::Midpatella), joint(Joint::LeftKnee).y, joint(Joint::LeftHip).y),
        }
    }
}
