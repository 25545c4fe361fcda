//! The folder of a study: chunks of rows by their content, written whole or not at all; the file that they are merged to.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::digest;
use crate::error::{Result, StudyError};
use crate::parquet_file::{self, Notes, RowWriter};
use crate::study::Study;

/// Which part of a study is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub number: u64,
    /// How many there are.
    pub of: u64,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Reads `2/8`.
    ///
    /// # Errors
    /// Anything else.
    pub fn parse(text: &str) -> std::result::Result<Self, String> {
        let parts = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match parts {
            Some((number, of)) if number >= 1 && number <= of => Ok(Self { number, of }),
            _ => Err(format!("{text:?} is no part of a whole; give such as 2/8, the second of eight")),
        }
    }

    /// The chunks of this shard.
    const fn chunks(self, of_all: u64) -> Range<u64> {
        of_all * (self.number - 1) / self.of..of_all * self.number / self.of
    }
}

/// What a folder says of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Manifest {
    schema: String,
    version: String,
    study_sha256: String,
    study: PathBuf,
    people: u64,
    rows: u64,
    people_a_chunk: u64,
    notes: Notes,
}

/// What became of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// The shard's number, from 1.
    pub shard: u64,
    /// How many shards there are.
    pub of: u64,
    /// Whether it came to its end.
    pub done: bool,
    /// Rows of the shard.
    pub rows: u64,
    /// Rows that earlier runs had done.
    pub kept: u64,
    /// Try-ons that this run simulated.
    pub draped: u64,
    /// Threads that worked.
    pub workers: usize,
    /// Time that it took (s).
    pub seconds: f64,
}

/// What a merge gives.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Merged {
    /// The Parquet file of all rows.
    pub file: PathBuf,
    /// Its SHA-256.
    pub sha256: String,
    /// Number of its rows.
    pub rows: u64,
}

/// A folder in use by this process.
#[derive(Debug)]
pub struct StudyFolder {
    path: PathBuf,
    manifest: Manifest,
    /// Released by the system when the process ends, however it does.
    _locks: Vec<File>,
}

impl StudyFolder {
    /// Takes a folder for a shard of a study; it is made if missing.
    ///
    /// # Errors
    /// A folder that cannot be written, holds another study or is in use.
    pub fn take(path: &Path, study: &Study, shard: Shard) -> Result<Self> {
        for folder in [path.to_path_buf(), path.join("chunks"), path.join("runs")] {
            fs::create_dir_all(&folder).map_err(|e| StudyError::unwritten(&folder, &e))?;
        }
        let whole = shard == Shard::WHOLE;
        let mut locks = vec![locked(path, "lock", whole)?];
        if !whole {
            locks.push(locked(path, &format!("lock-{}-of-{}", shard.number, shard.of), true)?);
        }
        let manifest = Manifest {
            schema: crate::study::SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            study_sha256: study.digest().to_owned(),
            study: study.path().to_path_buf(),
            people: study.people(),
            rows: study.rows(),
            people_a_chunk: study.people_a_chunk(),
            notes: study.notes(),
        };
        let place = path.join("study.json");
        if place.exists() {
            let found = read_manifest(&place)?;
            if found.study_sha256 != manifest.study_sha256 {
                return Err(StudyError::Input(format!(
                    "{} holds rows of another study, or of one that has been changed or made by version {} (SHA-256 {}, not {}); \
                     give another --out, or delete the folder",
                    path.display(),
                    found.version,
                    &found.study_sha256[..12.min(found.study_sha256.len())],
                    &manifest.study_sha256[..12]
                )));
            }
        } else {
            let text = serde_json::to_vec_pretty(&manifest).map_err(StudyError::internal)?;
            write_whole(&place, &text)?;
        }
        Ok(Self { path: path.to_path_buf(), manifest, _locks: locks })
    }

    /// Opens a folder in which a study has been computed.
    ///
    /// # Errors
    /// A folder that holds no study, or is in use.
    pub fn open(path: &Path) -> Result<Self> {
        let place = path.join("study.json");
        if !place.exists() {
            let shown = path.display();
            return Err(StudyError::Input(format!(
                "{shown} holds no study; make one by `toile study STUDY.toml --out {shown}`"
            )));
        }
        let locks = vec![locked(path, "lock", true)?];
        Ok(Self { path: path.to_path_buf(), manifest: read_manifest(&place)?, _locks: locks })
    }

    /// The study's file, where it lay when the folder was made.
    pub fn study_path(&self) -> &Path {
        &self.manifest.study
    }

    /// SHA-256 of the study whose rows it holds.
    pub fn digest(&self) -> &str {
        &self.manifest.study_sha256
    }

    /// The Parquet file of all rows.
    pub fn rows_file(&self) -> PathBuf {
        self.path.join("rows.parquet")
    }

    fn chunk_count(&self) -> u64 {
        self.manifest.people.div_ceil(self.manifest.people_a_chunk)
    }

    /// Computes what is missing of a shard; `progress` is called with the rows that each chunk adds.
    ///
    /// # Errors
    /// A person or garment that cannot be used, a disk that is full: what is done is kept.
    pub fn run(
        &self,
        study: &Study,
        shard: Shard,
        workers: usize,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<RunReport> {
        let begun = Instant::now();
        let each = study.rows_a_person();
        let chunks = shard.chunks(self.chunk_count());
        let people = |chunk: u64| {
            let first = chunk * self.manifest.people_a_chunk;
            first..(first + self.manifest.people_a_chunk).min(self.manifest.people)
        };
        let rows_of = |chunk: u64| (people(chunk).end - people(chunk).start) * each;
        let there = self.sound_chunks()?;
        let missing: Vec<u64> = chunks.clone().filter(|chunk| !there.contains_key(chunk)).collect();
        let mut report = RunReport {
            shard: shard.number,
            of: shard.of,
            done: false,
            rows: chunks.clone().map(rows_of).sum(),
            kept: chunks.filter(|chunk| there.contains_key(chunk)).map(rows_of).sum(),
            draped: 0,
            workers,
            seconds: 0.0,
        };
        progress(report.kept);
        self.record(&report)?;
        let (next, draped, failed) = (AtomicUsize::new(0), AtomicU64::new(0), Mutex::new(None));
        let work = || {
            // Relaxed: only the number handed out matters, and the scope's end orders all else.
            while let Some(chunk) = missing.get(next.fetch_add(1, Ordering::Relaxed)) {
                match self.chunk(study, *chunk, people(*chunk)) {
                    Ok(count) => {
                        draped.fetch_add(count, Ordering::Relaxed);
                        progress(rows_of(*chunk));
                    }
                    Err(error) => {
                        next.store(missing.len(), Ordering::Relaxed);
                        failed.lock().unwrap_or_else(std::sync::PoisonError::into_inner).get_or_insert(error);
                    }
                }
            }
        };
        std::thread::scope(|scope| {
            let others: Vec<_> = (1..workers.max(1)).map(|_| scope.spawn(work)).collect();
            work();
            drop(others);
        });
        if let Some(error) = failed.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner) {
            return Err(error);
        }
        (report.done, report.draped, report.seconds) = (true, draped.into_inner(), begun.elapsed().as_secs_f64());
        // A run that found all done says nothing of speed: what an earlier one said stays.
        if !missing.is_empty()
            || !self.runs()?.iter().any(|r| (r.shard, r.of, r.done) == (shard.number, shard.of, true))
        {
            self.record(&report)?;
        }
        Ok(report)
    }

    /// Computes a chunk and writes it; the number of its try-ons that were simulated.
    fn chunk(&self, study: &Study, chunk: u64, people: Range<u64>) -> Result<u64> {
        let mut rows = Vec::new();
        for person in people {
            rows.extend(study.person_rows(person)?);
        }
        let draped = rows.iter().filter(|row| row.draped).count() as u64;
        let bytes = parquet_file::bytes_of(rows, &self.manifest.notes)?;
        let name = format!("{chunk:08}-{}.parquet", &digest::of_bytes(&bytes)[..16]);
        write_whole(&self.path.join("chunks").join(name), &bytes)?;
        Ok(draped)
    }

    /// The chunks whose content is what their name says; the others are taken away.
    fn sound_chunks(&self) -> Result<BTreeMap<u64, PathBuf>> {
        let folder = self.path.join("chunks");
        let refused = |e: std::io::Error| StudyError::Input(format!("{} cannot be read ({e})", folder.display()));
        let mut found = BTreeMap::new();
        for entry in fs::read_dir(&folder).map_err(refused)? {
            let path = entry.map_err(refused)?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let parts = name.strip_suffix(".parquet").and_then(|stem| stem.split_once('-'));
            let Some((chunk, hash)) = parts.and_then(|(chunk, hash)| Some((chunk.parse::<u64>().ok()?, hash))) else {
                continue;
            };
            let bytes = fs::read(&path).map_err(refused)?;
            if digest::of_bytes(&bytes)[..16] == *hash {
                found.insert(chunk, path);
            } else {
                // Half-written, or spoilt: it is computed again.
                let _ = fs::remove_file(&path);
            }
        }
        Ok(found)
    }

    /// What runs have said of themselves.
    ///
    /// # Errors
    /// A folder that cannot be read.
    pub fn runs(&self) -> Result<Vec<RunReport>> {
        let folder = self.path.join("runs");
        let refused = |e: std::io::Error| StudyError::Input(format!("{} cannot be read ({e})", folder.display()));
        let mut all = Vec::new();
        for entry in fs::read_dir(&folder).map_err(refused)? {
            let text = fs::read(entry.map_err(refused)?.path()).map_err(refused)?;
            all.extend(serde_json::from_slice::<RunReport>(&text).ok());
        }
        all.sort_by_key(|run| (run.of, run.shard));
        Ok(all)
    }

    fn record(&self, run: &RunReport) -> Result<()> {
        let text = serde_json::to_vec(run).map_err(StudyError::internal)?;
        write_whole(&self.path.join("runs").join(format!("{}-of-{}.json", run.shard, run.of)), &text)
    }

    /// Merges all chunks to one file: the same bytes, however they were computed.
    ///
    /// # Errors
    /// Chunks that are missing, by the shard that computes them; a disk that is full.
    pub fn merge(&self) -> Result<Merged> {
        let there = self.sound_chunks()?;
        let missing: Vec<u64> = (0..self.chunk_count()).filter(|chunk| !there.contains_key(chunk)).collect();
        if let Some(first) = missing.first() {
            return Err(self.incomplete(*first, missing.len()));
        }
        let place = self.rows_file();
        let part = self.path.join(format!(".part-{}-rows", std::process::id()));
        let merged = self.write_rows(there.values(), &part).inspect_err(|_| _ = fs::remove_file(&part));
        let rows = merged?;
        if rows != self.manifest.rows {
            _ = fs::remove_file(&part);
            let wanted = self.manifest.rows;
            return Err(StudyError::Internal(format!("the chunks hold {rows} rows, and the study has {wanted}")));
        }
        let bytes = fs::read(&part).map_err(|e| StudyError::unwritten(&part, &e))?;
        fs::rename(&part, &place).map_err(|e| StudyError::unwritten(&place, &e))?;
        Ok(Merged { file: place, sha256: digest::of_bytes(&bytes), rows })
    }

    fn write_rows<'a>(&self, chunks: impl Iterator<Item = &'a PathBuf>, to: &Path) -> Result<u64> {
        let full = |e: &dyn std::fmt::Display| StudyError::unwritten(to, &std::io::Error::other(e.to_string()));
        let file = File::create(to).map_err(|e| StudyError::unwritten(to, &e))?;
        let mut writer = RowWriter::new(std::io::BufWriter::new(file), &self.manifest.notes).map_err(|e| full(&e))?;
        let mut rows = 0;
        for chunk in chunks {
            parquet_file::read(chunk, |row| {
                rows += 1;
                writer.push(row).map_err(|e| full(&e))
            })?;
        }
        let file = writer.finish().map_err(|e| full(&e))?;
        let file = file.into_inner().map_err(|e| full(&e.error()))?;
        file.sync_all().map_err(|e| StudyError::unwritten(to, &e))?;
        Ok(rows)
    }

    /// What is said of missing chunks: the shard that has them, where the runs say how many shards there are.
    fn incomplete(&self, chunk: u64, count: usize) -> StudyError {
        let folder = self.path.display();
        let study = self.manifest.study.display();
        let people = chunk * self.manifest.people_a_chunk;
        let of = self.runs().ok().and_then(|runs| runs.iter().map(|run| run.of).max()).unwrap_or(1);
        let shard = (1..=of).find(|number| Shard { number: *number, of }.chunks(self.chunk_count()).contains(&chunk));
        let again = match (of, shard) {
            (2.., Some(number)) => format!(
                "shard {number}/{of} is missing or was not finished: run `toile study {study} --out {folder} --shard {number}/{of}`"
            ),
            _ => format!("run `toile study {study} --out {folder}`, which goes on from there"),
        };
        let all = self.chunk_count();
        StudyError::Input(format!(
            "{folder}: {count} of {all} chunks are missing, the first from person {people} on; {again}"
        ))
    }
}

fn read_manifest(place: &Path) -> Result<Manifest> {
    let refused = |why: &dyn std::fmt::Display| {
        StudyError::Input(format!(
            "{}: it does not say which study the folder holds ({why}); give another folder",
            place.display()
        ))
    };
    let text = fs::read(place).map_err(|e| refused(&e))?;
    serde_json::from_slice(&text).map_err(|e| refused(&e))
}

/// Takes a lock of the folder, for this process alone or with others.
fn locked(folder: &Path, name: &str, alone: bool) -> Result<File> {
    let place = folder.join(name);
    let file = File::options().create(true).truncate(false).write(true).read(true).open(&place);
    let file = file.map_err(|e| StudyError::unwritten(&place, &e))?;
    match if alone { file.try_lock() } else { file.try_lock_shared() } {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(StudyError::Device(format!(
            "{} is in use by another run of a study; wait until it ends, or give another --out",
            folder.display()
        ))),
        Err(TryLockError::Error(e)) => Err(StudyError::unwritten(&place, &e)),
    }
}

/// Writes a file under another name and gives it its own once it is whole.
fn write_whole(place: &Path, bytes: &[u8]) -> Result<()> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let folder = place.parent().unwrap_or(Path::new(""));
    // Relaxed: each call has to have a number of its own, no more.
    let part = folder.join(format!(".part-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    let written = File::create(&part).and_then(|mut file| {
        file.write_all(bytes)?;
        file.sync_all()?;
        fs::rename(&part, place)
    });
    written.map_err(|e| {
        let _ = fs::remove_file(&part);
        StudyError::unwritten(place, &e)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_all_chunks_out_and_none_twice() {
        for all in [0, 1, 7, 250] {
            for of in [1, 2, 3, 16] {
                let shared: Vec<u64> = (1..=of).flat_map(|number| Shard { number, of }.chunks(all)).collect();
                assert_eq!(shared, (0..all).collect::<Vec<_>>());
            }
        }
        assert_eq!(Shard::parse("2/8"), Ok(Shard { number: 2, of: 8 }));
        for wrong in ["0/8", "9/8", "2", "a/b"] {
            assert!(Shard::parse(wrong).unwrap_err().contains("2/8"));
        }
    }
}
