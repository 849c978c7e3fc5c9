//! Whether two logs are one recording: to the bit, or written once more with another clock, rounded, thinned out, cut
//! or in another format.
//!
//! Positions tell. Of two flights of one mission no two agree to the last digit that is told, wind and sensors see to
//! that; of one recording they do, whatever was made of its rows and of its clock:
//!
//! ```text
//! d(t) = a(t) − b(t + s)       s: where b is at a place that a passes fast, put right by least squares
//! rms(d − mean d) ≤ 10 µm + 0.45 √(qa² + qb²) + chord
//! ```
//!
//! over at least half of the shorter one's way. q is the length of the step in which a log tells places, of which
//! rounding leaves 0.29, and the chord is what is cut off between two rows of the denser log. Only where it moves is
//! compared: all flights of a mission stand at the same place before it.

use hairpin::campaign::fit::Flown;
use hairpin::trajectory::Track;
use nalgebra::{Point3, Vector3};

/// Places of one recording differ by this, m, whatever was made of it: singles of a hundred metres do.
const FLOOR_M: f64 = 1e-5;
/// Of the step's length, what two of one recording are apart (rms); rounding alone leaves 0.29.
const OF_STEP: f64 = 0.45;
/// Steps that are longer count as this, m: beyond it two flights may agree.
const COARSEST_M: f64 = 0.02;
/// Chords that are longer count as this, m.
const LONGEST_CHORD_M: f64 = 5e-4;
/// A place is compared where it is so many times the bound from the one before.
const MOVES: f64 = 4.0;
/// So many places are compared at least.
const FEWEST: usize = 20;
/// Of the shorter one's way so much must be in both.
const SHARE: f64 = 0.5;
/// Stretches of the shorter one's way in each of which a place is looked for in the other log: half of it holds one.
const STRETCHES: usize = 4;
/// Times at which the other log is at such a place that are tried.
const TRIED: usize = 32;
/// Rows that are farther apart than so many of a log's usual intervals have a gap between them.
const GAP: f64 = 4.0;

/// A log that was read, and the length of the step in which it tells places, m; 0: exactly.
pub(super) struct Read {
    pub(super) flown: Flown,
    pub(super) step_m: f64,
}

/// Why two logs are one recording to the bit, if they are.
pub(super) fn same_samples(log: &Read, before: &Read) -> Option<String> {
    is_same(&log.flown.track, &before.flown.track).then(|| format!("has the samples of {}", before.flown.log))
}

/// Why two logs are one recording, if they are.
pub(super) fn is_one(log: &Read, before: &Read) -> Option<String> {
    if let Some(why) = same_samples(log, before) {
        return Some(why);
    }
    if has_its_places(&log.flown.track, &before.flown.track) {
        return Some(format!("has the places of {}, row by row, at other times", before.flown.log));
    }
    let found = Pair::of(log, before).found()?;
    Some(format!(
        "is the recording of {} once more: over {:.1} m of its way they are {:.2} mm apart (rms), by clocks that are \
         {:.3} s apart",
        before.flown.log,
        found.way_m,
        1e3 * found.rms_m,
        found.shift_s.abs()
    ))
}

/// Whether all that they say is the same to the bit.
fn is_same(one: &Track, other: &Track) -> bool {
    let [one_values, other_values] = [one, other].map(|track| track.channels().iter().map(|channel| &channel.values));
    one.times() == other.times() && one.poses() == other.poses() && one_values.eq(other_values)
}

/// Whether all places that they say are the same to the bit, of which there are some.
fn has_its_places(one: &Track, other: &Track) -> bool {
    let places = |track: &'_ Track| track.poses().iter().map(|pose| pose.translation.vector).collect::<Vec<_>>();
    let [one, other] = [one, other].map(places);
    let passes = one.windows(2).filter(|pair| pair[0] != pair[1]).count();
    passes >= FEWEST && one == other
}

/// How two logs agree.
struct Agreement {
    way_m: f64,
    rms_m: f64,
    shift_s: f64,
}

/// The places of a log, and those of them that are compared.
struct Way<'a> {
    times: &'a [f64],
    places: Vec<Point3<f64>>,
    /// Rows, and how far each is from the one before it.
    moved: Vec<(usize, f64)>,
    length: f64,
    /// The usual interval between rows, s.
    usual_s: f64,
}

impl<'a> Way<'a> {
    fn of(track: &'a Track, bound: f64) -> Self {
        let places: Vec<Point3<f64>> = track.poses().iter().map(|pose| pose.translation.vector.into()).collect();
        let (mut moved, mut last) = (Vec::new(), 0);
        for (i, place) in places.iter().enumerate() {
            let far = (place - places[last]).norm();
            if far > MOVES * bound {
                moved.push((i, far));
                last = i;
            }
        }
        let length = moved.iter().map(|(_, far)| far).sum();
        let mut spans: Vec<f64> = track.times().windows(2).map(|pair| pair[1] - pair[0]).collect();
        let middle = spans.len() / 2;
        let usual_s = match spans.is_empty() {
            true => f64::INFINITY,
            false => *spans.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        Self { times: track.times(), places, moved, length, usual_s }
    }

    /// Place and velocity at a time; `None` outside of it and within a gap.
    fn at(&self, t_s: f64) -> Option<(Point3<f64>, Vector3<f64>)> {
        let (first, last) = (*self.times.first()?, *self.times.last()?);
        if !(first..=last).contains(&t_s) {
            return None;
        }
        let after = self.times.partition_point(|time| *time <= t_s).clamp(1, self.times.len() - 1);
        let (from, to) = (self.times[after - 1], self.times[after]);
        let v = (self.places[after] - self.places[after - 1]) / (to - from);
        (to - from <= GAP * self.usual_s).then(|| (self.places[after - 1] + v * (t_s - from), v))
    }

    fn speed(&self, i: usize) -> f64 {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(self.places.len() - 1));
        (self.places[after] - self.places[before]).norm() / (self.times[after] - self.times[before])
    }

    /// Of each stretch of its way the row that is passed fastest.
    fn fast(&self) -> Vec<usize> {
        let (mut way, mut fastest) = (0.0, [None; STRETCHES]);
        for (i, far) in &self.moved {
            way += far;
            let stretch = ((STRETCHES as f64 * way / self.length) as usize).min(STRETCHES - 1);
            let speed = self.speed(*i);
            if fastest[stretch].is_none_or(|(_, most)| speed > most) {
                fastest[stretch] = Some((*i, speed));
            }
        }
        fastest.into_iter().flatten().map(|(i, _)| i).collect()
    }

    /// When it passes `place`: of each time that it comes within `near` of it the nearest moment.
    fn passes(&self, place: &Point3<f64>, near: f64) -> Vec<f64> {
        let (mut all, mut best): (Vec<f64>, Option<(f64, f64)>) = (Vec::new(), None);
        for (pair, times) in self.places.windows(2).zip(self.times.windows(2)) {
            let along = pair[1] - pair[0];
            let share = ((place - pair[0]).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            let far = (place - (pair[0] + along * share)).norm();
            if far > near {
                all.extend(best.take().map(|(_, t_s)| t_s));
            } else if best.is_none_or(|(least, _)| far < least) {
                best = Some((far, times[0] + share * (times[1] - times[0])));
            }
        }
        all.extend(best.map(|(_, t_s)| t_s));
        all.truncate(TRIED);
        all
    }

    /// What is cut off between two rows, m (rms): an eighth of second differences.
    fn chord(&self) -> f64 {
        let cut = |three: &[Point3<f64>]| ((three[2] - three[1]) - (three[1] - three[0])).norm_squared() / 64.0;
        let sum: f64 = self.places.windows(3).map(cut).sum();
        (sum / self.places.len().max(1) as f64).sqrt().min(LONGEST_CHORD_M)
    }
}

/// Of a place of one log: how far it is from the one before it, where the other one is beside it, and its velocity.
type Difference = (f64, Vector3<f64>, Vector3<f64>);

/// Two logs that are held against each other: what is compared is the places of the one with fewer rows.
struct Pair<'a> {
    sparse: Way<'a>,
    dense: Way<'a>,
    /// Of differences in rms, and of their mean, m.
    bound: f64,
    offset: f64,
    /// Whether the first of both is the sparse one.
    in_order: bool,
}

impl<'a> Pair<'a> {
    fn of(one: &'a Read, other: &'a Read) -> Self {
        let steps = [one, other].map(|read| read.step_m.min(COARSEST_M));
        let exact = FLOOR_M + OF_STEP * libm::hypot(steps[0], steps[1]);
        let [mut one, mut other] = [one, other].map(|read| Way::of(&read.flown.track, exact));
        let in_order = one.usual_s >= other.usual_s;
        if !in_order {
            std::mem::swap(&mut one, &mut other);
        }
        let bound = exact + other.chord();
        Self { sparse: one, dense: other, bound, offset: bound + steps[0].max(steps[1]), in_order }
    }

    fn found(&self) -> Option<Agreement> {
        let shorter = self.sparse.length.min(self.dense.length);
        // A place of the shorter way is in the other's, and not the other way round.
        let of_sparse = self.sparse.length <= self.dense.length;
        let (from, to) = if of_sparse { (&self.sparse, &self.dense) } else { (&self.dense, &self.sparse) };
        // Between the rows of the sparse one lies more.
        let near = self.offset + self.bound + if of_sparse { 0.0 } else { LONGEST_CHORD_M };
        from.fast().into_iter().find_map(|i| {
            let times = to.passes(&from.places[i], near).into_iter();
            let shifts = times.map(|t_s| if of_sparse { t_s - from.times[i] } else { from.times[i] - t_s });
            shifts.filter_map(|shift| self.agrees(shift)).find(|found| found.way_m >= SHARE * shorter)
        })
    }

    /// How they agree where the dense one's clock is `shift` s ahead, if they do.
    fn agrees(&self, shift: f64) -> Option<Agreement> {
        let first = self.compare(shift)?;
        let second = self.compare(shift + first.late_s)?;
        let best = if second.rms_m < first.rms_m { second } else { first };
        let is_one = best.rms_m <= self.bound && best.offset_m <= self.offset;
        let shift_s = if self.in_order { best.shift_s } else { -best.shift_s };
        is_one.then_some(Agreement { way_m: best.way_m, rms_m: best.rms_m, shift_s })
    }

    fn compare(&self, shift_s: f64) -> Option<Compared> {
        let pairs: Vec<Difference> = self
            .sparse
            .moved
            .iter()
            .filter_map(|(i, far)| {
                let (place, v) = self.dense.at(self.sparse.times[*i] + shift_s)?;
                Some((*far, self.sparse.places[*i] - place, v))
            })
            .collect();
        if pairs.len() < FEWEST {
            return None;
        }
        let way_m: f64 = pairs.iter().map(|(far, ..)| far).sum();
        let mean = |of: &dyn Fn(&Difference) -> Vector3<f64>| {
            pairs.iter().map(|pair| of(pair) * pair.0).sum::<Vector3<f64>>() / way_m
        };
        let (d_mean, v_mean) = (mean(&|pair| pair.1), mean(&|pair| pair.2));
        let (mut square, mut along, mut speed) = (0.0, 0.0, 0.0);
        for (far, d, v) in &pairs {
            let (d, v) = (d - d_mean, v - v_mean);
            square += far * d.norm_squared();
            along += far * d.dot(&v);
            speed += far * v.norm_squared();
        }
        let late_s = if speed > 0.0 { along / speed } else { 0.0 };
        Some(Compared { way_m, rms_m: (square / way_m).sqrt(), offset_m: d_mean.norm(), late_s, shift_s })
    }
}

/// Differences by one shift of the clock.
struct Compared {
    way_m: f64,
    /// About their mean.
    rms_m: f64,
    offset_m: f64,
    /// By how much more the shift would be better.
    late_s: f64,
    shift_s: f64,
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::{Case, CaseNumber};
    use nalgebra::Isometry3;

    use super::*;

    /// A flight of a mission with a stand of 5 s before it; `other` is how it differs from the next one, m.
    fn place(t: f64, other: f64) -> Point3<f64> {
        let s = (t - 5.0).max(0.0);
        let sway = other * (1.0 - (0.8 * s).cos());
        Point3::new(3.0 + 8.0 * (0.31 * s).sin(), 2.0 + 6.0 * (0.47 * s).sin() + sway, 5.0 + 1.5 * (0.2 * s).sin())
    }

    fn read(name: &str, rows: &[(f64, Point3<f64>)], step_m: f64) -> Read {
        let first = rows[0].0;
        let times = rows.iter().map(|(t_s, _)| t_s - first).collect();
        let poses = rows.iter().map(|(_, p)| Isometry3::translation(p.x, p.y, p.z)).collect();
        let track = Track::new(times, poses, Vec::new()).unwrap();
        let case = Case::bare(CaseNumber(0), 0, vec![Point3::origin(); 2]);
        Read { flown: Flown { log: name.into(), mission: "m".into(), case, track }, step_m }
    }

    fn rows(rate: f64, other: f64) -> Vec<(f64, Point3<f64>)> {
        (0..(30.0 * rate) as usize).map(|i| i as f64 / rate).map(|t| (t, place(t, other))).collect()
    }

    fn rounded(rows: &[(f64, Point3<f64>)], digits: i32) -> (Vec<(f64, Point3<f64>)>, f64) {
        let unit = 10_f64.powi(digits);
        let rows = rows.iter().map(|(t, p)| (*t, p.map(|c| (c * unit).round() / unit))).collect();
        (rows, 3_f64.sqrt() / unit)
    }

    #[test]
    fn a_recording_that_comes_again_is_known_whatever_was_made_of_it() {
        let all = rows(100.0, 0.0);
        let whole = read("a.csv", &all, 0.0);
        let shifted: Vec<_> = all.iter().map(|(t, p)| (t + 100.0, *p)).collect();
        let thin: Vec<_> = all.iter().copied().step_by(2).collect();
        let sparse: Vec<_> = all.iter().copied().skip(7).step_by(13).collect();
        // At other moments, by straight lines between rows.
        let between: Vec<_> =
            all.windows(2).map(|two| (two[0].0 + 0.004, two[0].1 + (two[1].1 - two[0].1) * 0.4)).collect();
        let gap: Vec<_> = all.iter().copied().filter(|(t, _)| !(12.0..15.0).contains(t)).collect();
        let mut again = vec![
            read("shifted", &shifted, 0.0),
            read("thin", &thin, 0.0),
            read("sparse", &sparse, 0.0),
            read("between", &between, 0.0),
            read("end cut", &all[..1900], 0.0),
            read("begin cut", &all[1300..], 0.0),
            read("middle", &all[900..2300], 0.0),
            read("gap", &gap, 0.0),
            read("the same", &all, 0.0),
            read("a fast clock", &all.iter().map(|(t, p)| (t * 1.01, *p)).collect::<Vec<_>>(), 0.0),
            read("jitter", &all.iter().map(|(t, p)| (t + 0.004 * (t * 977.0).fract(), *p)).collect::<Vec<_>>(), 0.0),
        ];
        for digits in [2, 3, 4] {
            let (rows, step_m) = rounded(&thin, digits);
            again.push(read("rounded", &rows, step_m));
        }
        for copy in &again {
            assert!(is_one(copy, &whole).is_some(), "{}", copy.flown.log);
            assert!(is_one(&whole, copy).is_some(), "{}", copy.flown.log);
        }
        let told = is_one(&again[5], &whole).unwrap();
        assert!(told.starts_with("is the recording of a.csv once more: over "), "{told}");
        assert!(told.ends_with("by clocks that are 13.000 s apart"), "{told}");
    }

    #[test]
    fn two_flights_of_one_mission_are_two() {
        let one = read("a.csv", &rows(100.0, 0.0), 0.0);
        for other in [0.001, 0.01, 0.1] {
            assert_eq!(is_one(&read("b.csv", &rows(100.0, other), 0.0), &one), None, "{other} m");
            assert_eq!(is_one(&read("b.csv", &rows(20.0, other), 0.0), &one), None, "{other} m");
        }
        // As far as their digits tell.
        let (coarse, step_m) = rounded(&rows(50.0, 0.02), 2);
        assert_eq!(is_one(&read("b.csv", &coarse, step_m), &one), None);
        // They part after a third of the way; before that they are one.
        let parts = |rows: Vec<(f64, Point3<f64>)>| -> Vec<_> {
            rows.into_iter().map(|(t, _)| (t, place(t, if t < 13.0 { 0.0 } else { 0.3 }))).collect()
        };
        assert_eq!(is_one(&read("b.csv", &parts(rows(100.0, 0.0)), 0.0), &one), None);
    }

    #[test]
    fn standing_at_one_place_makes_no_two_flights_one() {
        let stand = |other: f64| {
            let all = (0..6000).map(|i| f64::from(i) / 100.0).map(|t| (t, place((t - 45.0).max(0.0), other)));
            all.collect::<Vec<_>>()
        };
        assert_eq!(is_one(&read("b.csv", &stand(0.05), 0.0), &read("a.csv", &stand(0.0), 0.0)), None);
        // Neither moves.
        let still =
            |t0: f64| (0..500).map(|i| (t0 + f64::from(i) / 50.0, Point3::new(1.0, 1.0, 1.0))).collect::<Vec<_>>();
        let (one, other) = (still(0.0), still(3.0)[..400].to_vec());
        assert_eq!(is_one(&read("b.csv", &other, 0.0), &read("a.csv", &one, 0.0)), None);
    }
}
