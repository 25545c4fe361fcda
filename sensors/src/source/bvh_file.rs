//! BVH motion capture: the parser. Hierarchy with offsets and channels, then a line of numbers a frame.
//!
//! Channels are honoured as listed, joint by joint: order differs between files and even inside one.

use glam::DVec3;

use crate::error::{FilePlace, ReaderFault};
use crate::limits::{MAX_BVH_DEPTH, MAX_BVH_JOINTS, MAX_JOINT_FRAMES};

const CURE: &str = "export the motion again as BVH";

/// The rotation or motion of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Channel {
    /// Position along axis 0, 1 or 2 (file units); replaces the offset's component.
    Position(usize),
    /// Rotation about axis 0, 1 or 2 (degrees).
    Rotation(usize),
}

/// One joint of the hierarchy.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// Name; empty for an end site.
    pub name: String,
    /// Index of the parent, lower than the joint's own.
    pub parent: Option<usize>,
    /// From the parent (file units).
    pub offset: DVec3,
    /// Its channels, in the order of the file.
    pub channels: Vec<Channel>,
}

/// A parsed file.
#[derive(Debug)]
pub(super) struct Bvh {
    /// Parents before children.
    pub nodes: Vec<Node>,
    /// Seconds between frames (s).
    pub frame_time: f64,
    /// Channel values `[frames * channels]`.
    pub values: Vec<f32>,
    /// Channels of all joints.
    pub channels: usize,
}

/// The file's words, with the line each stands on.
struct BvhWords<'a> {
    rest: &'a str,
    line: usize,
}

impl<'a> BvhWords<'a> {
    fn next(&mut self) -> Option<&'a str> {
        let start = self.rest.find(|c: char| !c.is_whitespace())?;
        self.line += self.rest[..start].bytes().filter(|b| *b == b'\n').count();
        let tail = &self.rest[start..];
        let end = tail.find(char::is_whitespace).unwrap_or(tail.len());
        self.rest = &tail[end..];
        Some(&tail[..end])
    }

    fn fault(&self, problem: impl Into<String>) -> ReaderFault {
        ReaderFault::new(FilePlace::Line(self.line), problem, CURE)
    }

    fn word(&mut self, wanted: &str) -> Result<&'a str, ReaderFault> {
        self.next().ok_or_else(|| self.fault(format!("the file ends where {wanted} should stand")))
    }

    fn expect(&mut self, wanted: &str) -> Result<(), ReaderFault> {
        let found = self.word(wanted)?;
        if found.eq_ignore_ascii_case(wanted) {
            return Ok(());
        }
        Err(self.fault(format!("'{}' stands where '{wanted}' should", clip(found))))
    }

    fn number(&mut self, what: &str) -> Result<f64, ReaderFault> {
        let word = self.word(what)?;
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() && x.abs() < 1e9 => Ok(x),
            _ => Err(self.fault(format!("'{}' is not a number for {what}", clip(word)))),
        }
    }

    fn count(&mut self, what: &str, limit: usize) -> Result<usize, ReaderFault> {
        let word = self.word(what)?;
        match word.parse::<usize>() {
            Ok(n) if n <= limit => Ok(n),
            Ok(n) => Err(self.fault(format!("{n} {what} are more than the {limit} that are read"))),
            Err(_) => Err(self.fault(format!("'{}' is not a count of {what}", clip(word)))),
        }
    }
}

fn clip(word: &str) -> &str {
    let end = word.char_indices().nth(20).map_or(word.len(), |(i, _)| i);
    &word[..end]
}

/// Parses a file.
pub(super) fn parse(bytes: &[u8]) -> Result<Bvh, ReaderFault> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|e| {
        ReaderFault::new(FilePlace::Byte(e.valid_up_to() as u64), "not text", "give the file as exported")
    })?;
    let mut words = BvhWords { rest: text, line: 1 };
    words.expect("HIERARCHY")?;
    words.expect("ROOT")?;
    let nodes = hierarchy(&mut words)?;
    // "MOTION" was the word that ended the hierarchy.
    words.expect("Frames:")?;
    let frames = words.count("frames", MAX_JOINT_FRAMES)?;
    words.expect("Frame")?;
    words.expect("Time:")?;
    let frame_time = words.number("the frame time")?;
    if !(1e-4..=10.0).contains(&frame_time) {
        return Err(words.fault(format!("a frame time of {frame_time} s is not that of a recording")));
    }
    let channels: usize = nodes.iter().map(|n| n.channels.len()).sum();
    if frames == 0 || channels == 0 {
        return Err(words.fault("no frame, or no channel that moves"));
    }
    // A number takes two bytes at least, so a header cannot ask for more memory than its file is long.
    if frames * channels > words.rest.len() {
        return Err(words.fault(format!("the file is too short for the {frames} frames that it announces")));
    }
    let mut values = Vec::with_capacity(frames * channels);
    for _ in 0..frames * channels {
        values.push(words.number("a channel")? as f32);
    }
    if words.next().is_some() {
        return Err(words.fault(format!("more numbers follow than the {frames} frames announced")));
    }
    Ok(Bvh { nodes, frame_time, values, channels })
}

/// Reads from the root's name up to and with the word MOTION.
fn hierarchy(words: &mut BvhWords<'_>) -> Result<Vec<Node>, ReaderFault> {
    let mut nodes = vec![node(words, None)?];
    let mut open = vec![0_usize];
    loop {
        let word = words.word("a joint or a brace")?;
        match word.to_ascii_uppercase().as_str() {
            "JOINT" | "END" => {
                let Some(parent) = open.last().copied() else { return Err(words.fault("a joint outside the root")) };
                if nodes.len() == MAX_BVH_JOINTS || open.len() == MAX_BVH_DEPTH {
                    let limits = format!("more than {MAX_BVH_JOINTS} joints, or {MAX_BVH_DEPTH} one below the other");
                    return Err(words.fault(limits));
                }
                let mut child = node(words, Some(parent))?;
                if word.eq_ignore_ascii_case("END") {
                    child.name.clear();
                }
                open.push(nodes.len());
                nodes.push(child);
            }
            "}" => {
                if open.pop().is_none() {
                    return Err(words.fault("a closing brace without its opening one"));
                }
            }
            "MOTION" if open.is_empty() => return Ok(nodes),
            "MOTION" => return Err(words.fault("the motion begins before every joint is closed")),
            "ROOT" => return Err(words.fault("a second skeleton; only one person is read")),
            _ => return Err(words.fault(format!("'{}' stands where a joint or a brace should", clip(word)))),
        }
    }
}

/// Reads name, brace, offset and channels of one joint; the end site has no channels.
fn node(words: &mut BvhWords<'_>, parent: Option<usize>) -> Result<Node, ReaderFault> {
    let mut name = words.word("a joint's name")?.to_owned();
    // Names may hold spaces: they end at the brace.
    loop {
        match words.word("{")? {
            "{" => break,
            more if name.len() < 256 => {
                name.push(' ');
                name.push_str(more);
            }
            _ => return Err(words.fault("a joint's name without an end")),
        }
    }
    words.expect("OFFSET")?;
    let mut offset = DVec3::ZERO;
    for k in 0..3 {
        offset[k] = words.number("an offset")?;
    }
    let before = (words.rest, words.line);
    let mut channels = Vec::new();
    if words.word("CHANNELS or a brace")?.eq_ignore_ascii_case("CHANNELS") {
        for _ in 0..words.count("channels", 6)? {
            channels.push(channel(words)?);
        }
    } else {
        (words.rest, words.line) = before;
    }
    Ok(Node { name, parent, offset, channels })
}

fn channel(words: &mut BvhWords<'_>) -> Result<Channel, ReaderFault> {
    let word = words.word("a channel's name")?;
    Ok(match word.to_ascii_lowercase().as_str() {
        "xposition" => Channel::Position(0),
        "yposition" => Channel::Position(1),
        "zposition" => Channel::Position(2),
        "xrotation" => Channel::Rotation(0),
        "yrotation" => Channel::Rotation(1),
        "zrotation" => Channel::Rotation(2),
        _ => return Err(words.fault(format!("'{}' is not a channel", clip(word)))),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: &str = "HIERARCHY\nROOT Hips {\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation \
        Yrotation Xrotation\nJOINT Left Arm {\nOFFSET 0 1 0\nCHANNELS 1 Xrotation\nEnd Site {\nOFFSET 0 1 0\n}\n}\n}\n\
        MOTION\nFrames: 2\nFrame Time: 0.033\n0 0 0 0 0 0 1\n1 2 3 4 5 6 7\n";

    #[test]
    fn a_small_file_is_read() {
        let bvh = parse(SMALL.as_bytes()).unwrap();
        assert_eq!(bvh.nodes.len(), 3);
        assert_eq!(bvh.nodes[1].name, "Left Arm");
        assert_eq!(bvh.nodes[2].parent, Some(1));
        assert_eq!(bvh.channels, 7);
        assert_eq!(bvh.values[7..], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    }

    #[test]
    fn wrong_files_name_the_line() {
        for (from, to) in [
            ("Frames: 2", "Frames: 1000000000"),
            ("Frames: 2", "Frames: 3"),
            ("Frames: 2", "Frames: 1"),
            ("Frames: 2", "Frames: 0"),
            ("4 5 6", "4 nan 6"),
            ("4 5 6", "4 inf 6"),
            ("0.033", "-1"),
            ("CHANNELS 1", "CHANNELS 1000000000"),
            ("OFFSET 0 1 0", "OFFSET 0 1e300 0"),
            ("}\n}\n}\n", "}\n}\n"),
            ("}\n}\n}\n", "}\n}\n}\n}\n"),
            ("JOINT", "ROOT"),
        ] {
            let fault = parse(SMALL.replace(from, to).as_bytes()).unwrap_err();
            assert!(matches!(fault.place, FilePlace::Line(_)), "{to}: {fault:?}");
        }
    }

    #[test]
    fn a_million_nested_joints_are_refused() {
        let deep = format!("HIERARCHY ROOT a {{ OFFSET 0 0 0 {}", "JOINT b { OFFSET 0 0 0 ".repeat(1_000_000));
        assert!(parse(deep.as_bytes()).unwrap_err().problem.contains("more than"));
    }
}
