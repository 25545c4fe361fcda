//! Dense symmetric positive definite systems of a few dozen unknowns, by Cholesky's factors in f64.
//!
//! A = L L^T, L lower triangular (Golub and Van Loan 2013, algorithm 4.2.1, row by row). A matrix is a slice of N rows of
//! which only the lower triangle is read; [`factor`] puts L in its place.

/// What is done with a pivot that rounding or a poor matrix leaves too small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pivot {
    /// The matrix is refused where a pivot is not above 0.
    Positive,
    /// A smaller pivot (in the units of A's diagonal) is raised to this one.
    AtLeast(f64),
}

/// Puts the lower factor in the place of the lower triangle; `None` where the matrix is refused.
pub fn factor<const N: usize>(a: &mut [[f64; N]], least: Pivot) -> Option<()> {
    for i in 0..a.len() {
        for j in 0..=i {
            let (above, here) = a.split_at(i);
            let row = &here[0];
            let other = if i == j { row } else { &above[j] };
            let dot: f64 = row[..j].iter().zip(&other[..j]).map(|(p, q)| p * q).sum();
            let rest = row[j] - dot;
            a[i][j] = match least {
                _ if j < i => rest / a[j][j],
                Pivot::AtLeast(least) => rest.max(least).sqrt(),
                Pivot::Positive if rest > 0.0 => rest.sqrt(),
                Pivot::Positive => return None,
            };
        }
    }
    Some(())
}

/// Solves L L^T x = b in place: `x` comes as b.
pub fn solve<const N: usize>(l: &[[f64; N]], x: &mut [f64; N]) {
    let n = l.len();
    for i in 0..n {
        let dot: f64 = l[i][..i].iter().zip(&x[..i]).map(|(a, b)| a * b).sum();
        x[i] = (x[i] - dot) / l[i][i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i][i];
    }
}

/// The inverse of A by its factor.
pub fn inverse<const N: usize>(l: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut inverse = [[0.0; N]; N];
    for column in 0..N {
        let mut x = [0.0; N];
        x[column] = 1.0;
        solve(l, &mut x);
        inverse.iter_mut().zip(x).for_each(|(row, x)| row[column] = x);
    }
    inverse
}

/// The logarithm of A's determinant by its factor.
pub fn log_determinant<const N: usize>(l: &[[f64; N]]) -> f64 {
    l.iter().enumerate().fold(0.0, |sum, (i, row)| sum + 2.0 * row[i].ln())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::SplitMix64;

    const N: usize = 9;

    /// B B^T of random numbers, and a little on the diagonal.
    fn positive(seed: u64) -> [[f64; N]; N] {
        let mut random = SplitMix64::new(seed);
        let b: [[f64; N]; N] = std::array::from_fn(|_| std::array::from_fn(|_| random.uniform_f64() - 0.5));
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..N).map(|k| b[i][k] * b[j][k]).sum::<f64>() + f64::from(u8::from(i == j)) * 0.1)
        })
    }

    #[test]
    fn a_system_is_solved_and_inverted() {
        for seed in 0..20 {
            let a = positive(seed);
            let mut l = a;
            factor(&mut l, Pivot::Positive).expect("positive definite");
            let right: [f64; N] = std::array::from_fn(|i| i as f64 - 4.0);
            let (mut x, inverse) = (right, inverse(&l));
            solve(&l, &mut x);
            for i in 0..N {
                let back: f64 = (0..N).map(|j| a[i][j] * x[j]).sum();
                assert!((back - right[i]).abs() < 1e-10, "{back} {}", right[i]);
                let unit: f64 = (0..N).map(|j| a[i][j] * inverse[j][i]).sum();
                assert!((unit - 1.0).abs() < 1e-10, "{unit}");
            }
        }
    }

    #[test]
    fn the_determinant_is_the_product_of_the_pivots() {
        let mut a = [[4.0, 0.0], [2.0, 10.0]];
        factor(&mut a, Pivot::Positive).expect("positive definite");
        assert!((log_determinant(&a) - 36f64.ln()).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_positive_definite_is_refused_or_raised() {
        let a = [[1.0, 0.0], [2.0, 1.0]];
        assert_eq!(factor(&mut a.clone(), Pivot::Positive), None);
        let mut raised = a;
        assert_eq!(factor(&mut raised, Pivot::AtLeast(1e-12)), Some(()));
        assert_eq!(raised[1][1], 1e-6);
        assert_eq!(factor(&mut [[f64::NAN]], Pivot::Positive), None);
    }
}
