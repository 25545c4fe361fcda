//! Recording: what a replay needs of a run, without images: the filtered frames, and of each step when it was due, the
//! quality it was taken at and a hash of what came out.
//!
//! The file: the magic `toile-tape/3\n`, u32 length of a text that says how the scene is made, the text, then records: u8
//! kind, u8 length of the body / 8, the body, u32 check (FNV-1a of kind, length and body). Numbers are little endian. A
//! file that was cut off is read up to the cut.

use glam::Vec3;
use thiserror::Error;
use toile_base::frame::{Joints, TrackedJoint};
use toile_base::skeleton::JOINTS;

use super::sensor_thread::SensorFrame;

/// First bytes of a file. The number changes where old files would mean something else: with the quality levels, which steps name.
pub const MAGIC: &[u8] = b"toile-tape/3\n";

/// First bytes of files of seven and of eleven quality levels.
const OLD_LEVELS: [&[u8]; 2] = [b"toile-tape/1\n", b"toile-tape/2\n"];

/// Entries that wait to be written: six seconds at 150 a second.
pub const ENTRIES: usize = 1024;

/// Name of this capacity in reports and warnings.
pub const ENTRIES_NAME: &str = "ENTRIES (queue of what is recorded)";

/// Longest text about the scene (bytes).
const MOST_TEXT: usize = 1 << 20;

/// Longest text of a note (bytes): what a record holds beside the joints.
pub const MOST_NOTE: usize = 8 * (u8::MAX as usize - 2 - 2 * JOINTS);

/// An entry of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Entry {
    /// The joints in which the shopper was dressed, before the first step.
    Dressed(Joints),
    /// From the next step on another scene is stepped.
    Changed {
        /// Its number, from which the scene's text tells how it is made.
        number: u64,
        /// Whether another shopper came with it.
        afresh: bool,
    },
    /// A filtered frame that the next step knew.
    SensorFrame(SensorFrame),
    /// The state was spoilt by this seed before the next step, to try what is borne.
    Fault(u64),
    /// A step was taken.
    Step {
        /// Number of the step.
        tick: u64,
        /// When it was due (ns).
        scheduled_ns: u64,
        /// Place in the quality levels.
        level: u8,
        /// Hash of the state that it ended in.
        fingerprint: u64,
    },
}

/// Description of a scene that came after the start of the recording, so that the text at the start does not have it.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneNote {
    /// The scene's number.
    pub number: u64,
    /// The joints in which it was dressed.
    pub first: Joints,
    /// The rest in words; what is beyond [`MOST_NOTE`] bytes is cut off.
    pub text: String,
}

/// Everything in a file.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopRecording {
    /// The text about the scene.
    pub text: String,
    /// What was noted of scenes, in order.
    pub notes: Vec<SceneNote>,
    /// Entries, in order.
    pub entries: Vec<Entry>,
}

/// Why a recording cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RecordingError {
    /// The first line is not that of a recording.
    #[error(
        "this is not a recording of a run (it does not begin with `toile-tape/3`); make one with `toile latency --record F` or `toile soak --record F`"
    )]
    Magic,
    /// Written by a version whose list of quality levels had other levels.
    #[error(
        "this recording names quality levels that are no longer used (it begins with `toile-tape/1` or `/2`); replay it with the version \
         of the program that made it, or record the run again"
    )]
    OldLevels,
    /// Cut off before the first step, or no text.
    #[error("the recording ends before its first step; record the run again")]
    Short,
    /// Bytes that no writer makes.
    #[error("the recording is damaged at byte {0}; restore it from a copy")]
    Damaged(usize),
}

/// The begin of a file whose scene is described by a text.
pub fn header(scene: &str) -> Vec<u8> {
    let mut out = MAGIC.to_vec();
    out.extend((scene.len() as u32).to_le_bytes());
    out.extend(scene.as_bytes());
    out
}

/// Appends an entry to the bytes of a file.
pub fn write(entry: &Entry, out: &mut Vec<u8>) {
    let mut body = Vec::with_capacity(8 * usize::from(u8::MAX));
    let kind = match entry {
        Entry::Dressed(joints) => {
            put_joints(joints, &mut body);
            b'd'
        }
        Entry::Changed { number, afresh } => {
            [*number, u64::from(*afresh)].iter().for_each(|n| body.extend(n.to_le_bytes()));
            b'c'
        }
        Entry::SensorFrame(seen) => {
            [seen.number, seen.arrived_ns].iter().for_each(|n| body.extend(n.to_le_bytes()));
            put_joints(&seen.joints, &mut body);
            b'j'
        }
        Entry::Fault(seed) => {
            body.extend(seed.to_le_bytes());
            b'u'
        }
        Entry::Step { tick, scheduled_ns, level, fingerprint } => {
            [*tick, *scheduled_ns, u64::from(*level), *fingerprint].iter().for_each(|n| body.extend(n.to_le_bytes()));
            b's'
        }
    };
    put(kind, &body, out);
}

/// Appends what is known of a scene to the bytes of a file.
pub fn write_note(note: &SceneNote, out: &mut Vec<u8>) {
    let mut body = Vec::with_capacity(8 * usize::from(u8::MAX));
    body.extend(note.number.to_le_bytes());
    put_joints(&note.first, &mut body);
    let cut = (0..=note.text.len().min(MOST_NOTE)).rev().find(|i| note.text.is_char_boundary(*i)).unwrap_or(0);
    body.extend(&note.text.as_bytes()[..cut]);
    body.resize(body.len().next_multiple_of(8), b' ');
    put(b'm', &body, out);
}

fn put(kind: u8, body: &[u8], out: &mut Vec<u8>) {
    let start = out.len();
    out.extend([kind, (body.len() / 8) as u8]);
    out.extend(body);
    let check = check(&out[start..]);
    out.extend(check.to_le_bytes());
}

fn put_joints(joints: &Joints, out: &mut Vec<u8>) {
    out.extend(joints.time_ns.to_le_bytes());
    for joint in &joints.joints {
        let p = joint.position;
        [p.x, p.y, p.z, joint.confidence].iter().for_each(|x| out.extend(x.to_le_bytes()));
    }
}

fn check(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193))
}

/// Reads a file up to its end or the cut.
///
/// # Errors
/// [`RecordingError`].
pub fn read(bytes: &[u8]) -> Result<LoopRecording, RecordingError> {
    if OLD_LEVELS.iter().any(|old| bytes.starts_with(old)) {
        return Err(RecordingError::OldLevels);
    }
    let rest = bytes.strip_prefix(MAGIC).ok_or(RecordingError::Magic)?;
    let (len, rest) = rest.split_first_chunk::<4>().ok_or(RecordingError::Short)?;
    let len = u32::from_le_bytes(*len) as usize;
    if len > MOST_TEXT {
        return Err(RecordingError::Damaged(MAGIC.len()));
    }
    let (text, mut rest) = rest.split_at_checked(len).ok_or(RecordingError::Short)?;
    let text = String::from_utf8(text.to_vec()).map_err(|_| RecordingError::Damaged(MAGIC.len() + 4))?;
    let (mut notes, mut entries) = (Vec::new(), Vec::new());
    while let [_, eights, ..] = rest {
        let len = 2 + 8 * usize::from(*eights);
        let Some((record, after)) = rest.split_at_checked(len + 4) else { break };
        let damaged = || RecordingError::Damaged(bytes.len() - rest.len());
        if check(&record[..len]).to_le_bytes() != record[len..] {
            return Err(damaged());
        }
        match record[0] {
            b'm' => notes.push(note(&record[2..len]).ok_or_else(damaged)?),
            kind => entries.push(entry(kind, &record[2..len]).ok_or_else(damaged)?),
        }
        rest = after;
    }
    let steps = entries.iter().any(|e| matches!(e, Entry::Step { .. }));
    if steps { Ok(LoopRecording { text, notes, entries }) } else { Err(RecordingError::Short) }
}

fn entry(kind: u8, body: &[u8]) -> Option<Entry> {
    let (words, []) = body.as_chunks::<8>() else { return None };
    let word = |i: usize| words.get(i).map(|w| u64::from_le_bytes(*w));
    match kind {
        b'd' => Some(Entry::Dressed(joints(words)?)),
        b'j' => {
            let joints = joints(words.get(2..)?)?;
            Some(Entry::SensorFrame(SensorFrame { joints, number: word(0)?, arrived_ns: word(1)? }))
        }
        b'c' if words.len() == 2 => Some(Entry::Changed { number: word(0)?, afresh: word(1)? != 0 }),
        b'u' if words.len() == 1 => Some(Entry::Fault(word(0)?)),
        b's' if words.len() == 4 => Some(Entry::Step {
            tick: word(0)?,
            scheduled_ns: word(1)?,
            level: word(2)?.try_into().ok()?,
            fingerprint: word(3)?,
        }),
        _ => None,
    }
}

fn note(body: &[u8]) -> Option<SceneNote> {
    let (words, []) = body.as_chunks::<8>() else { return None };
    let (number, rest) = words.split_first()?;
    let (first, text) = rest.split_at_checked(1 + 2 * JOINTS)?;
    let text = String::from_utf8(text.as_flattened().to_vec()).ok()?;
    Some(SceneNote { number: u64::from_le_bytes(*number), first: joints(first)?, text: text.trim_end().to_owned() })
}

fn joints(words: &[[u8; 8]]) -> Option<Joints> {
    let (time, rest) = words.split_first()?;
    if rest.len() != 2 * JOINTS {
        return None;
    }
    let half = |word: &[u8; 8], k: usize| f32::from_le_bytes([word[k], word[k + 1], word[k + 2], word[k + 3]]);
    let mut joints = Joints::absent(u64::from_le_bytes(*time));
    for (joint, [a, b]) in joints.joints.iter_mut().zip(rest.as_chunks::<2>().0) {
        let position = Vec3::new(half(a, 0), half(a, 4), half(b, 0));
        *joint = TrackedJoint { position, confidence: half(b, 4) };
    }
    Some(joints)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries() -> Vec<Entry> {
        let mut joints = Joints::absent(77);
        joints.joints[3] = TrackedJoint { position: Vec3::new(0.1, -2.0, 3e-9), confidence: 0.25 };
        vec![
            Entry::Dressed(joints),
            Entry::SensorFrame(SensorFrame { joints, arrived_ns: u64::MAX, number: 1 }),
            Entry::Changed { number: 5, afresh: true },
            Entry::Fault(u64::MAX / 3),
            Entry::Step { tick: 0, scheduled_ns: 9, level: 2, fingerprint: u64::MAX - 1 },
            Entry::Step { tick: 1, scheduled_ns: 10, level: 0, fingerprint: 0 },
        ]
    }

    fn noted() -> SceneNote {
        SceneNote { number: 3, first: Joints::absent(5), text: "a coat, grün".into() }
    }

    fn file() -> Vec<u8> {
        let mut bytes = header("a scene");
        write_note(&noted(), &mut bytes);
        entries().iter().for_each(|e| write(e, &mut bytes));
        bytes
    }

    fn whole() -> LoopRecording {
        LoopRecording { text: "a scene".to_owned(), notes: vec![noted()], entries: entries() }
    }

    #[test]
    fn what_was_written_is_read_and_a_cut_file_up_to_the_cut() {
        let bytes = file();
        assert_eq!(read(&bytes), Ok(whole()));
        let step = 2 + 32 + 4;
        for cut in 1..=step {
            assert_eq!(read(&bytes[..bytes.len() - cut]).unwrap().entries, entries()[..5]);
        }
        assert_eq!(read(&bytes[..bytes.len() - step - 1]), Err(RecordingError::Short), "no step is left");
        assert_eq!(read(&bytes[..20]), Err(RecordingError::Short));
        assert_eq!(read(b"toile"), Err(RecordingError::Magic));
        for first in OLD_LEVELS {
            let old = [first, &bytes[MAGIC.len()..]].concat();
            assert_eq!(read(&old), Err(RecordingError::OldLevels), "its levels would be taken for others");
        }
    }

    #[test]
    fn a_flipped_bit_is_found_wherever_it_is() {
        let bytes = file();
        let first = header("a scene").len();
        for i in first..bytes.len() {
            let mut bad = bytes.clone();
            bad[i] ^= 4;
            // A length that grew beyond the end looks like a cut: then what came before is right.
            let right = match read(&bad) {
                Err(_) => true,
                Ok(found) => found.entries.len() < entries().len() && entries().starts_with(&found.entries),
            };
            assert!(right, "byte {i}");
        }
    }
}
