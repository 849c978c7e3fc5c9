"""The logs that our readers are tested with, read by the formats' own readers: pyulog, rosbags and mcap, pymavlink.

They lie beside the tests of hairpin-formats, which write them anew from the formats' descriptions and compare the bytes.
"""

from pathlib import Path

FIXTURES = Path(__file__).parents[2] / "crates" / "hairpin-formats" / "tests" / "fixtures" / "logs"


def test_pyulog_reads_what_we_take_for_a_ulog():
    from pyulog import ULog

    log = ULog(str(FIXTURES / "flight.ulg"))
    assert not log.file_corruption
    data = {(it.name, it.multi_id): it.data for it in log.data_list}
    position = data["vehicle_local_position", 0]
    assert len(position["x"]) == 100 and position["timestamp_sample"][-1] == 11_980_000
    assert abs(position["x"][-1] - 3.96) < 1e-5 and abs(position["z"][-1] + 1.98) < 1e-5
    assert position["ref_lat"][0] == 47.3977 and position["xy_valid"][0] == 1
    attitude = data["vehicle_attitude", 0]
    assert abs(attitude["q[0]"][0] - 0.9659258) < 1e-6 and abs(attitude["q[2]"][0] - 0.2588190) < 1e-6
    assert list(data["mission_result", 0]["seq_current"]) == [1, 2]
    assert list(data["position_setpoint_triplet", 0]["current.lat"]) == [47.3978, 47.3979]
    assert list(data["vehicle_status", 0]["nav_state"]) == [4, 3, 5]
    assert [it.duration for it in log.dropouts] == [120]
    assert log.initial_parameters["SDLOG_PROFILE"] == 1 and log.get_version_info()[:3] == (1, 15, 2)


def test_mcap_readers_read_what_we_take_for_a_bag():
    from mcap.reader import make_reader
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    with open(FIXTURES / "drive.mcap", "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert reader.get_header().profile == "ros2"
        seen = {}
        for schema, channel, message in reader.iter_messages():
            if channel.topic != "/rosout":
                seen.setdefault(channel.topic, []).append(store.deserialize_cdr(message.data, schema.name))
    odometry = seen["/odom"][-1]
    assert len(seen["/odom"]) == 20 and odometry.header.frame_id == "odom" and odometry.child_frame_id == "base_link"
    assert (odometry.header.stamp.sec, odometry.header.stamp.nanosec) == (101, 900_000_000)
    assert odometry.pose.pose.position.x == 19 and abs(odometry.pose.pose.orientation.z - 0.70710678) < 1e-8
    assert odometry.pose.covariance[7] == 0.04 and odometry.twist.twist.linear.x == 1
    joints = seen["/joint_states"][7]
    assert joints.name == ["q_a", "q_b"] and list(joints.position) == [7, 14]


def test_pymavlink_reads_what_we_take_for_a_dataflash_log():
    from pymavlink.DFReader import DFReader_binary

    log = DFReader_binary(str(FIXTURES / "flight.bin"))
    seen = {}
    while (message := log.recv_msg()) is not None:
        seen.setdefault(message.get_type(), []).append(message)
    position = seen["POS"][-1]
    assert len(seen["POS"]) == 100 and position.TimeUS == 11_980_000
    assert abs(position.Lat - 47.3977) < 1e-9 and abs(position.Alt - 489.98) < 1e-4
    assert seen["ATT"][0].Pitch == 30 and seen["XKF1"][-1].VE == 2
    assert [(it.CNum, it.TimeUS) for it in seen["CMD"][-2:]] == [(2, 10_100_000), (3, 11_000_000)]
    assert [it.ModeNum for it in seen["MODE"]] == [5, 3, 6]
