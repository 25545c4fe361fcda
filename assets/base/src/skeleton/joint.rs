//! The joints: their order, their parents, their mirror images.

named! {
    /// Joints that a sensor may report and a pose may bend; each is the centre of the rotation that it names.
    /// Parents stand before their children.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    #[repr(u8)]
    pub enum Joint {
        /// Where the trunk hangs: the middle of the sacroiliac joints.
        Pelvis,
        /// Of the lowest lumbar vertebra: trunk on pelvis.
        Spine,
        /// Of the highest lumbar vertebra: rib cage on loins.
        Chest,
        /// Of the middle of the neck.
        Neck,
        /// Of skull on neck.
        Head,
        /// Of the left collar bone on the breastbone.
        LeftClavicle,
        /// Of the left upper arm.
        LeftShoulder,
        /// Of the left forearm.
        LeftElbow,
        /// Of the left hand.
        LeftWrist,
        /// The knuckle of the left middle finger, where the fingers begin.
        LeftHand,
        /// Of the left thigh.
        LeftHip,
        /// Of the left shin.
        LeftKnee,
        /// Of the left foot.
        LeftAnkle,
        /// The ball of the left foot, where the toes begin.
        LeftToe,
        /// Of the right collar bone on the breastbone.
        RightClavicle,
        /// Of the right upper arm.
        RightShoulder,
        /// Of the right forearm.
        RightElbow,
        /// Of the right hand.
        RightWrist,
        /// The knuckle of the right middle finger, where the fingers begin.
        RightHand,
        /// Of the right thigh.
        RightHip,
        /// Of the right shin.
        RightKnee,
        /// Of the right foot.
        RightAnkle,
        /// The ball of the right foot, where the toes begin.
        RightToe,
    }
}

/// Number of joints.
pub const JOINTS: usize = 23;

impl Joint {
    /// The joint's place in every `[_; JOINTS]` array.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The joint this one hangs from; `None` for the pelvis.
    pub const fn parent(self) -> Option<Self> {
        use Joint::*;
        Some(match self {
            Pelvis => return None,
            Spine | LeftHip | RightHip => Pelvis,
            Chest => Spine,
            Neck | LeftClavicle | RightClavicle => Chest,
            Head => Neck,
            LeftShoulder => LeftClavicle,
            LeftElbow => LeftShoulder,
            LeftWrist => LeftElbow,
            LeftHand => LeftWrist,
            LeftKnee => LeftHip,
            LeftAnkle => LeftKnee,
            LeftToe => LeftAnkle,
            RightShoulder => RightClavicle,
            RightElbow => RightShoulder,
            RightWrist => RightElbow,
            RightHand => RightWrist,
            RightKnee => RightHip,
            RightAnkle => RightKnee,
            RightToe => RightAnkle,
        })
    }

    /// The same joint on the other side; joints of the midline are their own mirror.
    pub const fn mirror(self) -> Self {
        let i = self as usize;
        if i < 5 {
            self
        } else if i < 14 {
            Self::ALL[i + 9]
        } else {
            Self::ALL[i - 9]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_come_before_children_and_mirrors_return() {
        for (i, joint) in Joint::ALL.into_iter().enumerate() {
            assert_eq!(joint.index(), i);
            assert!(joint.parent().is_none_or(|p| p.index() < i));
            assert_eq!(joint.mirror().mirror(), joint);
            assert_eq!(joint.parent().map(Joint::mirror), joint.mirror().parent());
        }
    }
}
