"""Flies hairpin's missions with ArduPilot's Copter over MAVLink: GUIDED or AUTO. `pip install pymavlink==2.4.50`.

    # SITL, ten times real time, a fresh one for each mission
    hairpin stress quadrotor.toml --executor "python3 examples/executors/ardupilot_mavlink.py --speedup 10 \\
        --start 'build/sitl/bin/arducopter -w -I {instance} --model quad --defaults Tools/autotest/default_params/copter.parm'"
    # one that runs already (`sim_vehicle.py -v ArduCopter`), as a mission
    … --executor "python3 examples/executors/ardupilot_mavlink.py --mode auto"

Written against ArduPilot's documented interface and run with a stand-in for it (tests/python/fake_autopilot.py), not yet
with ArduPilot itself. `--mode guided` streams set points at `--rate-hz` of simulated time: the timed motion with its
velocities, or with `--setpoints waypoints` the next waypoint. `--mode auto` uploads a mission (item 0 is home, then
take-off at waypoint 0 and the waypoints) and takes the leg from MISSION_CURRENT; Copter's acceptance radius is the
parameter WPNAV_RADIUS (WP_RADIUS_M from 4.7 on), which is always set. `--limits` sets speed and tilt as well. The nose
stays where the approach left it (WP_YAW_BEHAVIOR 0). With `--start` the simulation begins anew for each mission; else the
vehicle flies back to the next mission's start. Several processes: instance i listens at port 5760 + 10 i. SIM_STATE has no
time of its own: poses of `--truth` have that of the last message before, so ask for a high `--rate-hz`.
"""
from mavlink_flight import mavlink, serve
from mavlink_frames import Scaled


class ArduPilot:
    """ArduPilot's Copter over MAVLink, as an executor of hairpin's missions."""

    NAME, ADDRESS, PORT_STEP, SPEED_OPTION = "ArduPilot", "tcp:127.0.0.1:5760", 10, "--speedup"
    STEERED, UPLOADED, MISSION, BYTEWISE, PROJECTION, HOME_ITEMS = "GUIDED", "auto", "AUTO", False, Scaled, 1
    TRUTH = [mavlink.MAVLINK_MSG_ID_SIM_STATE]
    MODES = {
        "STABILIZE": (0,), "ACRO": (1,), "ALT_HOLD": (2,), "AUTO": (3,), "GUIDED": (4,), "LOITER": (5,), "RTL": (6,),
        "CIRCLE": (7,), "LAND": (9,), "POSHOLD": (16,), "BRAKE": (17,), "SMART_RTL": (21,),
    }
    # By the names until 4.6 (cm/s, cdeg, cm), and from 4.7 on.
    LIMITS = {
        "max_speed_m_s": [("WPNAV_SPEED", 100.0), ("WP_SPD", 1.0)],
        "max_tilt_deg": [("ANGLE_MAX", 100.0), ("ATC_ANGLE_MAX", 1.0)],
    }
    RADIUS = [("WPNAV_RADIUS", 100.0), ("WP_RADIUS_M", 1.0)]

    def environment(self, options):
        return {}

    def mode_name(self, number):
        return next((name for name, of in self.MODES.items() if of == (number,)), f"mode {number}")

    def prepare(self, vehicle, options):
        vehicle.set_parameter([("WP_YAW_BEHAVIOR", 1.0)], 0.0)
        vehicle.set_parameter([("MIS_RESTART", 1.0)], 1.0)
        if options.speed:
            vehicle.set_parameter([("SIM_SPEEDUP", 1.0)], options.speed)

    def take_off(self, vehicle, height, heading, patience_s):
        """From the ground by a command of its own, which has to be armed first."""
        vehicle.target = None
        vehicle.enter("GUIDED", patience_s)
        ground = vehicle.landed is not False or not vehicle.armed
        vehicle.arm(patience_s)
        if ground:
            vehicle.must(mavlink.MAV_CMD_NAV_TAKEOFF, "take-off", 0, 0, 0, 0, 0, 0, height)
            vehicle.wait_for(lambda: -vehicle.place[1][2] > 0.5 * height, 60, "it does not take off")

    def hold(self, vehicle):
        if vehicle.armed:
            vehicle.set_mode("GUIDED")
        vehicle.target = None

    def land(self, vehicle):
        vehicle.command(mavlink.MAV_CMD_DO_SET_MODE, mavlink.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED, *self.MODES["LAND"])


if __name__ == "__main__":
    serve(ArduPilot())
