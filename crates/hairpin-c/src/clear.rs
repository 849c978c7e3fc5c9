//! Drives that stay clear of places: the one look for them that takes memory.

use hairpin::feasibility::steering::clear::{Around, Hazards, Intrusion, footprint};
use hairpin::feasibility::steering::shooting::Control;
use hairpin::feasibility::steering::shooting::rough::Status;
use hairpin::feasibility::steering::shooting::solve::{Choices, Method};
use hairpin::trajectory::drive::Planar;
use hairpin::world::terrain::{ElevationMap, KeepOut, KeepOutShape, KeepOuts};

use crate::drive::{Drive, HAIRPIN_INFEASIBLE, HAIRPIN_SOLVED, State};
use crate::ground::{FLAT, Found};
use crate::memory::{given, many, put, result};
use crate::refusal::{Code, Error, Refused, enter};
use crate::steer::SteerHandle;

/// A place to keep out of: a disc, or a polygon where it has corners.
#[repr(C)]
pub struct KeepOutPlace {
    /// Middle of the disc, x and y, m.
    pub center_m: [f64; 2],
    /// Its radius, m.
    pub radius_m: f64,
    /// Corners of a polygon in turn, x and y each, m; NULL: a disc.
    pub corners_m: *const f64,
    /// How many, 3 or more; 0 of a disc.
    pub corners: usize,
}

/// Looks for a drive as hairpin_steer does, and around `places`: the circle about all wheels and the underside stays
/// out of them, on a map along the predicted motion. Takes memory, and knows no budget.
///
/// Where none stays clear the answer is HAIRPIN_INFEASIBLE with `keep_out`, and `excess` says by how many metres the
/// drive comes too near.
///
/// @param steer what is asked
/// @param start where the vehicle is, on the map or anywhere in the plane
/// @param goal where it is to be, in the same frame
/// @param places what it keeps out of, in the same frame
/// @param count how many
/// @param drive the answer
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_steer_clear(
    steer: *const SteerHandle,
    start: *const State,
    goal: *const State,
    places: *const KeepOutPlace,
    count: usize,
    drive: *mut Drive,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, with as many places and corners, as the header has it.
    unsafe {
        enter(error, || {
            let (steer, start, goal) = (given(steer, "steer")?, given(start, "start")?, given(goal, "goal")?);
            let place = result(drive, "drive")?;
            let listed: Result<Vec<KeepOut>, Refused> =
                many(places, count, "places")?.iter().map(|of| of.read()).collect();
            let keep_outs = KeepOuts::new(listed?).map_err(Refused::invalid)?;
            put(place, steer.clear_of(&keep_outs, &start.planar(), &goal.planar())?)
        })
    }
}

impl KeepOutPlace {
    /// The place.
    ///
    /// # Safety
    /// It has as many corners as it says.
    unsafe fn read(&self) -> Result<KeepOut, Refused> {
        let shape = if self.corners_m.is_null() && self.corners == 0 {
            KeepOutShape::Circle { center_m: self.center_m, radius_m: self.radius_m }
        } else {
            // SAFETY: handed on.
            let corners = unsafe { many(self.corners_m, self.corners.saturating_mul(2), "corners_m")? };
            KeepOutShape::Polygon { points_m: corners.as_chunks().0.to_vec() }
        };
        Ok(KeepOut { name: String::new(), shape })
    }
}

impl SteerHandle {
    fn clear_of(&self, keep_outs: &KeepOuts, start: &Planar, goal: &Planar) -> Result<Drive, Refused> {
        if keep_outs.is_empty() {
            return self.answer(start, goal);
        }
        let hazards = self.hazards(start, keep_outs);
        let query = match self.question(start, goal)? {
            Ok(query) => query,
            Err(answered) => return Ok(answered.near(hazards.intrusion(&[]))),
        };
        let shaping = self.shaping(start);
        let Some(map) = &self.map else { return Ok(self.in_the_plane(&query, &shaping, &hazards)) };
        let around = |choices| Around { keep_outs, radius: hazards.radius, control: self.control, choices };
        let choices = self.settings.choices(FLAT);
        let found = self.cleared(map, [start, goal], &around(choices));
        let usual = self.control == Control::Quintic;
        Ok(match found.0.answer.status {
            // Closed forms change steadily with their goal where arcs do not.
            Status::NotConverged { .. } if usual => {
                let closed = Choices { arcs: false, ..choices };
                let (second, near) = self.cleared(map, [start, goal], &around(closed));
                self.told(&second, goal).near(near)
            }
            _ => self.told(&found.0, goal).near(found.1),
        })
    }

    fn cleared(
        &self,
        map: &ElevationMap,
        [start, goal]: [&Planar; 2],
        around: &Around<'_>,
    ) -> (Found, Option<Intrusion>) {
        let (shaping, ground) = (self.shaping(start), self.settings.ground());
        let cleared = self.site(map).solve_clear(start, goal, &shaping, &ground, around, &|| false);
        let method = cleared.method.unwrap_or(Method::SingleArc);
        (Found { answer: cleared.answer, method, looks: 0, spent: false }, cleared.intrusion)
    }

    /// `keep_outs` as a drive from `start` meets them.
    pub(crate) fn hazards<'a>(&self, start: &Planar, keep_outs: &'a KeepOuts) -> Hazards<'a> {
        Hazards { keep_outs, start: *start, direction: self.settings.direction_rad, radius: footprint(&self.rover) }
    }
}

impl Drive {
    /// Solved no more where it comes too near to a place.
    pub(crate) fn near(self, intrusion: Option<Intrusion>) -> Self {
        match intrusion {
            Some(Intrusion { depth, .. }) if self.status == HAIRPIN_SOLVED => {
                Self { status: HAIRPIN_INFEASIBLE, ..self }.over("keep_out", Some(depth))
            }
            _ => self,
        }
    }
}
