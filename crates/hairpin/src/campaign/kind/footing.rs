//! What stands under a robot that drives, for motions and missions whose heights are not their own: planar estimators
//! and simulators tell where on a map a vehicle was, and what drives is as high as the ground there.

/// A way as long as this tells the heading of a motion without attitudes, m.
const WAY_M: f64 = 0.05;

/// The ground under a robot.
///
/// m and rad, world frame.
pub trait Footing {
    /// Height of the ground at (x, y), m; `None` where there is none.
    fn ground(&self, x: f64, y: f64) -> Option<f64>;

    /// Heights (m) of the robot's origin where it rests at each \[x, y, ψ\] of a way, as plans and runs have it;
    /// `None` where it finds no rest.
    fn resting(&self, way: &[[f64; 3]]) -> Vec<Option<f64>>;
}

/// Heights of a motion on the ground.
#[derive(Debug, Clone, PartialEq)]
pub struct OnGround {
    /// At each of its places, m.
    pub heights: Vec<f64>,
    /// Places at which the robot cannot stand, so that nobody knows its height; rising.
    pub lost: Vec<usize>,
}

impl OnGround {
    /// Of a motion over `places` \[x, y\], m, whose headings (rad) are told, or those of its way where they are not.
    ///
    /// Off the map it is as high above the ground as it was last: that it is off the map is told by its places.
    pub fn of(footing: &dyn Footing, places: &[[f64; 2]], told: &[Option<f64>]) -> Self {
        let headings = headings(places);
        let told = told.iter().copied().chain(std::iter::repeat(None));
        let with = places.iter().zip(headings).zip(told);
        let way: Vec<[f64; 3]> = with.map(|(([x, y], way), told)| [*x, *y, told.unwrap_or(way)]).collect();
        let (mut lost, mut above, mut last) = (Vec::new(), 0.0, 0.0);
        let mut heights = Vec::with_capacity(way.len());
        for (i, ([x, y], rest)) in places.iter().zip(footing.resting(&way)).enumerate() {
            let ground = footing.ground(*x, *y);
            match (rest, ground) {
                (Some(rest), _) => (last, above) = (rest, ground.map_or(above, |ground| rest - ground)),
                (None, Some(ground)) => {
                    last = ground + above;
                    lost.push(i);
                }
                (None, None) => {}
            }
            heights.push(last);
        }
        Self { heights, lost }
    }

    /// Whose heights they are: `those of the vehicle on the map's ground, with the log's headings`.
    pub fn in_words(whose: Option<&str>) -> String {
        let by = whose.map_or("the headings of its way".to_owned(), |whose| format!("the {whose}'s headings"));
        format!("those of the vehicle on the map's ground, with {by}")
    }
}

/// ψ of the way at each of its places, rad; 0 of what does not move.
fn headings(places: &[[f64; 2]]) -> Vec<f64> {
    let mut headings = Vec::with_capacity(places.len());
    let Some(first) = places.first() else { return headings };
    let (mut from, mut heading) = (*first, None);
    for place in places {
        let way = [place[0] - from[0], place[1] - from[1]];
        if libm::hypot(way[0], way[1]) >= WAY_M {
            let turned = libm::atan2(way[1], way[0]);
            if heading.is_none() {
                // Before it has moved it stands as it sets off.
                headings.fill(turned);
            }
            (from, heading) = (*place, Some(turned));
        }
        headings.push(heading.unwrap_or(0.0));
    }
    headings
}
