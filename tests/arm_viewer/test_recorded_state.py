"""What the page shows of a recording at a moment, and where its numbers stand."""

from contextlib import closing

import cv2
import numpy as np
import pytest
from geometry_msgs.msg import Point, TransformStamped, WrenchStamped
from mcap.writer import Writer
from rclpy.serialization import deserialize_message, serialize_message
from robots import joint, link, robot
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CompressedImage, Image, JointState
from std_msgs.msg import Float64MultiArray, String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from arm_viewer.recordings.curve import read_curve
from arm_viewer.recordings.open_recording import Wanted
from arm_viewer.recordings.recorded_bag import RecordedBag
from arm_viewer.ros.observer import type_name
from arm_viewer.ros.recorded_state import RecordedState, number_places

URDF = robot(link("base"), link("hand"), joint("j0", "base", "hand"))
S = 1_000_000_000


def transform(child, x, parent="base"):
    stamped = TransformStamped(child_frame_id=child)
    stamped.header.frame_id = parent
    stamped.transform.translation.x = x
    return TFMessage(transforms=[stamped])


def joints(position, *names):
    return JointState(name=list(names), position=[position] * len(names))


def marker(number, action=Marker.ADD):
    made = Marker(ns="world", id=number, action=action, type=Marker.CUBE)
    made.header.frame_id = "world"
    made.scale.x = made.scale.y = made.scale.z = made.color.a = 1.0
    return MarkerArray(markers=[made])


def contacts(x, text):
    """Return the contact markers of a force of 1 N at x on the ground; none without a text."""
    points = Marker(type=Marker.SPHERE_LIST, points=[Point(x=x)])
    forces = Marker(type=Marker.LINE_LIST, points=[Point(x=x), Point(x=x, z=0.02)], text=text)
    for each in (points, forces):
        each.header.frame_id = "world"
        each.action = Marker.ADD if text else Marker.DELETE
    return MarkerArray(markers=[points, forces])


@pytest.fixture
def state_of(tmp_path):
    """Return a function that records (topic, seconds, message) and returns their state."""
    opened = []

    def make(*messages):
        path = tmp_path / "a.mcap"
        with path.open("wb") as stream:
            writer = Writer(stream)
            writer.start()
            channels = {}
            for topic, at_s, message in messages:
                is_raw = isinstance(message, bytes)
                kind = type_name(JointState if is_raw else type(message))
                if topic not in channels:
                    schema = writer.register_schema(kind, "ros2msg", b"")
                    channels[topic] = writer.register_channel(topic, "cdr", schema)
                data = message if is_raw else serialize_message(message)
                writer.add_message(channels[topic], round(at_s * S), data, round(at_s * S))
            writer.finish()
        opened.append(RecordedBag(path))
        return RecordedState(opened[-1])

    yield make
    for recording in opened:
        recording.close()


def at(state, time_s, pictures=(), curves=()):
    wanted = Wanted(frozenset(pictures), frozenset(curves))
    return state.at(round(time_s * S), 100.0, 1.0, wanted)


def test_the_robot_is_parsed_once_and_only_from_when_it_is_there(state_of):
    state = state_of(("/a", 0, String()), ("/robot_description", 1, String(data=URDF)))
    assert at(state, 0.5).descriptions == {}
    first = at(state, 1.0).descriptions["/robot_description"]
    assert first.robot.name == "r"
    assert at(state, 9.0).descriptions["/robot_description"] is first


def test_joints_of_several_publishers_are_shown_together_after_a_jump(state_of):
    rows = [("/joint_states", 0.1 * n, joints(n, "a")) for n in range(100)]
    rows += [("/joint_states", 0.05 + n, joints(-n, "b")) for n in range(10)]
    state = state_of(*sorted(rows, key=lambda row: row[1]))
    for time_s, a, b in ((7.5, 75, -7), (2.5, 25, -2), (2.6, 26, -2), (9.9, 99, -9)):
        shown = at(state, time_s).joint_states["/joint_states"].joints
        assert (shown["a"].position, shown["b"].position) == (a, b)


def test_playing_on_shows_the_same_as_a_jump(state_of):
    rows = [("/tf", 0.01 * n, transform(f"f{n % 7}", float(n))) for n in range(300)]
    played = state_of(*rows)
    for n in range(60):
        seen = at(played, n / 30.0).transforms
    assert seen == at(state_of(*rows), 59 / 30.0).transforms


def test_after_a_jump_back_nothing_of_later_is_left(state_of):
    state = state_of(("/tf", 0, transform("a", 1.0)), ("/tf", 5, transform("b", 2.0)))
    assert set(at(state, 5.0).transforms) == {"b"}
    assert set(at(state, 1.0).transforms) == {"a"}


def test_static_frames_are_all_there(state_of):
    state = state_of(("/tf_static", 0, transform("a", 1.0)), ("/tf_static", 1, transform("b", 2.0)))
    assert set(at(state, 9.0).transforms) == {"a", "b"}
    assert set(at(state, 0.5).transforms) == {"a"}


def test_without_transforms_the_joints_place_the_links(state_of):
    state = state_of(("/left/joint_states", 0, joints(0.5, "j0")))
    assert at(state, 0.0).hardware_positions == {"/left": {"j0": 0.5}}


def test_things_of_the_world_come_and_go(state_of):
    state = state_of(
        ("/world_markers", 0, marker(1)),
        ("/world_markers", 2, marker(2)),
        ("/world_markers", 4, marker(1, Marker.DELETE)),
    )
    names = [sorted(at(state, time_s).markers) for time_s in (1, 3, 5, 1)]
    one, two = "/world_markers/world/1", "/world_markers/world/2"
    assert names == [[one], [one, two], [two], [one]]


def test_contacts_are_those_of_the_latest_message_before_the_moment(state_of):
    state = state_of(
        ("/contact_markers", 1, contacts(1.0, "hand on world: 1 N")),
        ("/left/contact_markers", 2, contacts(2.0, "left on world: 1 N")),
        ("/contact_markers", 3, contacts(0.0, "")),
    )
    shown = [at(state, time_s).contacts for time_s in (0.5, 1.5, 2.5, 3.5, 1.5)]
    assert shown[0] is None
    assert shown[1].frame == "world"
    assert shown[1].points.tolist() == [[1.0, 0.0, 0.0]]
    assert shown[1].lines.tolist() == pytest.approx(np.array([[[1.0, 0.0, 0.0], [1.0, 0.0, 0.02]]]))
    said = [each.strongest for each in shown[1:]]
    assert said == [("hand on world: 1 N",), ("left on world: 1 N",), (), ("hand on world: 1 N",)]


def test_pictures_are_read_only_where_they_are_shown(state_of):
    plain = Image(encoding="rgb8", width=2, height=1, step=6, data=[1, 2, 3, 4, 5, 6])
    pixels = np.full((4, 6, 3), 200, dtype=np.uint8)
    packed = CompressedImage(format="jpeg", data=cv2.imencode(".jpg", pixels)[1].tobytes())
    state = state_of(("/a", 0, plain), ("/b/compressed", 0, packed))
    assert at(state, 0.0).pictures == {}
    shown = at(state, 0.0, ["/a", "/b/compressed"]).pictures
    assert shown["/a"].data.tolist() == [1, 2, 3, 4, 5, 6]
    assert (shown["/b/compressed"].width, shown["/b/compressed"].encoding) == (6, "bgr8")
    assert abs(int(shown["/b/compressed"].data[0]) - 200) < 5


def test_simulated_time_and_speed(state_of):
    clock = Clock()
    clock.clock.sec = 7
    shown = at(state_of(("/clock", 0, clock)), 0.0)
    assert (shown.time.time_s, shown.time.factor, shown.replay) == (7.0, 1.0, "a.mcap")


def test_messages_that_cannot_be_read_are_left_out_and_named_once(state_of, caplog):
    state = state_of(("/joint_states", 0, b"\x00\x01\x00\x00\xff"), ("/joint_states", 1, b""))
    assert [at(state, time_s).joint_states for time_s in (0.0, 1.0)] == [{}, {}]
    assert [r.getMessage().split(":")[0] for r in caplog.records] == [
        "messages of /joint_states cannot be read"
    ]


def test_curves_end_at_the_moment_and_begin_before_it(state_of):
    rows = [("/joint_states", 0.1 * n, joints(float(n), "a")) for n in range(600)]
    state = state_of(*rows)
    name = "/joint_states.position[a]"
    for time_s in (30.0, 30.05, 30.5, 5.0, 55.0):
        shown = at(state, time_s, curves=[name])
        samples = shown.curves.since(name, -np.inf)
        first = max(0.0, (30.0 if 30.0 <= time_s < 31.0 else time_s) - 20.0)
        wanted = [n for n in range(600) if first + 1e-9 < 0.1 * n <= time_s + 1e-9]
        assert samples.values.tolist() == [float(n) for n in wanted if n]
        assert shown.curves_s == pytest.approx(time_s)
    assert shown.numbers["/joint_states"] == ("position[a]",)


def test_curves_of_a_jump_are_others_and_grow_while_it_plays(state_of):
    state = state_of(*(("/joint_states", 0.1 * n, joints(float(n), "a")) for n in range(600)))
    first = at(state, 10.0, curves=["/joint_states.position[a]"]).curves
    assert at(state, 10.1, curves=["/joint_states.position[a]"]).curves is first
    assert at(state, 5.0, curves=["/joint_states.position[a]"]).curves is not first


def test_what_stands_between_the_fields_is_not_looked_at(state_of):
    """The writer leaves there what its memory held: mostly the same, and now and then not."""
    plain = serialize_message(joints(0.0, "a"))
    rows = [bytearray(serialize_message(joints(float(n), "a"))) for n in range(1, 9)]
    for row in rows[1::2]:
        # Behind the header of 4 bytes: stamp 8, text 4 + 1, gap 3, texts 4 + 4 + 2, gap 2, number.
        for gap in (slice(17, 20), slice(30, 32)):
            row[gap] = b"\xa5" * len(row[gap])
    assert deserialize_message(bytes(rows[1]), JointState) == joints(2.0, "a")
    messages = [bytes(row) for row in rows] + [plain]
    state = state_of(*(("/joint_states", 0.1 * n, data) for n, data in enumerate(messages, 1)))
    samples = at(state, 0.9, curves=["/joint_states.position[a]"]).curves
    values = samples.since("/joint_states.position[a]", -np.inf).values
    assert values.tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 0.0]


def test_numbers_are_found_by_their_names():
    message = JointState(name=["a", "b"], position=[1.0, 2.0], velocity=[3.0, 4.0])
    data = serialize_message(message)
    places = number_places(data, JointState)
    assert list(places) == ["position[a]", "position[b]", "velocity[a]", "velocity[b]"]
    found = {n: float(np.frombuffer(data, "<f8", 1, p.offset)[0]) for n, p in places.items()}
    assert list(found.values()) == [1.0, 2.0, 3.0, 4.0]


def test_numbers_of_nested_messages_and_of_lists():
    wrench = number_places(serialize_message(WrenchStamped()), WrenchStamped)
    assert list(wrench)[:2] == ["wrench.force.x", "wrench.force.y"]
    array = number_places(serialize_message(Float64MultiArray(data=[1.0, 2.0])), Float64MultiArray)
    assert list(array) == ["data[0]", "data[1]"]
    assert number_places(serialize_message(String(data="text")), String) == {}


def test_stamps_and_numbers_may_change_and_names_may_not(state_of, tmp_path):
    rows = []
    for n in range(50):
        message = joints(float(n), "a", "b")
        message.header.stamp.sec, message.velocity = 1000 * n, [0.5, float(-n)]
        rows.append(("/joint_states", n, message))
    rows.append(("/joint_states", 50, joints(99.0, "b", "a")))
    state = state_of(*rows, ("/joint_states", 51, rows[-1][2]))
    place = number_places(serialize_message(rows[0][2]), JointState)["position[a]"]
    with closing(RecordedBag(tmp_path / "a.mcap")) as recording:
        curve = read_curve(recording, "/joint_states", place)
    assert (np.nanmin(curve.low), np.nanmax(curve.high), curve.skipped) == (0.0, 49.0, 2)
    assert ("/joint_states", "position[b]") in state.numbers()
