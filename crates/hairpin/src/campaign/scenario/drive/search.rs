//! `generate.search` of drives: that of flights, with the score in it and words of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::campaign::scenario::{EXECUTED, SearchMethod, SearchSection, Target};
use crate::judgement::Stress;
use crate::search::Aggregate;
use crate::world::Sampling;

/// Declares the section, and how it becomes that of flights and back; the score stands between two keys that both have.
macro_rules! drive_search {
    (
        $(#[$of_first:meta])* pub $first:ident: $First:ty,
        $(#[$of_score:meta])* score,
        $($(#[$of_key:meta])* pub $key:ident: $Key:ty,)+
    ) => {
        /// `generate.search` of drives.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        pub struct DriveSearch {
            $(#[$of_first])*
            pub $first: $First,
            $(#[$of_score])*
            pub score: String,
            $($(#[$of_key])* pub $key: $Key,)+
        }

        impl DriveSearch {
    /// The score of a scenario that gives none, and of what is executed only in part.
    pub const BY_HAND: &str = "slope+slip";

            fn of(score: &str, section: SearchSection) -> Self {
                Self { $first: section.$first, score: score.to_owned(), $($key: section.$key,)+ }
            }

            /// The part that flights have as well.
            pub fn section(&self) -> SearchSection {
                SearchSection { $first: self.$first, $($key: self.$key.clone(),)+ }
            }
        }
    };
}

drive_search! {
    /// worst | beam | exact | uniform | in-loop | adaptive.
    pub method: SearchMethod,
    /// Terms joined by +: slope, roll, curvature-change, slip, speed, reversals; random; executed; learned:MODEL; or
    /// python:FILE.
    score,
    /// How scores of legs become the score of a trajectory.
    pub aggregate: Aggregate,
    /// Waypoints sampled per graph.
    pub waypoints: u64,
    /// How they are sampled.
    pub sampling: Sampling,
    /// Partial trajectories expanded per iteration.
    pub width: u64,
    /// Cases asked for: one best per sampled graph, unless `per_graph` asks for more.
    pub cases: u64,
    /// Trajectories taken from one graph at most.
    pub per_graph: u64,
    /// Whether a waypoint may be used twice.
    pub revisits: bool,
    /// Iterations per graph at most.
    pub iterations: u64,
    /// Partial trajectories kept on the frontier at most; the worst are dropped.
    pub frontier: u64,
    /// Graphs sampled at most; 20 per case asked for if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub graphs: Option<u64>,
    /// `worst`: executions for each case asked for, all in one pool; `in-loop`, and the score `executed`: executions
    /// per graph at most; `adaptive`: executions of all rounds together.
    pub executions: u64,
    /// `worst`: time for the search, s, in the place of `executions`; what is found then depends on the clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// `worst`, `in-loop`: executions under noise that what would be kept is given in addition; its stress is the mean.
    /// 0: none.
    pub confirm: u64,
    /// `adaptive`: rounds of executing and learning; in the first nothing is known, and all is drawn uniformly. If not
    /// given, one for 45 executions, at least 4 where there are enough, at most 15.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rounds: Option<u64>,
    /// `adaptive`: share of every later round's executions that is drawn uniformly, whatever the model says.
    pub explore: f64,
    /// `adaptive`: time for executing and learning beside `executions`; what is found then depends on the clock.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
    /// `worst`, `in-loop`: whether waypoints are moved off their graph, as far as legs can be solved; if not given,
    /// `worst` moves them and `in-loop` does not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub move_waypoints: Option<bool>,
    /// `worst`: what is searched for; if not given, each limit of `[spec]`, by its margin in spreads of what is drawn
    /// at random: deviation | clearance | acceleration | time | overshoot | tip-over | lateness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Target>,
    /// `in-loop`, `adaptive`, and the score `executed`: what is searched for: max-deviation | mean-deviation |
    /// max-acceleration | time | overshoot | saturation | clearance | tilt.
    pub stress: Stress,
}

impl Default for DriveSearch {
    fn default() -> Self {
        // Every leg is a boundary-value problem: a graph of 60 has some thousand of them within reach.
        Self::of(Self::BY_HAND, SearchSection { waypoints: 60, ..SearchSection::default() })
    }
}

impl DriveSearch {
    /// The name of the score that single legs have.
    pub fn score_of_legs(&self) -> &str {
        if self.score == EXECUTED { Self::BY_HAND } else { &self.score }
    }
}
