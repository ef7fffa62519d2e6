//! How many rays leave each source: one systematic pass (theory: Bekaert 1999, stochastic relaxation).
//!
//! With cumulated shares `Q_i = (w_1 + ... + w_i) / W` and one `u` in [0, 1), source i gets
//! `floor(N Q_i + u) - floor(N Q_(i-1) + u)` of N rays: its expected number `N w_i / W`, rounded up or down, N in all.

/// Rays of one step over its sources, 8 bytes a source.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Allocation {
    sources: Vec<u32>,
    /// Number of the first ray of each source.
    first: Vec<u32>,
    rays: u64,
}

/// The rays of one source that belong to a range of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    pub source: u32,
    /// How many rays of this source come before.
    pub before: u32,
    pub count: u32,
    /// All rays of this source.
    pub rays: u32,
}

impl Allocation {
    /// Distributes `rays` over the sources in proportion to their positive weights; `u` in [0, 1).
    pub fn systematic(weights: impl Iterator<Item = (u32, f64)>, total: f64, rays: u64, u: f64) -> Allocation {
        let most = (weights.size_hint().1.unwrap_or(0) as u64).min(rays) as usize;
        let room = || Vec::with_capacity(most);
        let mut allocation = Allocation { sources: room(), first: room(), rays };
        let (mut cumulated, mut given) = (0.0, 0u64);
        for (source, weight) in weights.filter(|&(_, weight)| weight > 0.0) {
            cumulated += weight;
            let until = ((rays as f64 * (cumulated / total) + u) as u64).clamp(given, rays);
            allocation.push(source, given, until);
            given = until;
        }
        // Should rounding of the sum leave the last ray out, it belongs to the last source; without sources there is none.
        if allocation.sources.is_empty() {
            allocation.rays = 0;
        }
        allocation
    }

    /// As many rays for every source as `counts` say.
    pub fn of_counts(counts: impl Iterator<Item = (u32, u32)>) -> Allocation {
        let mut allocation = Allocation::default();
        for (source, count) in counts {
            let first = allocation.rays;
            allocation.rays += u64::from(count);
            allocation.push(source, first, allocation.rays);
        }
        allocation
    }

    fn push(&mut self, source: u32, first: u64, until: u64) {
        if until > first {
            self.sources.push(source);
            self.first.push(first as u32);
        }
    }

    pub fn rays(&self) -> u64 {
        self.rays
    }

    /// Sources with at least one ray, and their numbers of rays.
    pub fn counts(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        (0..self.sources.len()).map(|k| (self.sources[k], (self.end(k) - u64::from(self.first[k])) as u32))
    }

    /// The sources of the rays in `range`, in order.
    pub fn shares(&self, range: std::ops::Range<u64>) -> impl Iterator<Item = Share> + '_ {
        let start = self.first.partition_point(|&first| u64::from(first) <= range.start).saturating_sub(1);
        (start..self.sources.len()).map_while(move |k| {
            let first = u64::from(self.first[k]);
            let (from, until) = (first.max(range.start), self.end(k).min(range.end));
            (from < range.end).then(|| Share {
                source: self.sources[k],
                before: (from - first) as u32,
                count: (until - from) as u32,
                rays: (self.end(k) - first) as u32,
            })
        })
    }

    /// One past the last ray of the k-th source.
    fn end(&self, k: usize) -> u64 {
        self.first.get(k + 1).map_or(self.rays, |&next| u64::from(next))
    }
}

/// Elements, about, that stand for all where only their sum matters.
pub const SAMPLE: usize = 4096;

/// How much the variance of an element of `area` [m²] matters: less than it does over the area, so that small elements are not
/// given up, and more than it does for elements one by one, of which most are often on a hundredth of all surfaces. In three
/// furnished rooms the root serves both better than `A^(3/4)`, and in the one where it was tried better over the area than `A^(1/4)`.
pub fn importance(area: f64) -> f64 {
    area.sqrt()
}

/// The level from which `wanted(level)`, which grows from 0, is `target`, to a millionth; 0 for no target, and a very large
/// number if it is never reached. Twice as much of everything gives twice the level, bit for bit.
pub fn level(wanted: impl Fn(f64) -> f64, target: f64) -> f64 {
    if target <= 0.0 {
        return 0.0;
    }
    let mut high = 1.0;
    while wanted(high) < target && high < 1e30 {
        high *= 2.0;
    }
    while wanted(0.5 * high) >= target && high > 1e-30 {
        high *= 0.5;
    }
    let mut low = 0.5 * high;
    while high - low > 1e-6 * high {
        let middle = 0.5 * (low + high);
        if wanted(middle) > target { high = middle } else { low = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_found_on_any_scale() {
        for exact in [1e-9, 0.3, 1.0, 7e5] {
            let found = level(|level| 3.0 * level, 3.0 * exact);
            assert!((found / exact - 1.0).abs() < 2e-6, "{found} instead of {exact}");
        }
        assert_eq!(level(|level| level.sqrt(), 0.3 * 1024.0), level(|level| level.sqrt(), 0.3) * 1024.0 * 1024.0);
        assert_eq!(level(|level| level, 0.0), 0.0);
        assert!(level(|_| 0.0, 1.0) > 1e29);
    }

    fn weights() -> Vec<f64> {
        (0..1000).map(|k| f64::from(k % 7) * 0.01 + if k == 500 { 3.0 } else { 0.0 }).collect()
    }

    fn allocate(rays: u64, u: f64) -> Allocation {
        let w = weights();
        Allocation::systematic((0..).zip(w.iter().copied()), w.iter().sum(), rays, u)
    }

    #[test]
    fn every_source_gets_its_expected_number_rounded_up_or_down() {
        let (w, rays) = (weights(), 12_345);
        let total: f64 = w.iter().sum();
        for u in [0.0, 0.3, 0.999_999] {
            let allocation = allocate(rays, u);
            assert_eq!(allocation.counts().map(|(_, n)| u64::from(n)).sum::<u64>(), rays);
            for (source, n) in allocation.counts() {
                let expected = rays as f64 * w[source as usize] / total;
                assert!((f64::from(n) - expected).abs() <= 1.0 + 1e-9, "source {source}: {n} for {expected}");
            }
        }
    }

    #[test]
    fn pieces_cover_every_ray_once() {
        let allocation = allocate(12_345, 0.5);
        let mut counts = vec![0u32; 1000];
        for start in (0..12_345).step_by(100) {
            for share in allocation.shares(start..(start + 100).min(12_345)) {
                assert_eq!(share.before, counts[share.source as usize]);
                counts[share.source as usize] += share.count;
            }
        }
        assert!(allocation.counts().all(|(source, n)| counts[source as usize] == n));
    }

    #[test]
    fn the_mean_over_u_is_the_expected_number() {
        let w = weights();
        let total: f64 = w.iter().sum();
        let mut mean = vec![0.0; 1000];
        let steps = 1000;
        for k in 0..steps {
            let u = (f64::from(k) + 0.5) / f64::from(steps);
            allocate(200, u).counts().for_each(|(s, n)| mean[s as usize] += f64::from(n) / f64::from(steps));
        }
        for (m, w) in mean.iter().zip(&w) {
            assert!((m - 200.0 * w / total).abs() < 2.0 / f64::from(steps), "{m} {}", 200.0 * w / total);
        }
    }
}
