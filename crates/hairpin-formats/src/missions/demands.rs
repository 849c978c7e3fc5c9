//! What a mission made elsewhere asks of what is executed, beside the spec: as campaign folders and repro files keep
//! it.

use hairpin::campaign::bounds::FARTHEST_ON_EARTH_M;
use hairpin::world::terrain::KeepOutShape;
use serde::{Deserialize, Serialize};

use super::{Fence, Mission};

/// Corners of one fence at most.
const MOST_CORNERS: usize = 10_000;

/// What is asked of one case.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Demands {
    /// Whether it is what lies between two stops, and not all of a mission.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub part: bool,
    /// What the mission asks that is not what was executed: its case is inconclusive.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub unmet: Vec<String>,
    /// Its own fences, which what is executed is held against.
    #[serde(skip_serializing_if = "Fences::is_empty")]
    pub fences: Fences,
}

/// The fences of a mission.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Fences {
    /// `MAV_AUTOPILOT` of who flies it, where its file says so.
    pub firmware: Option<u64>,
    /// Each of them.
    pub fences: Vec<FenceTold>,
}

/// One of them, in metres of the world: a circle's centre and radius, or corners.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FenceTold {
    /// Whether the vehicle must stay inside; else outside.
    pub keeps_in: bool,
    /// x, y and radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle_m: Option<[f64; 3]>,
    /// x, y of each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners_m: Vec<[f64; 2]>,
}

impl Demands {
    /// Whether nothing is asked.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Whether its numbers are places.
    ///
    /// # Errors
    /// The key that is none, with its value and its bound.
    pub fn check(&self) -> Result<(), String> {
        let is_place = |x: &f64| x.abs() <= FARTHEST_ON_EARTH_M;
        for (i, fence) in self.fences.fences.iter().enumerate() {
            let refuse = |what: String| Err(format!("mission.fences.fences[{i}]: {what}"));
            match (&fence.circle_m, &fence.corners_m[..]) {
                (Some(circle), []) if circle.iter().all(is_place) && circle[2] > 0.0 => {}
                (Some(circle), []) => {
                    return refuse(format!(
                        "circle_m = {circle:?}: must be x, y, radius > 0, {FARTHEST_ON_EARTH_M} m at most"
                    ));
                }
                (None, corners) if !(3..=MOST_CORNERS).contains(&corners.len()) => {
                    return refuse(format!("{} corners: must be 3 … {MOST_CORNERS}", corners.len()));
                }
                (None, corners) => {
                    if let Some(corner) = corners.iter().find(|corner| !corner.iter().all(is_place)) {
                        return refuse(format!("corner {corner:?}: must be m, {FARTHEST_ON_EARTH_M} at most"));
                    }
                }
                (Some(_), [..]) => return refuse("must have either circle_m or corners_m".into()),
            }
        }
        Ok(())
    }
}

impl Fences {
    /// Those of `mission`.
    pub fn of(mission: &Mission) -> Self {
        Self { firmware: mission.whose.firmware, fences: mission.fences.iter().map(FenceTold::of).collect() }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.fences.is_empty()
    }
}

impl FenceTold {
    fn of(fence: &Fence) -> Self {
        let (circle_m, corners_m) = match fence.outline.shape() {
            KeepOutShape::Circle { center_m: [x, y], radius_m } => (Some([x, y, radius_m]), Vec::new()),
            KeepOutShape::Polygon { points_m } => (None, points_m),
        };
        Self { keeps_in: fence.keeps_in, circle_m, corners_m }
    }

    /// What it encloses.
    pub fn shape(&self) -> KeepOutShape {
        match self.circle_m {
            Some([x, y, radius_m]) => KeepOutShape::Circle { center_m: [x, y], radius_m },
            None => KeepOutShape::Polygon { points_m: self.corners_m.clone() },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As they were written before repro files had them too.
    #[test]
    fn what_is_asked_is_read_back() {
        let circle = FenceTold { keeps_in: true, circle_m: Some([1.0, 2.0, 3.0]), corners_m: Vec::new() };
        let corners =
            FenceTold { keeps_in: false, circle_m: None, corners_m: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]] };
        let fences = Fences { firmware: Some(12), fences: vec![circle, corners] };
        let demands = Demands { part: true, unmet: vec!["a".into()], fences };
        let json = serde_json::to_value(&demands).unwrap();
        assert_eq!(json["fences"]["fences"][0]["circle_m"], serde_json::json!([1.0, 2.0, 3.0]));
        let read: Demands = serde_json::from_value(json.clone()).unwrap();
        assert!(read == demands && read.check().is_ok() && !read.is_none());
        assert_eq!(serde_json::to_value(Demands::default()).unwrap(), serde_json::json!({}));
        for (key, value, told) in [
            ("circle_m", serde_json::json!([1.0, 2.0, -3.0]), "radius > 0"),
            ("circle_m", serde_json::json!([1e12, 2.0, 3.0]), "at most"),
            ("corners_m", serde_json::json!([[0.0, 0.0]]), "either"),
        ] {
            let mut edited = json.clone();
            edited["fences"]["fences"][0][key] = value;
            let refused = serde_json::from_value::<Demands>(edited).unwrap().check().unwrap_err();
            assert!(refused.starts_with("mission.fences.fences[0]") && refused.contains(told), "{refused}");
        }
    }
}
