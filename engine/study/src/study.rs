//! A study: people x garments x sizes x poses, each try-on a row that is a function of the study and its number alone.

use std::path::{Path, PathBuf};

use serde_json::json;
use toile_assets::sizes::Girth;
use toile_base::body::{Body, Measures};
use toile_base::limits::STEP_HZ;
use toile_base::rig::Rig;
use toile_engine::cloth::{Quality, Settings};
use toile_track::estimate::Estimate;
use toile_track::measure::Measurements;
use toile_track::recommend::Recommendation;

use crate::digest;
use crate::drape::{self, Draped, TriedPose, WornFrame};
use crate::error::{Result, StudyError};
use crate::garments::{DrapeStart, GarmentNote, TriedGarment};
use crate::parquet_file::{self, Notes};
use crate::population::{Person, Population};
use crate::row::StudyRow;
use crate::sensor::{Sensor, exact};
use crate::study_file::{PhysicsMode, StudyFile, WantedPhysics, one_of};

/// Version of the rows' columns and of what they mean.
pub const SCHEMA: &str = "toile.study/1";

/// Which sizes of a garment are draped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DrapedSizes {
    Recommended,
    Near,
    All,
}

/// How try-ons are draped.
#[derive(Debug, Clone, PartialEq)]
struct Physics {
    /// The first so many people are.
    people: u64,
    sizes: DrapedSizes,
    poses: Vec<TriedPose>,
    start: DrapeStart,
    settings: Settings,
    settle: usize,
    compare: u64,
    compare_steps: usize,
}

/// A study, open: all that its rows are made of.
#[derive(Debug)]
pub struct Study {
    file: StudyFile,
    text: String,
    path: PathBuf,
    population: Population,
    garments: Vec<TriedGarment>,
    sensor: Sensor,
    physics: Physics,
    hashes: Vec<Option<String>>,
    digest: String,
}

/// How a garment suits a person, whatever the size of the row.
struct Judged {
    best: Option<String>,
    seen: Option<Recommendation>,
    by_table: Option<String>,
}

impl Study {
    /// Opens a study's file with all that it names.
    ///
    /// # Errors
    /// What of it cannot be used: file, place and cure.
    pub fn open(path: &Path) -> Result<Self> {
        let (file, text) = StudyFile::read(path)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_path_buf();
        let named = |e: StudyError| match e {
            StudyError::Input(why) => StudyError::Input(format!("{}: {why}", path.display())),
            other => other,
        };
        let garments: Vec<TriedGarment> =
            file.garment.iter().map(|g| TriedGarment::open(g, &folder)).collect::<Result<_>>().map_err(named)?;
        let names: Vec<&str> = garments.iter().map(|g| g.name.as_str()).collect();
        if let Some(twice) = (1..names.len()).find(|i| names[..*i].contains(&names[*i])) {
            let name = names[twice];
            return Err(named(StudyError::Input(format!(
                "the garment {name} is named twice; name it once, in all its sizes"
            ))));
        }
        let population = Population::open(&file.population, file.seed, &folder).map_err(named)?;
        let sensor = Sensor::open(&file.sensor, file.seed).map_err(named)?;
        let physics = Physics::open(&file.physics, population.people()).map_err(|why| named(StudyError::Input(why)))?;
        let bytes: Vec<Option<Vec<u8>>> =
            file.garment.iter().map(|g| std::fs::read(folder.join(&g.name)).ok()).collect();
        let hashes: Vec<Option<String>> = bytes.iter().map(|b| b.as_deref().map(digest::of_bytes)).collect();
        let mut parts: Vec<&[u8]> =
            vec![SCHEMA.as_bytes(), env!("CARGO_PKG_VERSION").as_bytes(), text.as_bytes(), &population.source];
        parts.extend(hashes.iter().map(|hash| hash.as_deref().unwrap_or_default().as_bytes()));
        let digest = digest::of_parts(&parts);
        let path = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        Ok(Self { file, text, path, population, garments, sensor, physics, hashes, digest })
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.file.name
    }

    /// Where its file lies.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of people.
    pub const fn people(&self) -> u64 {
        self.population.people()
    }

    /// Number of rows.
    pub fn rows(&self) -> u64 {
        self.people() * self.rows_a_person()
    }

    /// Rows of each person: every garment in every size and pose.
    pub fn rows_a_person(&self) -> u64 {
        (self.garments.iter().map(|g| g.tried.len()).sum::<usize>() * self.physics.poses.len()) as u64
    }

    /// SHA-256 of all that its rows depend on: the file, the tables and garments that it names, and the version.
    pub fn digest(&self) -> &str {
        &self.digest
    }

    /// People whose rows are computed and kept together.
    pub const fn people_a_chunk(&self) -> u64 {
        // Some minutes of physics, or some seconds without.
        if self.physics.people > 0 { 4 } else { 512 }
    }

    /// The garments.
    pub fn garments(&self) -> &[TriedGarment] {
        &self.garments
    }

    /// A person of its population.
    pub fn person(&self, number: u64) -> Person {
        self.population.person(number)
    }

    /// What stands in its Parquet files besides rows.
    pub fn notes(&self) -> Notes {
        let garments: Vec<GarmentNote> =
            self.garments.iter().zip(&self.hashes).map(|(g, h)| g.note(h.clone())).collect();
        let sensor = self.sensor.sigma_mm().into_iter().map(|(name, mm)| (name.to_owned(), json!(mm))).collect();
        let text = |value: serde_json::Value| value.to_string();
        [
            ("toile.schema", SCHEMA.to_owned()),
            ("toile.version", env!("CARGO_PKG_VERSION").to_owned()),
            ("toile.study_sha256", self.digest.clone()),
            ("toile.study", self.text.clone()),
            ("toile.name", self.file.name.clone()),
            ("toile.seed", self.file.seed.to_string()),
            ("toile.people", self.people().to_string()),
            ("toile.rows", self.rows().to_string()),
            ("toile.garments", text(json!(garments))),
            ("toile.sensor_sigma_mm", text(serde_json::Value::Object(sensor))),
        ]
        .map(|(key, value)| (key.to_owned(), value))
        .to_vec()
    }

    /// One row, whatever others were asked for.
    ///
    /// # Errors
    /// A number out of range; measures that no body has.
    pub fn row(&self, number: u64) -> Result<StudyRow> {
        if number >= self.rows() {
            let rows = self.rows();
            return Err(StudyError::Input(format!("there is no row {number}: the study has {rows}, counted from 0")));
        }
        let each = self.rows_a_person();
        let mut found = self.rows_of(number / each, Some((number % each) as usize))?;
        found.pop().ok_or_else(|| StudyError::Internal("a row is missing".to_owned()))
    }

    /// One row as a Parquet file, with the study's notes.
    ///
    /// # Errors
    /// As [`Self::row`].
    pub fn row_bytes(&self, number: u64) -> Result<Vec<u8>> {
        parquet_file::bytes_of([self.row(number)?], &self.notes())
    }

    /// All rows of a person, in their order.
    ///
    /// # Errors
    /// Measures that no body has.
    pub fn person_rows(&self, person: u64) -> Result<Vec<StudyRow>> {
        self.rows_of(person, None)
    }

    /// The rows of a person, or the one at a place among them.
    fn rows_of(&self, number: u64, only: Option<usize>) -> Result<Vec<StudyRow>> {
        let person = self.population.person(number);
        let exactly = exact(&person.measures);
        let seen = self.sensor.see(number, &person.measures);
        let first = StudyRow { row: (number * self.rows_a_person()) as i64, ..described(&person, &seen) };
        let (mut rows, mut body) = (Vec::new(), None);
        let mut place = 0;
        for garment in &self.garments {
            let here = place..place + garment.tried.len() * self.physics.poses.len();
            if only.is_some_and(|only| !here.contains(&only)) {
                place = here.end;
                continue;
            }
            let judged = match garment.is_for(person.sex) {
                false => None,
                true => Some(Judged {
                    best: Some(garment.offer.judge(None, &exactly)?.size),
                    seen: Some(garment.offer.judge(None, &seen)?),
                    by_table: garment.by_table(&person.measures).map(str::to_owned),
                }),
            };
            for size in &garment.tried {
                for pose in &self.physics.poses {
                    if only.is_none_or(|only| only == place) {
                        let row = StudyRow { row: first.row + place as i64, ..first.clone() };
                        let mut row = sized(row, garment, *size, *pose, &person.measures, judged.as_ref());
                        if judged.is_some() && self.is_draped(number, garment, *size, row.best_size.as_deref()) {
                            self.drape(&mut row, &person, garment, *pose, &mut body)?;
                        }
                        rows.push(row);
                    }
                    place += 1;
                }
            }
        }
        Ok(rows)
    }

    fn is_draped(&self, person: u64, garment: &TriedGarment, size: usize, best: Option<&str>) -> bool {
        let at = garment.offer.sizes.iter().position(|made| Some(made.code.as_str()) == best);
        let near = |by: usize| at.is_some_and(|at| at.abs_diff(size) <= by);
        person < self.physics.people
            && match self.physics.sizes {
                DrapedSizes::Recommended => near(0),
                DrapedSizes::Near => near(1),
                DrapedSizes::All => true,
            }
    }

    /// Adds to a row what physics says.
    fn drape(
        &self,
        row: &mut StudyRow,
        person: &Person,
        garment: &TriedGarment,
        pose: TriedPose,
        kept: &mut Option<(Body, Rig)>,
    ) -> Result<()> {
        if kept.is_none() {
            let body = person.body()?;
            let rig = toile_assets::rig::fit(&body);
            *kept = Some((body, rig));
        }
        let Some((body, rig)) = kept else { return Ok(()) };
        let Physics { start, settings, settle, compare, compare_steps, .. } = &self.physics;
        let size = row.size.clone();
        let put_on = |start, settle| WornFrame::put_on((body, rig), (garment, &size, start), pose, (*settings, settle));
        let worn = put_on(*start, *settle);
        let mut worn = match worn {
            Ok(worn) => worn,
            // Of one body in a thousand a garment cannot be laid on: the row says so, and the study goes on.
            Err(why) => {
                row.trouble = Some(why.to_string());
                return Ok(());
            }
        };
        let draped = worn.look();
        filled(row, &draped);
        if person.number < *compare
            && let Ok(mut full) = put_on(DrapeStart::Panels, settle + compare_steps)
        {
            let [mean, p99] = drape::moved(&worn.positions(), &full.positions());
            let then = full.look();
            let change = draped.worn_ease.iter().zip(&then.worn_ease).filter_map(|(a, b)| Some(((*a)? - (*b)?).abs()));
            row.unsettled_mean_mm = mm(Some(mean));
            row.unsettled_p99_mm = mm(Some(p99));
            row.unsettled_ease_mm = mm(change.reduce(f64::max));
            row.settled_pulls = Some(then.pulls());
        }
        Ok(())
    }

    /// A person in a garment's size as they stand once it has settled, for pictures.
    ///
    /// # Errors
    /// A garment that cannot be laid on their body.
    pub fn worn_by(&self, person: u64, garment: usize, size: &str) -> Result<WornFrame> {
        let body = self.population.person(person).body()?;
        let Physics { start, settings, settle, .. } = &self.physics;
        let on = (&body, &toile_assets::rig::fit(&body));
        WornFrame::put_on(on, (&self.garments[garment], size, *start), TriedPose::Standing, (*settings, *settle))
    }
}

impl Physics {
    fn open(wanted: &WantedPhysics, people: u64) -> std::result::Result<Self, String> {
        let known = TriedPose::ALL.map(TriedPose::name);
        let pose = |word: &String| {
            one_of("[physics] poses", word, &known)?;
            TriedPose::ALL.into_iter().find(|pose| pose.name() == word).ok_or_else(String::new)
        };
        let poses: Vec<TriedPose> = wanted.poses.iter().map(pose).collect::<std::result::Result<_, _>>()?;
        one_of("[physics] quality", &wanted.quality, &Quality::ALL.map(Quality::name))?;
        let quality: Quality = wanted.quality.parse()?;
        one_of("[physics] start", &wanted.start, &DrapeStart::ALL.map(DrapeStart::name))?;
        let start = DrapeStart::ALL.into_iter().find(|start| start.name() == wanted.start).unwrap_or(DrapeStart::Size);
        let drapes = wanted.mode == PhysicsMode::Drape;
        if !drapes && poses != [TriedPose::Standing] {
            return Err("[physics] poses are tried by physics alone; say mode = \"drape\" or leave them out".to_owned());
        }
        let steps = |seconds: f64| (seconds * f64::from(STEP_HZ)).round() as usize;
        Ok(Self {
            people: if drapes { wanted.people.unwrap_or(people).min(people) } else { 0 },
            sizes: match wanted.sizes.as_str() {
                "recommended" => DrapedSizes::Recommended,
                "all" => DrapedSizes::All,
                _ => DrapedSizes::Near,
            },
            poses,
            // A try-on is one core's; others take other people.
            settings: Settings { quality, workers: 1, ..Settings::default() },
            start,
            settle: steps(wanted.settle_s),
            compare: wanted.compare,
            compare_steps: steps(wanted.compare_s),
        })
    }
}

/// Millimetres to a thousandth; none of what is not finite.
fn mm(metres: Option<f64>) -> Option<f64> {
    metres.filter(|m| m.is_finite()).map(|m| (m * 1e6).round() / 1e3)
}

/// A share to a millionth.
fn share(value: f64) -> Option<f64> {
    value.is_finite().then_some((value * 1e6).round() / 1e6)
}

/// Who a row is of, and what is seen of them.
fn described(person: &Person, seen: &Measurements) -> StudyRow {
    let of = |m: f32| mm(Some(f64::from(m))).unwrap_or_default();
    let seen_mm = |e: Option<Estimate>| e.map_or(0.0, |e| of(e.value));
    let m = &person.measures;
    StudyRow {
        person: person.number as i64,
        weight: person.weight,
        sex: person.sex.name().to_owned(),
        stature_mm: of(m.stature),
        shoulder_breadth_mm: of(m.shoulder_breadth),
        chest_mm: of(m.chest_girth),
        waist_mm: of(m.waist_girth),
        hip_mm: of(m.hip_girth),
        seen_chest_mm: seen_mm(seen.measures.chest_girth),
        seen_waist_mm: seen_mm(seen.measures.waist_girth),
        seen_hip_mm: seen_mm(seen.measures.hip_girth),
        ..StudyRow::default()
    }
}

/// A row in its size and pose, with what girths alone say.
fn sized(
    row: StudyRow,
    garment: &TriedGarment,
    size: usize,
    pose: TriedPose,
    body: &Measures,
    judged: Option<&Judged>,
) -> StudyRow {
    let mut row = StudyRow {
        garment: garment.name.clone(),
        size: garment.offer.sizes[size].code.clone(),
        pose: pose.name().to_owned(),
        offered: judged.is_some(),
        ..row
    };
    let Some(judged) = judged else { return row };
    row.best_size.clone_from(&judged.best);
    row.seen_size = judged.seen.as_ref().map(|seen| seen.size.clone());
    row.seen_probability = judged.seen.as_ref().and_then(|seen| share(f64::from(seen.probability)));
    row.table_size.clone_from(&judged.by_table);
    row.fits = true;
    for zone in garment.eases(size, body) {
        let (ease, verdict) = match zone.zone {
            Girth::Chest => (&mut row.chest_ease_mm, &mut row.chest_verdict),
            Girth::Waist => (&mut row.waist_ease_mm, &mut row.waist_verdict),
            Girth::Hip => (&mut row.hip_ease_mm, &mut row.hip_verdict),
        };
        *ease = mm(Some(f64::from(zone.ease)));
        *verdict = zone.verdict().map(str::to_owned);
        row.fits &= zone.verdict().is_none_or(|v| v == "good");
    }
    row
}

/// A row with what physics says.
fn filled(row: &mut StudyRow, draped: &Draped) {
    row.draped = true;
    [row.chest_worn_ease_mm, row.waist_worn_ease_mm, row.hip_worn_ease_mm] = draped.worn_ease.map(mm);
    [row.chest_gap_mm, row.waist_gap_mm, row.hip_gap_mm] = draped.gap.map(mm);
    let stretch = draped.stretch.map(|s| s.and_then(share));
    [row.sleeves_stretch, row.chest_stretch, row.waist_stretch, row.hip_stretch, row.legs_stretch] = stretch;
    row.comfortable_stretch = share(draped.comfortable);
    row.pulls = Some(draped.pulls());
    [row.hem_height_mm, row.hem_radius_mm, row.hem_folds_mm] =
        draped.hem.map_or([None; 3], |hem| hem.map(|metres| mm(Some(metres))));
    [row.strain_mean, row.strain_p99] = draped.strain.map(share);
    row.penetration_mm = mm(Some(draped.penetration));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(name: &str, text: &str) -> Study {
        let folder = std::env::temp_dir().join(format!("toile-study-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("study.toml");
        std::fs::write(&path, text).unwrap();
        let study = Study::open(&path).unwrap();
        std::fs::remove_dir_all(folder).unwrap();
        study
    }

    const SMALL: &str = "name = \"small\"\nseed = 4\n[[garment]]\nname = \"tee\"\n[[garment]]\nname = \"pencil-skirt\"\n\
        sizes = [\"38\", \"40\"]\n[population]\nfrom = \"ansur\"\npeople = 6\nwomen = 0.5\n";

    #[test]
    fn a_row_is_a_function_of_study_and_number() {
        let study = opened("rows", SMALL);
        let all: Vec<StudyRow> = (0..6).flat_map(|person| study.person_rows(person).unwrap()).collect();
        assert_eq!(all.len() as u64, study.rows());
        for number in [all.len() - 1, 3, 17] {
            assert_eq!(study.row(number as u64).unwrap(), all[number]);
            assert_eq!(all[number].row, number as i64);
        }
        assert!(study.row(study.rows()).is_err());
        let mut people = all.iter().filter(|r| r.garment == "pencil-skirt");
        assert!(people.all(|r| r.offered == (r.sex == "female") && (r.offered || r.best_size.is_none())));
    }

    #[test]
    fn what_the_rows_depend_on_is_in_the_digest() {
        let digest = |text: &str| opened("digest", text).digest().to_owned();
        assert_eq!(digest(SMALL), digest(SMALL));
        assert_ne!(digest(SMALL), digest(&SMALL.replace("seed = 4", "seed = 5")));
    }

    #[test]
    fn a_try_on_is_draped_and_says_how_it_hangs() {
        let physics =
            "[physics]\nmode = \"drape\"\npeople = 1\nsizes = \"recommended\"\ncompare = 1\ncompare_s = 0.25\n";
        let text = SMALL.replace("women = 0.5", "women = 1.0").replace("[[garment]]\nname = \"tee\"\n", "");
        let study = opened("drape", &format!("{text}{physics}"));
        let rows = study.person_rows(0).unwrap();
        let Some(row) = rows.iter().find(|r| r.best_size.as_deref() == Some(&r.size)) else {
            assert!(rows.iter().all(|r| !r.draped), "nothing but the recommended size is draped");
            return;
        };
        assert!(row.draped, "{:?}", row.trouble);
        let (by_girth, worn) = (row.hip_ease_mm.unwrap(), row.hip_worn_ease_mm.unwrap());
        assert!((by_girth - worn).abs() < 40.0, "the same garment: {by_girth} and {worn}");
        assert!(row.strain_p99.unwrap() < 0.2 && row.hip_gap_mm.unwrap() > 0.0, "{row:?}");
        assert!(row.chest_worn_ease_mm.is_none() && row.unsettled_mean_mm.unwrap() < 20.0);
        assert!(study.person_rows(1).unwrap().iter().all(|r| !r.draped));
        assert_eq!(study.row(row.row as u64).unwrap(), *row);
    }
}
