//! Floor 3: what moves. Equations and numbers of robots; nothing of trajectories, search or controllers.
//!
//! | room | state x | control u | what it adds |
//! | --- | --- | --- | --- |
//! | [`quadrotor`] | p, q, v, ω (13 numbers) | four rotor speeds | mixing, drag, the published one-step model |
//! | [`ground`] | x, y, ψ and two rates | accelerations | cars, differential drives, and what each is planned as |
//! | [`rover`] | planar pose; the ground settles the rest | curvature, speed | suspension, slip, wheels, forces |
//! | [`arm`] | six joint angles | their rates | kinematics both ways, bounds between samples, torques |
//!
//! Data flow: a `…Description` (a file's keys, units in the names, gaps allowed) → `build` → the robot (SI, rad,
//! checked, immutable). Numbers that `build` derived are named in the robot's `estimated`; a robot that is a stand-in
//! says so in its `caveat`. A mistake in a file is an error with key, value and bound, raised there and nowhere later.
//!
//! Frames: world z up; body x forward, y left, z up; R = Rz(ψ) Ry(θ) Rx(φ), so that θ > 0 is nose down. The claim and
//! the act share these equations, the proof does not.

pub mod arm;
pub mod battery;
pub mod boat;
pub mod estimated;
pub mod ground;
pub mod quadrotor;
pub mod rover;
