//! Every sequence of the table as a source of estimates: unbiased, with independent streams, better than random numbers.

use isolux_core::math::moments::Moments;
use isolux_core::sampling::{Entry, SEQUENCES, Sample, Sequence};
use isolux_testing::budget::{assert_chi2, assert_t_of, refutes};
use isolux_testing::statistics::{chi_square, p_of_chi2, p_of_t};
use std::f64::consts::FRAC_PI_2;

const SEEDS: u64 = 32;
const POINTS: usize = 256;

/// A smooth function of five numbers, and its integral over the unit cube.
struct Integrand {
    name: &'static str,
    value: fn([f64; 5]) -> f64,
    integral: f64,
}

fn integrands() -> [Integrand; 4] {
    [
        Integrand { name: "line", value: |x| x.iter().map(|x| 0.75 + 0.5 * x).product(), integral: 1.0 },
        Integrand {
            name: "exponential",
            value: |x| (0.2 * x.iter().sum::<f64>()).exp(),
            integral: (5.0 * 0.2f64.exp_m1()).powi(5),
        },
        Integrand {
            name: "sine",
            value: |x| x.iter().map(|x| FRAC_PI_2 * (2.0 * FRAC_PI_2 * x).sin()).product(),
            integral: 1.0,
        },
        Integrand {
            name: "cosine",
            value: |x| (1.0 + x.iter().sum::<f64>()).cos(),
            integral: 3.5f64.cos() * (2.0 * 0.5f64.sin()).powi(5),
        },
    ]
}

/// Deviations of the estimates from all integrals, from the first points of a stream.
fn deviations(sequence: &dyn Sequence, stream: u64, points: usize) -> [f64; 4] {
    let mut samples: Vec<Sample> = vec![[0.0; 4]; points];
    sequence.fill(stream, 0, &mut samples);
    let fifth = |index: usize| sequence.number(stream, index as u64, 4);
    let points: Vec<[f64; 5]> =
        samples.iter().enumerate().map(|(k, &[a, b, c, d])| [a, b, c, d, fifth(k)].map(f64::from)).collect();
    integrands().map(|f| points.iter().map(|&x| (f.value)(x)).collect::<Moments>().mean - f.integral)
}

/// Deviations in a run for each seed, by integral.
fn runs(make: impl Fn(u64) -> Box<dyn Sequence>) -> [Vec<f64>; 4] {
    let runs: Vec<[f64; 4]> = (0..SEEDS).map(|seed| deviations(&*make(seed), 3, POINTS)).collect();
    std::array::from_fn(|f| runs.iter().map(|run| run[f]).collect())
}

/// Deviation of the mean from zero in standard errors, and the degrees of freedom.
fn t(values: &[f64]) -> (f64, f64) {
    let moments: Moments = values.iter().copied().collect();
    (moments.mean / moments.std_error(), (values.len() - 1) as f64)
}

fn is_refuted((t, dof): (f64, f64)) -> bool {
    refutes(p_of_t(t, dof))
}

/// A faulty sequence: numbers reach only up to 1 - `lost`, and all streams are the first if `one_stream`.
struct Faulty {
    inner: Box<dyn Sequence>,
    lost: f32,
    one_stream: bool,
}

impl Sequence for Faulty {
    fn fill(&self, stream: u64, first: u64, points: &mut [Sample]) {
        self.inner.fill(if self.one_stream { 0 } else { stream }, first, points);
        points.iter_mut().flatten().for_each(|x| *x *= 1.0 - self.lost);
    }

    fn number(&self, stream: u64, index: u64, dimension: u32) -> f32 {
        self.inner.number(if self.one_stream { 0 } else { stream }, index, dimension) * (1.0 - self.lost)
    }
}

fn faulty(entry: &Entry, seed: u64, lost: f32, one_stream: bool) -> Box<dyn Sequence> {
    Box::new(Faulty { inner: (entry.make)(seed), lost, one_stream })
}

#[test]
fn estimates_are_unbiased() {
    for entry in SEQUENCES {
        for (f, values) in integrands().iter().zip(runs(entry.make)) {
            let (t, dof) = t(&values);
            assert_t_of("integrals by sequences", &format!("{} by {}", f.name, entry.name), t, dof);
        }
        // The faults: one shift for all seeds; and in even sequences, numbers that lack the last hundredth.
        assert!(runs(|_| (entry.make)(0)).iter().all(|values| is_refuted(t(values))), "{}", entry.name);
        if entry.name != "random" {
            let short = runs(|seed| faulty(entry, seed, 0.01, false));
            assert!(short.iter().any(|values| is_refuted(t(values))), "{}", entry.name);
        }
    }
}

#[test]
fn streams_are_independent() {
    // Deviations of two streams have a product of mean zero.
    let products = |make: &dyn Fn(u64) -> Box<dyn Sequence>| -> Vec<f64> {
        let pair = |seed, stream| {
            let sequence = make(seed);
            deviations(&*sequence, stream, 64)[3] * deviations(&*sequence, stream + 1, 64)[3]
        };
        (0..SEEDS).flat_map(|seed| (0..16).map(move |k| pair(seed, 2 * k))).collect()
    };
    for entry in SEQUENCES {
        let (t, dof) = t(&products(&entry.make));
        assert_t_of("streams of sequences", entry.name, t, dof);
    }
    // The fault: one stream for all.
    for entry in SEQUENCES {
        assert!(is_refuted(t(&products(&|seed| faulty(entry, seed, 0.0, true)))), "{}", entry.name);
    }
}

#[test]
fn every_number_is_uniform() {
    // One number of each of many streams, sorted into 16 equal intervals.
    const STREAMS: u64 = 4096;
    let chi2 = |sequence: &dyn Sequence, dimension| {
        let mut counts = [0; 16];
        (0..STREAMS).for_each(|s| counts[(16.0 * sequence.number(s, 77, dimension)) as usize] += 1);
        chi_square(&counts, &[STREAMS as f64 / 16.0; 16])
    };
    for entry in SEQUENCES {
        for dimension in [0, 4, 5, 40] {
            let (value, dof) = chi2(&*(entry.make)(1), dimension);
            assert_chi2("uniform numbers of sequences", value, dof);
        }
        // The fault: the last tenth of the interval is missing.
        let (value, dof) = chi2(&*faulty(entry, 1, 0.1, false), 0);
        assert!(refutes(p_of_chi2(value, dof)), "{}", entry.name);
    }
}

#[test]
fn low_discrepancy_sequences_beat_random_numbers() {
    let rms =
        |entry: &Entry| runs(entry.make).map(|values| values.iter().map(|d| d * d).collect::<Moments>().mean.sqrt());
    let random = SEQUENCES.iter().find(|entry| entry.name == "random").map(rms).expect("the table has random numbers");
    for entry in SEQUENCES.iter().filter(|entry| entry.name != "random") {
        for ((f, found), random) in integrands().iter().zip(rms(entry)).zip(random) {
            assert!(found < 0.5 * random, "{} by {}: RMS error {found}, random {random}", f.name, entry.name);
        }
    }
}
