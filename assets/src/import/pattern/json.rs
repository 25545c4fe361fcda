//! JSON with comments, and the few shapes of values that patterns are made of.

use glam::{DVec2, DVec3};
use serde_json::Value;

use super::error::PatternFault;

/// Reads JSON in which `//` and `/* */` may comment.
pub fn read(text: &str) -> Result<Value, PatternFault> {
    serde_json::from_str(&without_comments(text)).map_err(|e| {
        let reason = e.to_string();
        PatternFault::Content(format!("it is no complete JSON ({reason}); export the pattern again"))
    })
}

/// The text with spaces in place of its comments, so that places stay what they are.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text.chars().peekable();
    let mut quoted = false;
    while let Some(c) = rest.next() {
        match (c, rest.peek()) {
            ('\\', Some(&next)) if quoted => {
                out.extend([c, next]);
                rest.next();
            }
            ('/', Some('/')) if !quoted => {
                while rest.next_if(|c| *c != '\n').is_some() {
                    out.push(' ');
                }
            }
            ('/', Some('*')) if !quoted => {
                let mut before = ' ';
                for c in rest.by_ref() {
                    out.push(if c == '\n' { c } else { ' ' });
                    if before == '*' && c == '/' {
                        break;
                    }
                    before = c;
                }
            }
            _ => {
                quoted ^= c == '"';
                out.push(c);
            }
        }
    }
    out
}

/// A pair of finite numbers.
pub fn pair(value: &Value) -> Option<DVec2> {
    let [x, y] = value.as_array()?.as_slice() else { return None };
    Some(DVec2::new(x.as_f64()?, y.as_f64()?))
}

/// Three numbers.
pub fn triple(value: &Value) -> Option<DVec3> {
    let [x, y, z] = value.as_array()?.as_slice() else { return None };
    Some(DVec3::new(x.as_f64()?, y.as_f64()?, z.as_f64()?))
}

/// An index.
pub fn index(value: &Value) -> Option<usize> {
    value.as_u64().and_then(|i| usize::try_from(i).ok())
}

/// The items of a list; of anything else none.
pub fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// A text, if it is one.
pub fn text(value: &Value) -> Option<String> {
    value.as_str().map(str::to_owned)
}

/// Most characters of a name that are kept.
const MAX_NAME: usize = 80;

/// A name as messages show it: in one line, and no longer than a line.
pub fn name(text: &str) -> String {
    text.chars().take(MAX_NAME).map(|c| if c.is_control() { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_passed_over_outside_of_texts() {
        let value = read("{ // one\n \"a\": /* two\n lines */ [1, 2], \"b\": \"x // \\\" /* y\" }").unwrap();
        assert_eq!(pair(&value["a"]), Some(DVec2::new(1.0, 2.0)));
        assert_eq!(value["b"], "x // \" /* y");
        assert_eq!((name("a\nb").as_str(), name(&"x".repeat(1_000)).len()), ("a b", MAX_NAME));
        assert!(read("{ /* never closed").is_err() && read("/").is_err());
    }
}
