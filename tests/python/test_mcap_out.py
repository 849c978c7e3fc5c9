"""MCAP as its own readers take it: mcap, mcap-protobuf-support with Foxglove's schemas, mcap-ros2-support, rosbags.

Campaigns are made by the binary $HAIRPIN_BIN.
"""

import csv
import os
import subprocess

import pytest

SMALL = {
    "quadrotor": ["--set", "generate.search.cases=1", "--set", "execute.repeat=2", "--seed", "10"],
    "arm": ["--set", "task.points.count=6", "--set", "generate.search.programs=1", "--set", "execute.repeat=1"],
}


def run(place, *arguments):
    done = subprocess.run([os.environ["HAIRPIN_BIN"], *arguments], cwd=place, capture_output=True, text=True)
    assert done.returncode in (0, 1), f"{arguments}: exit {done.returncode}\n{done.stdout}\n{done.stderr}"


@pytest.fixture(scope="module")
def flight(tmp_path_factory):
    place = tmp_path_factory.mktemp("mcap")
    run(place, "new", "quadrotor")
    run(place, "stress", "quadrotor.toml", "--out", "out", *SMALL["quadrotor"])
    run(place, "export", "out", "--to", "csv,mcap,mcap-ros2")
    return place / "out" / "export"


@pytest.fixture(scope="module")
def arm(tmp_path_factory):
    place = tmp_path_factory.mktemp("mcap-arm")
    run(place, "generate", "arm", "--out", "arm", *SMALL["arm"])
    run(place, "export", "arm", "--to", "mcap-ros2,joint-trajectory")
    return place / "arm" / "export"


def summary(path):
    from mcap.reader import make_reader

    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        found = reader.get_summary()
        times = [message.log_time for _, _, message in reader.iter_messages(log_time_order=False)]
        assert times == sorted(times) and found.chunk_indexes and found.statistics.message_count == len(times), path
        return reader.get_header().profile, found


def rows(path):
    with open(path, newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def near(pose, row, quaternion):
    for axis in "xyz":
        assert abs(getattr(pose.position, axis) - row[f"{axis}_m"]) < 1e-9, row
    for part in "xyzw":
        assert abs(getattr(quaternion, part) - row[f"q{part}"]) < 1e-9, row


def test_foxglove_has_every_frame_and_its_own_schemas(flight):
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    path = flight / "0000.mcap"
    profile, found = summary(path)
    assert profile == "" and {channel.message_encoding for channel in found.channels.values()} == {"protobuf"}
    assert {schema.encoding for schema in found.schemas.values()} == {"protobuf"}
    messages = {}
    with open(path, "rb") as file:
        for schema, channel, message, decoded in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            messages.setdefault((channel.topic, schema.name), []).append((message.log_time, decoded))
    assert set(messages) == {
        ("/planned", "foxglove.PosesInFrame"),
        ("/run_0", "foxglove.PoseInFrame"),
        ("/run_1", "foxglove.PoseInFrame"),
        ("/tf", "foxglove.FrameTransform"),
        ("/scene", "foxglove.SceneUpdate"),
    } or ("/scene", "foxglove.SceneUpdate") not in messages
    transforms = [decoded for _, decoded in messages["/tf", "foxglove.FrameTransform"]]
    frames = {name for it in transforms for name in (it.parent_frame_id, it.child_frame_id)}
    assert frames == {"world", "planned", "run_0", "run_1"}
    [(_, planned)] = messages["/planned", "foxglove.PosesInFrame"]
    expected = rows(flight / "0000.planned.csv")
    assert planned.frame_id in frames and len(planned.poses) == len(expected)
    for pose, row in zip(planned.poses, expected):
        near(pose, row, pose.orientation)
    flown = messages["/run_1", "foxglove.PoseInFrame"]
    expected = rows(flight / "0000-1.csv")
    assert len(flown) == len(expected)
    for (time, decoded), row in zip(flown, expected):
        assert decoded.frame_id in frames and abs(time * 1e-9 - row["t"]) < 1e-9
        assert abs(decoded.timestamp.seconds + decoded.timestamp.nanos * 1e-9 - row["t"]) < 1e-9
        near(decoded.pose, row, decoded.pose.orientation)


def test_descriptors_are_those_that_foxglove_ships(flight):
    """Each field of each message that we declare has the name, number, type and label that foxglove-schemas-protobuf has."""
    import importlib

    from google.protobuf.descriptor_pb2 import DescriptorProto, FileDescriptorSet

    _, found = summary(flight / "0000.mcap")
    checked = 0
    for schema in found.schemas.values():
        files = FileDescriptorSet.FromString(schema.data)
        names = [f"{file.package}.{message.name}" for file in files.file for message in file.message_type]
        assert schema.name in names
        [ours] = [file for file in files.file if file.package == "foxglove"]
        for message in ours.message_type:
            theirs = importlib.import_module(f"foxglove_schemas_protobuf.{message.name}_pb2")
            expected = DescriptorProto()
            getattr(theirs, message.name).DESCRIPTOR.CopyToProto(expected)
            facts = lambda it: {(f.name, f.number, f.type, f.label, f.type_name) for f in it.field}
            assert facts(message) <= facts(expected), message.name
            # What a newer version has added may be missing; what is here is theirs.
            assert {(e.name, *((v.name, v.number) for v in e.value)) for e in message.enum_type} == {
                (e.name, *((v.name, v.number) for v in e.value)) for e in expected.enum_type
            }
            checked += 1
    assert checked >= 20


def test_ros_reads_paths_and_poses(flight):
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    path = flight / "0000.ros2.mcap"
    profile, found = summary(path)
    assert profile == "ros2"
    assert {channel.message_encoding for channel in found.channels.values()} == {"cdr"}
    assert {schema.encoding for schema in found.schemas.values()} == {"ros2msg"}
    assert all(channel.metadata["offered_qos_profiles"] for channel in found.channels.values())
    seen = {}
    with open(path, "rb") as file:
        for schema, channel, message, decoded in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            seen.setdefault((channel.topic, schema.name), []).append(decoded)
    paths = {("/planned", "0000.planned.csv"), ("/run_0/path", "0000-0.csv"), ("/run_1/path", "0000-1.csv")}
    for topic, name in paths:
        [decoded] = seen[topic, "nav_msgs/msg/Path"]
        expected = rows(flight / name)
        assert decoded.header.frame_id == "world" and len(decoded.poses) == len(expected)
        for pose, row in zip(decoded.poses, expected):
            assert pose.header.frame_id == "world"
            assert abs(pose.header.stamp.sec + pose.header.stamp.nanosec * 1e-9 - row["t"]) < 1e-9
            near(pose.pose, row, pose.pose.orientation)
    assert len(seen["/run_0/pose", "geometry_msgs/msg/PoseStamped"]) == len(rows(flight / "0000-0.csv"))


def messages(path, topic):
    from rosbags.rosbag2 import Reader
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    with Reader(path) as reader:
        chosen = [connection for connection in reader.connections if connection.topic == topic]
        assert chosen, topic
        return [store.deserialize_cdr(raw, connection.msgtype) for connection, _, raw in reader.messages(chosen)]


def test_rosbags_reads_the_same(flight):
    [path] = messages(flight / "0000.ros2.mcap", "/planned")
    expected = rows(flight / "0000.planned.csv")
    assert len(path.poses) == len(expected)
    near(path.poses[-1].pose, expected[-1], path.poses[-1].pose.orientation)


def test_joints_rise_from_their_start(arm):
    import json

    [trajectory] = messages(arm / "0000.ros2.mcap", "/planned/joints")
    text = json.loads((arm / "0000.joint_trajectory.json").read_text())
    assert trajectory.joint_names == text["joint_names"]
    assert len(trajectory.points) == len(text["points"]) > 2
    before = -1
    for point, expected in zip(trajectory.points, text["points"]):
        now = point.time_from_start.sec * 10**9 + point.time_from_start.nanosec
        assert now > before and list(point.positions) == expected["positions"]
        assert now == expected["time_from_start"]["sec"] * 10**9 + expected["time_from_start"]["nanosec"]
        before = now
