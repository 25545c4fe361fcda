//! A table of the file, read key by key by the schema; every refusal says the place, the key and the cure.

use std::ops::Range;

use glam::{DVec3, Vec3};
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::error::{SceneDocument, SceneError};
use super::schema::{self, KeyKind, SceneKey};
use crate::toml_keys;

/// One table, all of whose keys are known.
#[derive(Debug, Clone, Copy)]
pub(super) struct SceneTable<'t> {
    document: SceneDocument<'t>,
    entries: &'t DeTable<'t>,
    /// Name of the table in the schema.
    name: &'static str,
    /// Start of the table in the text (byte).
    at: usize,
}

type SceneValue<'t> = &'t Spanned<DeValue<'t>>;

impl<'t> SceneTable<'t> {
    /// A table whose keys are checked against the schema's table of this name.
    pub fn open(
        document: SceneDocument<'t>,
        entries: &'t DeTable<'t>,
        name: &'static str,
        at: usize,
    ) -> Result<Self, SceneError> {
        let known: Vec<&str> = schema::of(name).map(|key| key.name).collect();
        let place = if name.is_empty() { "a scene".to_owned() } else { format!("[{name}]") };
        toml_keys::check(entries, &place, &known).map_err(|unknown| document.error(unknown.at, unknown.message))?;
        Ok(Self { document, entries, name, at })
    }

    /// Whether the key is there.
    pub fn has(&self, name: &str) -> bool {
        self.entries.contains_key(name)
    }

    /// Whether the key holds a table.
    pub fn is_table(&self, name: &str) -> bool {
        self.entries.get(name).is_some_and(|v| v.get_ref().is_table())
    }

    /// An error at the value of a key, or at the table where it is not there. `says` follows the key's name.
    pub fn wrong(&self, name: &str, problem: impl AsRef<str>) -> SceneError {
        let at = self.entries.get(name).map_or(self.at, |v| v.span().start);
        self.document.error(at, format!("{} {}", key(self.name, name).path(), problem.as_ref()))
    }

    /// An error about the table as a whole.
    pub fn error(&self, problem: impl Into<String>) -> SceneError {
        self.document.error(self.at, problem)
    }

    fn find(&self, name: &str) -> Option<(SceneValue<'t>, &'static SceneKey)> {
        self.entries.get(name).map(|value| (value, key(self.name, name)))
    }

    fn refuse(&self, at: Range<usize>, key: &SceneKey) -> SceneError {
        let given: String = self.document.text.get(at.clone()).unwrap_or_default().chars().take(40).collect();
        self.document.error(at.start, format!("{} is {given}; give {}", key.path(), key.takes()))
    }

    fn missing(&self, name: &str) -> SceneError {
        let key = key(self.name, name);
        self.document.error(self.at, format!("{} is missing; give {}", key.path(), key.takes()))
    }

    /// A number, or the schema's default.
    pub fn number(&self, name: &str) -> Result<f64, SceneError> {
        match self.maybe_number(name)? {
            Some(number) => Ok(number),
            None => key(self.name, name).default.parse().map_err(|_| self.missing(name)),
        }
    }

    /// A number that has to be there.
    pub fn needed(&self, name: &str) -> Result<f64, SceneError> {
        self.maybe_number(name)?.ok_or_else(|| self.missing(name))
    }

    /// A number, if it is there.
    pub fn maybe_number(&self, name: &str) -> Result<Option<f64>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(None) };
        let KeyKind::Number(low, high) = key.kind else { return Ok(None) };
        let number = number(value.get_ref()).filter(|n| (low..=high).contains(n));
        number.map(Some).ok_or_else(|| self.refuse(value.span(), key))
    }

    /// A whole number, if it is there.
    pub fn maybe_count(&self, name: &str) -> Result<Option<u32>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(None) };
        let KeyKind::Count(low, high) = key.kind else { return Ok(None) };
        let count = whole(value.get_ref()).filter(|n| (low..=high).contains(n)).and_then(|n| u32::try_from(n).ok());
        count.map(Some).ok_or_else(|| self.refuse(value.span(), key))
    }

    /// A whole number that has to be there.
    pub fn count(&self, name: &str) -> Result<u32, SceneError> {
        self.maybe_count(name)?.ok_or_else(|| self.missing(name))
    }

    /// Three numbers, or the schema's default.
    pub fn vector(&self, name: &str) -> Result<Vec3, SceneError> {
        let Some((value, key)) = self.find(name) else {
            let default = key(self.name, name).default.trim_matches(['[', ']']);
            let parts = default.split(',').filter_map(|x| x.trim().parse().ok()).collect::<Vec<f32>>();
            return <[f32; 3]>::try_from(parts).map(Vec3::from_array).map_err(|_| self.missing(name));
        };
        let KeyKind::Vector(limit) = key.kind else { return Err(self.refuse(value.span(), key)) };
        vector(value.get_ref(), limit).map(DVec3::as_vec3).ok_or_else(|| self.refuse(value.span(), key))
    }

    /// Two corners of a box, the lower first in every coordinate, if it is there.
    pub fn corners(&self, name: &str) -> Result<Option<[Vec3; 2]>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(None) };
        let parts = value.get_ref().as_array().filter(|a| a.len() == 2);
        let corner = |a: &DeArray<'_>, i: usize| vector(a[i].get_ref(), schema::FAR_M).map(DVec3::as_vec3);
        let pair = parts.and_then(|a| corner(a, 0).zip(corner(a, 1)));
        let (a, b) = pair.ok_or_else(|| self.refuse(value.span(), key))?;
        Ok(Some([a.min(b), a.max(b)]))
    }

    /// Indices below `count`, if they are there.
    pub fn vertices(&self, name: &str, count: usize) -> Result<Option<Vec<usize>>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(None) };
        let list = value.get_ref().as_array().ok_or_else(|| self.refuse(value.span(), key))?;
        let mut found = Vec::new();
        for item in list {
            let (low, high) = range(item.get_ref()).ok_or_else(|| self.refuse(item.span(), key))?;
            if high >= count || low > high {
                let problem = format!("{} names vertex {high} of {count}; count from 0 to {}", key.path(), count - 1);
                return Err(self.document.error(item.span().start, problem));
            }
            found.extend(low..=high);
        }
        Ok(Some(found))
    }

    /// Pairs of indices below `count`.
    pub fn pairs(&self, name: &str, count: usize) -> Result<Vec<[u8; 2]>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(Vec::new()) };
        let list = value.get_ref().as_array().ok_or_else(|| self.refuse(value.span(), key))?;
        let pair = |item: SceneValue<'t>| {
            let ends = item.get_ref().as_array().filter(|a| a.len() == 2);
            let end = |i: usize| whole(ends?[i].get_ref());
            let (a, b) = end(0).zip(end(1)).ok_or_else(|| self.refuse(item.span(), key))?;
            if a.max(b) >= count as u64 {
                let problem = format!("{} names sphere {}, but there are {count}; count from 0", key.path(), a.max(b));
                return Err(self.document.error(item.span().start, problem));
            }
            Ok([a as u8, b as u8])
        };
        list.iter().map(pair).collect()
    }

    /// A text, if it is there.
    pub fn text(&self, name: &str) -> Result<Option<&'t str>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(None) };
        let text = value.get_ref().as_str().filter(|t| !t.trim().is_empty());
        text.map(Some).ok_or_else(|| self.refuse(value.span(), key))
    }

    /// One of the schema's words, or its default; the index among them.
    pub fn choice(&self, name: &str) -> Result<Option<usize>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(None) };
        let KeyKind::Choice(words) = key.kind else { return Ok(None) };
        let word = value.get_ref().as_str().and_then(|w| words.iter().position(|known| *known == w));
        word.map(Some).ok_or_else(|| self.refuse(value.span(), key))
    }

    /// True or false, or the default.
    pub fn flag(&self, name: &str) -> Result<bool, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(key(self.name, name).default == "true") };
        value.get_ref().as_bool().ok_or_else(|| self.refuse(value.span(), key))
    }

    /// The table of a key, if it is there and is one.
    pub fn table(&self, name: &str) -> Result<Option<Self>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(None) };
        let (KeyKind::Table(opens) | KeyKind::TextOrTable(opens)) = key.kind else { return Ok(None) };
        let entries = value.get_ref().as_table().ok_or_else(|| self.refuse(value.span(), key))?;
        Self::open(self.document, entries, opens, value.span().start).map(Some)
    }

    /// The tables of a key: none, one, or several.
    pub fn tables(&self, name: &str) -> Result<Vec<Self>, SceneError> {
        let Some((value, key)) = self.find(name) else { return Ok(Vec::new()) };
        let KeyKind::Tables(opens) = key.kind else { return Ok(Vec::new()) };
        let open = |v: SceneValue<'t>| match v.get_ref().as_table() {
            Some(entries) => Self::open(self.document, entries, opens, v.span().start),
            None => Err(self.refuse(v.span(), key)),
        };
        match value.get_ref().as_array() {
            Some(list) => list.iter().map(open).collect(),
            None => Ok(vec![open(value)?]),
        }
    }
}

/// The schema's key. The readers ask only for names that they know.
fn key(table: &'static str, name: &str) -> &'static SceneKey {
    schema::of(table).find(|k| k.name == name).expect("the readers and the schema have the same keys")
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(f) => f.as_str().parse().ok(),
        DeValue::Integer(_) => signed(value).map(|i| i as f64),
        _ => None,
    }
}

fn signed(value: &DeValue<'_>) -> Option<i64> {
    value.as_integer().and_then(|i| i64::from_str_radix(i.as_str(), i.radix()).ok())
}

fn whole(value: &DeValue<'_>) -> Option<u64> {
    signed(value).and_then(|i| u64::try_from(i).ok())
}

/// Three finite numbers, none farther from 0 than `limit`.
fn vector(value: &DeValue<'_>, limit: f64) -> Option<DVec3> {
    let parts: Option<Vec<f64>> = value.as_array()?.iter().map(|v| number(v.get_ref())).collect();
    let v = <[f64; 3]>::try_from(parts?).map(DVec3::from_array).ok()?;
    (v.abs().max_element() <= limit).then_some(v)
}

/// An index, or the first and last index of a text such as "3-9".
fn range(value: &DeValue<'_>) -> Option<(usize, usize)> {
    if let Some(text) = value.as_str() {
        let (low, high) = text.split_once('-')?;
        return Some((low.trim().parse().ok()?, high.trim().parse().ok()?));
    }
    let index = usize::try_from(whole(value)?).ok()?;
    Some((index, index))
}
