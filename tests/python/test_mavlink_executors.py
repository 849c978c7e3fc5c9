"""The executors for PX4 and ArduPilot against our stand-in for both (fake_autopilot.py): missions in each mode, what is refused,
what breaks in flight. The autopilots themselves are not run here."""
import json
import math
import os
import shlex
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from talk import Talk

ROOT = Path(__file__).resolve().parents[2]
HAIRPIN = os.environ.get("HAIRPIN_BIN", str(ROOT / "target" / "debug" / "hairpin"))
EXECUTORS = ROOT / "examples" / "executors"
sys.path.insert(0, str(EXECUTORS))
FAKE = Path(__file__).with_name("fake_autopilot.py")
PROGRAM = {"px4": "px4_mavlink.py", "ardupilot": "ardupilot_mavlink.py"}
FACTOR = 40  # simulated seconds a second
POINTS = [[1.0, 1.0, 2.0], [3.0, 1.0, 3.0], [4.0, 3.0, 2.5]]
YAW = 0.3


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def fake(kind, port, trouble=""):
    return [sys.executable, str(FAKE), kind, str(port), "--factor", str(FACTOR), "--trouble", trouble]


def command(kind, mode, *more, trouble="", start=True):
    port = free_port(socket.SOCK_DGRAM if kind == "px4" else socket.SOCK_STREAM)
    address = f"udpin:127.0.0.1:{port}" if kind == "px4" else f"tcp:127.0.0.1:{port}"
    words = [sys.executable, str(EXECUTORS / PROGRAM[kind]), "--mode", mode, "--connect", address, "--rate-hz", "25", *more]
    words += ["--start", shlex.join(fake(kind, "{port}", trouble))] if start else []
    return words, port


def mission(points=POINTS, **more):
    return {"robot": {}, "world": {"origin": {"x_axis_heading_deg": 73.5}}, "waypoints_m": points, "accept_m": 0.5, "yaw_rad": [YAW] * len(points),
            "limits": {"max_speed_m_s": 2.0, "max_tilt_deg": 35.0}, "accept": {"radius_m": 0.5, "height_m": 0.5}, "time_limit_s": 15.0, "timed": [], **more}


def turned(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def test_a_climbing_turning_tilted_pose_changes_frames():
    from mavlink_frames import World

    world = World(73.5)
    # Nose by compass 110°, up 12°, right side down 20°; climbing at 3 m/s, flying north-east.
    yaw, pitch, roll = np.radians([110.0, 12.0, 20.0])
    about = lambda axis, angle: np.array([math.cos(angle / 2), *(math.sin(angle / 2) * np.eye(3)[axis])])
    from mavlink_frames import multiplied

    q = multiplied(multiplied(about(2, yaw), about(1, pitch)), about(0, roll))
    p, v, attitude = world.pose((10.0, 4.0, -7.0), (2.0, 2.0, -3.0), q)
    # The world's axes as vectors of east, north, up, and the same pose there by ordinary geometry.
    h = math.radians(73.5)
    axes = np.array([[math.sin(h), math.cos(h), 0.0], [-math.cos(h), math.sin(h), 0.0], [0.0, 0.0, 1.0]])
    np.testing.assert_allclose(p, axes @ [4.0, 10.0, 7.0], atol=1e-12)
    np.testing.assert_allclose(v, axes @ [2.0, 2.0, 3.0], atol=1e-12)
    nose = axes @ [math.cos(pitch) * math.sin(yaw), math.cos(pitch) * math.cos(yaw), math.sin(pitch)]
    level_left = axes @ [-math.cos(yaw), math.sin(yaw), 0.0]
    level_up = np.cross(nose, level_left)
    left = math.cos(roll) * level_left + math.sin(roll) * level_up  # the right side is down, the left one up
    matrix = turned(attitude)
    np.testing.assert_allclose(matrix[:, 0], nose, atol=1e-12)
    np.testing.assert_allclose(matrix[:, 1], left, atol=1e-12)
    np.testing.assert_allclose(matrix[:, 2], np.cross(nose, left), atol=1e-12)
    assert attitude[0] >= 0.0
    np.testing.assert_allclose(world.turned(p), (10.0, 4.0, -7.0), atol=1e-12)
    # A nose along x looks where x heads; a quarter turn to the left looks 90° less.
    assert math.isclose(math.degrees(world.compass(0.0)), 73.5)
    assert math.isclose(math.degrees(world.compass(math.pi / 2)), -16.5)


@pytest.mark.parametrize("name", ["Azimuthal", "Scaled"])
def test_latitudes_and_longitudes_are_metres_again(name):
    import mavlink_frames

    projection = getattr(mavlink_frames, name)(47.397742, 8.545594)
    lat, lon = projection.degrees(120.0, -80.0)
    np.testing.assert_allclose(projection.metres(lat, lon), (120.0, -80.0), atol=1e-6)
    # Along a great circle on the ball that each takes the Earth for.
    radius = 6371000.0 if name == "Azimuthal" else 6378100.0
    a, b, difference = math.radians(47.397742), math.radians(lat), math.radians(lon - 8.545594)
    haversine = math.sin((b - a) / 2) ** 2 + math.cos(a) * math.cos(b) * math.sin(difference / 2) ** 2
    assert math.isclose(2 * radius * math.asin(math.sqrt(haversine)), math.hypot(120.0, 80.0), rel_tol=1e-5)
    assert lat > 47.397742 and lon < 8.545594


@pytest.mark.parametrize("kind, mode, more", [
    ("px4", "offboard", ["--truth", "--limits", "--param", "COM_RC_IN_MODE=4"]), ("px4", "mission", []),
    ("ardupilot", "guided", []), ("ardupilot", "auto", ["--truth", "--limits"])])
def test_a_mission_is_flown(kind, mode, more):
    words, _ = command(kind, mode, *more)
    with Talk(words) as talk:
        answer, rows = talk.fly(**mission())
        assert answer == {"type": "end", "reason": "done", "case": "0000", "run": 0}
        assert talk.ready["protocol"] == 2 and mode in talk.ready["name"]
        assert talk.end() == 0
    t, p, q, v, leg = rows[:, 0], rows[:, 1:4], rows[:, 4:8], rows[:, 8:11], rows[:, 11]
    assert t[0] == 0.0 and (np.diff(t) > 0.0).all() and leg[0] == 0 and leg[-1] == 1 and (np.diff(leg) >= 0).all()
    assert np.linalg.norm(p[0] - POINTS[0]) < 0.3
    for point in POINTS:
        assert np.linalg.norm(p - point, axis=1).min() < 0.51
    # Velocities are those of the positions, thrust leans into the acceleration, the nose is where it is wanted.
    mean = (p[2:] - p[:-2]) / (t[2:] - t[:-2])[:, None]
    assert np.abs(mean - v[1:-1]).max() < 0.3
    fastest = np.linalg.norm(v, axis=1).max()
    assert 1.0 < fastest < (2.1 if "--limits" in more else 5.0)
    first = np.argmax(np.linalg.norm(v, axis=1) > 0.2)
    matrix = turned(q[first])
    assert matrix[0, 2] > 0.02 and matrix[2, 2] > 0.8
    assert abs(math.atan2(turned(q[-1])[1, 0], turned(q[-1])[0, 0]) - YAW) < 0.05


REFUSED = [
    ("px4", "offboard", "arming-denied",
     "arming: refused with MAV_RESULT_TEMPORARILY_REJECTED; it says: Arming denied: Resolve system health failures first"),
    ("ardupilot", "guided", "arming-denied", "arming: refused with MAV_RESULT_FAILED; it says: Arm: Compass not healthy"),
    ("px4", "mission", "upload-refused", "mission upload: refused with MAV_MISSION_NO_SPACE at item 0; it says: Mission: Storage failure"),
    ("ardupilot", "auto", "upload-refused", "mission upload: refused with MAV_MISSION_NO_SPACE"),
    ("px4", "mission", "failsafe", "it left AUTO.MISSION for AUTO.RTL; it says: Failsafe: battery low, returning"),
    ("px4", "mission", "silent", "the link is lost: nothing was heard for 2 s"),
    ("ardupilot", "auto", "no-heartbeat", "the link is lost: no HEARTBEAT for"),
    ("ardupilot", "auto", "gone", "the link is lost"),
]


@pytest.mark.parametrize("kind, mode, trouble, sentence", REFUSED)
def test_what_is_refused_is_an_error_in_the_autopilots_own_words(kind, mode, trouble, sentence):
    # A second of the clock on the wall, in which a busy machine comes to stream without a gap.
    words, _ = command(kind, mode, "--arm-patience-s", str(FACTOR), "--link-timeout-s", "2", trouble=trouble)
    with Talk(words) as talk:
        answer, _ = talk.fly(**mission())
        assert answer["type"] == "error" and sentence in answer["message"], answer
        assert talk.end() == 0


@pytest.mark.parametrize("kind, mode", [("px4", "mission"), ("ardupilot", "auto")])
def test_who_stops_short_of_an_item_is_flown_to_the_time_limit(kind, mode):
    words, _ = command(kind, mode, trouble="stall")
    with Talk(words) as talk:
        answer, rows = talk.fly(**mission())
        assert answer["reason"] == "time" and 15.0 <= rows[-1, 0] < 15.1
        assert np.linalg.norm(rows[-1, 1:4] - rows[-100, 1:4]) < 0.01 and rows[-1, 11] == 1


def test_a_fall_is_a_crash():
    words, _ = command("ardupilot", "auto", trouble="crash")
    with Talk(words) as talk:
        answer, rows = talk.fly(**mission())
        assert answer["reason"] == "crash" and rows[-1, 0] < 5.0


@pytest.mark.parametrize("kind, mode", [("px4", "mission"), ("ardupilot", "guided")])
def test_a_vehicle_that_runs_already_flies_back_to_the_next_start(kind, mode):
    words, port = command(kind, mode, start=False)
    vehicle = subprocess.Popen(fake(kind, port))
    try:
        with Talk(words) as talk:
            for run, points in enumerate([POINTS, POINTS[::-1]]):
                answer, rows = talk.fly(run, **mission(points))
                assert answer["type"] == "end" and answer["reason"] == "done", answer
                assert np.linalg.norm(rows[0, 1:4] - points[0]) < 0.3
            assert talk.end() == 0
    finally:
        vehicle.kill()
        vehicle.wait()


def test_nobody_there_and_nothing_to_start_are_told():
    words, _ = command("px4", "offboard", "--link-timeout-s", "0.3", start=False)
    with Talk(words) as talk:
        assert "no heartbeat at udpin:127.0.0.1:" in talk.fly(**mission())[0]["message"]
    words, _ = command("px4", "offboard", "--start", "/no/such/px4", start=False)
    with Talk(words) as talk:
        assert "--start: " in talk.fly(**mission())[0]["message"]


def test_the_stand_in_refuses_what_an_autopilot_refuses():
    from mavlink_link import mavlink, mavutil

    port = free_port(socket.SOCK_DGRAM)
    vehicle = subprocess.Popen(fake("px4", port))
    try:
        link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255)
        link.wait_heartbeat(timeout=5)
        item = lambda seq, command, frame: link.mav.mission_item_int_send(1, 1, seq, frame, command, 0, 1, 0, 0, 0, 0, 473977420, 85455940, 490.0, 0)

        def answer(kind, send, **wanted):
            until = time.monotonic() + 3
            send()
            while time.monotonic() < until:
                message = link.recv_match(type=kind, blocking=True, timeout=0.2)
                if message and all(getattr(message, name) == value for name, value in wanted.items()):
                    return message
            raise AssertionError(kind)

        def upload(*items):
            answer("MISSION_REQUEST_INT", lambda: link.mav.mission_count_send(1, 1, len(items), 0), seq=0)
            for one in items[:-1]:
                answer("MISSION_REQUEST_INT", lambda: item(*one))
            return answer("MISSION_ACK", lambda: item(*items[-1])).type

        order = lambda command, *p: link.mav.command_long_send(1, 1, command, 0, *p, *[0.0] * (7 - len(p)))
        offboard = answer("COMMAND_ACK", lambda: order(mavlink.MAV_CMD_DO_SET_MODE, 1, 6))
        assert offboard.result == mavlink.MAV_RESULT_TEMPORARILY_REJECTED  # without a stream
        takeoff, waypoint, here = mavlink.MAV_CMD_NAV_TAKEOFF, mavlink.MAV_CMD_NAV_WAYPOINT, mavlink.MAV_FRAME_GLOBAL_INT
        assert upload((0, takeoff, here), (5, waypoint, here)) == mavlink.MAV_MISSION_INVALID_SEQUENCE
        assert upload((0, takeoff, mavlink.MAV_FRAME_LOCAL_NED)) == mavlink.MAV_MISSION_UNSUPPORTED_FRAME
        assert upload((0, waypoint, here), (1, waypoint, here)) == mavlink.MAV_MISSION_ACCEPTED
        started = answer("COMMAND_ACK", lambda: order(mavlink.MAV_CMD_MISSION_START), command=mavlink.MAV_CMD_MISSION_START)
        assert started.result == mavlink.MAV_RESULT_DENIED  # without a take-off
    finally:
        vehicle.kill()
        vehicle.wait()


def test_hairpin_finds_it_sound():
    words, _ = command("px4", "offboard")
    done = subprocess.run([HAIRPIN, "check-executor", shlex.join(words), "--json"], capture_output=True, text=True)
    answer = json.loads(done.stdout)
    assert done.returncode == 0, [(step["step"], step["findings"]) for step in answer["steps"]]


@pytest.mark.parametrize("kind, mode, trouble, status", [("ardupilot", "auto", "", "pass"), ("px4", "mission", "stall", "fail")])
def test_a_campaign_is_flown_and_a_stall_is_a_violation(kind, mode, trouble, status, tmp_path):
    words, _ = command(kind, mode, trouble=trouble)
    out = tmp_path / "campaign"
    sets = ['generate.search={ method = "uniform", waypoints = 60, cases = 1 }', "execute.repeat=1", "task.length=4", "task.end_m=[9, 7, 6]",
            "spec.deviation.max_m=4", "execute.baseline=0"]
    arguments = [HAIRPIN, "stress", "demo-quadrotor", "--executor", shlex.join(words), "--out", str(out), "--json"]
    done = subprocess.run(arguments + [word for one in sets for word in ("--set", one)], capture_output=True, text=True)
    answer = json.loads(done.stdout)
    assert answer["counts"][status] == 1, (answer, done.stderr, [path.read_text() for path in out.glob("executor-*.log")])
    assert ("stood still after 2 of 4 waypoints" in answer["verdict"]) == (trouble == "stall"), answer["verdict"]
