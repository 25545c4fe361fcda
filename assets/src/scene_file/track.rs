//! Motion from CSV: rows of time and values, interpolated linearly in f64 and held at both ends.

use glam::{DAffine3, DQuat, DVec3, DVec4};

/// Rows of numbers over time.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    times: Vec<f64>,
    values: Vec<f64>,
    width: usize,
}

/// Farthest value that a track may hold: as far as a scene reaches (m).
const FAR: f64 = 1e6;

/// Most rows of a track: a day at 30 Hz is 2.6 million.
const MAX_ROWS: usize = 4_000_000;

impl Track {
    /// Reads rows of `time, value, value, ...`: numbers separated by commas, semicolons, tabs or spaces. A first line of
    /// names is passed over, as are empty lines and those that begin with `#`. Every row has as many values as `fits`
    /// accepts. An error says line and cure, to stand behind the file's name. With `pass`, values that are not finite
    /// are kept.
    pub fn parse(text: &str, fits: impl Fn(usize) -> Result<(), String>, pass: bool) -> Result<Self, String> {
        let mut track = Self { times: Vec::new(), values: Vec::new(), width: 0 };
        let mut names_may_come = true;
        for (i, line) in text.lines().enumerate() {
            let line = line.trim().trim_start_matches('\u{feff}');
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let numbers: Vec<Option<f64>> = fields(line).map(|f| f.parse().ok()).collect();
            if std::mem::take(&mut names_may_come) && numbers.iter().all(Option::is_none) {
                continue;
            }
            track.push(&numbers, &fits, pass).map_err(|message| format!("line {}: {message}", i + 1))?;
        }
        if track.times.is_empty() {
            return Err("it has no rows; give at least one of time and values".into());
        }
        Ok(track)
    }

    fn push(
        &mut self,
        row: &[Option<f64>],
        fits: &impl Fn(usize) -> Result<(), String>,
        pass: bool,
    ) -> Result<(), String> {
        if let Some(column) = row.iter().position(Option::is_none) {
            return Err(format!("column {} is not a number; write it as 0.25 or 1e-3", column + 1));
        }
        let row: Vec<f64> = row.iter().copied().flatten().collect();
        let (time, values) = (row[0], &row[1..]);
        if self.times.is_empty() {
            fits(values.len())?;
            self.width = values.len();
        }
        if values.len() != self.width {
            let (found, first) = (row.len(), self.width + 1);
            return Err(format!("it has {found} columns, but the first row has {first}; give every row as many"));
        }
        if !time.is_finite() || self.times.last().is_some_and(|last| time <= *last) {
            return Err(format!("time {time} does not come after the row before; sort the rows by time (s)"));
        }
        let bad = values.iter().position(|v| v.is_nan() || v.abs() > FAR);
        if let Some(column) = bad.filter(|_| !pass) {
            let value = values[column];
            let cure = "correct it, or set bad_rows = \"pass\" to see how the engine copes";
            return Err(format!("column {} is {value}, which is nowhere; {cure}", column + 2));
        }
        if self.times.len() == MAX_ROWS {
            return Err(format!("there are more than {MAX_ROWS} rows; give fewer a second"));
        }
        self.times.push(time);
        self.values.extend(values);
        Ok(())
    }

    /// A track that never moves.
    pub fn still(values: &[f64]) -> Self {
        Self { times: vec![0.0], values: values.into(), width: values.len() }
    }

    /// Values of a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Time of the last row (s).
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or_default()
    }

    /// The two rows around a time, and how far it is from the first to the second (0..1).
    fn around(&self, time: f64) -> (usize, usize, f64) {
        let next = self.times.partition_point(|t| *t <= time);
        if next == 0 || next == self.times.len() {
            let end = next.saturating_sub(1);
            return (end, end, 0.0);
        }
        let (from, to) = (self.times[next - 1], self.times[next]);
        (next - 1, next, (time - from) / (to - from))
    }

    /// One value at a time (s): linear between rows, held before the first and after the last.
    pub fn at(&self, time: f64, column: usize) -> f64 {
        let (a, b, t) = self.around(time);
        let value = |row: usize| self.values[row * self.width + column];
        if t == 0.0 { value(a) } else { value(a) + (value(b) - value(a)) * t }
    }

    /// Sphere `k` of a track of spheres: centre and radius (m).
    pub fn sphere(&self, time: f64, k: usize) -> DVec4 {
        DVec4::from_array(std::array::from_fn(|i| self.at(time, 4 * k + i)))
    }

    /// The rigid motion of a track of `x, y, z, qx, qy, qz, qw`: the point p of the start goes to q p + (x, y, z).
    /// Quaternions are turned along the shorter arc.
    pub fn rigid(&self, time: f64) -> DAffine3 {
        let (a, b, t) = self.around(time);
        let row = |r: usize| &self.values[r * self.width..][..7];
        let turn = |r: usize| DQuat::from_slice(&row(r)[3..]).normalize();
        let place = DVec3::from_array(std::array::from_fn(|i| self.at(time, i)));
        let turned = if t == 0.0 { turn(a) } else { turn(a).slerp(turn(b), t) };
        DAffine3::from_rotation_translation(turned, place)
    }

    /// The first row whose values `bad` finds, as its number from 1.
    pub fn find(&self, bad: impl Fn(&[f64]) -> bool) -> Option<usize> {
        self.values.chunks_exact(self.width).position(bad).map(|i| i + 1)
    }
}

fn fields(line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    if line.contains([',', ';', '\t']) {
        Box::new(line.split([',', ';', '\t']).map(str::trim))
    } else {
        Box::new(line.split_whitespace())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Track, String> {
        Track::parse(text, |_| Ok(()), false)
    }

    #[test]
    fn values_are_linear_between_rows_and_held_outside() {
        let track = read("time,x,y\n# rest\n0, 1, 10\n0.5, 2, 30\n2, 2, 0\n").unwrap();
        assert_eq!((track.width(), track.end()), (2, 2.0));
        assert_eq!(
            [-1.0, 0.0, 0.25, 0.5, 1.25, 2.0, 9.0].map(|t| track.at(t, 1)),
            [10.0, 10.0, 20.0, 30.0, 15.0, 0.0, 0.0]
        );
        assert_eq!(track.at(0.125, 0), 1.25);
        for text in ["0;1;2\n1;3;4", "0\t1\t2\n1\t3\t4", "0 1 2\n1 3 4", "\u{feff}t,a,b\r\n0,1,2\r\n1,3,4\r\n"] {
            assert_eq!(read(text).unwrap().at(0.5, 1), 3.0, "{text:?}");
        }
    }

    #[test]
    fn interpolation_is_exact_to_f64() {
        // A long run at large coordinates: f32 would be off by 30 um here.
        let track = read("0, 500\n36000, 501").unwrap();
        assert!((track.at(18_000.123, 0) - (500.0 + 18_000.123 / 36_000.0)).abs() < 1e-12);
    }

    #[test]
    fn a_rigid_track_turns_along_the_shorter_arc() {
        let half = std::f64::consts::FRAC_PI_4;
        let (s, c) = half.sin_cos();
        // The same turn, once with its quaternion negated.
        for sign in [1.0, -1.0] {
            let text = format!("0, 0,0,0, 0,0,0,1\n1, 2,0,0, 0,{},0,{}", sign * s, sign * c);
            let track = read(&text).unwrap();
            let p = track.rigid(0.5).transform_point3(DVec3::X);
            let turned = DQuat::from_rotation_y(half) * DVec3::X + DVec3::X;
            assert!(p.distance(turned) < 1e-12, "{p}");
            assert!(track.rigid(5.0).transform_point3(DVec3::X).distance(DVec3::new(2.0, 0.0, -1.0)) < 1e-12);
        }
    }

    #[test]
    fn bad_rows_are_told_with_line_and_cure() {
        for (text, expected) in [
            ("", "no rows"),
            ("t,x\n", "no rows"),
            ("0,1\n1,x\n", "line 2: column 2"),
            ("0,1\n\n1\n", "line 3: it has 1 columns"),
            ("0,1\n1,,2\n", "line 2: column 2"),
            ("0,1\n0,2\n", "line 2: time 0"),
            ("1,1\n0,2\n", "line 2: time 0"),
            ("nan,1\n", "line 1: time NaN"),
            ("0,nan\n", "line 1: column 2 is NaN"),
            ("0,inf\n", "bad_rows"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(expected), "{text:?}: {error}");
        }
        assert!(Track::parse("0,nan\n", |_| Ok(()), true).unwrap().at(0.0, 0).is_nan());
        assert_eq!(Track::parse("0,1,2\n", |n| Err(format!("{n} values")), false).unwrap_err(), "line 1: 2 values");
    }
}
