//! Floor 3: what moves. Equations and numbers of robots; nothing of trajectories, search or controllers.

pub mod arm;
pub mod ground;
pub mod quadrotor;
pub mod rover;
