//! From datagrams to joints: messages sorted into frames, and every reason to drop one counted.
//!
//! No message ends a frame, and senders differ in the order of theirs. A frame is complete when every bone that the sender
//! has sent before has come, or when one comes a second time.

use glam::{Quat, Vec3};

use super::bones::{BoneMap, COUNT, Local, bone};
use super::osc::{self, OscArgument, OscMessage, OscPacket};
use crate::limits::{MAX_OSC_BUNDLES, MAX_PACKET_BYTES};
use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;
use toile_base::limits::MAX_COORDINATE;

/// A sender's time that goes back by more than this (s) is that of a sender that began anew; by less, a late packet's.
const RESTART_SECONDS: f64 = 1.0;

/// Longest time that a sender may count (s): eleven days.
const LONGEST_TIME: f64 = 1e6;

/// Least time between two frames (ns).
const SHORTEST_STEP_NS: u64 = 100_000;

/// Counts of dropped messages, by reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Drops {
    /// Datagrams longer than [`MAX_PACKET_BYTES`].
    pub oversize: u64,
    /// Datagrams that are no OSC, or nested beyond [`MAX_OSC_BUNDLES`].
    pub malformed: u64,
    /// Messages whose arguments are of other kinds, not finite, or out of the room.
    pub invalid: u64,
    /// Datagrams that carry a time before that of one that came earlier.
    pub late: u64,
    /// Datagrams that waited behind the greatest number read in one call.
    pub overrun: u64,
    /// Datagrams of another sender than the one that is followed.
    pub stranger: u64,
}

impl Drops {
    /// Number dropped, for all reasons.
    pub fn total(&self) -> u64 {
        self.oversize + self.malformed + self.invalid + self.late + self.overrun + self.stranger
    }
}

/// State of one sender, of a fixed size.
#[derive(Debug, Clone)]
pub struct Decoder {
    map: BoneMap,
    root: Local,
    bones: [Option<Local>; COUNT],
    /// Bones that came in the frame that is open, and in any frame.
    fresh: u32,
    known: u32,
    /// The sender's newest time, and what to add to it to have ours (s).
    sent: Option<f64>,
    offset: f64,
    last_ns: Option<u64>,
    complete: Option<Joints>,
    drops: Drops,
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

impl Decoder {
    /// A decoder that has heard nothing.
    pub fn new() -> Self {
        Self {
            map: BoneMap::new(),
            root: Local { position: Vec3::ZERO, turn: Quat::IDENTITY },
            bones: [None; COUNT],
            fresh: 0,
            known: 0,
            sent: None,
            offset: 0.0,
            last_ns: None,
            complete: None,
            drops: Drops::default(),
        }
    }

    /// Counts of dropped messages so far.
    pub fn drops(&self) -> Drops {
        self.drops
    }

    pub(super) fn drops_mut(&mut self) -> &mut Drops {
        &mut self.drops
    }

    /// The newest complete frame since the last call; older ones that were not taken are gone.
    pub fn take(&mut self) -> Option<Joints> {
        self.complete.take()
    }

    /// Takes in one datagram that arrived at a time (ns, ours, since the session began).
    pub fn push(&mut self, datagram: &[u8], arrival_ns: u64) {
        if datagram.len() > MAX_PACKET_BYTES {
            self.drops.oversize += 1;
            return;
        }
        // The parser descends into bundles by recursion; a datagram can nest hundreds.
        let bundles = datagram.windows(8).filter(|w| w == b"#bundle\0").count();
        let packet = if bundles <= MAX_OSC_BUNDLES { osc::decode(datagram) } else { None };
        match packet {
            Some(packet) if self.clock(&packet, arrival_ns) => self.apply(&packet, arrival_ns),
            Some(_) => self.drops.late += 1,
            None => self.drops.malformed += 1,
        }
    }

    /// Takes the sender's time out of a packet, where it has one; false where that lies in the past.
    fn clock(&mut self, packet: &OscPacket, arrival_ns: u64) -> bool {
        let Some(time) = time(packet) else { return true };
        if !(0.0..=LONGEST_TIME).contains(&time) {
            self.drops.invalid += 1;
            return true;
        }
        match self.sent {
            Some(sent) if time < sent && sent - time < RESTART_SECONDS => return false,
            Some(sent) if time >= sent => {}
            // The first time, or that of a sender that began anew.
            _ => {
                self.offset = arrival_ns as f64 / SECOND_NS as f64 - time;
                self.fresh = 0;
            }
        }
        self.sent = Some(time);
        true
    }

    fn apply(&mut self, packet: &OscPacket, arrival_ns: u64) {
        match packet {
            OscPacket::Bundle(packets) => packets.iter().for_each(|p| self.apply(p, arrival_ns)),
            OscPacket::Message(message) => match message.address {
                "/VMC/Ext/Root/Pos" => match local(message) {
                    Some(root) => self.root = root,
                    None => self.drops.invalid += 1,
                },
                "/VMC/Ext/Bone/Pos" => self.bone(message, arrival_ns),
                _ => {}
            },
        }
    }

    fn bone(&mut self, message: &OscMessage, arrival_ns: u64) {
        let Some(OscArgument::Text(name)) = message.arguments.first() else {
            self.drops.invalid += 1;
            return;
        };
        // Fingers, eyes and jaw are bones too, and none of ours.
        let Some(bone) = bone(name) else { return };
        let Some(pose) = local(message) else {
            self.drops.invalid += 1;
            return;
        };
        let bit = 1 << bone;
        if self.fresh & bit != 0 {
            self.finish(arrival_ns);
        }
        self.bones[bone] = Some(pose);
        self.fresh |= bit;
        if self.known != 0 && self.fresh & self.known == self.known && bit & self.known != 0 {
            self.known |= self.fresh;
            self.finish(arrival_ns);
        }
    }

    /// Ends the open frame.
    fn finish(&mut self, arrival_ns: u64) {
        self.known |= self.fresh;
        self.fresh = 0;
        let ours = self.sent.map(|t| ((t + self.offset).max(0.0) * SECOND_NS as f64) as u64);
        let after = self.last_ns.map_or(0, |last| last.saturating_add(SHORTEST_STEP_NS));
        let time_ns = ours.unwrap_or(arrival_ns).max(after);
        let joints = self.map.joints(time_ns, self.root, &self.bones);
        if joints.is_valid() {
            self.last_ns = Some(time_ns);
            self.complete = Some(joints);
        } else {
            self.drops.invalid += 1;
        }
    }
}

/// The sender's time in a packet (s).
fn time(packet: &OscPacket) -> Option<f64> {
    match packet {
        OscPacket::Bundle(packets) => packets.iter().find_map(time),
        OscPacket::Message(message) if message.address == "/VMC/Ext/T" => match message.arguments.first() {
            Some(OscArgument::Float(t)) => Some(f64::from(*t)),
            Some(OscArgument::Double(t)) => Some(*t),
            _ => None,
        },
        OscPacket::Message(_) => None,
    }
}

/// The pose in a message's arguments 1 to 7, in our axes; `None` where they are not one.
fn local(message: &OscMessage) -> Option<Local> {
    let mut numbers = [0.0; 7];
    for (number, arg) in numbers.iter_mut().zip(message.arguments.get(1..8)?) {
        *number = match arg {
            OscArgument::Float(x) => *x,
            OscArgument::Double(x) => *x as f32,
            _ => return None,
        };
    }
    let [px, py, pz, qx, qy, qz, qw] = numbers;
    let position = Vec3::new(-px, py, pz);
    let turn = Quat::from_xyzw(qx, -qy, -qz, qw);
    let near = position.is_finite() && position.abs().max_element() <= MAX_COORDINATE;
    // A mirrored x keeps what turns about x and turns the rest round.
    let whole = turn.is_finite() && (0.5..2.0).contains(&turn.length());
    (near && whole).then(|| Local { position, turn: turn.normalize() })
}

#[cfg(test)]
mod tests;
