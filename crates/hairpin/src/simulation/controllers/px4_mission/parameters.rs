//! PX4's parameters as v1.16 has them by default, under their names there, in m and s.
//!
//! Source: PX4's parameter reference, v1.16. Of `NAV_ACC_RAD` (10 in the source, 2 by the multicopter defaults of
//! v1.16, which later versions dropped) nothing is taken: missions are sent with their own acceptance radius.

/// Horizontal speed of missions.
pub(super) const MPC_XY_CRUISE: f64 = 5.0;
/// Horizontal acceleration of missions.
pub(super) const MPC_ACC_HOR: f64 = 3.0;
/// Jerk of missions, each axis.
pub(super) const MPC_JERK_AUTO: f64 = 4.0;
/// Climbing and sinking in missions.
pub(super) const MPC_Z_V_AUTO_UP: f64 = 3.0;
pub(super) const MPC_Z_V_AUTO_DN: f64 = 1.5;
/// Accelerations up and down.
pub(super) const MPC_ACC_UP_MAX: f64 = 4.0;
pub(super) const MPC_ACC_DOWN_MAX: f64 = 3.0;
/// Share of the horizontal acceleration that a turn at a waypoint may take.
pub(super) const MPC_XY_TRAJ_P: f64 = 0.5;
/// Set points wait for a robot that is so far behind.
pub(super) const MPC_XY_ERR_MAX: f64 = 2.0;
/// Height within which a waypoint counts as reached.
pub(super) const NAV_MC_ALT_RAD: f64 = 0.8;

/// Velocity per position error, 1/s.
pub(super) const MPC_XY_P: f64 = 0.95;
pub(super) const MPC_Z_P: f64 = 1.0;
/// Acceleration per velocity error, its integral, and less per measured acceleration.
pub(super) const MPC_XY_VEL_P_ACC: f64 = 1.8;
pub(super) const MPC_XY_VEL_I_ACC: f64 = 0.4;
pub(super) const MPC_XY_VEL_D_ACC: f64 = 0.2;
pub(super) const MPC_Z_VEL_P_ACC: f64 = 4.0;
pub(super) const MPC_Z_VEL_I_ACC: f64 = 2.0;
pub(super) const MPC_Z_VEL_D_ACC: f64 = 0.0;
/// Corner of the low-pass on the measured acceleration, Hz.
pub(super) const MPC_VELD_LP: f64 = 5.0;
/// Largest velocities that position control asks for; down 1.2 · `MPC_Z_V_AUTO_DN`, which leaves room to correct.
pub(super) const MPC_XY_VEL_MAX: f64 = 12.0;
pub(super) const MPC_Z_VEL_MAX_UP: f64 = 3.0;
pub(super) const VEL_MAX_DN: f64 = 1.2 * MPC_Z_V_AUTO_DN;
/// 45°.
pub(super) const MPC_TILTMAX_AIR: f64 = std::f64::consts::FRAC_PI_4;
/// In shares of all thrust: the least, the most, and what is kept for the horizontal.
pub(super) const MPC_THR_MIN: f64 = 0.12;
pub(super) const MPC_THR_MAX: f64 = 1.0;
pub(super) const MPC_THR_XY_MARG: f64 = 0.3;
