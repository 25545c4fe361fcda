//! The cases, in the order of the table.

mod bending;
mod bias;
mod buckling;
mod contact;
mod hysteresis;
mod invariance;
pub mod layered;
mod links;
mod motion;
mod rope;
mod search;
mod strings;

use super::case::ValidationCase;

/// All cases, in the order of the table.
pub fn all() -> Vec<ValidationCase> {
    let modules = [
        bending::cases,
        bias::cases,
        hysteresis::cases,
        buckling::cases,
        strings::cases,
        links::cases,
        motion::cases,
        contact::cases,
        layered::cases,
        invariance::cases,
    ];
    modules.into_iter().flat_map(|cases| cases()).collect()
}
