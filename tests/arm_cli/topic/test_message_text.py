"""Messages as text, in ros2's formats."""

import json

import numpy as np
import pytest
from geometry_msgs.msg import Point
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import Byte, String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_cli.errors import CommandUsageError, MessageError
from arm_cli.output import print_json
from arm_cli.topic.message_parts import FieldPath, message_filter
from arm_node.messages.text import Abridgement, to_csv, to_plain, to_yaml

STATE = JointState(name=["j0", "j1"], position=[0.5, 1e-20])


def test_yaml_has_the_format_of_ros2():
    assert to_yaml(STATE) == (
        "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: ''\n"
        "name:\n- j0\n- j1\nposition:\n- 0.5\n- 1.0e-20\nvelocity: []\neffort: []\n"
    )


def test_flow_style_is_one_line():
    assert to_yaml(Point(x=1.0), flow_style=True) == "{x: 1.0, y: 0.0, z: 0.0}\n"


def test_csv_puts_nested_values_in_place():
    assert to_csv(STATE) == "0,0,,j0,j1,0.5,1e-20,,"


def test_long_arrays_and_strings_are_cut():
    cut = Abridgement(truncate_length=3)
    assert to_plain(JointState(position=[1.0] * 4), cut)["position"] == [1.0, 1.0, 1.0, "..."]
    assert to_plain(String(data="abcd"), cut) == {"data": "abc..."}
    assert to_csv(JointTrajectoryPoint(positions=[1.0] * 4), cut).startswith("1.0,1.0,1.0,...,")


def test_arrays_and_strings_can_be_replaced_by_placeholders():
    short = Abridgement(no_arr=True, no_str=True)
    assert to_plain(Image(data=[1, 2]), short)["data"] == "<sequence type: uint8, length: 2>"
    assert to_plain(CameraInfo(), short)["k"] == "<array type: double[9]>"
    trajectory = JointTrajectory(points=[JointTrajectoryPoint()])
    points = "<sequence type: trajectory_msgs/msg/JointTrajectoryPoint, length: 1>"
    assert to_plain(trajectory, short)["points"] == points
    assert to_plain(String(data="abc"), short) == {"data": "<string length: <3>>"}
    assert to_csv(Image(data=[1, 2]), short).endswith(",<sequence type: uint8, length: 2>")


def test_numpy_values_and_bytes_become_plain():
    plain = to_plain(CameraInfo(k=np.arange(9.0)))
    assert plain["k"] == list(range(9))
    assert to_plain(Byte(data=b"\x41")) == {"data": "A"}


def test_json_has_null_for_nan_and_infinity(capsys):
    print_json(to_plain(Point(x=float("nan"), y=float("inf"), z=1.0)))
    assert json.loads(capsys.readouterr().out) == {"x": None, "y": None, "z": 1.0}


@pytest.mark.parametrize(
    ("path", "value"), [("header.stamp.sec", 0), ("position[0]", 0.5), ("name", ["j0", "j1"])]
)
def test_a_field_path_finds_its_part(path, value):
    parsed = FieldPath.parse(path)
    parsed.check(JointState)
    assert parsed.of(STATE) == value


def test_a_field_path_goes_into_lists_of_messages():
    parsed = FieldPath.parse("points[1].time_from_start")
    parsed.check(JointTrajectory)
    with pytest.raises(MessageError, match="the list has 1 items"):
        parsed.of(JointTrajectory(points=[JointTrajectoryPoint()]))


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        ("positio", "no field 'positio' (fields: header, name, position, velocity, effort)"),
        ("name.x", "string[] has no fields"),
        ("header[0]", "[0] does not follow a list"),
    ],
)
def test_a_field_path_to_nothing_is_refused(path, sentence):
    with pytest.raises(MessageError) as error:
        FieldPath.parse(path).check(JointState)
    assert str(error.value) == f"--field {path}: {sentence}"


@pytest.mark.parametrize("text", ["", ".", "a-b", "a[x]"])
def test_a_malformed_field_path_is_refused(text):
    with pytest.raises(MessageError, match="--field"):
        FieldPath.parse(text)


def test_a_filter_selects_messages():
    fits = message_filter("m.position[0] > 0.4 and 'j1' in m.name")
    assert fits(STATE)
    assert not fits(JointState(position=[0.4]))


def test_a_filter_that_does_not_fit_the_messages_is_reported():
    with pytest.raises(MessageError, match=r"--filter 'm\.positon' fails: AttributeError: "):
        message_filter("m.positon")(STATE)
    with pytest.raises(MessageError, match="fails: IndexError: "):
        message_filter("m.velocity[0] > 1")(STATE)
    with pytest.raises(CommandUsageError, match="is not a Python expression"):
        message_filter("m.position[0")
