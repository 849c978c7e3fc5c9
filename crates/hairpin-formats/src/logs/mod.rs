//! Logs of robots that moved, whichever program wrote them, in one shape: metres, seconds, bodies forward, left, up.
//!
//! Readers convert axes at this door and nowhere else, and align nothing: what a log's frame is, whose stamps it has and who
//! estimated its poses is told beside them.

mod log;

pub use log::{Clock, Event, EventKind, Joints, LogFrame, Logged, LoggedMotion, Progress, Reset, Sample, Source, Span};
