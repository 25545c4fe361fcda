//! Virtual Motion Capture (VMC) protocol: a humanoid's bones as OSC messages over UDP.
//!
//! Runs on the sensor thread: some 60 messages a frame in less than 100 µs, and at most
//! [`MAX_PACKETS_A_POLL`](crate::limits::MAX_PACKETS_A_POLL) datagrams a call.
//!
//! `/VMC/Ext/Bone/Pos name px py pz qx qy qz qw` is a bone of Unity's humanoid relative to its parent, `/VMC/Ext/Root/Pos`
//! the same of the figure, `/VMC/Ext/T t` the sender's time (s), `/VMC/Ext/OK loaded` whether there is a model.
//! Unity is left-handed, y up, z forward: a mirrored x makes it ours. The bone `LeftShoulder` is the collar bone.
//!
//! A message is dropped and counted if it is not OSC, too long, late, not finite, or has other arguments or an unknown bone.

mod bones;
mod decode;
mod osc;
mod receive;

pub use decode::{Decoder, Drops};
pub use receive::{PORT, VmcReceiver};
