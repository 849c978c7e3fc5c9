//! How near a move has to come to its target before the next one begins, with the zones that ABB's controllers
//! predefine.
//!
//! Inside a zone the controller leaves the programmed path for a corner to the next one: a point that must be met is
//! `fine`.

/// A stop, or a fly-by with the distances from the target at which the corner path begins.
///
/// Zones of tool and reorientation are lengths of the tool centre point's path: a move that only turns blends by the
/// angle.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// Its name; without one it is written in place.
    pub name: Option<String>,
    /// Whether the arm stops at the target.
    pub fine: bool,
    /// Distance of the tool's centre point, m.
    pub tcp: f64,
    /// Distance of the tool's centre point at which reorientation blends, m.
    pub path_orientation: f64,
    /// Distance of the tool's centre point at which external axes blend, m.
    pub path_external: f64,
    /// Angle at which reorientation blends where the tool's centre point does not move, rad.
    pub orientation: f64,
    /// Distance of linear external axes, m.
    pub linear_external: f64,
    /// Angle of rotating external axes, rad.
    pub rotating_external: f64,
}

/// Name, mm of the tool's centre point, of reorientation and external axes, degrees.
/// (ABB, Technical reference manual, RAPID, `zonedata`.)
const PREDEFINED: [(&str, f64, f64, f64); 15] = [
    ("fine", 0.0, 0.0, 0.0),
    ("z0", 0.3, 0.3, 0.03),
    ("z1", 1.0, 1.0, 0.1),
    ("z5", 5.0, 8.0, 0.8),
    ("z10", 10.0, 15.0, 1.5),
    ("z15", 15.0, 23.0, 2.3),
    ("z20", 20.0, 30.0, 3.0),
    ("z30", 30.0, 45.0, 4.5),
    ("z40", 40.0, 60.0, 6.0),
    ("z50", 50.0, 75.0, 7.5),
    ("z60", 60.0, 90.0, 9.0),
    ("z80", 80.0, 120.0, 12.0),
    ("z100", 100.0, 150.0, 15.0),
    ("z150", 150.0, 225.0, 23.0),
    ("z200", 200.0, 300.0, 30.0),
];

impl Zone {
    /// The zone that controllers predefine under `name` (`fine`, `z0` to `z200`), whatever its case.
    pub fn predefined(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let (_, tcp, others, degrees) = PREDEFINED.into_iter().find(|(known, ..)| *known == name)?;
        let (others, angle) = (others / 1000.0, degrees.to_radians());
        Some(Self {
            fine: name == "fine",
            name: Some(name),
            tcp: tcp / 1000.0,
            path_orientation: others,
            path_external: others,
            orientation: angle,
            linear_external: others,
            rotating_external: angle,
        })
    }

    /// The names of all predefined ones, nearest first.
    pub fn predefined_names() -> impl Iterator<Item = &'static str> {
        PREDEFINED.into_iter().map(|(name, ..)| name)
    }

    /// A stop at the target.
    pub fn stop() -> Self {
        Self {
            name: Some("fine".into()),
            fine: true,
            tcp: 0.0,
            path_orientation: 0.0,
            path_external: 0.0,
            orientation: 0.0,
            linear_external: 0.0,
            rotating_external: 0.0,
        }
    }

    /// The same numbers, whatever they are called.
    ///
    /// NaN is never the same, and whether it stops counts, too: `z0` with its lengths set to 0 is not `fine`.
    pub fn same_as(&self, other: &Self) -> bool {
        let unnamed = |zone: &Self| Self { name: None, ..zone.clone() };
        unnamed(self) == unnamed(other)
    }
}
