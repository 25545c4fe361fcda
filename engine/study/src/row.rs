//! One row a try-on: its columns, which are those of the Parquet file.

use serde::Serialize;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers.
    Whole,
    /// Numbers, or none.
    Number,
    /// Text, or none.
    Text,
    /// Yes or no.
    Flag,
}

/// One value of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A whole number.
    Whole(i64),
    /// A number, or none.
    Number(Option<f64>),
    /// Text, or none.
    Text(Option<String>),
    /// Yes or no.
    Flag(bool),
}

/// What stands in a row.
trait Cell: Sized {
    const KIND: Kind;
    fn value(&self) -> Value;
    fn of(value: Value) -> Option<Self>;
}

macro_rules! cell {
    ($type:ty, $kind:ident, $to:expr, $from:pat => $back:expr) => {
        impl Cell for $type {
            const KIND: Kind = Kind::$kind;
            fn value(&self) -> Value {
                Value::$kind($to(self))
            }
            fn of(value: Value) -> Option<Self> {
                if let $from = value { Some($back) } else { None }
            }
        }
    };
}

cell!(i64, Whole, |v: &Self| *v, Value::Whole(v) => v);
cell!(bool, Flag, |v: &Self| *v, Value::Flag(v) => v);
cell!(f64, Number, |v: &Self| Some(*v), Value::Number(Some(v)) => v);
cell!(Option<f64>, Number, |v: &Self| *v, Value::Number(v) => v);
cell!(String, Text, |v: &Self| Some(v.clone()), Value::Text(Some(v)) => v);
cell!(Option<String>, Text, |v: &Self| v.clone(), Value::Text(v) => v);

macro_rules! row {
    ($($(#[$about:meta])* $name:ident: $type:ty,)*) => {
        /// A try-on: one person, one garment, one size, one pose.
        #[derive(Debug, Clone, PartialEq, Default, Serialize)]
        pub struct StudyRow {
            $($(#[$about])* pub $name: $type,)*
        }

        impl StudyRow {
            /// The columns, in their order.
            pub const COLUMNS: &[(&str, Kind)] = &[$((stringify!($name), <$type as Cell>::KIND)),*];

            /// The values, in the order of the columns.
            pub fn values(&self) -> Vec<Value> {
                vec![$(self.$name.value()),*]
            }

            /// Sets the value of a column; `None` where there is no such column, or it holds something else.
            pub fn set(&mut self, name: &str, value: Value) -> Option<()> {
                match name {
                    $(stringify!($name) => self.$name = <$type as Cell>::of(value)?,)*
                    _ => return None,
                }
                Some(())
            }
        }
    };
}

row! {
    /// Number of the row, from 0.
    row: i64,
    /// Number of the person, from 0.
    person: i64,
    /// How many people they stand for.
    weight: f64,
    /// `female` or `male`.
    sex: String,
    /// Stature (mm).
    stature_mm: f64,
    /// Between the tips of the shoulder blades (mm).
    shoulder_breadth_mm: f64,
    /// Chest or bust girth (mm), true.
    chest_mm: f64,
    /// Waist girth (mm), true.
    waist_mm: f64,
    /// Hip girth (mm), true.
    hip_mm: f64,
    /// Chest girth as the sensor sees it (mm).
    seen_chest_mm: f64,
    /// Waist girth as the sensor sees it (mm).
    seen_waist_mm: f64,
    /// Hip girth as the sensor sees it (mm).
    seen_hip_mm: f64,
    /// The garment, as the study names it.
    garment: String,
    /// The size of this row.
    size: String,
    /// The pose of this row.
    pose: String,
    /// Whether the garment is made for a person of their sex; else nothing of what follows is judged.
    offered: bool,
    /// The size recommended to the true measures.
    best_size: Option<String>,
    /// The size recommended to the measures as seen.
    seen_size: Option<String>,
    /// How probable that size was stated to be.
    seen_probability: Option<f64>,
    /// The size whose range in the size table holds the girth that sizes are designated by; none where none does.
    table_size: Option<String>,
    /// Girth of the garment at the chest less the body's (mm).
    chest_ease_mm: Option<f64>,
    /// The same at the waist.
    waist_ease_mm: Option<f64>,
    /// The same at the hip.
    hip_ease_mm: Option<f64>,
    /// `tight`, `good` or `loose`, of the zones that the garment is judged by.
    chest_verdict: Option<String>,
    /// The same of the waist.
    waist_verdict: Option<String>,
    /// The same of the hip.
    hip_verdict: Option<String>,
    /// Whether every zone that is judged is good.
    fits: bool,
    /// Whether the try-on was simulated.
    draped: bool,
    /// Why it could not be, where it was asked for.
    trouble: Option<String>,
    /// Girth of the cloth that hangs at the level of the chest, unstretched, less the body's (mm).
    chest_worn_ease_mm: Option<f64>,
    /// The same at the waist.
    waist_worn_ease_mm: Option<f64>,
    /// The same at the hip.
    hip_worn_ease_mm: Option<f64>,
    /// Mean distance of the cloth from the body at the chest (mm).
    chest_gap_mm: Option<f64>,
    /// The same at the waist.
    waist_gap_mm: Option<f64>,
    /// The same at the hip.
    hip_gap_mm: Option<f64>,
    /// Stretch that nine tenths of the sleeves' edges stay below (1).
    sleeves_stretch: Option<f64>,
    /// The same of chest and shoulders.
    chest_stretch: Option<f64>,
    /// The same of the waist.
    waist_stretch: Option<f64>,
    /// The same of the seat.
    hip_stretch: Option<f64>,
    /// The same of the legs.
    legs_stretch: Option<f64>,
    /// Stretch that is comfortable in the fabric (1).
    comfortable_stretch: Option<f64>,
    /// Zones that are stretched beyond it, parted by a space.
    pulls: Option<String>,
    /// Mean height of the hem over the floor (mm).
    hem_height_mm: Option<f64>,
    /// How far the hem hangs from the body's middle, in the mean (mm).
    hem_radius_mm: Option<f64>,
    /// Deviation of that around the hem (mm): how deep its folds are.
    hem_folds_mm: Option<f64>,
    /// Mean strain of warp and weft edges (1).
    strain_mean: Option<f64>,
    /// 99th percentile of it (1).
    strain_p99: Option<f64>,
    /// Deepest point inside of the body (mm).
    penetration_mm: Option<f64>,
    /// Mean distance of the cloth from where it lies sewn up around the body and fully settled (mm); of those who are compared.
    unsettled_mean_mm: Option<f64>,
    /// 99th percentile of it (mm).
    unsettled_p99_mm: Option<f64>,
    /// Greatest difference of a zone's worn ease to that (mm).
    unsettled_ease_mm: Option<f64>,
    /// Zones that pull there, parted by a space.
    settled_pulls: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_by_their_names_and_others_are_refused() {
        let row =
            StudyRow { person: 7, weight: 0.5, size: "38".into(), chest_ease_mm: Some(-3.25), ..StudyRow::default() };
        let mut back = StudyRow::default();
        for ((name, _), value) in StudyRow::COLUMNS.iter().zip(row.values()) {
            back.set(name, value).expect(name);
        }
        assert_eq!(back, row);
        assert!(back.set("chest", Value::Flag(true)).is_none() && back.set("fits", Value::Whole(1)).is_none());
    }
}
