//! One run of one program, as its JSON has it.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};

use super::case::TurnCase;
use super::error::TurnsError;

/// What one run said.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct TurnReading {
    /// Time of a step.
    pub step_us: StepMedian,
    /// Strain of the same steps.
    pub strain: StrainParts,
    /// Mean time of each stage (us).
    #[serde(default)]
    pub stages_us: BTreeMap<String, f64>,
    /// Hash of the state at the end.
    pub state_hash: String,
    /// Heap memory of the garments and their states (bytes).
    #[serde(default)]
    pub memory_bytes: Option<u64>,
}

/// Times of a step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct StepMedian {
    /// Median (us).
    pub p50: f64,
}

/// Strain, as a part of an edge's length.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct StrainParts {
    /// Mean.
    pub mean: f64,
    /// Mean of the frames' 99th percentiles.
    pub p99: f64,
    /// The worst edge.
    pub max: f64,
}

impl TurnReading {
    /// One run of a case by a program, or what it said where it would not.
    ///
    /// # Errors
    /// Where the program does not start.
    pub fn take(program: &Path, case: &TurnCase, steps: usize) -> Result<Result<Self, String>, TurnsError> {
        let mut command = Command::new(program);
        command.args(["bench", "skirt", "--runs", "1", "--steps", &steps.to_string(), "--json"]).args(&case.options);
        let start = |cause| TurnsError::Start { program: program.to_owned(), cause };
        let output = command.output().map_err(start)?;
        Ok(Self::of(output.status.success(), &output.stdout, &output.stderr))
    }

    fn of(success: bool, stdout: &[u8], stderr: &[u8]) -> Result<Self, String> {
        if !success {
            let text = String::from_utf8_lossy(stderr);
            return Err(text.lines().next().unwrap_or("it ended without a word").to_owned());
        }
        serde_json::from_slice(stdout).map_err(|e| format!("its report cannot be read: {e}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_is_read_and_a_refusal_kept() {
        let json =
            br#"{"kind":"bench-skirt","step_us":{"p50":2.5,"p99":3.0},"strain":{"mean":0.001,"p99":0.02,"max":0.3,
            "edges":7},"stages_us":{"bend":1.5},"state_hash":"00ff","memory_bytes":12}"#;
        let reading = TurnReading::of(true, json, b"").unwrap();
        assert_eq!((reading.step_us.p50, reading.strain.p99, reading.memory_bytes), (2.5, 0.02, Some(12)));
        assert_eq!(reading.stages_us["bend"], 1.5);
        let refusal = TurnReading::of(false, b"", b"error: unexpected argument '--garment' found\nmore");
        assert_eq!(refusal.unwrap_err(), "error: unexpected argument '--garment' found");
        assert!(TurnReading::of(true, b"{}", b"").is_err());
    }
}
