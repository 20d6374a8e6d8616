"""Numbers in messages: how they are named, found and read."""

import array
import math

import pytest

from arm_viewer.errors import BrowserMessageError
from arm_viewer.plots.field_paths import numbers_in, parse_curve, reader, unit_of


class Fields:
    """Stands for a ROS message."""

    def __init__(self, **fields):
        self.__dict__.update(fields)

    def get_fields_and_field_types(self):
        return dict.fromkeys(self.__dict__, "")


STAMP = Fields(sec=5, nanosec=500_000_000)
STATES = Fields(
    header=Fields(stamp=STAMP, frame_id="base"),
    name=["a", "b/c"],
    position=array.array("d", [1.0, 2.0]),
    velocity=array.array("d"),
)
CONTROLLER = Fields(
    joint_names=["a", "b"],
    reference=Fields(positions=array.array("d", [3.0, 4.0]), time_from_start=STAMP),
)
TREE = Fields(
    transforms=[
        Fields(child_frame_id="hand", transform=Fields(translation=Fields(x=0.5, y=True))),
        Fields(child_frame_id="tip", transform=Fields(translation=Fields(x=0.6, y=False))),
    ]
)
DYNAMIC = Fields(
    joint_names=["a"],
    interface_values=[
        Fields(interface_names=["position", "effort"], values=array.array("d", [7.0, 8.0]))
    ],
)
PLAIN = Fields(data=array.array("d", [9.0, math.nan]), layout=Fields(dim=[]), text="no", raw=b"no")
PICTURE = Fields(width=640, data=array.array("B", bytes(1000)))


def test_every_number_is_listed_by_name_or_index():
    assert list(numbers_in(STATES)) == ["position[a]", "position[b/c]"]
    assert list(numbers_in(CONTROLLER)) == [
        "reference.positions[a]",
        "reference.positions[b]",
        "reference.time_from_start",
    ]
    assert list(numbers_in(TREE)) == [
        f"transforms[{frame}].transform.translation.{axis}"
        for frame in ("hand", "tip")
        for axis in "xy"
    ]
    assert list(numbers_in(DYNAMIC)) == [
        "interface_values[a].values[position]",
        "interface_values[a].values[effort]",
    ]
    assert list(numbers_in(PLAIN)) == ["data[0]", "data[1]"]
    assert list(numbers_in(PICTURE)) == ["width"]


@pytest.mark.parametrize("message", [STATES, CONTROLLER, TREE, DYNAMIC, PLAIN, PICTURE])
def test_what_is_listed_can_be_read(message):
    read = [reader(parse_curve(f"/topic.{path}"))(message) for path in numbers_in(message)]
    assert read
    assert sum(map(math.isnan, read)) == (message is PLAIN)


@pytest.mark.parametrize(
    ("message", "path", "value"),
    [
        (STATES, "position[b/c]", 2.0),
        (STATES, "position[0]", 1.0),
        (STATES, "header.stamp", 5.5),
        (CONTROLLER, "reference.positions[b]", 4.0),
        (TREE, "transforms[tip].transform.translation.x", 0.6),
        (DYNAMIC, "interface_values[a].values[effort]", 8.0),
        (PICTURE, "data[999]", 0.0),
    ],
)
def test_a_number_is_read(message, path, value):
    assert reader(parse_curve(f"/topic.{path}"))(message) == value


@pytest.mark.parametrize(
    "path",
    [
        *("position[c]", "position[2]", "velocity[a]", "position", "nothing", "name[0]", "name"),
        *("header", "header.frame_id", "header.frame_id.x", "position[a].x", "position[a][b]"),
    ],
)
def test_what_is_not_there_is_nan(path):
    assert math.isnan(reader(parse_curve(f"/topic.{path}"))(STATES))


def test_joints_are_followed_when_their_order_changes():
    read = reader(parse_curve("/joint_states.position[b]"))
    assert read(Fields(name=["a", "b"], position=[1.0, 2.0])) == 2.0
    assert read(Fields(name=["b", "a"], position=[3.0, 4.0])) == 3.0
    assert math.isnan(read(Fields(name=["a"], position=[1.0])))


@pytest.mark.parametrize(
    "text", ["", "/", "/a", "a.b", "/a.", "/a.b[", "/a.b[]", "/a.b c", "/a.b[[]]", "/a[0]x"]
)
def test_anything_else_is_refused_with_a_sentence(text):
    with pytest.raises(BrowserMessageError, match=r"is not a number of a topic; one is"):
        parse_curve(text)


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("position[turn]", "rad"),
        ("reference.velocities[slide]", "m/s"),
        ("interface_values[turn].values[effort]", "N m"),
        ("statistics[state_interface.slide/position].value", "m"),
        ("position[unknown]", ""),
        ("pose.position.x", "m"),
        ("twist.angular.z", "rad/s"),
        ("wrench.force.y", "N"),
        ("linear_acceleration.z", "m/s²"),
        ("accel.linear.x", "m/s²"),
        ("pose.orientation.w", ""),
        ("data", ""),
    ],
)
def test_units(path, unit):
    assert unit_of(path, {"turn": False, "slide": True}) == unit
