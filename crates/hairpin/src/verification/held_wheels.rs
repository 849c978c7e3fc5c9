//! What wheels are held to, as plain numbers.

/// Which wheels steer, and what all may do: infinite where nothing binds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldWheels {
    /// Which ones steer.
    pub steered: SteeredWheels,
    /// Largest |steer angle|, rad.
    pub steer_rad: f64,
    /// Largest rate of it while driving, rad/s.
    pub steer_rate_rad_s: f64,
    /// Largest |rolling speed|, rad/s.
    pub speed_rad_s: f64,
    /// Largest change of it while driving, rad/s².
    pub acceleration_rad_s2: f64,
}

/// Which wheels steer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SteeredWheels {
    /// The foremost and the rearmost.
    Corners,
    /// The foremost; what is commanded is the motion of the middle of the others.
    Front,
    /// All.
    All,
    /// None: each turns about half of this track, m.
    Skid(f64),
}
