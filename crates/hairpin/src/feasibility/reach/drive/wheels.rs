//! What a drive asks of its wheels, step by step: steer angles, their rates, rolling speeds and their changes, held to
//! what the wheels may do.

use super::settings::DriveSettings;
use super::tally::LegRefusal;
use crate::feasibility::steering::shooting::rough::Driven;
use crate::robot::rover::{Rover, Twist, WheelMotion};

/// Share of a bound of angles and speeds that is left for what lies between two looks.
const ROOM: f64 = 1e-3;
/// The same of their rates, which are differences from look to look, and err low by what bends between them.
const ROOM_OF_RATES: f64 = 0.02;

/// A drive under way.
///
/// Rates are those at the commanded speed, whichever way it changes: what a leg keeps it keeps at every lower speed
/// too.
///
/// ```text
/// δ̇ = |Δδ/Δs| v      ω = |rolls| v / r      ω̇ = (|Δrolls/Δs| v² + |rolls| a) / r
/// ```
///
/// v the commanded speed (m/s), a the hardest change of it (m/s²), r the wheels' radius (m); in a turn in place v is
/// the rate of turns, and neither rate is asked. Where the gear changes and around turns in place the vehicle stands,
/// and its wheels may swing.
#[derive(Debug, Default)]
pub(super) struct WheelWatch {
    /// What the wheels did a step ago, after how many metres, and in which stretch: −1 reverse, 0 in place, 1 forward.
    before: Option<([WheelMotion; 6], f64, f64)>,
}

impl WheelWatch {
    /// Looks at a step of a vehicle that travels at `direction` (rad) in its body.
    ///
    /// # Errors
    /// The first bound of the wheels that is broken: angle, speed, rate of the angle, change of the speed.
    pub(super) fn keep(
        &mut self,
        rover: &Rover,
        settings: &DriveSettings,
        direction: f64,
        driven: &Driven,
    ) -> Result<(), LegRefusal> {
        let bounds = &rover.wheels;
        if !bounds.are_held() {
            return Ok(());
        }
        let sign = driven.step.signum();
        let (twist, speed, stretch) = if driven.in_place {
            (Twist { turn: sign, ..Twist::IN_PLACE }, settings.turn_rate, 0.0)
        } else {
            (Twist::along(direction, driven.at.curvature, sign), settings.speed, sign)
        };
        let last = self.before.take();
        let (motions, count) =
            rover.wheel_motions(&twist, &driven.settled.joints, last.as_ref().map(|(motions, ..)| motions));
        let radius = rover.suspension.wheels(&[0.0; 3]).2;
        let keep = |value: f64, bound: f64, room: f64, refusal: LegRefusal| {
            if value <= bound * (1.0 - room) { Ok(()) } else { Err(refusal) }
        };
        for wheel in &motions[..count] {
            keep(wheel.steer.abs(), bounds.steer, ROOM, LegRefusal::SteerAngle)?;
            keep(wheel.rolls.abs() * speed / radius, bounds.speed, ROOM, LegRefusal::WheelSpeed)?;
        }
        if let Some((before, s, of)) = last
            && of == stretch
            && driven.s > s
        {
            let way = driven.s - s;
            let acceleration = settings.pace.acceleration();
            for (wheel, before) in motions[..count].iter().zip(&before) {
                let steered = (wheel.steer - before.steer).abs() / way * speed;
                keep(steered, bounds.steer_rate, ROOM_OF_RATES, LegRefusal::SteerRate)?;
                let rolled = (wheel.rolls - before.rolls).abs() / way * speed * speed;
                let changed = (rolled + wheel.rolls.abs() * acceleration) / radius;
                keep(changed, bounds.acceleration, ROOM_OF_RATES, LegRefusal::WheelAcceleration)?;
            }
        }
        self.before = Some((motions, driven.s, stretch));
        Ok(())
    }
}
