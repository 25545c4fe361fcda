//! The filters that are compared.

use toile_base::filter::Filter;
use toile_base::frame::Joints;
use toile_base::skeleton::Skeleton;
use toile_engine::body::Poser;
use toile_engine::body::filters::{LimitFilter, PoseFilter};
use toile_sensors::filter::angles::AngleFilter;
use toile_sensors::filter::holt::{HoltSettings, NOMINAL_PERIOD};
use toile_sensors::filter::one_euro::OneEuroSettings;
use toile_sensors::filter::predict::Predictor;
use toile_sensors::filter::smoothing::Smoothing;
use toile_sensors::filter::{FilterSettings, JointFilter};

/// Names of the rows, in their order.
pub const NAMES: [&str; 14] = [
    "none",
    "gate, hold and blend",
    "Holt .5/.5/.5",
    "Holt .7/.3/0",
    "One Euro 1, 10",
    "One Euro .5, 10",
    "bones of the session",
    "bones of the body",
    "angles, 40 ms",
    "joint limits",
    DEFAULT,
    "the same, bones of the session",
    "the same, posed",
    "the same, predicted by 38 ms",
];

/// The row of what the program runs.
pub const DEFAULT: &str = "default: hold and damped, adaptive Holt";

/// Time by which is predicted (s): from a frame's arrival to the picture.
const LEAD: f32 = 0.038;

/// Several filters, one after the other.
struct FilterChain(Vec<Box<dyn Filter>>);

impl Filter for FilterChain {
    fn push(&mut self, frame: &Joints) -> Joints {
        self.0.iter_mut().fold(*frame, |joints, filter| filter.push(&joints))
    }

    fn reset(&mut self) {
        self.0.iter_mut().for_each(|filter| filter.reset());
    }
}

/// Passes joints through as they are seen.
struct Unfiltered;

impl Filter for Unfiltered {
    fn push(&mut self, frame: &Joints) -> Joints {
        *frame
    }

    fn reset(&mut self) {}
}

/// A row's filter, new, for a body of these bones; nothing for a name that is no row's.
pub fn filter(name: &str, body: &Skeleton) -> Option<Box<dyn Filter>> {
    let of = |smoothing, bone_pull| JointFilter::new(FilterSettings { smoothing, bone_pull });
    let classic = |smoothing, correction, prediction: f32| {
        Smoothing::Holt(HoltSettings {
            smoothing,
            correction,
            damping: 1.0,
            trust_radius: f32::INFINITY,
            prediction: prediction * NOMINAL_PERIOD,
        })
    };
    let euro = |min_cutoff| Smoothing::OneEuro(OneEuroSettings { min_cutoff, beta: 10.0 });
    Some(match name {
        "none" => Box::new(Unfiltered),
        "gate, hold and blend" => Box::new(of(Smoothing::None, 0.0)),
        "Holt .5/.5/.5" => Box::new(of(classic(0.5, 0.5, 0.5), 0.0)),
        "Holt .7/.3/0" => Box::new(of(classic(0.7, 0.3, 0.0), 0.0)),
        "One Euro 1, 10" => Box::new(of(euro(1.0), 0.0)),
        "One Euro .5, 10" => Box::new(of(euro(0.5), 0.0)),
        "bones of the session" => Box::new(of(Smoothing::None, 1.0)),
        "bones of the body" => {
            let mut filter = of(Smoothing::None, 1.0);
            filter.lock_bones(body);
            Box::new(filter)
        }
        "angles, 40 ms" => Box::new(AngleFilter::new(0.04)),
        "joint limits" => Box::new(LimitFilter::new(body)),
        DEFAULT => Box::new(JointFilter::default()),
        "the same, bones of the session" => Box::new(of(Smoothing::default(), 1.0)),
        "the same, predicted by 38 ms" => {
            Box::new(FilterChain(vec![Box::new(JointFilter::default()), Box::new(Predictor::new(LEAD))]))
        }
        "the same, posed" => {
            Box::new(FilterChain(vec![Box::new(JointFilter::default()), Box::new(PoseFilter::new(Poser::new(body)))]))
        }
        _ => return None,
    })
}
