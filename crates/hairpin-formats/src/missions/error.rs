//! Why a file is no mission of a world.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use crate::qgc::Wrong;
use crate::waypoints::WaypointsError;

/// Why a file is no mission, or a folder has none.
#[derive(Debug, Error)]
pub enum MissionError {
    /// A table of waypoints that is none.
    #[error(transparent)]
    Waypoints(#[from] WaypointsError),
    /// The file or folder cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's answer.
        cause: io::Error,
    },
    /// A plan or a list of items that is none.
    #[error("{}, {wrong}", path.display())]
    Wrong {
        /// The file.
        path: PathBuf,
        /// Where, what, and what must be.
        wrong: Wrong,
    },
    /// A place that is none of the world's.
    #[error("{}: {why}", path.display())]
    Placed {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
    /// A trajectory has a start and an end.
    #[error("{}: {found} waypoints, must be at least 2 (a take-off counts, what is passed over does not)", path.display())]
    TooFew {
        /// The file.
        path: PathBuf,
        /// Waypoints found.
        found: usize,
    },
    /// A folder without any mission.
    #[error("{}: no .csv file in it, nor a .plan or .waypoints one", path.display())]
    Empty {
        /// The folder.
        path: PathBuf,
    },
}
