//! Typical people: the middles of clusters of bodies (k-means, Lloyd 1982), begun from people who are far apart.

use super::wearers::Wearer;

/// Rounds until the middles stay, or nearly.
const ROUNDS: usize = 20;

/// Most people who are looked at: every so many of more.
const MOST: usize = 20_000;

type Features = [f64; 4];

/// The people nearest to the middles of `count` clusters, by their place among the wearers, and the share of weights of each cluster; the
/// largest first.
pub(super) fn typical(all: &[Wearer], count: usize) -> Vec<(usize, f64)> {
    let every = all.len().div_ceil(MOST).max(1);
    let places: Vec<usize> = (0..all.len()).step_by(every).collect();
    if places.is_empty() {
        return Vec::new();
    }
    let raw: Vec<Features> = places.iter().map(|i| features(&all[*i])).collect();
    let weights: Vec<f64> = places.iter().map(|i| all[*i].weight.max(1e-9)).collect();
    let sum: f64 = weights.iter().sum();
    let mean: Features = std::array::from_fn(|k| raw.iter().zip(&weights).map(|(f, w)| f[k] * w).sum::<f64>() / sum);
    let deviation: Features = std::array::from_fn(|k| {
        let square = raw.iter().zip(&weights).map(|(f, w)| (f[k] - mean[k]).powi(2) * w).sum::<f64>();
        (square / sum).sqrt().max(1e-9)
    });
    let points: Vec<Features> = raw.iter().map(|f| std::array::from_fn(|k| (f[k] - mean[k]) / deviation[k])).collect();
    let mut middles = vec![points[nearest(&points, &[0.0; 4])]];
    while middles.len() < count.min(points.len()) {
        let far = |p: &Features| middles.iter().map(|m| apart(p, m)).fold(f64::MAX, f64::min);
        let next = (0..points.len()).max_by(|a, b| far(&points[*a]).total_cmp(&far(&points[*b]))).unwrap_or(0);
        middles.push(points[next]);
    }
    let mut share = vec![0.0; middles.len()];
    for _ in 0..ROUNDS {
        let mut sums = vec![([0.0; 4], 0.0); middles.len()];
        for (point, weight) in points.iter().zip(&weights) {
            let (total, all) = &mut sums[nearest(&middles, point)];
            (0..4).for_each(|k| total[k] += point[k] * weight);
            *all += weight;
        }
        for ((middle, share), (total, all)) in middles.iter_mut().zip(&mut share).zip(sums) {
            if all > 0.0 {
                *middle = total.map(|t| t / all);
            }
            *share = all / sum;
        }
    }
    let mut found: Vec<(usize, f64)> =
        middles.iter().zip(share).map(|(m, s)| (places[nearest(&points, m)], s)).collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    found.dedup_by_key(|(place, _)| *place);
    found
}

fn features(w: &Wearer) -> Features {
    [w.stature, w.girths[0], w.girths[1], w.girths[2]]
}

fn apart(a: &Features, b: &Features) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

fn nearest(points: &[Features], to: &Features) -> usize {
    (0..points.len()).min_by(|a, b| apart(&points[*a], to).total_cmp(&apart(&points[*b], to))).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_kinds_of_people_give_one_typical_person_each() {
        let person = |i: i64| {
            let kind = f64::from(u8::from(i % 4 == 0));
            let girth = 900.0 + 200.0 * kind + (i % 7) as f64;
            Wearer { person: i, weight: 1.0, stature: 1600.0 + 200.0 * kind, girths: [girth; 3], ..Wearer::default() }
        };
        let people: Vec<Wearer> = (0..400).map(person).collect();
        let found = typical(&people, 2);
        let (large, small) = (&people[found[1].0], &people[found[0].0]);
        assert!((found[0].1 - 0.75).abs() < 1e-9 && small.stature == 1600.0 && large.stature == 1800.0, "{found:?}");
        assert_eq!(typical(&people[..1], 10).len(), 1);
        assert!(typical(&[], 10).is_empty());
    }
}
