//! Motion that controllers know and that is not modelled here, by what it is.

/// Why a line that is understood as words is not followed: from here on the arm does what no model here says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unmodelled {
    /// Tracks, positioners, servo tools, axes that move on their own.
    ExternalAxes,
    /// Conveyors, and work objects that something moves.
    Conveyors,
    /// Several arms in one motion (MultiMove).
    MultiMove,
    /// Paths that sensors correct.
    Corrections,
    /// Servos that give way.
    SoftServos,
    /// Forces that are controlled.
    ForceControl,
    /// Loads that change.
    Payload,
    /// Zones in the world at which the arm stops.
    WorldZones,
    /// Moves with triggers along the path.
    Triggers,
    /// Motion that comes from outside the program.
    Guidance,
    /// Moves that end where a signal says.
    Searches,
    /// Frames that are shifted while the program runs.
    Displacements,
    /// Speeds and accelerations that are changed on the way.
    Speeds,
    /// Another way of getting from target to target.
    Interpolation,
    /// Paths that are stopped, stored and gone back.
    Restarts,
    /// Moves of a process: welding, gluing, painting.
    Processes,
    /// Interrupts whose traps move the arm.
    Interrupts,
    /// Handlers of errors, UNDO and BACKWARD that move the arm.
    Handlers,
    /// Tools that stand in the cell, work objects that are held.
    StandingTools,
}

impl Unmodelled {
    /// All of them.
    pub const ALL: [Self; 19] = [
        Self::ExternalAxes,
        Self::Conveyors,
        Self::MultiMove,
        Self::Corrections,
        Self::SoftServos,
        Self::ForceControl,
        Self::Payload,
        Self::WorldZones,
        Self::Triggers,
        Self::Guidance,
        Self::Searches,
        Self::Displacements,
        Self::Speeds,
        Self::Interpolation,
        Self::Restarts,
        Self::Processes,
        Self::Interrupts,
        Self::Handlers,
        Self::StandingTools,
    ];

    /// For machines.
    pub fn word(self) -> &'static str {
        match self {
            Self::ExternalAxes => "external-axes",
            Self::Conveyors => "conveyors",
            Self::MultiMove => "multimove",
            Self::Corrections => "corrections",
            Self::SoftServos => "soft-servos",
            Self::ForceControl => "force-control",
            Self::Payload => "payload",
            Self::WorldZones => "world-zones",
            Self::Triggers => "triggers",
            Self::Guidance => "guidance",
            Self::Searches => "searches",
            Self::Displacements => "displacements",
            Self::Speeds => "speeds",
            Self::Interpolation => "interpolation",
            Self::Restarts => "restarts",
            Self::Processes => "processes",
            Self::Interrupts => "interrupts",
            Self::Handlers => "handlers",
            Self::StandingTools => "standing-tools",
        }
    }

    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            Self::ExternalAxes => "external axes",
            Self::Conveyors => "conveyors and other work objects that move",
            Self::MultiMove => "arms that move together",
            Self::Corrections => "path corrections",
            Self::SoftServos => "soft servos",
            Self::ForceControl => "force control",
            Self::Payload => "payload changes",
            Self::WorldZones => "world zones",
            Self::Triggers => "triggers along the path",
            Self::Guidance => "motion guided from outside",
            Self::Searches => "moves that end at a signal",
            Self::Displacements => "displaced frames",
            Self::Speeds => "speeds and accelerations changed on the way",
            Self::Interpolation => "another interpolation",
            Self::Restarts => "paths stopped, stored and gone back",
            Self::Processes => "moves of a process",
            Self::Interrupts => "interrupts that move the arm",
            Self::Handlers => "handlers that move the arm",
            Self::StandingTools => "tools that stand in the cell",
        }
    }
}
