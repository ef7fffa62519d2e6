//! How evenly points lie: the net property and the L2 star discrepancy, for tests.

/// Whether `base^m` points are a (t, m, s)-net (Niederreiter 1987): each elementary interval of volume `base^(t - m)` holds
/// exactly `base^t` of them. `leading(index, dimension, k)` is the integer made of the `k` leading digits of a coordinate.
pub fn is_net(base: u64, t: u32, m: u32, dimensions: usize, leading: impl Fn(u64, usize, u32) -> u64) -> bool {
    compositions(m - t, dimensions).iter().all(|digits| {
        let mut counts = vec![0; base.pow(m - t) as usize];
        for index in 0..base.pow(m) {
            let place = |cell, (d, &k): (usize, &u32)| cell * base.pow(k) + leading(index, d, k);
            counts[digits.iter().enumerate().fold(0, place) as usize] += 1;
        }
        counts.iter().all(|&count| count == base.pow(t))
    })
}

/// All ways to write `total` as a sum of `parts` numbers, in order.
fn compositions(total: u32, parts: usize) -> Vec<Vec<u32>> {
    if parts == 1 {
        return vec![vec![total]];
    }
    let with_first = |first| {
        compositions(total - first, parts - 1).into_iter().map(move |mut rest| {
            rest.push(first);
            rest
        })
    };
    (0..=total).flat_map(with_first).collect()
}

/// Square of the L2 star discrepancy by the formula of Warnock (1972), in O(n²).
pub fn l2_star_squared<const S: usize>(points: &[[f64; S]]) -> f64 {
    let n = points.len() as f64;
    let one = |p: &[f64; S]| p.iter().map(|x| 0.5 * (1.0 - x * x)).product::<f64>();
    let two = |p: &[f64; S], q: &[f64; S]| p.iter().zip(q).map(|(x, y)| 1.0 - x.max(*y)).product::<f64>();
    let single: f64 = points.iter().map(one).sum();
    let double: f64 = points.iter().map(|p| points.iter().map(|q| two(p, q)).sum::<f64>()).sum();
    3f64.powi(-(S as i32)) - 2.0 / n * single + double / (n * n)
}

/// Asserts that the first points of a sequence, by coordinate and index, have known L2 star discrepancies in four dimensions:
/// pairs of a number of points and a value that SciPy finds (`scipy.stats.qmc.discrepancy`, "L2-star") for points made in
/// Python. And that these are below 0.85 of the root mean square for random points, below 0.55 from 256 points on.
pub fn assert_l2_star(coordinate: impl Fn(u64, usize) -> f64, known: &[(u64, f64)]) {
    for &(n, expected) in known {
        let points: Vec<[f64; 4]> = (0..n).map(|index| std::array::from_fn(|d| coordinate(index, d))).collect();
        let found = l2_star_squared(&points).sqrt();
        assert!((found - expected).abs() < 1e-12, "{n} points: {found}, not {expected}");
        let random = ((2f64.powi(-4) - 3f64.powi(-4)) / n as f64).sqrt();
        assert!(found < if n < 256 { 0.85 } else { 0.55 } * random, "{n} points: {found}, of random points {random}");
    }
}

#[test]
fn nets_are_told_from_others() {
    let hammersley = |index: u64, d: usize, k: u32| {
        let x = if d == 0 { index } else { index.reverse_bits() >> 58 };
        x >> (6 - k)
    };
    assert!(is_net(2, 0, 6, 2, hammersley));
    assert!(!is_net(2, 0, 6, 2, |index, _, k| index >> (6 - k)), "the diagonal is even in each dimension only");
    assert_eq!(compositions(2, 3).len(), 6);
}

#[test]
fn the_discrepancy_of_regular_points_on_a_line_is_known() {
    // n points k / n: the integral of the squared local discrepancy is 1 / (3 n²); midpoints have a quarter of it.
    let points = |offset: f64| (0..8).map(|k| [(f64::from(k) + offset) / 8.0]).collect::<Vec<_>>();
    assert!((l2_star_squared(&points(0.0)) - 1.0 / 192.0).abs() < 1e-15);
    assert!((l2_star_squared(&points(0.5)) - 1.0 / 768.0).abs() < 1e-15);
}
