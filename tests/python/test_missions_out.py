"""Missions as ground stations and autopilots' own tools read them: pymavlink for WPL, the loader's rules for `.plan`.

The campaign is $HAIRPIN_BIN's.
"""

import csv
import json
import math
import os
import struct
import subprocess

import pytest

ORIGIN = "world.origin={lat_deg=47.3977,lon_deg=8.5456,alt_amsl_m=488.0,x_axis_heading_deg=73.5}"


@pytest.fixture(scope="module")
def export(tmp_path_factory):
    if "HAIRPIN_BIN" not in os.environ:
        pytest.skip("HAIRPIN_BIN is not set")
    place = tmp_path_factory.mktemp("missions")
    few = ["--set", "generate.search.cases=2", "--set", ORIGIN]
    for arguments in (
        ["generate", "demo-quadrotor", "--out", "a", *few],
        ["export", "a", "--to", "plan,wpl,setpoints,poly4d,waypoints"],
    ):
        done = subprocess.run([os.environ["HAIRPIN_BIN"], *arguments], cwd=place, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    return place / "a/export"


def waypoints(export, case):
    with open(export / f"{case}.csv", newline="") as file:
        return [[float(row[key]) for key in ("x_m", "y_m", "z_m")] for row in csv.DictReader(file)]


def number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def check_plan(plan):
    """What QGroundControl's loader refuses a file for."""
    assert plan["fileType"] == "Plan" and plan["version"] == 1 and plan["groundStation"] == "QGroundControl"
    fence, rally, mission = plan["geoFence"], plan["rallyPoints"], plan["mission"]
    assert isinstance(fence["circles"], list) and isinstance(fence["polygons"], list) and fence["version"] == 2
    assert isinstance(rally["points"], list) and rally["version"] == 2
    for polygon in fence["polygons"]:
        assert polygon["version"] == 1 and isinstance(polygon["inclusion"], bool) and len(polygon["polygon"]) >= 3
        assert all(len(corner) == 2 and all(map(number, corner)) for corner in polygon["polygon"])
    assert mission["version"] == 2 and mission["firmwareType"] in (12, 3) and mission["vehicleType"] in (2, 10)
    assert len(mission["plannedHomePosition"]) == 3 and all(map(number, mission["plannedHomePosition"]))
    for place, item in enumerate(mission["items"]):
        assert item["type"] == "SimpleItem" and isinstance(item["autoContinue"], bool) and item["doJumpId"] == place + 1
        assert item["command"] in (16, 21, 22, 178) and item["frame"] == (2 if item["command"] == 178 else 3)
        assert len(item["params"]) == 7 and all(value is None or number(value) for value in item["params"])
        assert len({"AltitudeMode", "Altitude", "AMSLAltAboveTerrain"} & set(item)) in (0, 3)


def distance(a, b):
    """Between two places of latitude, longitude, height, m, on a sphere of the Earth's local radius."""
    radius = 6371000.0
    north = math.radians(b[0] - a[0]) * radius
    east = math.radians(b[1] - a[1]) * radius * math.cos(math.radians(a[0]))
    return math.sqrt(north**2 + east**2 + (b[2] - a[2]) ** 2)


def test_plans_keep_to_the_loaders_rules_and_legs_keep_their_lengths(export):
    found = sorted(export.glob("*.plan"))
    assert len(found) == 2
    for path in found:
        plan = json.loads(path.read_text())
        check_plan(plan)
        items = plan["mission"]["items"]
        assert items[0]["command"] == 22 and items[-1]["command"] == 21
        points = waypoints(export, path.stem)
        places = [item["params"][4:] for item in items if item["command"] == 16][: len(points)]
        for i in range(len(points) - 1):
            legs = math.dist(points[i], points[i + 1]), distance(places[i], places[i + 1])
            assert abs(legs[0] - legs[1]) < 0.005 * legs[0], (path, i, legs)


def test_pymavlink_loads_the_waypoint_files(export):
    from pymavlink import mavwp

    for path in sorted(export.glob("*.waypoints")):
        lines = path.read_text().split("\n")
        assert lines[0] == "QGC WPL 110" and lines[-1] == "" and all(len(line.split("\t")) == 12 for line in lines[1:-1])
        loader = mavwp.MAVWPLoader()
        count = loader.load(str(path))
        plan = json.loads((export / f"{path.stem}.plan").read_text())["mission"]
        home, items = plan["plannedHomePosition"], plan["items"]
        assert count == len(items) + 1
        assert distance([loader.wp(0).x, loader.wp(0).y, loader.wp(0).z], home) < 1e-3
        for place, item in enumerate(items):
            wp = loader.wp(place + 1)
            assert (wp.command, wp.frame, wp.autocontinue) == (item["command"], item["frame"], 1)
            assert abs(wp.param2 - (item["params"][1] or 0)) < 1e-6
            if item["command"] != 178:
                assert distance([wp.x, wp.y, wp.z], item["params"][4:]) < 1e-3


def test_set_points_are_one_motion(export):
    for path in sorted(export.glob("*.setpoints.csv")):
        with open(path, newline="") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        for a, b in zip(rows, rows[1:]):
            span = b["t"] - a["t"]
            assert span > 0
            for axis in ("north", "east", "down"):
                mean = 0.5 * (a[f"v_{axis}_m_s"] + b[f"v_{axis}_m_s"])
                assert abs((b[f"{axis}_m"] - a[f"{axis}_m"]) - mean * span) < 2e-3
        points = waypoints(export, path.name.split(".")[0])
        # Heights are those of the cage, and the way from start to end has its length.
        assert abs(-rows[0]["down_m"] - points[0][2]) < 1e-3 and abs(-rows[-1]["down_m"] - points[-1][2]) < 2e-3
        ends = [[row[f"{axis}_m"] for axis in ("north", "east", "down")] for row in (rows[0], rows[-1])]
        assert abs(math.dist(*ends) - math.dist(points[0], points[-1])) < 2e-3
        assert all(abs(row["yaw_rad"] - math.radians(73.5)) < 1e-4 for row in rows)


def test_polynomials_go_through_the_waypoints(export):
    for path in sorted(export.glob("*.poly4d.csv")):
        case = path.name.split(".")[0]
        with open(path, newline="") as file:
            header, *rows = list(csv.reader(file))
        assert header[:3] == ["Duration", "x^0", "x^1"] and all(len(row) == 33 for row in rows)
        ends = []
        for duration, *values in ([float(cell) for cell in row] for row in rows):
            packed = struct.pack("<33f", *values, duration)  # as the trajectory memory has it
            assert len(packed) == 132
            ends.append([sum(values[8 * axis + i] * duration**i for i in range(8)) for axis in range(3)])
        for point in waypoints(export, case)[1:]:
            assert min(math.dist(point, end) for end in ends) < 2e-3, (path, point)
        assert (export / f"{case}.poly4d.bin").stat().st_size < 132 * len(rows)
