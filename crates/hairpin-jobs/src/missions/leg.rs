//! What becomes a case.

use hairpin_formats::missions::Mission;
use nalgebra::Point3;

use crate::check::Checked;

/// A mission, or what of it lies between two stops, as a case is made of it.
pub(crate) struct Leg {
    /// Its name: the file's, with the waypoints where it is not all of it.
    pub(crate) name: String,
    pub(crate) waypoints: Vec<Point3<f64>>,
    /// Its first and last waypoint in the mission.
    pub(crate) ends: [usize; 2],
    /// What the mission asks of it that is not what is carried out, in sentences' parts.
    pub(crate) unmet: Vec<String>,
    /// What the claim says of the whole mission; `None` where it is not asked.
    pub(crate) checked: Option<Checked>,
    pub(crate) mission: Mission,
}
