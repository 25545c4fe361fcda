//! YAML as OpenCV's `FileStorage` writes it, by a reader of our own: its first line `%YAML:1.0` and its tags are refused by
//! readers of YAML, and of the language it uses two shapes alone, `key: value` and a matrix.
//!
//! One camera a file: `camera_matrix`, `distortion_coefficients`, `image_width`, `image_height`, and its pose as a matrix or a
//! Rodrigues vector `R` (also `rotation`, `rvec`) with `T` (`translation`, `tvec`). A stereo pair in one file has `M1`, `D1`,
//! `M2`, `D2`, `R`, `T`: the first camera is the world.

use std::collections::BTreeMap;

use glam::{DMat3, DQuat, DVec3};

use super::camera::CalibratedCamera;
use super::parameters::CameraParameters;
use crate::error::{FilePlace, ReaderFault};

const CURE: &str =
    "write it with OpenCV's FileStorage: camera_matrix, distortion_coefficients, image_width, image_height, R and T";

/// Most numbers of one matrix.
const MOST_NUMBERS: usize = 64;

/// A value of the file: a matrix with its rows and columns, or a plain number as a matrix of one.
#[derive(Debug, Clone, Default)]
struct Value {
    rows: usize,
    columns: usize,
    data: Vec<f64>,
}

/// Reads the cameras of one file; a single camera is called as the file is.
pub(super) fn read(bytes: &[u8], name: &str) -> Result<Vec<CalibratedCamera>, ReaderFault> {
    let whole = |problem: String| ReaderFault::new(FilePlace::Whole, problem, CURE);
    let text = std::str::from_utf8(bytes).map_err(|_| whole("not text".to_owned()))?;
    let values = values(text)?;
    let camera = |name: &str, lens: [&[&str]; 2], pose: Option<(DMat3, DVec3)>| {
        parameters(&values, lens, pose)
            .and_then(|p| CalibratedCamera::new(name, &p))
            .map_err(|e| whole(format!("the camera '{name}': {e}")))
    };
    if values.contains_key("M1") && values.contains_key("M2") {
        let first = camera("1", [&["M1"], &["D1"]], Some((DMat3::IDENTITY, DVec3::ZERO)))?;
        return Ok(vec![first, camera("2", [&["M2"], &["D2"]], None)?]);
    }
    let lens: [&[&str]; 2] =
        [&["camera_matrix", "K", "Camera_Matrix"], &["distortion_coefficients", "D", "Distortion_Coefficients"]];
    Ok(vec![camera(name, lens, None)?])
}

fn parameters(
    values: &BTreeMap<String, Value>,
    [matrix, distortion]: [&[&str]; 2],
    pose: Option<(DMat3, DVec3)>,
) -> Result<CameraParameters, String> {
    let find = |keys: &[&str]| keys.iter().find_map(|k| values.get(*k));
    let need = |keys: &[&str], count: usize| {
        let value = find(keys).ok_or_else(|| format!("it has no {}", keys[0]))?;
        let (rows, columns) = (value.rows, value.columns);
        let fits = value.data.len() == count;
        fits.then_some(&value.data)
            .ok_or_else(|| format!("its {} is {rows} x {columns} and not of {count} numbers", keys[0]))
    };
    let k = need(matrix, 9)?;
    let size = [need(&["image_width", "image_Width"], 1)?[0], need(&["image_height", "image_Height"], 1)?[0]];
    let mut lens = find(distortion).map_or_else(Vec::new, |d| d.data.clone());
    while lens.len() > 5 && lens.last() == Some(&0.0) {
        lens.pop();
    }
    let (rotation, translation) = match pose {
        Some(pose) => pose,
        None => {
            let t = need(&["T", "translation", "tvec"], 3)?;
            (turn(find(&["R", "rotation", "rvec"]).ok_or("it has no R")?)?, DVec3::new(t[0], t[1], t[2]))
        }
    };
    let matrix = std::array::from_fn(|i| std::array::from_fn(|j| k[3 * i + j]));
    Ok(CameraParameters { size, matrix, distortion: lens, rotation, translation })
}

fn turn(value: &Value) -> Result<DMat3, String> {
    match value.data.as_slice() {
        [x, y, z] => Ok(DMat3::from_quat(DQuat::from_scaled_axis(DVec3::new(*x, *y, *z)))),
        nine if nine.len() == 9 => Ok(DMat3::from_cols_slice(nine).transpose()),
        other => Err(format!("its R has {} numbers where a rotation has 3 or 9", other.len())),
    }
}

/// All values of the file by their keys, those of a matrix's own keys taken into it.
fn values(text: &str) -> Result<BTreeMap<String, Value>, ReaderFault> {
    let mut found = BTreeMap::<String, Value>::new();
    let mut current: Option<String> = None;
    let mut open = false;
    for (number, line) in text.lines().enumerate() {
        let fault = |problem: String| ReaderFault::new(FilePlace::Line(number + 1), problem, CURE);
        let bare = line.trim();
        if bare.is_empty() || bare.starts_with(['%', '#']) || bare == "---" || bare == "..." {
            continue;
        }
        let (key, rest) = match bare.split_once(':') {
            Some((key, rest)) if !open => (key.trim(), rest.trim()),
            _ => ("data", bare),
        };
        let matrix = current.as_ref().and_then(|name| found.get_mut(name));
        match (key, matrix) {
            ("rows", Some(m)) => m.rows = rest.parse().map_err(|_| fault(format!("rows: {rest} is no number")))?,
            ("cols", Some(m)) => m.columns = rest.parse().map_err(|_| fault(format!("cols: {rest} is no number")))?,
            ("dt", Some(_)) => {}
            ("data", Some(m)) => {
                numbers(rest, &mut m.data).map_err(fault)?;
                open = !rest.contains(']');
            }
            _ if rest.starts_with("!!opencv-matrix") => {
                found.insert(key.to_owned(), Value::default());
                current = Some(key.to_owned());
            }
            _ => {
                current = None;
                if let Ok(number) = rest.parse() {
                    found.insert(key.to_owned(), Value { rows: 1, columns: 1, data: vec![number] });
                }
            }
        }
    }
    for (key, m) in &found {
        if m.rows * m.columns != m.data.len() {
            let problem = format!("{key} has {} numbers where {} x {} are stated", m.data.len(), m.rows, m.columns);
            return Err(ReaderFault::new(FilePlace::Whole, problem, CURE));
        }
    }
    Ok(found)
}

fn numbers(text: &str, into: &mut Vec<f64>) -> Result<(), String> {
    for word in text.trim_matches(['[', ']', ' ']).split([',', ' ', ']']).filter(|w| !w.is_empty()) {
        into.push(word.parse().map_err(|_| format!("'{word}' is no number"))?);
        if into.len() > MOST_NUMBERS {
            return Err(format!("more than {MOST_NUMBERS} numbers in one matrix"));
        }
    }
    Ok(())
}
