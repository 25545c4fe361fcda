//! What a simulated shopper does: keys in time for both wrists and the trunk, minimum-jerk between them.

use glam::Vec3;
use toile_base::numeric::random::SplitMix64;
use toile_track::gesture::Gesture;

/// A moment of a motion.
#[derive(Debug, Clone, Copy)]
struct Keyframe {
    /// Time since the motion began (s).
    time: f32,
    /// Wrists, left and right (arm lengths along the trunk's axes from the middle of the shoulders).
    wrists: [Vec3; 2],
    /// Where the trunk stands, off its first place (m).
    place: Vec3,
    /// How far it has turned to its left (rad).
    turn: f32,
}

/// What a shopper does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Act {
    /// A swipe, one of three.
    Swipe(Gesture),
    /// A hand held out towards the mirror: to confirm.
    Hold,
    /// Standing, weight shifted now and then.
    Stand,
    /// Walking, arms swinging.
    Walk,
    /// Turning around once.
    TurnAround,
    /// Scratching the head.
    ScratchHead,
    /// Putting on a jacket.
    PutOnJacket,
    /// Pulling a shirt over the head.
    PullOverHead,
    /// Raising both arms.
    RaiseArms,
    /// Waving a hand to and fro.
    Wave,
    /// Holding and tapping a phone.
    HoldPhone,
    /// Smoothing the garment with both hands.
    SmoothGarment,
    /// Crossing the arms.
    CrossArms,
    /// A hand put on the hip.
    HandOnHip,
    /// Adjusting the collar.
    AdjustCollar,
    /// Taking a hanger from the side.
    TakeHanger,
    /// Talking with the hands.
    Talk,
}

impl Act {
    /// The acts that are to be recognised as gestures.
    pub const GESTURES: [Self; 4] =
        [Self::Swipe(Gesture::SwipeLeft), Self::Swipe(Gesture::SwipeRight), Self::Swipe(Gesture::SwipeUp), Self::Hold];

    /// What is no gesture.
    pub const OTHERS: [Self; 15] = [
        Self::Stand,
        Self::Walk,
        Self::TurnAround,
        Self::ScratchHead,
        Self::PutOnJacket,
        Self::PullOverHead,
        Self::RaiseArms,
        Self::Wave,
        Self::HoldPhone,
        Self::SmoothGarment,
        Self::CrossArms,
        Self::HandOnHip,
        Self::AdjustCollar,
        Self::TakeHanger,
        Self::Talk,
    ];

    /// The words for tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Swipe(gesture) => gesture.name(),
            Self::Hold => "confirm",
            Self::Stand => "standing, shifting weight",
            Self::Walk => "walking, arms swinging",
            Self::TurnAround => "turning around",
            Self::ScratchHead => "scratching the head",
            Self::PutOnJacket => "putting on a jacket",
            Self::PullOverHead => "pulling a shirt over the head",
            Self::RaiseArms => "raising both arms",
            Self::Wave => "waving",
            Self::HoldPhone => "holding and tapping a phone",
            Self::SmoothGarment => "smoothing the garment",
            Self::CrossArms => "crossing the arms",
            Self::HandOnHip => "a hand on the hip",
            Self::AdjustCollar => "adjusting the collar",
            Self::TakeHanger => "taking a hanger from the side",
            Self::Talk => "talking with the hands",
        }
    }

    /// The event that is right for it.
    pub const fn wanted(self) -> Option<Gesture> {
        match self {
            Self::Swipe(gesture) => Some(gesture),
            Self::Hold => Some(Gesture::Confirm),
            _ => None,
        }
    }
}

/// A motion in time.
pub(super) struct GestureMotion {
    keys: Vec<Keyframe>,
}

/// The right wrist's place; the left one's is mirrored.
const HANGING: Vec3 = Vec3::new(-0.42, -0.92, 0.08);

/// Draws motions: both hands first hang.
struct MotionBuilder<'a> {
    rng: &'a mut SplitMix64,
    keys: Vec<Keyframe>,
    now: Keyframe,
}

fn mirrored(p: Vec3) -> Vec3 {
    p * Vec3::new(-1.0, 1.0, 1.0)
}

impl MotionBuilder<'_> {
    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.rng.uniform()
    }

    /// A point within a box.
    fn near(&mut self, low: [f32; 3], high: [f32; 3]) -> Vec3 {
        Vec3::from_array(std::array::from_fn(|i| self.between(low[i], high[i])))
    }

    /// The next key, `seconds` later.
    fn key(&mut self, seconds: f32) {
        self.now.time += seconds;
        self.keys.push(self.now);
    }

    fn right(&mut self, place: Vec3, seconds: f32) {
        self.now.wrists[1] = place;
        self.key(seconds);
    }

    fn both(&mut self, right: Vec3, seconds: f32) {
        self.now.wrists = [mirrored(right), right];
        self.key(seconds);
    }

    /// Nothing moves for a time between two bounds (s).
    fn rest(&mut self, low: f32, high: f32) {
        let seconds = self.between(low, high);
        self.key(seconds);
    }

    fn lower(&mut self) {
        let seconds = self.between(0.45, 0.8);
        self.both(HANGING, seconds);
    }

    fn swipe(&mut self, gesture: Gesture) {
        let length = self.between(0.65, 1.0);
        let from = match gesture {
            Gesture::SwipeUp => self.near([-0.5, -0.6, 0.45], [-0.15, -0.3, 0.7]),
            Gesture::SwipeRight => self.near([-0.1, -0.35, 0.5], [0.25, 0.1, 0.75]),
            _ => self.near([-0.75, -0.35, 0.4], [-0.4, 0.1, 0.7]),
        };
        let drift = self.near([-0.1, -0.1, -0.15], [0.1, 0.1, 0.15]);
        let along = match gesture {
            Gesture::SwipeUp => Vec3::Y,
            Gesture::SwipeRight => Vec3::NEG_X,
            _ => Vec3::X,
        };
        let raising = self.between(0.4, 0.8);
        self.right(from, raising);
        self.rest(0.25, 0.7);
        let seconds = self.between(0.25, 0.6);
        self.right(from + along * length + drift - along * drift.dot(along), seconds);
        if self.rng.uniform() < 0.7 {
            self.rest(0.2, 0.6);
        }
        self.lower();
    }

    fn hold(&mut self) {
        let place = self.near([-0.45, -0.15, 0.8], [-0.1, 0.15, 0.95]);
        let raising = self.between(0.4, 0.8);
        self.right(place, raising);
        self.rest(1.5, 2.2);
        self.lower();
    }

    fn walk(&mut self) {
        let pace = self.between(0.45, 0.6);
        let way = self.near([-0.4, 0.0, 0.2], [0.4, 0.0, 0.6]);
        let swing = self.between(0.15, 0.35);
        let mut forth = 1.0;
        for _ in 0..8 {
            self.now.place += if self.rng.uniform() < 0.8 { way } else { -way };
            self.now.wrists[1] = HANGING + Vec3::new(0.0, 0.1 * swing, swing * forth);
            self.now.wrists[0] = mirrored(HANGING + Vec3::new(0.0, 0.1 * swing, -swing * forth));
            forth = -forth;
            self.key(pace);
        }
    }

    fn scratch(&mut self) {
        let head = self.near([-0.2, 0.2, 0.0], [0.0, 0.5, 0.3]);
        let raising = self.between(0.4, 0.8);
        self.right(head, raising);
        for _ in 0..6 {
            let place = head + self.near([-0.06, -0.06, -0.04], [0.06, 0.06, 0.04]);
            let seconds = self.between(0.12, 0.25);
            self.right(place, seconds);
        }
        self.lower();
    }

    fn jacket(&mut self) {
        // One sleeve behind the back, the hand comes out in front; then the other; then the fronts are pulled.
        for i in [1, 0] {
            let side = |p: Vec3| if i == 1 { p } else { mirrored(p) };
            let behind = side(self.near([-0.6, -0.7, -0.5], [-0.3, -0.4, -0.2]));
            let out = side(self.near([-0.9, -0.3, 0.2], [-0.5, 0.1, 0.6]));
            let collar = mirrored(side(self.near([-0.2, -0.3, 0.2], [0.0, 0.0, 0.35])));
            for (own, other) in [(behind, collar), (out, collar)] {
                self.now.wrists[i] = own;
                self.now.wrists[1 - i] = other;
                let seconds = self.between(0.5, 0.9);
                self.key(seconds);
            }
        }
        let chest = self.near([-0.35, -0.4, 0.3], [-0.1, -0.1, 0.4]);
        self.both(chest, 0.6);
        self.both(chest + Vec3::new(0.05, -0.35, 0.0), 0.5);
        self.lower();
    }

    fn over_head(&mut self) {
        let hem = self.near([-0.2, -0.75, 0.25], [-0.05, -0.6, 0.4]);
        self.now.wrists = [mirrored(hem), hem];
        self.key(0.6);
        self.rest(0.2, 0.6);
        let seconds = self.between(0.4, 0.8);
        // The right hand leads a little.
        let up = self.near([-0.4, 0.5, 0.1], [-0.2, 0.8, 0.4]);
        self.now.wrists = [mirrored(hem.lerp(up, 0.8)), up];
        self.key(seconds);
        self.both(up, 0.2);
        let seconds = self.between(0.5, 0.9);
        self.both(HANGING, seconds);
    }

    fn raise_arms(&mut self) {
        let up = match self.rng.next_u64() % 3 {
            0 => Vec3::new(-1.2, 0.1, 0.1),
            1 => Vec3::new(-0.4, 0.0, 0.9),
            _ => Vec3::new(-0.6, 0.85, 0.2),
        };
        let seconds = self.between(0.4, 1.2);
        self.both(up, seconds);
        self.rest(0.3, 2.5);
        self.lower();
    }

    fn wave(&mut self) {
        let middle = self.near([-0.75, 0.05, 0.2], [-0.35, 0.45, 0.6]);
        let half = self.between(0.12, 0.45);
        let seconds = self.between(0.18, 0.4);
        self.right(middle, 0.6);
        for i in 0..9 {
            let sign = if i % 2 == 0 { half } else { -half };
            self.right(middle + Vec3::X * sign, seconds);
        }
        self.lower();
    }

    fn phone(&mut self) {
        let place = self.near([-0.2, -0.45, 0.35], [0.1, -0.15, 0.6]);
        self.right(place, 0.6);
        for _ in 0..8 {
            self.now.wrists[0] = place + self.near([-0.05, -0.12, -0.08], [0.15, 0.08, 0.05]);
            let seconds = self.between(0.15, 0.5);
            self.key(seconds);
        }
        self.rest(0.5, 1.5);
        self.lower();
    }

    fn smooth(&mut self) {
        for _ in 0..4 {
            let top = self.near([-0.3, -0.3, 0.18], [0.1, -0.1, 0.34]);
            let end = top + self.near([-0.3, -0.5, -0.02], [0.3, -0.25, 0.06]);
            let [first, second] = [self.between(0.3, 0.6), self.between(0.25, 0.6)];
            if self.rng.uniform() < 0.5 {
                self.both(top, first);
                self.both(end, second);
            } else {
                self.right(top, first);
                self.right(end, second);
            }
        }
        self.lower();
    }

    fn cross(&mut self) {
        let place = self.near([0.15, -0.4, 0.2], [0.3, -0.2, 0.4]);
        let seconds = self.between(0.4, 0.7);
        self.both(place, seconds);
        self.rest(1.0, 3.0);
        self.lower();
    }

    fn hip(&mut self) {
        let place = self.near([-0.5, -0.75, 0.05], [-0.35, -0.6, 0.2]);
        self.right(place, 0.6);
        self.rest(1.0, 3.0);
        self.lower();
    }

    fn collar(&mut self) {
        let place = self.near([-0.2, -0.1, 0.2], [0.0, 0.1, 0.32]);
        self.both(place, 0.6);
        for _ in 0..5 {
            let shift = self.near([-0.08, -0.1, -0.03], [0.08, 0.1, 0.03]);
            let seconds = self.between(0.15, 0.4);
            self.both(place + shift, seconds);
        }
        self.lower();
    }

    fn hanger(&mut self) {
        let rail = self.near([-1.2, -0.1, 0.0], [-0.9, 0.3, 0.35]);
        self.right(rail, 0.7);
        self.rest(0.3, 1.2);
        let before = self.near([-0.3, -0.3, 0.35], [0.0, 0.0, 0.5]);
        let seconds = self.between(0.6, 1.1);
        self.right(before, seconds);
        // Held before the chest with both hands, looked at.
        self.both(before, 0.4);
        self.rest(0.8, 2.0);
        self.lower();
    }

    fn talk(&mut self) {
        let centre = self.near([-0.35, -0.55, 0.35], [-0.1, -0.25, 0.6]);
        self.right(centre, 0.6);
        for _ in 0..14 {
            let place = centre + self.near([-0.25, -0.2, -0.12], [0.25, 0.25, 0.12]);
            let seconds = self.between(0.2, 0.6);
            self.right(place, seconds);
            if self.rng.uniform() < 0.4 {
                self.rest(0.05, 0.5);
            }
        }
        self.lower();
    }

    fn turn_around(&mut self) {
        let seconds = self.between(1.5, 3.0);
        for _ in 0..8 {
            self.now.turn += std::f32::consts::TAU / 8.0;
            self.now.wrists[1] = HANGING + self.near([-0.15, 0.0, 0.0], [0.0, 0.15, 0.1]);
            self.now.wrists[0] = mirrored(HANGING + self.near([-0.15, 0.0, 0.0], [0.0, 0.15, 0.1]));
            self.key(seconds / 8.0);
        }
    }

    fn stand(&mut self) {
        for _ in 0..6 {
            self.now.place = self.near([-0.05, -0.01, -0.03], [0.05, 0.0, 0.03]);
            self.now.turn = self.between(-0.1, 0.1);
            let seconds = self.between(0.6, 1.2);
            self.key(seconds);
        }
    }
}

impl GestureMotion {
    /// A random way to do something, of the left hand as often as of the right.
    pub(super) fn new(act: Act, rng: &mut SplitMix64) -> Self {
        let left_handed = rng.next_u64() & 1 == 0;
        let now = Keyframe { time: 0.0, wrists: [mirrored(HANGING), HANGING], place: Vec3::ZERO, turn: 0.0 };
        let mut draw = MotionBuilder { rng, keys: vec![now], now };
        draw.rest(0.6, 1.2);
        match act {
            // Mirrored below, so that the shopper's left stays their left.
            Act::Swipe(Gesture::SwipeLeft) if left_handed => draw.swipe(Gesture::SwipeRight),
            Act::Swipe(Gesture::SwipeRight) if left_handed => draw.swipe(Gesture::SwipeLeft),
            Act::Swipe(gesture) => draw.swipe(gesture),
            Act::Hold => draw.hold(),
            Act::Stand => draw.stand(),
            Act::Walk => draw.walk(),
            Act::TurnAround => draw.turn_around(),
            Act::ScratchHead => draw.scratch(),
            Act::PutOnJacket => draw.jacket(),
            Act::PullOverHead => draw.over_head(),
            Act::RaiseArms => draw.raise_arms(),
            Act::Wave => draw.wave(),
            Act::HoldPhone => draw.phone(),
            Act::SmoothGarment => draw.smooth(),
            Act::CrossArms => draw.cross(),
            Act::HandOnHip => draw.hip(),
            Act::AdjustCollar => draw.collar(),
            Act::TakeHanger => draw.hanger(),
            Act::Talk => draw.talk(),
        }
        draw.rest(0.6, 1.0);
        let mut keys = draw.keys;
        if left_handed {
            for key in &mut keys {
                let [left, right] = key.wrists;
                key.wrists = [mirrored(right), mirrored(left)];
                key.turn = -key.turn;
                key.place.x = -key.place.x;
            }
        }
        Self { keys }
    }

    /// How long it takes (s).
    pub(super) fn seconds(&self) -> f32 {
        self.keys.last().map_or(0.0, |k| k.time)
    }

    /// Wrists, place and turn at a time (s): minimum jerk between keys (Flash and Hogan 1985).
    pub(super) fn at(&self, time: f32) -> ([Vec3; 2], Vec3, f32) {
        let after = self.keys.partition_point(|k| k.time <= time).clamp(1, self.keys.len() - 1);
        let (a, b) = (&self.keys[after - 1], &self.keys[after]);
        let t = ((time - a.time) / (b.time - a.time).max(1e-3)).clamp(0.0, 1.0);
        let s = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
        let wrists = [0, 1].map(|i| a.wrists[i].lerp(b.wrists[i], s));
        (wrists, a.place.lerp(b.place, s), a.turn + (b.turn - a.turn) * s)
    }
}
