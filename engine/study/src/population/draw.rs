//! Drawing by number: a generator for each person and purpose, bodies of the survey, people of a size.

use toile_assets::body::shape::{BodyShape, Shapes};
use toile_assets::body::{En, Wanted};
use toile_base::numeric::random::SplitMix64;

/// What numbers are drawn for: each purpose has numbers of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub(crate) enum Purpose {
    /// Who a person is.
    Person = 1,
    /// The sensor's errors.
    Sensor = 2,
    /// Which people are counted again for an interval.
    Resample = 3,
}

/// The generator of number `index`, the same whatever was drawn before.
pub(crate) fn generator(seed: u64, purpose: Purpose, index: u64) -> SplitMix64 {
    let stream = SplitMix64::new(seed ^ ((purpose as u64) << 56)).next_u64();
    SplitMix64::new(stream ^ SplitMix64::new(index).next_u64())
}

/// What a drawn person's body is made from; all else is what people with these have in the mean.
const GIVEN: [En; 10] = [
    En::Stature,
    En::ShoulderBreadth,
    En::ArmLength,
    En::InsideLegHeight,
    En::NeckGirth,
    En::BustGirth,
    En::UnderbustGirth,
    En::WaistGirth,
    En::HipGirth,
    En::ThighGirth,
];

/// Draws until there is a person whom a body can be built for: one of a million is not.
const DRAWS: usize = 16;

/// A body of the survey: measures drawn from its means and covariance, with one of them as given (m) where that is so, and the shape
/// that has them as nearly as any has.
pub(super) fn shape(shapes: &Shapes, known: Option<(En, f32)>, random: &mut SplitMix64) -> BodyShape {
    let drawn = (0..DRAWS).find_map(|_| {
        let normal = std::array::from_fn(|_| f64::from(random.gaussian()));
        let person = match known {
            None => shapes.person(&normal),
            Some((measure, value)) => shapes.person_with(&normal, measure, value),
        };
        let wanted = GIVEN.iter().fold(Wanted::<En>::new(), |all, of| all.with(*of, person.of(*of)));
        shapes.wanted(&wanted).ok()
    });
    drawn.unwrap_or_else(|| {
        let wanted = known.into_iter().fold(Wanted::<En>::new(), |all, (measure, value)| all.with(measure, value));
        shapes.wanted(&wanted).unwrap_or(*shapes.mean())
    })
}

#[cfg(test)]
mod tests {
    use toile_base::body::Sex;

    use super::*;

    #[test]
    fn drawn_bodies_have_the_survey_s_means_and_deviations() {
        // ANSUR II, public release: mean and deviation (mm) of stature, chest and buttock girth.
        let survey = [
            (Sex::Female, [(En::Stature, 1628.5, 64.2), (En::BustGirth, 946.9, 82.7), (En::HipGirth, 1021.2, 75.9)]),
            (Sex::Male, [(En::Stature, 1756.2, 68.6), (En::BustGirth, 1058.7, 87.4), (En::HipGirth, 1019.5, 76.7)]),
        ];
        for (sex, measures) in survey {
            let shapes = Shapes::of(sex);
            let drawn = |n: u64| shapes.read(&shape(shapes, None, &mut generator(5, Purpose::Person, n))).readings;
            let people: Vec<_> = (0..400).map(drawn).collect();
            for (measure, mean, deviation) in measures {
                let all: Vec<f64> = people.iter().map(|p| f64::from(p.of(measure)) * 1e3).collect();
                let found = all.iter().sum::<f64>() / all.len() as f64;
                let spread = (all.iter().map(|x| (x - found).powi(2)).sum::<f64>() / (all.len() - 1) as f64).sqrt();
                println!("{sex:?} {measure:?}: mean {found:.0} of {mean}, deviation {spread:.0} of {deviation}");
                // Four standard errors of 400 people.
                assert!((found - mean).abs() < 0.2 * deviation, "{sex:?} {measure:?}: mean {found}, not {mean}");
                assert!((0.86..1.14).contains(&(spread / deviation)), "{sex:?} {measure:?}: {spread}, not {deviation}");
            }
        }
    }

    #[test]
    fn people_of_one_girth_are_as_various_in_all_else_as_the_survey_s_people_of_it() {
        let shapes = Shapes::of(Sex::Female);
        let normal = |n: u64, salt: u64| {
            let mut random = generator(7 + salt, Purpose::Person, n);
            std::array::from_fn(|_| f64::from(random.gaussian()))
        };
        // What is left of waist and hip once the bust is known, by regression over people of any bust, and by people of this bust.
        let people: Vec<_> = (0..4_000).map(|n| shapes.person(&normal(n, 0))).collect();
        let of_bust: Vec<_> = (0..4_000).map(|n| shapes.person_with(&normal(n, 1), En::BustGirth, 0.9)).collect();
        assert!(of_bust.iter().all(|p| p.of(En::BustGirth) == 0.9));
        for measure in [En::WaistGirth, En::HipGirth, En::Stature] {
            let pairs = people.iter().map(|p| [p.of(En::BustGirth), p.of(measure)].map(f64::from));
            let n = people.len() as f64;
            let [mx, my] = pairs.clone().fold([0.0; 2], |m, [x, y]| [m[0] + x / n, m[1] + y / n]);
            let [xx, xy] =
                pairs.clone().fold([0.0; 2], |s, [x, y]| [s[0] + (x - mx).powi(2), s[1] + (x - mx) * (y - my)]);
            let slope = xy / xx;
            let left = (pairs.map(|[x, y]| (y - my - slope * (x - mx)).powi(2)).sum::<f64>() / n).sqrt();
            let expected = my + slope * (0.9 - mx);
            let mean = of_bust.iter().map(|p| f64::from(p.of(measure))).sum::<f64>() / n;
            let spread = (of_bust.iter().map(|p| (f64::from(p.of(measure)) - mean).powi(2)).sum::<f64>() / n).sqrt();
            println!("{measure:?}: {mean:.4} of {expected:.4}, deviation {spread:.4} of {left:.4}");
            // Six standard errors.
            assert!((mean - expected).abs() < 0.1 * left && (spread / left - 1.0).abs() < 0.07, "{measure:?}");
        }
    }

    #[test]
    fn a_number_gives_the_same_draw_whatever_came_before_and_others_differ() {
        let first = |purpose, index| generator(9, purpose, index).next_u64();
        assert_eq!(first(Purpose::Person, 7), first(Purpose::Person, 7));
        let mut all: Vec<u64> = (0..1000).map(|i| first(Purpose::Person, i)).collect();
        all.push(first(Purpose::Sensor, 7));
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 1001);
    }
}
