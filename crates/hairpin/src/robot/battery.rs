//! What a robot's battery lasts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Of a charge, kept back where a file does not say: what flight manuals usually do.
const RESERVE: f64 = 0.2;

/// A battery as a file has it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BatteryDescription {
    /// How long a full charge lasts in the air, as data sheets have it.
    pub endurance_s: f64,
    /// Share of it that is kept back; 0.2 if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reserve: Option<f64>,
}

/// A battery.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Battery {
    /// How long a full charge lasts, s.
    pub endurance: f64,
    /// Share of it that is kept back.
    pub reserve: f64,
}

impl BatteryDescription {
    /// Checks both numbers.
    ///
    /// # Errors
    /// The key, its value and its bound.
    pub(super) fn build(&self) -> Result<Battery, (&'static str, f64, &'static str)> {
        let reserve = self.reserve.unwrap_or(RESERVE);
        match (self.endurance_s, reserve) {
            (endurance, _) if !(1.0..=1e6).contains(&endurance) => {
                Err(("battery.endurance_s", endurance, "a number from 1 to 1e6"))
            }
            (_, reserve) if !(0.0..=0.9).contains(&reserve) => {
                Err(("battery.reserve", reserve, "a number from 0 to 0.9"))
            }
            (endurance, reserve) => Ok(Battery { endurance, reserve }),
        }
    }
}

impl Battery {
    /// What of a charge is flown, s.
    pub fn usable(&self) -> f64 {
        self.endurance * (1.0 - self.reserve)
    }

    /// Which charge each of these flights (s), in their order, is flown on, from 0; `None` of one that is longer than a
    /// charge. A battery is changed where the next flight does not fit into what is left of it.
    pub fn charges(&self, flights: &[f64]) -> Vec<Option<usize>> {
        let (mut charge, mut left) = (0, self.usable());
        let mut on = |flight: &f64| {
            if *flight > self.usable() {
                return None;
            }
            if *flight > left {
                (charge, left) = (charge + 1, self.usable());
            }
            left -= flight;
            Some(charge)
        };
        flights.iter().map(&mut on).collect()
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn a_charge_carries_what_fits_into_it() {
        let battery = BatteryDescription { endurance_s: 100.0, reserve: None }.build().unwrap();
        assert_eq!(battery.usable(), 80.0);
        assert_eq!(
            battery.charges(&[30.0, 50.0, 1.0, 81.0, 79.0, 1.0]),
            [Some(0), Some(0), Some(1), None, Some(1), Some(2)]
        );
        let wrong = |endurance_s, reserve| BatteryDescription { endurance_s, reserve }.build().unwrap_err().0;
        assert_eq!(wrong(f64::NAN, None), "battery.endurance_s");
        assert_eq!((wrong(0.0, None), wrong(60.0, Some(0.95))), ("battery.endurance_s", "battery.reserve"));
    }
}
