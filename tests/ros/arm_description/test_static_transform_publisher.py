"""static_transform_publisher as other nodes see it, in a process of its own."""

import math
import re

import pytest
from tf2_msgs.msg import TFMessage

from arm_description.errors import SettingsError
from arm_description.static_transform_publisher_node import parameters_of, unit_quaternion

MODULE = "static_transform_publisher_node"
HALF = math.sqrt(0.5)


@pytest.fixture
def received(client, start, latched):
    """Start the program with arguments and parameters; return the transform that comes late."""

    def run(*arguments: str, **parameters):
        node = start(MODULE, *arguments, **parameters)
        node.wait_for_line("Spinning until stopped - publishing transform")
        (transform,) = client.subscribe(TFMessage, "/tf_static", latched).wait_for()[0].transforms
        t, r = transform.transform.translation, transform.transform.rotation
        names = (transform.header.frame_id, transform.child_frame_id)
        assert transform.header.stamp.sec > 0
        return node, names, [t.x, t.y, t.z, r.x, r.y, r.z, r.w]

    return run


# A quarter turn about z, then half a turn about the turned y: not a symmetric case.
EULER_AS_QUATERNION = [-HALF, HALF, 0.0, 0.0]


@pytest.mark.parametrize(
    ("words", "numbers"),
    [
        ("1 -2 3e-1 1.5707963267948966 3.141592653589793 0", [1, -2, 0.3, *EULER_AS_QUATERNION]),
        ("0 0 -1 0 0 2 2", [0, 0, -1, 0, 0, HALF, HALF]),
    ],
)
def test_arguments_without_options_by_their_number(received, words, numbers):
    node, names, transform = received(*words.split(), "world", "base")
    assert names == ("world", "base")
    assert transform == pytest.approx(numbers)
    assert "Old-style arguments are deprecated; see --help for new-style arguments" in node.output


def test_arguments_by_their_options_in_any_order(received):
    words = "--frame-id world --yaw 1.5707963267948966 --pitch 3.141592653589793 --y -2e0 --x=1"
    node, names, transform = received(*words.split(), "--child-frame-id", "base")
    assert names == ("world", "base")
    assert transform == pytest.approx([1, -2, 0, *EULER_AS_QUATERNION])
    assert "deprecated" not in node.output


def test_parameters_say_the_same_and_arguments_win(received):
    words = ("--x", "5", "--child-frame-id", "base")
    _, names, transform = received(*words, **{"frame_id": "world", "translation.x": 1.0})
    assert (names, transform[0]) == (("world", "base"), 5.0)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("1 2 3", "3 arguments; without options there are eight"),
        ("--frame-id a --child-frame-id b --yaw one", "yaw is 'one', not a finite number"),
        ("--frame-id a --child-frame-id b --yw 1", "unknown argument '--yw'; usage: "),
        ("--frame-id a --child-frame-id b --yaw 1 --qx 1", "not as both"),
        ("--frame-id a --child-frame-id", "--child-frame-id lacks its value"),
    ],
)
def test_wrong_arguments_get_a_sentence(words, said):
    with pytest.raises(SettingsError, match=re.escape(said)):
        parameters_of(words.split(), pytest.fail)


def test_a_quaternion_without_a_direction_is_refused():
    with pytest.raises(SettingsError, match="is not a quaternion: its length is 0"):
        unit_quaternion([0.0] * 4)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--x 1", "--frame-id and --child-frame-id are needed"),
        ("0 0 0 0 0 0 a a", "a frame cannot be its own parent: both are 'a'"),
    ],
)
def test_wrong_frames_end_it_with_a_sentence(start, words, said):
    node = start(MODULE, *words.split())
    node.wait_for_line(said)
    assert node.process.wait(60) == 1
    assert "Traceback" not in node.output
