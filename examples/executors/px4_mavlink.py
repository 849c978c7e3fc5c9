"""Flies hairpin's missions with PX4 over MAVLink: in offboard mode or as uploaded missions. `pip install pymavlink==2.4.50`.

    # PX4's simulator inside PX4 (SIH), lockstep, five times real time, a fresh one for each mission
    hairpin stress quadrotor.toml --executor "python3 examples/executors/px4_mavlink.py --speed-factor 5 \\
        --start 'PX4_SIM_MODEL=sihsim_quadx build/px4_sitl_default/bin/px4 -i {instance} -d'" --set execute.processes=1
    # one that runs already (`make px4_sitl_sih sihsim_quadx`), as a mission
    … --executor "python3 examples/executors/px4_mavlink.py --mode mission"

Written against PX4's documented interface and run with a stand-in for it (tests/python/fake_autopilot.py), not yet with
PX4 itself. `--mode offboard` streams set points at `--rate-hz` of simulated time: the timed motion with its velocities,
or with `--setpoints waypoints` the next waypoint. `--mode mission` uploads them (take-off at waypoint 0, then waypoints
with the acceptance radius) and takes the leg from MISSION_CURRENT. `--limits` sets PX4's parameters to the mission's.
With `--start` the simulation begins anew for each mission; else the vehicle flies back to the next mission's start.
Several processes: instance i listens at port 14540 + i. At a high speed factor set points come late by what the socket
takes times the factor: compare with factor 1 before you believe a deviation.
"""
from mavlink_flight import mavlink, serve
from mavlink_frames import Azimuthal


class Px4:
    """PX4 over MAVLink, as an executor of hairpin's missions."""

    NAME, ADDRESS, PORT_STEP, SPEED_OPTION = "PX4", "udpin:127.0.0.1:14540", 1, "--speed-factor"
    STEERED, UPLOADED, MISSION, BYTEWISE, PROJECTION, HOME_ITEMS = "OFFBOARD", "mission", "AUTO.MISSION", True, Azimuthal, 0
    TRUTH = [mavlink.MAVLINK_MSG_ID_HIL_STATE_QUATERNION]
    # Main mode and sub mode.
    MODES = {
        "MANUAL": (1, 0), "ALTCTL": (2, 0), "POSCTL": (3, 0), "ACRO": (5, 0), "OFFBOARD": (6, 0), "STABILIZED": (7, 0),
        "AUTO.READY": (4, 1), "AUTO.TAKEOFF": (4, 2), "AUTO.LOITER": (4, 3), "AUTO.MISSION": (4, 4), "AUTO.RTL": (4, 5),
        "AUTO.LAND": (4, 6), "AUTO.PRECLAND": (4, 9), "DESCEND": (4, 11), "TERMINATION": (10, 0),
    }
    LIMITS = {
        "max_speed_m_s": [("MPC_XY_VEL_MAX", 1.0)],
        "max_tilt_deg": [("MPC_TILTMAX_AIR", 1.0)],
    }
    RADIUS = [("NAV_ACC_RAD", 1.0)]

    def environment(self, options):
        return {"PX4_SIM_SPEED_FACTOR": f"{options.speed:g}"} if options.speed else {}

    def mode_name(self, number):
        main, sub = number >> 16 & 0xFF, number >> 24
        return next((name for name, of in self.MODES.items() if of == (main, sub)), f"mode {main}.{sub}")

    def prepare(self, vehicle, options):
        """Nothing: its speed is the simulation's, from the start."""

    def take_off(self, vehicle, height, heading, patience_s):
        """Set points flow for a second before the mode is asked for; armed there, it climbs to the set point."""
        x, y, _ = vehicle.place[1]
        vehicle.target = ((x, y, -height), None, heading)
        vehicle.wait(1.5)
        vehicle.enter("OFFBOARD", patience_s)
        vehicle.arm(patience_s)

    def hold(self, vehicle):
        if vehicle.armed:
            vehicle.set_mode("AUTO.LOITER")
        vehicle.target = None

    def land(self, vehicle):
        vehicle.command(mavlink.MAV_CMD_NAV_LAND)


if __name__ == "__main__":
    serve(Px4())
