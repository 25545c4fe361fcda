//! One check, and the texts in which the kernel describes its subject.

use std::path::Path;

use serde::Serialize;

/// How one thing stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// As it should be.
    Ok,
    /// Not there, or not as it should be; the cure says how to mend it.
    Missing,
    /// This machine does not say.
    Unknown,
}

/// One thing that was looked at.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Name of the check.
    pub name: &'static str,
    /// Result of the check.
    pub status: Status,
    /// What was found, in words.
    pub found: String,
    /// Feature that needs it.
    pub needed_for: &'static str,
    /// The exact cure, where something is missing.
    pub cure: Option<String>,
}

impl Check {
    pub(super) fn ok(name: &'static str, needed_for: &'static str, found: impl Into<String>) -> Self {
        Self { name, status: Status::Ok, found: found.into(), needed_for, cure: None }
    }

    pub(super) fn missing(
        name: &'static str,
        needed_for: &'static str,
        found: impl Into<String>,
        cure: impl Into<String>,
    ) -> Self {
        Self { name, status: Status::Missing, found: found.into(), needed_for, cure: Some(cure.into()) }
    }

    pub(super) fn unknown(name: &'static str, needed_for: &'static str) -> Self {
        Self { name, status: Status::Unknown, found: "this machine does not say".into(), needed_for, cure: None }
    }
}

/// The text of one of the kernel's files, without its ends.
pub(super) fn kernel_file(path: impl AsRef<Path>) -> Option<String> {
    let text = std::fs::read_to_string(path).ok()?;
    Some(text.trim().to_owned()).filter(|t| !t.is_empty())
}

/// The value of a `Key: value` line.
pub(super) fn field<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(':')).map(str::trim)
}
