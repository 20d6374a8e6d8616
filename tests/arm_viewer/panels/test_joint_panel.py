"""The ranges of sliders, when a slider follows its joint, and numbers that are typed beside it."""

import json
import math
from collections.abc import Iterator

import pytest
from robots import joint, link, robot
from websockets.sync.client import connect

from arm_description.urdf.parser import parse_urdf
from arm_viewer.access import LOCAL_HOST as HOST
from arm_viewer.channel import PATH
from arm_viewer.page_server import PageServer, page_server
from arm_viewer.panels.joint_panel import (
    MAX_HOLD_S,
    STILL_S,
    TYPED_NUMBER,
    HeldSlider,
    JointPanel,
    JointRange,
    joint_ranges,
    number_typed,
)
from arm_viewer.requests import Request

ROBOT = robot(
    *map(link, ("base", "a", "b", "c", "d", "e", "f")),
    joint("turn", "base", "a", limits=(0.2, 2.0)),
    joint("wheel", "base", "b", kind="continuous", limits=None),
    joint("push", "base", "c", kind="prismatic", limits=(0.0, 0.05)),
    joint("finger", "base", "d", "<mimic joint='push'/>", kind="prismatic", limits=(0.0, 0.05)),
    joint("stuck", "base", "e", limits=(0.0, 0.0)),
    joint("free", "base", "f", kind="floating", limits=None),
)


def test_only_joints_with_a_position_of_their_own_and_room_have_one():
    turn, wheel, push = joint_ranges(parse_urdf(ROBOT).joints)
    assert (turn.name, turn.lower, turn.upper) == ("turn", 0.2, 2.0)
    assert (wheel.name, wheel.lower, wheel.upper) == ("wheel", -math.pi, math.pi)
    assert (push.name, push.lower, push.upper) == ("push", 0.0, 0.05)


def test_soft_limits_narrow_the_range_as_joint_state_publisher_gui_has_it():
    (joint,) = joint_ranges(
        parse_urdf("""<robot name='r'><link name='base'/><link name='a'/>
          <joint name='j' type='revolute'><parent link='base'/><child link='a'/>
            <limit lower='-1' upper='1' effort='1' velocity='1'/>
            <safety_controller k_velocity='1' soft_lower_limit='0.5' soft_upper_limit='9'/>
          </joint></robot>""").joints
    )
    assert (joint.lower, joint.upper, joint.centre) == (0.5, 1.0, 0.75)


@pytest.mark.parametrize(
    ("lower", "upper", "centre"), [(-1.0, 3.0, 0.0), (0.0, 1.0, 0.0), (0.2, 2.0, 1.1), (-3, -1, -2)]
)
def test_the_centre_is_zero_if_it_is_within_the_limits(lower, upper, centre):
    assert JointRange("j", lower, upper).centre == pytest.approx(centre)


def test_steps_are_powers_of_ten_and_positions_whole_steps_within_the_limits():
    joint = JointRange("j", -2.57, 2.57)
    assert joint.step == pytest.approx(0.001)
    assert joint.nearest(0.12345) == pytest.approx(0.123)
    assert joint.nearest(9.0) == 2.57
    assert math.copysign(1.0, joint.nearest(-1e-9)) == 1.0
    assert JointRange("j", 0.0, 0.05).step == pytest.approx(0.00001)


def test_it_follows_any_motion_of_the_joint():
    follower = HeldSlider(0.001)
    assert follower.shown(0.5, 0.0) == 0.5
    assert follower.shown(0.8, 0.1) == 0.8


def test_a_joint_that_trembles_moves_nothing():
    assert JointRange("j", -2.57, 2.57).followed(0.5, 0.5007) == 0.5


def test_a_joint_that_comes_to_rest_is_shown_where_it_is():
    joint = JointRange("j", -2.57, 2.57)
    follower = HeldSlider(joint.step)
    shown = -2.0
    # The last of the motion is smaller than a step.
    for time_s, position in enumerate((-2.0, -2.5692, -2.57)):
        followed = follower.shown(position, float(time_s))
        assert followed is not None
        shown = joint.followed(shown, followed)
    assert shown == -2.57


def test_nan_is_not_shown():
    assert HeldSlider(0.001).shown(float("nan"), 0.0) is None


def test_it_stays_where_the_user_put_it_until_the_joint_rests():
    follower = HeldSlider(0.001)
    follower.shown(0.0, 0.0)
    follower.hold(0.9, 1.0)
    for k in range(10):
        assert follower.shown(0.1 * k, 1.0 + 0.1 * k) is None
    # It went on moving until 1.9 s.
    assert follower.shown(0.9, 1.9 + 0.9 * STILL_S) is None
    assert follower.is_held(1.9 + 0.9 * STILL_S)
    assert follower.shown(0.9, 1.9 + 1.1 * STILL_S) == 0.9


def test_a_joint_that_others_keep_moving_does_not_hold_it_for_ever():
    follower = HeldSlider(0.001)
    follower.hold(9.0, 0.0)
    times = [0.1 * k for k in range(int(MAX_HOLD_S * 10) + 2)]
    shown = [follower.shown(time_s, time_s) for time_s in times]
    assert shown[-3] is None
    assert shown[-1] == times[-1]


def test_a_joint_that_sets_off_late_does_not_bring_it_back():
    follower = HeldSlider(0.001)
    follower.shown(0.0, 0.0)
    follower.hold(0.9, 1.0)
    assert follower.shown(0.0, 1.0 + 4.0 * STILL_S) is None
    assert follower.shown(0.9, 1.0 + 5.0 * STILL_S) is None
    assert follower.shown(0.9, 1.0 + 6.1 * STILL_S) == 0.9


def test_a_joint_that_is_there_already_releases_it():
    follower = HeldSlider(0.001)
    follower.shown(0.5, 0.0)
    follower.hold(0.5, 1.0)
    assert follower.shown(0.5, 1.0 + 0.9 * STILL_S) is None
    assert follower.shown(0.5, 1.0 + 1.1 * STILL_S) == 0.5


@pytest.mark.parametrize(
    ("text", "number"), [("-0.5", -0.5), ("1e-2", 0.01), (" 0.12345 ", 0.12345), ("-1", -1.0)]
)
def test_a_number_is_what_was_typed(text, number):
    assert number_typed(text, "j0", -1.0, 1.0) == number


def test_a_number_beyond_a_limit_by_rounding_is_the_limit():
    assert number_typed("-1e-20", "j0", 0.0, 1.0) == 0.0
    assert number_typed("1.0000000001", "j0", 0.0, 1.0) == 1.0


@pytest.mark.parametrize("text", ["", "-", "0,5", "1e", "half"])
def test_an_invalid_number_is_reported(text):
    with pytest.raises(ValueError, match="is not a number"):
        number_typed(text, "j0", -1.0, 1.0)


@pytest.mark.parametrize("text", ["1.01", "-inf", "nan"])
def test_an_unreachable_position_is_reported(text):
    with pytest.raises(ValueError, match="'j0' goes from -1 to 1"):
        number_typed(text, "j0", -1.0, 1.0)


@pytest.fixture(scope="module")
def served() -> Iterator[tuple[PageServer, list[Request]]]:
    """A page with a joint panel without robots, and what it sends."""
    sent: list[Request] = []
    with page_server(port=0) as running:
        JointPanel(running.channel, sent.append).build(running.gui)
        yield running, sent


def test_every_typed_number_is_answered_in_turn(served):
    server, sent = served
    with connect(f"ws://{HOST}:{server.get_port()}{PATH}", origin=server.url) as page:
        for number, text in enumerate(("-0.5", "1e-2")):
            page.send(
                json.dumps({"kind": TYPED_NUMBER, "number": number, "slider": "s", "text": text})
            )
        answers = [json.loads(page.recv(30.0)) for _ in range(2)]
    gone = "this joint is no longer there"
    assert answers == [{"kind": TYPED_NUMBER, "number": n, "problem": gone} for n in (0, 1)]
    assert not sent


@pytest.mark.parametrize(
    "fields", [{}, {"slider": 1, "text": "1"}, {"slider": "s", "text": "1" * 1000}]
)
def test_a_message_that_is_not_a_typed_number_moves_nothing(served, fields):
    server, sent = served
    with connect(f"ws://{HOST}:{server.get_port()}{PATH}") as program:
        program.send(json.dumps({"kind": TYPED_NUMBER, "number": 7, **fields}))
        answer = json.loads(program.recv(30.0))
    assert (answer["kind"], answer["of"], answer["number"]) == ("refused", TYPED_NUMBER, 7)
    assert "is not a text" in answer["problem"]
    assert not sent
