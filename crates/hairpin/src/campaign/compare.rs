//! Two campaigns over the same cases: what got better, what got worse, and what fails that did not fail before.
//!
//! Pairs share number, seed and waypoints, so that differences are those of the robot, the controller or the noise;
//! tests are of paired differences and assume no distribution.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Case, CaseNumber, CaseResult, Status};
use crate::judgement::{Measures, Violation, holm, median, signed_rank};

/// Confidence of the intervals.
pub const CONFIDENCE: f64 = 0.95;
/// A metric got better or worse if chance does as much less often than this, all metrics together.
pub const SIGNIFICANCE: f64 = 0.05;

/// Two campaigns, A and B, case by case.
///
/// Counts: `better` + `worse` + `unchanged` are the compared pairs; undecided ones are in `pairs` and in none of the
/// three.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Comparison {
    /// Cases that both have: the same number, seed, waypoints and environment.
    pub pairs: usize,
    /// Of these, pairs whose run came to a better end in B or deviates less, both passing, both failing or not judged.
    pub better: usize,
    /// … to a worse end, or deviates more.
    pub worse: usize,
    /// … to the same.
    pub unchanged: usize,
    /// Cases that pass in A, or were not judged, and fail in B.
    pub newly_failing: Vec<String>,
    /// Cases that fail in A and no longer do in B.
    pub newly_passing: Vec<String>,
    /// Cases whose executor failed, whose data are inconclusive, or of which no deviation was measured where that alone
    /// could tell A from B: not compared.
    pub undecided: Vec<String>,
    /// Cases without a partner.
    pub unpaired: Vec<Unpaired>,
    /// Every metric that both have.
    pub metrics: Vec<MetricChange>,
}

/// A case without a partner.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Unpaired {
    /// Its name.
    pub case: String,
    /// `only in A`, `only in B`, `another seed`, `other waypoints`, `another environment`.
    pub why: &'static str,
}

/// How one metric changed over all compared pairs in which both sides have it.
///
/// Of each case the worst over its runs, of that metric itself: which run is the worst one depends on the spec.
/// Medians in the metric's own unit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MetricChange {
    /// Its column in `results.parquet`, with the unit.
    pub metric: &'static str,
    /// Pairs.
    pub pairs: usize,
    /// Median in A.
    pub median_a: f64,
    /// Median in B.
    pub median_b: f64,
    /// Median of B − A.
    pub median_difference: f64,
    /// The interval that covers it at [`CONFIDENCE`], whatever the distribution; fewer than six pairs have none.
    pub interval: Option<[f64; 2]>,
    /// Matched-pairs rank biserial correlation of B − A, −1 … 1.
    /// (R⁺ − R⁻)/(R⁺ + R⁻) over the ranks of |B − A|, ties of [`compare`]'s tolerance left out: 1 where every pair
    /// rose.
    pub rank_biserial: f64,
    /// Wilcoxon's signed-rank test, two-sided.
    pub p: f64,
    /// `exact`, ties included, or `normal approximation`.
    pub test: &'static str,
    /// `p` by Holm's correction for all metrics.
    pub p_holm: f64,
    /// `better` or `worse` where the corrected p is below [`SIGNIFICANCE`], else `none`.
    pub change: &'static str,
}

impl Comparison {
    /// Whether a metric got worse beyond chance.
    ///
    /// By [`MetricChange::change`], corrected for all metrics.
    pub fn regresses(&self) -> bool {
        self.metrics.iter().any(|metric| metric.change == "worse")
    }

    /// Whether there are pairs, and not one of them could be compared: nothing is known of B against A then.
    pub fn inconclusive(&self) -> bool {
        self.pairs > 0 && self.undecided.len() == self.pairs
    }

    /// `better 812, worse 31, newly failing 2; newly passing 1, unchanged 154`; INCONCLUSIVE where nothing could be
    /// compared.
    pub fn sentence(&self) -> String {
        if self.inconclusive() {
            let unpaired = match self.unpaired.len() {
                0 => String::new(),
                unpaired => format!("; not paired {unpaired}"),
            };
            return format!(
                "INCONCLUSIVE: none of {} pairs could be compared: in A or B the executor failed, the data are inconclusive or \
                 no deviation was measured{unpaired}",
                self.pairs
            );
        }
        let mut sentence = format!(
            "better {}, worse {}, newly failing {}; newly passing {}, unchanged {}",
            self.better,
            self.worse,
            self.newly_failing.len(),
            self.newly_passing.len(),
            self.unchanged
        );
        for (what, count) in [("not compared", self.undecided.len()), ("not paired", self.unpaired.len())] {
            if count > 0 {
                sentence += &format!(", {what} {count}");
            }
        }
        sentence
    }
}

/// Compares judged cases of two campaigns. Pairs have the same number, the same seed, the same waypoints to the bit and
/// the same environment. Two runs that both pass or both fail are told apart by whether they crashed, then by their
/// largest deviation, of which `tolerance` (m) is no difference; it is none of any metric in metres either, nor is what
/// differs from the tenth digit on of any metric: such pairs are ties of its test.
pub fn compare(a: &[(Case, CaseResult)], b: &[(Case, CaseResult)], tolerance: f64) -> Comparison {
    let by_number = |side: &[(Case, CaseResult)]| -> BTreeMap<CaseNumber, usize> {
        side.iter().enumerate().map(|(index, (case, _))| (case.number, index)).collect()
    };
    let (in_a, in_b) = (by_number(a), by_number(b));
    let mut found = Comparison::default();
    let mut pairs = Vec::new();
    let numbers: std::collections::BTreeSet<CaseNumber> = in_a.keys().chain(in_b.keys()).copied().collect();
    for number in numbers {
        let why = match (in_a.get(&number), in_b.get(&number)) {
            (Some(&i), Some(&k)) => match (&a[i].0, &b[k].0) {
                (a, b) if a.seed != b.seed => "another seed",
                (a, b) if a.waypoints != b.waypoints => "other waypoints",
                (a, b) if a.environment != b.environment => "another environment",
                _ => {
                    pairs.push((&a[i].1, &b[k].1));
                    continue;
                }
            },
            (Some(_), None) => "only in A",
            _ => "only in B",
        };
        found.unpaired.push(Unpaired { case: number.to_string(), why });
    }
    found.pairs = pairs.len();
    pairs.retain(|(a, b)| found.take(a, b, tolerance));
    found.metrics = metrics(&pairs, tolerance);
    found
}

impl Comparison {
    /// Counts one pair; whether it can be compared.
    fn take(&mut self, a: &CaseResult, b: &CaseResult, tolerance: f64) -> bool {
        let name = a.case.to_string();
        match (a.status, b.status) {
            (Status::Pass, Status::Fail) => self.newly_failing.push(name),
            (Status::Fail, Status::Pass) => self.newly_passing.push(name),
            // Of what no limit was asked only a bad end is a failure, on either side.
            (Status::Unjudged, Status::Fail) if ended_badly(b) => self.newly_failing.push(name),
            (Status::Fail, Status::Unjudged) if ended_badly(a) => self.newly_passing.push(name),
            (Status::Pass | Status::Unjudged, Status::Pass | Status::Unjudged) | (Status::Fail, Status::Fail) => {
                let crashed = |result: &CaseResult| result.violations.iter().any(Violation::is_crash);
                // What was not measured is not small.
                let deviation = |result: &CaseResult| result.measured()?.deviation();
                let change = deviation(a).zip(deviation(b)).map(|(a, b)| b - a);
                let count = match (crashed(a), crashed(b), change) {
                    (true, false, _) => &mut self.better,
                    (false, true, _) => &mut self.worse,
                    (_, _, None) => {
                        self.undecided.push(name);
                        return false;
                    }
                    (_, _, Some(change)) if change > tolerance => &mut self.worse,
                    (_, _, Some(change)) if change < -tolerance => &mut self.better,
                    _ => &mut self.unchanged,
                };
                *count += 1;
            }
            _ => {
                self.undecided.push(name);
                return false;
            }
        }
        true
    }
}

/// Whether what a run violates is no limit, but how it ended.
fn ended_badly(result: &CaseResult) -> bool {
    result.violations.iter().any(|violation| violation.event().is_some())
}

/// A metric: its column, its value, and whether more of it is worse.
type Metric = (&'static str, fn(&Measures) -> Option<f64>, bool);

const METRICS: [Metric; 10] = [
    ("max_deviation_m", Measures::deviation, true),
    ("mean_deviation_m", |m| m.deviation().map(|_| m.mean_deviation), true),
    ("max_overshoot_m", |m| Some(m.max_overshoot()), true),
    ("max_acceleration_m_s2", Measures::acceleration, true),
    ("total_time_s", |m| Some(m.total_time), true),
    ("min_clearance_m", |m| m.min_clearance, false),
    ("min_tip_over_margin_deg", |m| m.min_tip_over_margin, false),
    ("saturation_share", |m| m.saturation_share, true),
    ("joint_effort_rad2_s3", |m| m.joint_effort, true),
    ("max_late_s", |m| m.latest.map(|late| late.by), true),
];

fn metrics(pairs: &[(&CaseResult, &CaseResult)], tolerance: f64) -> Vec<MetricChange> {
    let mut found: Vec<MetricChange> = METRICS.iter().filter_map(|metric| change(metric, pairs, tolerance)).collect();
    let corrected = holm(&found.iter().map(|metric| metric.p).collect::<Vec<_>>());
    for (metric, p) in found.iter_mut().zip(corrected) {
        let more_is_worse = METRICS.iter().any(|(name, _, worse)| name == &metric.metric && *worse);
        metric.p_holm = p;
        metric.change = match p < SIGNIFICANCE {
            false => "none",
            true if (metric.rank_biserial > 0.0) == more_is_worse => "worse",
            true => "better",
        };
    }
    found
}

/// What two equal runs may differ by as they are computed and written, of the larger of both values.
const WRITTEN: f64 = 1e-9;

fn change(&(metric, value, _): &Metric, pairs: &[(&CaseResult, &CaseResult)], tolerance: f64) -> Option<MetricChange> {
    let of = |result: &CaseResult| result.measured().and_then(value).filter(|value| value.is_finite());
    let values: Vec<(f64, f64)> = pairs.iter().filter_map(|(a, b)| Some((of(a)?, of(b)?))).collect();
    let (a, b): (Vec<f64>, Vec<f64>) = values.iter().copied().unzip();
    let differences: Vec<f64> = values.iter().map(|(a, b)| b - a).collect();
    let least = if metric.ends_with("_m") { tolerance } else { 0.0 };
    let is_tie = |(a, b): &(f64, f64)| (b - a).abs() <= least.max(WRITTEN * a.abs().max(b.abs()));
    let ranked: Vec<f64> = values.iter().map(|pair| if is_tie(pair) { 0.0 } else { pair.1 - pair.0 }).collect();
    let (difference, tested) = (median(&differences, CONFIDENCE)?, signed_rank(&ranked)?);
    Some(MetricChange {
        metric,
        pairs: values.len(),
        median_a: median(&a, CONFIDENCE)?.value,
        median_b: median(&b, CONFIDENCE)?.value,
        median_difference: difference.value,
        interval: difference.interval,
        rank_biserial: tested.rank_biserial,
        p: tested.p,
        test: if tested.exact { "exact" } else { "normal approximation" },
        p_holm: tested.p,
        change: "none",
    })
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use nalgebra::Point3;

    fn side(deviations: &[f64], limit: f64) -> Vec<(Case, CaseResult)> {
        let one = |(number, &deviation): (usize, &f64)| {
            let fails = deviation > limit;
            let violation =
                Violation { what: "deviation".into(), value: deviation, limit, unit: "m".into(), at: 1.0, leg: 0 };
            let ways = vec![Point3::origin(), Point3::new(number as f64, 0.0, 0.0)];
            let case = Case::bare(CaseNumber(number), number as u64, ways);
            let status = if fails { Status::Fail } else { Status::Pass };
            let result = CaseResult {
                measures: Some(Measures { max_deviation: deviation, ..Measures::default() }),
                ended: "done".into(),
                violations: if fails { vec![violation] } else { Vec::new() },
                ..CaseResult::bare(CaseNumber(number), status)
            };
            (case, result)
        };
        deviations.iter().enumerate().map(one).collect()
    }

    #[test]
    fn every_case_is_counted_once() {
        let a = side(&[0.1, 0.2, 0.6, 0.3, 0.7, 0.2, 0.4, 0.4], 0.5);
        let mut b = side(&[0.2, 0.1, 0.3, 0.9, 0.8, 0.2, 0.4, 0.4], 0.5);
        b[6].0.seed = 99;
        b[7].1.status = Status::ExecutorFailed;
        b.extend(side(&[0.0; 9], 0.5).split_off(8));
        let found = compare(&a, &b, 1e-9);
        assert_eq!((found.pairs, found.better, found.worse, found.unchanged), (7, 1, 2, 1));
        assert_eq!(
            (found.newly_failing.clone(), found.newly_passing.clone()),
            (vec!["0003".into()], vec!["0002".into()])
        );
        assert_eq!(found.undecided, ["0007"]);
        let unpaired: Vec<_> = found.unpaired.iter().map(|one| (one.case.as_str(), one.why)).collect();
        assert_eq!(unpaired, [("0006", "another seed"), ("0008", "only in B")]);
        assert_eq!(
            found.sentence(),
            "better 1, worse 2, newly failing 1; newly passing 1, unchanged 1, not compared 1, not paired 2"
        );
        // Where no pair can be compared that is said, and is not the same as nothing worse.
        assert!(!found.inconclusive());
        let mut broken = b.clone();
        broken.iter_mut().for_each(|(_, result)| result.status = Status::ExecutorFailed);
        let none = compare(&a, &broken, 1e-9);
        assert!(none.inconclusive() && none.undecided.len() == 7, "{none:?}");
        assert!(
            none.sentence().starts_with("INCONCLUSIVE: none of 7 pairs could be compared: "),
            "{}",
            none.sentence()
        );
        assert!(none.sentence().ends_with("; not paired 2"), "{}", none.sentence());
        assert!(!compare(&a, &[], 1e-9).inconclusive(), "without pairs there is nothing to be inconclusive about");
        // What nothing was asked of fails by how it ends alone.
        let (mut unjudged, mut crashed) = (side(&[0.1, 0.1, 0.2], 0.5), side(&[0.7, 0.7, 0.2], 0.5));
        unjudged.iter_mut().for_each(|(_, result)| result.status = Status::Unjudged);
        crashed[0].1.violations[0].what = "crash".into();
        let found = compare(&unjudged, &crashed, 1e-9);
        assert_eq!((&found.newly_failing[..], found.unchanged), (&["0000".to_owned()][..], 1));
        assert_eq!(found.undecided, ["0001"], "a limit that was not asked for on the other side");
        assert_eq!(compare(&crashed, &unjudged, 1e-9).newly_passing, ["0000"]);
        // A change within the tolerance is none.
        assert_eq!(compare(&a, &b, 0.15).unchanged, 4);
    }

    /// A run of which no sample counts for its deviation was better than any other.
    #[test]
    fn what_has_no_deviation_is_not_compared() {
        let (a, mut b) = (side(&[0.2, 0.3], 0.5), side(&[0.2, 0.3], 0.5));
        b[0].1.measures.as_mut().unwrap().missing.deviation = true;
        for (a, b) in [(&a, &b), (&b, &a)] {
            let found = compare(a, b, 0.0);
            assert_eq!((found.better, found.worse, found.unchanged), (0, 0, 1));
            assert_eq!(found.undecided, ["0000"]);
            assert!(found.metrics.iter().all(|metric| metric.pairs == 1), "{:?}", found.metrics);
        }
        b[1].1.measures = None;
        assert!(compare(&a, &b, 0.0).inconclusive());
    }

    #[test]
    fn a_crash_is_worse_than_any_deviation() {
        let a = side(&[0.9], 0.5);
        let mut b = side(&[0.6], 0.5);
        b[0].1.violations[0].what = "crash".into();
        assert_eq!(compare(&a, &b, 0.0).worse, 1);
        assert_eq!(compare(&b, &a, 0.0).better, 1);
    }

    #[test]
    fn a_metric_regresses_by_test_not_by_chance() {
        let before: Vec<f64> = (0..30).map(|i| 0.1 + 0.01 * f64::from(i)).collect();
        let shifted: Vec<f64> = before.iter().enumerate().map(|(i, d)| d + 0.001 * (1.0 + i as f64)).collect();
        let mixed: Vec<f64> =
            (before.iter().enumerate()).map(|(i, d)| if i % 2 == 0 { d + 0.01 } else { d - 0.01 }).collect();
        let a = side(&before, 9.0);
        let worse = compare(&a, &side(&shifted, 9.0), 0.0);
        assert!(worse.regresses() && worse.metrics[0].rank_biserial == 1.0 && worse.metrics[0].change == "worse");
        let back = compare(&side(&shifted, 9.0), &a, 0.0);
        assert!(!back.regresses() && back.metrics[0].change == "better");
        assert!(!compare(&a, &side(&mixed, 9.0), 0.0).regresses());
        let interval = worse.metrics[0].interval.unwrap();
        assert!(interval[0] <= 0.0155 && 0.0155 <= interval[1], "{interval:?}");
    }

    /// Pairs within the tolerance are ties of the test, however many lean to one side.
    #[test]
    fn what_is_within_the_tolerance_is_no_regression() {
        let before: Vec<f64> = (0..12).map(|i| 0.1 + 0.01 * f64::from(i)).collect();
        let by = |more: f64| side(&before.iter().map(|d| d + more).collect::<Vec<_>>(), 9.0);
        let a = side(&before, 9.0);
        assert!(compare(&a, &by(0.001), 0.0).regresses() && compare(&a, &by(0.001), 0.0009).regresses());
        let none = compare(&a, &by(0.001), 0.01);
        assert!(!none.regresses() && none.metrics[0].p == 1.0 && none.metrics[0].rank_biserial == 0.0, "{none:?}");
        assert!((none.metrics[0].median_difference - 0.001).abs() < 1e-9 && none.unchanged == 12);
        // What rounds in the last digits is none without any.
        assert!(!compare(&a, &by(1e-11), 0.0).regresses());
        // The tolerance is of metres.
        let mut slower = by(0.0);
        for (_, result) in &mut slower {
            result.measures.as_mut().unwrap().total_time = 0.005;
        }
        assert!(compare(&a, &slower, 0.01).regresses());
    }
}
