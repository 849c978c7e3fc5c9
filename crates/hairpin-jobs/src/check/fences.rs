//! A mission against its own geofence.

use hairpin::campaign::{Broken, Certainty, Passage};
use hairpin::world::terrain::{KeepOut, KeepOutShape, KeepOuts};
use hairpin_formats::missions::Mission;
use nalgebra::{Point2, Vector2};

/// `MAV_AUTOPILOT` of PX4, which demands to be in any of the fences that keep in.
pub(crate) const PX4: u64 = 12;
/// `MAV_AUTOPILOT` of ArduPilot, which demands to be in all of them, unless `FENCE_OPTIONS` says otherwise.
pub(crate) const ARDUPILOT: u64 = 3;

/// Adds to `passage` the first waypoint or leg that crosses a fence of `mission`: of each that keeps out, and of those
/// that keep in as the mission's autopilot takes several of them.
pub(super) fn hold(mission: &Mission, passage: &mut Passage) {
    let (within, out): (Vec<usize>, Vec<usize>) =
        (0..mission.fences.len()).partition(|number| mission.fences[*number].keeps_in);
    for number in out {
        add(passage, Held::of(mission, &[number]).broken());
    }
    let any = || Held::of(mission, &within).broken();
    let all = || {
        let each = within.iter().filter_map(|number| Held::of(mission, &[*number]).broken());
        each.min_by_key(|broken| broken.waypoint)
    };
    match mission.whose.firmware {
        _ if within.len() < 2 => add(passage, all()),
        Some(PX4) => add(passage, any()),
        Some(ARDUPILOT) => add(passage, all()),
        // Who is in none of them is not in all of them.
        other => add(passage, any().or_else(|| Some(doubted(all()?, other)))),
    }
}

/// What breaks by one autopilot's reading and not by the other's.
fn doubted(broken: Broken, firmware: Option<u64>) -> Broken {
    let whose = firmware.map_or("its autopilot is not told".into(), |number| format!("its firmwareType is {number}"));
    let words = format!(
        "{}; {whose}: ArduPilot (3) demands to be in all of the fences that keep in, PX4 (12) in any of them",
        broken.words
    );
    Broken { certainty: Certainty::NotFound, words, ..broken }
}

fn add(passage: &mut Passage, found: Option<Broken>) {
    let Some(one) = found else { return };
    if passage.broken.as_ref().is_none_or(|known| one.waypoint < known.waypoint) {
        passage.broken = Some(one);
    }
    passage.witness = None;
}

/// Fences that are held as one: to be in any of them, or out of one.
struct Held<'a> {
    mission: &'a Mission,
    /// By their numbers.
    numbers: &'a [usize],
    keeps_in: bool,
    outline: KeepOuts,
}

impl<'a> Held<'a> {
    fn of(mission: &'a Mission, numbers: &'a [usize]) -> Self {
        let one = |number: &usize| KeepOut {
            name: format!("fence {number}"),
            shape: mission.fences[*number].outline.shape(),
        };
        // Each was looked at when the mission was read.
        let outline = KeepOuts::new(numbers.iter().map(one).collect()).unwrap_or_default();
        let keeps_in = numbers.first().is_some_and(|number| mission.fences[*number].keeps_in);
        Self { mission, numbers, keeps_in, outline }
    }

    fn place(&self, k: usize) -> [f64; 2] {
        [self.mission.waypoints[k].x, self.mission.waypoints[k].y]
    }

    /// By how much waypoint `k` is on the wrong side, m.
    fn outside(&self, k: usize) -> f64 {
        let distance = self.outline.distance(self.place(k)[0], self.place(k)[1]);
        if self.keeps_in { distance } else { -distance }
    }

    fn crosses(&self, leg: usize) -> bool {
        let (from, to) = (self.place(leg), self.place(leg + 1));
        match self.keeps_in {
            false => self.outline.segment_distance(from, to) <= 0.0,
            true => leaves(&self.outline, from, to),
        }
    }

    /// The first waypoint or, where none is, the first leg on the wrong side.
    fn broken(&self) -> Option<Broken> {
        let count = self.mission.waypoints.len();
        let broken = |waypoint: usize, leg: Option<usize>, excess: Option<f64>, words: String| Broken {
            waypoint,
            leg,
            limit: "fence",
            unit: "m",
            excess,
            certainty: Certainty::Proven,
            words,
        };
        if let Some(waypoint) = (0..count).find(|k| self.outside(*k) > 0.0) {
            let (excess, side) = (self.outside(waypoint), if self.keeps_in { "outside" } else { "inside" });
            let words = format!("it lies {excess:.2} m {side} of the mission's own {}", self.told());
            return Some(broken(waypoint, None, Some(excess), words));
        }
        let leg = (0..count.saturating_sub(1)).find(|leg| self.crosses(*leg))?;
        let words = format!("its straight line crosses the mission's own {}", self.told());
        Some(broken(leg + 1, Some(leg), None, words))
    }

    fn told(&self) -> String {
        match self.numbers {
            [one] => format!("fence {one}"),
            all => format!("fences {}", all.iter().map(usize::to_string).collect::<Vec<_>>().join(" and ")),
        }
    }
}

/// Farther outside than this between two edges a leg is outside, m: one along an edge is not.
const OUTSIDE_M: f64 = 1e-6;

/// Whether the straight line from `a` to `b`, which are inside, leaves all that `outline` encloses: between two of the
/// places where it meets edges all of it is on one side.
fn leaves(outline: &KeepOuts, a: [f64; 2], b: [f64; 2]) -> bool {
    let (from, way) = (Point2::from(a), Point2::from(b) - Point2::from(a));
    let meets = outline.list().iter().flat_map(|one| meets(&one.shape, &from, &way));
    let mut places: Vec<f64> = meets.filter(|t| (0.0..=1.0).contains(t)).chain([0.0, 1.0]).collect();
    places.sort_unstable_by(f64::total_cmp);
    places.windows(2).any(|pair| {
        let middle = from + way * (0.5 * (pair[0] + pair[1]));
        outline.distance(middle.x, middle.y) > OUTSIDE_M
    })
}

/// Where the line from `from` along `way` meets the outline, in ways from `from`.
fn meets(shape: &KeepOutShape, from: &Point2<f64>, way: &Vector2<f64>) -> Vec<f64> {
    match shape {
        // |from + t way − c|² = r². Of a way of no length no number is finite.
        KeepOutShape::Circle { center_m, radius_m } => {
            let off = from - Point2::from(*center_m);
            let (a, b) = (way.norm_squared(), way.dot(&off));
            let root = (b * b - a * (off.norm_squared() - radius_m * radius_m)).sqrt();
            vec![(-b - root) / a, (-b + root) / a]
        }
        KeepOutShape::Polygon { points_m } => {
            let edges = points_m.iter().zip(points_m.iter().cycle().skip(1));
            let meet = |(start, end): (&[f64; 2], &[f64; 2])| {
                let (start, edge) = (Point2::from(*start), Point2::from(*end) - Point2::from(*start));
                let across = way.perp(&edge);
                let (t, s) = ((start - from).perp(&edge) / across, (start - from).perp(way) / across);
                // Parallel ones are met at no number; their ends belong to the edges beside them.
                (0.0..=1.0).contains(&s).then_some(t)
            };
            edges.filter_map(meet).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use hairpin_formats::missions::{Fence, Frame, Outline, Whose};
    use nalgebra::Point3;

    use super::*;

    /// A U that opens to the top: from one arm to the other across the bay, and around through the bottom.
    #[test]
    fn a_leg_across_a_bay_leaves_the_fence() {
        let corners = [
            [0.0, 0.0],
            [30.0, 0.0],
            [30.0, 20.0],
            [20.0, 20.0],
            [20.0, 10.0],
            [10.0, 10.0],
            [10.0, 20.0],
            [0.0, 20.0],
        ];
        let shape = KeepOutShape::Polygon { points_m: corners.to_vec() };
        let outline = KeepOuts::new(vec![KeepOut { name: "u".into(), shape }]).unwrap();
        for (a, b, out) in [
            ([5.0, 15.0], [25.0, 15.0], true),
            ([5.0, 12.0], [25.0, 2.0], false),
            ([5.0, 19.0], [25.0, 9.0], true),
            ([5.0, 5.0], [25.0, 5.0], false),
            // Along the bay's bottom edge, and along the outer one.
            ([5.0, 10.0], [25.0, 10.0], false),
            ([0.0, 0.0], [30.0, 0.0], false),
            ([5.0, 10.5], [25.0, 10.5], true),
        ] {
            assert_eq!(leaves(&outline, a, b), out, "{a:?} {b:?}");
        }
    }

    /// Two discs that overlap: places in one of them each, and both on the way.
    fn between_two_discs(firmware: Option<u64>) -> Option<Broken> {
        let disc = |x: f64| Fence { keeps_in: true, outline: Outline::Circle(Point2::new(x, 0.0), 6.0) };
        let mission = Mission {
            name: "m".into(),
            path: "m.plan".into(),
            format: "",
            waypoints: vec![Point3::new(-4.0, 0.0, 2.0), Point3::new(14.0, 0.0, 2.0)],
            sources: Vec::new(),
            rounded: false,
            frame: Frame::World,
            speeds: vec![None],
            accept: Vec::new(),
            whose: Whose { firmware, vehicle: None },
            stops: Vec::new(),
            notes: Vec::new(),
            uncertain: Vec::new(),
            fences: vec![disc(0.0), disc(10.0)],
            environment: None,
        };
        let mut passage = Passage {
            legs: Vec::new(),
            witness: None,
            broken: None,
            estimated: Vec::new(),
            model: String::new(),
            afloat: false,
        };
        hold(&mission, &mut passage);
        passage.broken
    }

    #[test]
    fn px4_demands_any_of_the_fences_that_keep_in_and_ardupilot_all() {
        assert_eq!(between_two_discs(Some(PX4)), None);
        let broken = between_two_discs(Some(ARDUPILOT)).unwrap();
        assert_eq!((broken.waypoint, broken.certainty, broken.excess), (0, Certainty::Proven, Some(8.0)));
        for firmware in [Some(0), None] {
            let broken = between_two_discs(firmware).unwrap();
            assert!(broken.certainty == Certainty::NotFound && broken.words.contains("PX4 (12)"), "{broken:?}");
        }
    }

    #[test]
    fn a_leg_between_two_discs_apart_leaves_both() {
        let disc =
            |x: f64| KeepOut { name: String::new(), shape: KeepOutShape::Circle { center_m: [x, 0.0], radius_m: 4.9 } };
        let outline = KeepOuts::new(vec![disc(0.0), disc(10.0)]).unwrap();
        assert!(leaves(&outline, [0.0, 0.0], [10.0, 0.0]) && !leaves(&outline, [-3.0, 0.0], [3.0, 0.0]));
    }
}
