"""robot_state_publisher as other nodes see it, in a process of its own."""

import math
import signal

import pytest
from rcl_interfaces.srv import GetParameters, ListParameters
from rclpy.parameter import parameter_value_to_python
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

NODE = "robot_state_publisher"
MODULE = "robot_state_publisher_node"
HALF = math.sqrt(0.5)


def seconds(stamp) -> float:
    return stamp.sec + stamp.nanosec * 1e-9


def transforms(message) -> dict[tuple[str, str], tuple[float, ...]]:
    """Return x, y, z and the quaternion x, y, z, w by parent and child, rounded."""
    result = {}
    for stamped in message.transforms:
        t, r = stamped.transform.translation, stamped.transform.rotation
        numbers = (t.x, t.y, t.z, r.x, r.y, r.z, r.w)
        key = (stamped.header.frame_id, stamped.child_frame_id)
        result[key] = tuple(round(number, 9) + 0.0 for number in numbers)
    return result


def children(message) -> set[str]:
    return {stamped.child_frame_id for stamped in message.transforms}


def test_late_subscribers_get_the_description_and_fixed_and_planar_joints(
    client, start, urdf, latched
):
    start(MODULE, robot_description=urdf)
    first = client.subscribe(String, "robot_description", latched).wait_for()
    late = client.subscribe(String, "robot_description", latched).wait_for()
    assert first[0].data == late[0].data == urdf
    client.subscribe(TFMessage, "/tf_static", latched).wait_for()
    late = client.subscribe(TFMessage, "/tf_static", latched).wait_for()
    assert transforms(late[0]) == {
        ("slide", "tool"): (1, 2, 3, 0, 0, 1, 0),
        ("base", "table"): (0, 0, -1, 0, 0, 0, 1),
    }


def test_a_joint_state_moves_what_it_names_and_what_mimics_it_with_its_own_stamp(tf, send):
    _, collector = tf()
    send(12.345, turn=math.pi / 2, push=0.25, free=1.0, unknown=1.0)
    message = collector.wait_for()[0]
    assert transforms(message) == {
        ("base", "arm"): (0, 0, 1, 0, 0, round(HALF, 9), round(HALF, 9)),
        ("arm", "slide"): (0, 0.25, 0, 0, 0, round(HALF, 9), round(HALF, 9)),
        ("slide", "finger"): (0, 0, 0, 0, 0, 0, 1),
    }
    assert {seconds(t.header.stamp) for t in message.transforms} == {12.345}


def test_a_follower_that_the_message_names_has_its_own_position(tf, send):
    _, collector = tf()
    send(1.0, push=0.0, grip=0.125)
    assert transforms(collector.wait_for()[0])["slide", "finger"][2] == 0.125


def test_the_frame_prefix_stands_before_every_frame(client, tf, send, latched):
    _, collector = tf(frame_prefix="left/")
    send(1.0, turn=0.0)
    assert transforms(collector.wait_for()[0]).keys() == {("left/base", "left/arm")}
    static = client.subscribe(TFMessage, "/tf_static", latched).wait_for()[0]
    assert ("left/slide", "left/tool") in transforms(static)


def test_one_process_has_a_node_in_each_namespace(client, start, urdf, latched):
    start(MODULE, "--namespaces", "left", "right", robot_description=urdf)
    for namespace in ("left", "right"):
        topic = f"/{namespace}/robot_description"
        assert client.subscribe(String, topic, latched).wait_for()[0].data == urdf
    collector = client.subscribe(TFMessage, "/tf", 100)
    client.wait_until(lambda: client.node.count_publishers("/tf") == 2, "both publishers of /tf")
    states = client.publisher(JointState, "/right/joint_states")
    message = JointState(name=["turn"], position=[0.0])
    message.header.stamp.sec = 1
    states.publish(message)
    assert children(collector.wait_for()[0]) == {"arm"}
    nodes = {f"{place}/{name}" for name, place in client.node.get_node_names_and_namespaces()}
    assert nodes >= {f"/left/{NODE}", f"/right/{NODE}"}


def test_another_frame_prefix_takes_effect_at_once(client, tf, send, latched, set_parameters):
    _, collector = tf()
    static = client.subscribe(TFMessage, "/tf_static", latched)
    static.wait_for()
    assert set_parameters(NODE, frame_prefix="x/") == ""
    assert children(static.wait_for(2)[1]) == {"x/tool", "x/table"}
    send(1.0, turn=0.0)
    assert children(collector.wait_for()[0]) == {"x/arm"}


OTHER = """<robot name='other'><link name='base'/><link name='hand'/><link name='nail'/>
  <joint name='wave' type='continuous'><parent link='base'/><child link='hand'/></joint>
  <joint name='nailed' type='fixed'><parent link='hand'/><child link='nail'/></joint></robot>"""


def test_another_description_takes_the_place_of_the_first(
    client, tf, send, latched, set_parameters
):
    _, collector = tf()
    descriptions = client.subscribe(String, "robot_description", latched)
    descriptions.wait_for()
    assert set_parameters(NODE, robot_description=OTHER) == ""
    assert descriptions.wait_for(2)[1].data == OTHER
    late = client.subscribe(TFMessage, "/tf_static", latched).wait_for()
    assert children(late[-1]) == {"nail"}
    send(1.0, turn=0.0, wave=0.0)
    assert children(collector.wait_for()[0]) == {"hand"}


@pytest.mark.parametrize(
    ("description", "reason"),
    [
        ("", "Empty URDF is not allowed"),
        ("<robot name='r'>\n<link/></robot>", "robot_description, line 2: <link> needs"),
        (5, "Wrong parameter type"),
    ],
)
def test_a_description_that_is_no_robot_is_refused_and_the_old_one_stays(
    tf, send, set_parameters, description, reason
):
    _, collector = tf()
    refusal = set_parameters(NODE, robot_description=description, frame_prefix="x/")
    assert refusal.startswith(reason)
    send(1.0, turn=0.0)
    assert children(collector.wait_for()[0]) == {"arm"}


def test_joint_states_that_make_no_sense_are_named_and_the_node_goes_on(tf, send):
    node, collector = tf()
    send(1.0, [], turn=0.0)
    node.wait_for_line("ignored a JointState about turn: it has no positions")
    send(1.0, [1.0, 2.0], turn=0.0)
    node.wait_for_line("ignored a JointState about turn: 1 names, but 2 positions")
    send(1.0, turn=0.25)
    collector.wait_for()
    assert [seconds(m.transforms[0].header.stamp) for m in collector.messages] == [1.0]


def test_a_position_that_is_no_number_is_not_sent(tf, send):
    node, collector = tf()
    send(1.0, turn=math.nan)
    node.wait_for_line("ignored a JointState about turn: a position is not a finite number")
    send(1.0, push=0.25)
    assert children(collector.wait_for()[0]) == {"slide", "finger"}


def test_a_position_that_is_too_large_for_what_mimics_it_is_not_sent(tf, send):
    node, collector = tf()
    send(1.0, push=1e308)
    node.wait_for_line("ignored a JointState about push: a position is not a finite number, or too")
    node.wait_for_line("large for link 'finger'")
    send(1.0, push=0.25)
    assert transforms(collector.wait_for()[0])["slide", "finger"][2] == 0.0
    assert "Warning" not in node.output


def test_bytes_that_are_no_joint_state_are_ignored(tf, send):
    node, collector = tf()
    send(1.0, b"\x00\x01\x00\x00 nonsense, far too short to be one")
    node.wait_for_line("ignored a JointState whose bytes cannot be read")
    send(1.0, turn=0.0)
    assert children(collector.wait_for()[0]) == {"arm"}


def test_the_topics_have_upstreams_quality_of_service(client, tf):
    tf()

    def policies(infos) -> set:
        return {
            (info.qos_profile.reliability, info.qos_profile.durability)
            for info in infos
            if info.node_name == NODE
        }

    reliable, latched = ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL
    volatile = DurabilityPolicy.VOLATILE
    find = client.node.get_publishers_info_by_topic
    for topic, expected in (
        ("/tf", (reliable, volatile)),
        ("/tf_static", (reliable, latched)),
        ("/robot_description", (reliable, latched)),
    ):
        offered = client.wait_until(lambda t=topic: policies(find(t)), f"a publisher of {topic}")
        assert offered == {expected}, topic
    find = client.node.get_subscriptions_info_by_topic
    asked = client.wait_until(lambda: policies(find("/joint_states")), "its subscription")
    assert asked == {(ReliabilityPolicy.BEST_EFFORT, volatile)}


def test_the_parameters_are_upstreams(client, tf):
    tf()
    names = client.call(ListParameters, f"/{NODE}/list_parameters", ListParameters.Request())
    expected = {
        "frame_prefix": "",
        "ignore_timestamp": False,
        "publish_frequency": 20.0,
        "qos_overrides./joint_states.subscription.depth": 5,
        "qos_overrides./joint_states.subscription.history": "keep_last",
        "qos_overrides./joint_states.subscription.reliability": "best_effort",
        "qos_overrides./tf.publisher.depth": 100,
        "qos_overrides./tf.publisher.durability": "volatile",
        "qos_overrides./tf.publisher.history": "keep_last",
        "qos_overrides./tf.publisher.reliability": "reliable",
        "qos_overrides./tf_static.publisher.depth": 1,
        "qos_overrides./tf_static.publisher.history": "keep_last",
        "qos_overrides./tf_static.publisher.reliability": "reliable",
    }
    assert expected.keys() <= set(names.result.names)
    request = GetParameters.Request(names=list(expected))
    values = client.call(GetParameters, f"/{NODE}/get_parameters", request).values
    assert [parameter_value_to_python(value) for value in values] == list(expected.values())


def test_the_quality_of_service_may_be_overridden(client, start, urdf):
    topics = {"/joint_states": {"subscription": {"reliability": "reliable"}}}
    start(MODULE, robot_description=urdf, qos_overrides=topics)

    subscriptions = client.wait_until(
        lambda: client.node.get_subscriptions_info_by_topic("/joint_states"),
        "a subscription to /joint_states",
    )
    assert [each.qos_profile.reliability for each in subscriptions] == [ReliabilityPolicy.RELIABLE]


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        ({}, "Empty URDF is not allowed: set the parameter robot_description to the URDF's text"),
        ({"robot_description": "<robot name='r'/>"}, "robot_description, the robot has no links"),
        (
            {
                "robot_description": OTHER,
                "qos_overrides": {"/tf": {"publisher": {"reliability": "hardly"}}},
            },
            "Unexpected QoS override for policy `reliability`: `hardly`",
        ),
    ],
)
def test_a_start_that_cannot_be_ends_with_a_sentence_and_exit_code_1(start, parameters, sentence):
    node = start(MODULE, **parameters)
    assert node.wait() == 1
    assert sentence in node.output
    assert "Traceback" not in node.output


def test_a_namespace_that_cannot_be_ends_with_a_sentence(start, urdf):
    node = start(MODULE, "--namespaces", "left", "2 rights", robot_description=urdf)
    assert node.wait() == 1
    assert "cannot create the node: Invalid namespace" in node.output
    assert "Traceback" not in node.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_exit_code_0_and_without_a_word(tf, send, number):
    node, collector = tf()
    send(1.0, turn=0.0)
    collector.wait_for()
    assert node.stop(number) == 0
    assert node.own_words == []


FALLBACK = "No robot_description parameter, but command-line argument available.  Assuming argument"


def test_a_urdf_file_as_argument_takes_the_place_of_the_parameter(
    client, start, urdf, latched, tmp_path
):
    file = tmp_path / "robot.urdf"
    file.write_text(urdf)
    node = start(MODULE, str(file))
    node.wait_for(FALLBACK)
    received = client.subscribe(String, "robot_description", latched).wait_for()
    assert received[0].data == urdf


def test_a_urdf_file_that_does_not_exist_is_named(start, tmp_path):
    node = start(MODULE, str(tmp_path / "robt.urdf"))
    node.wait_for_line(f"Failed to open URDF file: {tmp_path}/robt.urdf: No such file or directory")
    assert node.process.wait(60) == 1
