//! How fast a move is programmed, with the speeds that ABB's controllers predefine.
//!
//! A move takes as long as the slowest of its four speeds says; an arm's own joint limits come on top.

/// Programmed speeds; the slowest of them governs.
#[derive(Debug, Clone, PartialEq)]
pub struct Speed {
    /// Its name; without one it is written in place.
    pub name: Option<String>,
    /// Of the tool's centre point, m/s; infinite: as fast as the arm can (`vmax`).
    pub tcp: f64,
    /// Of reorientation, rad/s.
    pub orientation: f64,
    /// Of linear external axes, m/s.
    pub linear_external: f64,
    /// Of rotating external axes, rad/s.
    pub rotating_external: f64,
}

/// The predefined ones, in mm/s. (ABB, Technical reference manual, RAPID, `speeddata`.)
const PREDEFINED: [u32; 25] = [
    5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000, 2500, 3000, 4000, 5000,
    6000, 7000,
];

impl Speed {
    /// The speed that controllers predefine under `name` (`v5` to `v7000`, `vmax`), whatever its case: 500 °/s, 5000
    /// mm/s and 1000 °/s beside the number in mm/s.
    pub fn predefined(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let tcp = match name.strip_prefix('v')? {
            "max" => f64::INFINITY,
            digits => {
                let known = PREDEFINED.into_iter().find(|speed| speed.to_string() == digits)?;
                f64::from(known) / 1000.0
            }
        };
        Some(Self {
            name: Some(name),
            tcp,
            orientation: 500_f64.to_radians(),
            linear_external: 5.0,
            rotating_external: 1000_f64.to_radians(),
        })
    }

    /// The names of all predefined ones, slowest first.
    pub fn predefined_names() -> impl Iterator<Item = String> {
        PREDEFINED.into_iter().map(|speed| format!("v{speed}")).chain(["vmax".into()])
    }

    /// The same numbers, whatever they are called.
    pub fn same_as(&self, other: &Self) -> bool {
        let numbers = |s: &Self| [s.tcp, s.orientation, s.linear_external, s.rotating_external];
        numbers(self) == numbers(other)
    }

    /// No component above `cap`'s; with a predefined name where there is one, with its own where nothing changes.
    ///
    /// Component by component, min(self, cap).
    pub fn capped(&self, cap: &Self) -> Self {
        let mut slow = Self {
            name: None,
            tcp: self.tcp.min(cap.tcp),
            orientation: self.orientation.min(cap.orientation),
            linear_external: self.linear_external.min(cap.linear_external),
            rotating_external: self.rotating_external.min(cap.rotating_external),
        };
        if slow.same_as(self) {
            return self.clone();
        }
        slow.name = Self::predefined_names()
            .find(|name| Self::predefined(name).is_some_and(|known| known.same_as(&slow)))
            .or_else(|| cap.name.clone().filter(|_| slow.same_as(cap)));
        slow
    }
}
