//! Exceptions from the structure tests, by name: `tests/exceptions.toml`, which only may shrink.

use std::collections::{BTreeMap, BTreeSet};

use crate::tree;

/// The exceptions of one rule: each with its reason.
pub type Exceptions = BTreeMap<String, String>;

/// The exceptions of a rule, as the file has them.
///
/// # Panics
/// Where the file is not a table of tables of reasons.
pub fn of(rule: &str) -> Exceptions {
    read(&tree::read(&tree::root().join("tests/exceptions.toml")), rule)
}

fn read(text: &str, rule: &str) -> Exceptions {
    let table: toml::Table = text.parse().unwrap_or_else(|e| panic!("tests/exceptions.toml: {e}"));
    let Some(rows) = table.get(rule) else { return Exceptions::new() };
    let rows = rows.as_table().unwrap_or_else(|| panic!("tests/exceptions.toml: {rule} is a table"));
    let reason = |value: &toml::Value| value.as_str().expect("a reason is a text").trim().to_owned();
    rows.iter().map(|(name, value)| (name.clone(), reason(value))).collect()
}

/// What a rule has to say: violations that are not excepted, and exceptions that nothing needs any more or that give no
/// reason; empty where all is well.
pub fn judge(rule: &str, found: &BTreeSet<String>, excepted: &Exceptions) -> String {
    let mut violations = String::new();
    for name in found.iter().filter(|name| !excepted.contains_key(*name)) {
        violations.push_str(&format!("{rule}: {name:?} breaks the rule\n"));
    }
    for (name, reason) in excepted {
        if !found.contains(name) {
            violations
                .push_str(&format!("{rule}: {name:?} is not needed any more: take it out of tests/exceptions.toml\n"));
        } else if reason.is_empty() {
            violations.push_str(&format!("{rule}: {name:?} is excepted without a reason\n"));
        }
    }
    violations
}

/// Holds a rule over what was found.
///
/// # Panics
/// Where a violation is not excepted, or an exception is not needed.
pub fn hold(rule: &str, found: &BTreeSet<String>) {
    let violations = judge(rule, found, &of(rule));
    assert!(violations.is_empty(), "\n{violations}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exception_is_named_needed_and_justified() {
        let text = "[circles]\n\"a, b\" = \"why\"\n\"c, d\" = \"\"\n\"e, f\" = \"once\"\n[others]\n\"g\" = \"why\"";
        let found = ["a, b", "c, d", "h"].map(str::to_owned).into();
        let violations = judge("circles", &found, &read(text, "circles"));
        let lines: Vec<&str> = violations.lines().collect();
        assert_eq!(lines.len(), 3, "{violations}");
        assert!(lines[0].contains("\"h\" breaks"));
        assert!(lines[1].contains("\"c, d\" is excepted without"));
        assert!(lines[2].contains("\"e, f\" is not needed"));
        assert!(judge("none", &BTreeSet::new(), &read(text, "none")).is_empty());
    }
}
