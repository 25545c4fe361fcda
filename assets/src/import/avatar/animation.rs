//! An animation of a glTF file: how its nodes move (Khronos glTF 2.0, sections 3.11 and appendix C).

use glam::{DMat4, DQuat, DVec3, DVec4};
use serde_json::Value;

use super::error::Flaw;
use super::skinned::BoundJoints;
use crate::import::gltf::file::{GltfFile, index, list};

/// Longest animation that is read (s): its poses take 60 MB.
const MAX_SECONDS: f64 = 1_200.0;

/// Most names that a message lists.
const MOST_NAMES: usize = 12;

/// What of a node moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum AnimatedPath {
    Translation,
    Rotation,
    Scale,
}

/// How values between two keys are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Interpolation {
    Linear,
    Step,
    CubicSpline,
}

/// One property of one node in time.
#[derive(Debug, Clone)]
struct ClipChannel {
    node: usize,
    path: AnimatedPath,
    interpolation: Interpolation,
    /// Times of the keys (s), rising.
    times: Vec<f64>,
    /// One a key; of a cubic spline the tangent before it, its value, the tangent behind it.
    values: Vec<DVec4>,
}

/// An animation.
#[derive(Debug, Clone)]
pub(super) struct GltfClip {
    pub name: String,
    /// Time of its last key (s).
    pub seconds: f64,
    channels: Vec<ClipChannel>,
    /// Translation, rotation and scale of every node that moves, as the file's nodes have them.
    still: Vec<(usize, [DVec4; 3])>,
}

impl GltfClip {
    /// The animation of this name, as far as it moves the joints and what is above them.
    pub fn read(file: &GltfFile, joints: &BoundJoints, name: &str) -> Result<Self, Flaw> {
        let all = list(&file.json["animations"]);
        let title =
            |(k, clip): (usize, &Value)| clip["name"].as_str().map_or_else(|| format!("animation {k}"), str::to_owned);
        let names: Vec<String> = all.iter().enumerate().map(title).collect();
        let Some(number) = names.iter().position(|n| n == name) else {
            return Err(unknown(name, &names));
        };
        let wrong = |reason: String| Flaw::Animation { name: name.to_owned(), reason };
        let clip = &all[number];
        let mut channels: Vec<ClipChannel> = Vec::new();
        for channel in list(&clip["channels"]) {
            let Some(channel) = read_channel(file, clip, channel, joints).map_err(wrong)? else { continue };
            if channels.iter().any(|c| (c.node, c.path) == (channel.node, channel.path)) {
                let node = joints.nodes.name(channel.node);
                return Err(wrong(format!("moves node \"{node}\" twice at once; export it again")));
            }
            channels.push(channel);
        }
        let seconds = channels.iter().filter_map(|c| c.times.last().copied()).fold(0.0, f64::max);
        if seconds > MAX_SECONDS {
            return Err(wrong(format!("lasts {seconds:.0} s, more than {MAX_SECONDS} s; cut it into pieces")));
        }
        if seconds <= 0.0 {
            return Err(wrong("moves no joint; export it with the keys of the armature".into()));
        }
        let mut still: Vec<(usize, [DVec4; 3])> = Vec::new();
        for channel in &channels {
            if still.iter().all(|(node, _)| *node != channel.node) {
                let node = &file.json["nodes"][channel.node];
                if node["matrix"].is_array() {
                    let name = joints.nodes.name(channel.node);
                    let cure = "export translation, rotation and scale";
                    return Err(wrong(format!("moves node \"{name}\", whose place is a matrix; {cure}")));
                }
                still.push((channel.node, parts(node)));
            }
        }
        Ok(Self { name: name.to_owned(), seconds, channels, still })
    }

    /// Whether it changes the scale of anything.
    pub fn scales(&self) -> bool {
        let of_scale = |c: &&ClipChannel| c.path == AnimatedPath::Scale;
        self.channels
            .iter()
            .filter(of_scale)
            .any(|c| c.values.iter().any(|v| (v.truncate() - DVec3::ONE).abs().max_element() > 1e-3))
    }

    /// The places beside their parents of the nodes that move, at a time (s).
    pub fn at(&self, seconds: f64) -> impl Iterator<Item = (usize, DMat4)> + '_ {
        self.still.iter().map(move |(node, still)| {
            let mut now = *still;
            for channel in self.channels.iter().filter(|c| c.node == *node) {
                now[channel.path as usize] = channel.at(seconds);
            }
            let [place, turn, scale] = now;
            let turn = DQuat::from_vec4(turn).normalize();
            (*node, DMat4::from_scale_rotation_translation(scale.truncate(), turn, place.truncate()))
        })
    }
}

fn unknown(name: &str, names: &[String]) -> Flaw {
    if names.is_empty() {
        return Flaw::syntax("it has no animation; export the armature's actions too");
    }
    let more = names.len().saturating_sub(MOST_NAMES);
    let mut known = names[..names.len() - more].join(", ");
    if more > 0 {
        known.push_str(&format!(" and {more} more"));
    }
    Flaw::NoAnimation { name: name.to_owned(), known }
}

/// Translation, rotation and scale of a node.
fn parts(node: &Value) -> [DVec4; 3] {
    let numbers = |key: &str, default: DVec4| {
        let found: Vec<f64> = list(&node[key]).iter().filter_map(Value::as_f64).collect();
        match found[..] {
            [x, y, z] => DVec4::new(x, y, z, 0.0),
            [x, y, z, w] => DVec4::new(x, y, z, w),
            _ => default,
        }
    };
    [numbers("translation", DVec4::ZERO), numbers("rotation", DVec4::W), numbers("scale", DVec4::ONE)]
}

/// A channel that moves a joint or what is above one.
fn read_channel(
    file: &GltfFile,
    clip: &Value,
    channel: &Value,
    joints: &BoundJoints,
) -> Result<Option<ClipChannel>, String> {
    let node = index(&channel["target"]["node"]).filter(|n| joints.of.binary_search(n).is_ok());
    let path = match channel["target"]["path"].as_str() {
        Some("translation") => AnimatedPath::Translation,
        Some("rotation") => AnimatedPath::Rotation,
        Some("scale") => AnimatedPath::Scale,
        // Morph targets of a face, for example.
        _ => return Ok(None),
    };
    let Some(node) = node else { return Ok(None) };
    let sampler = index(&channel["sampler"]).map_or(&Value::Null, |k| &clip["samplers"][k]);
    let accessor = |key: &str| index(&sampler[key]).ok_or_else(|| "lacks a sampler; export it again".to_owned());
    let interpolation = match sampler["interpolation"].as_str() {
        None | Some("LINEAR") => Interpolation::Linear,
        Some("STEP") => Interpolation::Step,
        Some("CUBICSPLINE") => Interpolation::CubicSpline,
        Some(other) => {
            return Err(format!("is interpolated by {other}, which glTF does not have; export it as LINEAR"));
        }
    };
    let (input, output) = (accessor("input")?, accessor("output")?);
    let whose = |what: &str| format!("{what} of node \"{}\"", joints.nodes.name(node));
    let times: Vec<f64> = file.floats::<1>(input).map_err(|e| has(&e))?.into_iter().map(|[t]| f64::from(t)).collect();
    if times[0] < 0.0 || times.iter().any(|t| !t.is_finite()) || times.windows(2).any(|w| w[0] >= w[1]) {
        return Err(format!("has times that do not rise in the {}; export it again", whose("keys")));
    }
    let values: Vec<DVec4> = match path {
        AnimatedPath::Rotation => {
            file.floats::<4>(output).map_err(|e| has(&e))?.into_iter().map(|v| v.map(f64::from).into()).collect()
        }
        _ => file
            .floats::<3>(output)
            .map_err(|e| has(&e))?
            .into_iter()
            .map(|[x, y, z]| DVec3::from([x, y, z].map(f64::from)).extend(0.0))
            .collect(),
    };
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if values.len() != each * times.len() {
        let (have, need) = (values.len(), each * times.len());
        return Err(format!("has {have} values for {need} in the {}; export it again", whose("keys")));
    }
    let channel = ClipChannel { node, path, interpolation, times, values };
    let key = |k: usize| channel.values[each * k + each / 2];
    let broken = |v: DVec4| !v.is_finite() || (path == AnimatedPath::Rotation && v.length() < 1e-3);
    if channel.values.iter().any(|v| !v.is_finite()) || (0..channel.times.len()).any(|k| broken(key(k))) {
        return Err(format!("has numbers that say no place in the {}; export it again", whose("keys")));
    }
    Ok(Some(channel))
}

/// The fault of an accessor, to follow the animation's name.
fn has(reason: &str) -> String {
    format!("cannot be read: {reason}")
}

impl ClipChannel {
    /// The value at a time (s): before the first key the first, behind the last the last.
    fn at(&self, seconds: f64) -> DVec4 {
        let each = if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let key = |k: usize| self.values[each * k + each / 2];
        let after = self.times.partition_point(|t| *t <= seconds);
        if after == 0 || after == self.times.len() {
            return key(after.saturating_sub(1));
        }
        let (from, to) = (after - 1, after);
        let span = self.times[to] - self.times[from];
        let t = (seconds - self.times[from]) / span;
        match self.interpolation {
            Interpolation::Step => key(from),
            Interpolation::Linear if self.path == AnimatedPath::Rotation => {
                let [a, b] = [from, to].map(|k| DQuat::from_vec4(key(k)).normalize());
                a.slerp(b, t).into()
            }
            Interpolation::Linear => key(from).lerp(key(to), t),
            Interpolation::CubicSpline => {
                let (leaving, arriving) = (self.values[3 * from + 2] * span, self.values[3 * to] * span);
                let (t2, t3) = (t * t, t * t * t);
                key(from) * (2.0 * t3 - 3.0 * t2 + 1.0)
                    + leaving * (t3 - 2.0 * t2 + t)
                    + key(to) * (-2.0 * t3 + 3.0 * t2)
                    + arriving * (t3 - t2)
            }
        }
    }
}
