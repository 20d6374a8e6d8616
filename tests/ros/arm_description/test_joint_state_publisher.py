"""joint_state_publisher as other nodes see it, in a process of its own."""

import signal

import pytest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import String

NODE = "joint_state_publisher"
MODULE = "joint_state_publisher_node"


@pytest.fixture
def urdf_file(tmp_path, urdf) -> str:
    file = tmp_path / "robot.urdf"
    file.write_text(urdf)
    return str(file)


@pytest.fixture
def states(client):
    """Return the joint states that arrive from now on."""
    return client.subscribe(JointState, "joint_states")


@pytest.fixture
def describe(client, latched):
    """Publish a latched robot_description."""
    publisher = client.node.create_publisher(String, "robot_description", latched)
    return lambda text: publisher.publish(String(data=text))


CIRCLE = """<robot name='r'><link name='a'/><link name='b'/><link name='c'/>
  <joint name='j' type='continuous'><parent link='a'/><child link='b'/><mimic joint='k'/></joint>
  <joint name='k' type='continuous'><parent link='b'/><child link='c'/><mimic joint='j'/></joint>
</robot>"""


def test_a_file_gives_the_joints_in_its_order_with_defaults(start, states, urdf_file):
    start(MODULE, urdf_file)
    message = states.wait_for()[0]
    assert message.name == ["turn", "push", "grip"]
    assert list(message.position) == [0.0, 0.0, 0.5]
    assert (len(message.velocity), len(message.effort)) == (0, 0)


def test_a_description_from_the_topic_starts_it_and_another_takes_its_place(
    start, states, describe, urdf
):
    start(MODULE)
    describe(urdf)
    assert states.wait_for()[0].name == ["turn", "push", "grip"]
    describe("""<robot name='r'><link name='a'/><link name='b'/>
      <joint name='wave' type='continuous'><parent link='a'/><child link='b'/></joint></robot>""")
    states.wait_until(lambda m: m[-1].name == ["wave"], "the joints of the other robot")


def test_a_description_that_is_no_robot_is_ignored_with_a_warning(start, states, describe, urdf):
    node = start(MODULE)
    describe("<world/>")
    node.wait_for_line('ignoring: robot_description, line 1: URDF must have a "robot" tag')
    describe(urdf)
    assert states.wait_for()[0].name == ["turn", "push", "grip"]


def test_the_parameters_say_what_is_published(start, states, urdf_file):
    start(
        MODULE,
        urdf_file,
        rate=50,
        publish_default_velocities=True,
        publish_default_efforts=True,
        zeros={"turn": 1},
        dependent_joints={"push": {"parent": "turn", "factor": 2.0, "offset": 0.25}},
        source_list=[],
    )
    message = states.wait_for()[0]
    assert list(message.position) == [1.0, 2.25, -4.0]
    assert list(message.velocity) == list(message.effort) == [0.0, 0.0, 0.0]


def test_a_source_that_makes_no_sense_is_named_and_the_node_goes_on(
    client, start, states, urdf_file
):
    node = start(MODULE, urdf_file, source_list=["left"])
    publisher = client.publisher(JointState, "left")
    publisher.publish(JointState(name=["turn"], position=[0.5, 2.0]))
    node.wait_for_line("ignored a JointState: 1 names, but 2 positions")
    publisher.publish(JointState(name=["turn"], position=[1.0]))
    taken = states.wait_until(lambda m: bool(m) and m[-1].position[0] == 1.0, "the next one taken")
    assert {message.position[0] for message in taken} <= {0.0, 1.0}


def test_stamps_are_the_nodes_time_and_without_a_clock_nothing_is_published(
    client, start, states, urdf_file
):
    start(MODULE, urdf_file, use_sim_time=True)
    clock = client.publisher(Clock, "/clock")
    message = Clock()
    message.clock.sec = 100

    def tick() -> bool:
        message.clock.sec += 1
        clock.publish(message)
        return bool(states.messages)

    client.wait_until(tick, "a joint state in simulation time")
    assert states.messages[0].header.stamp.sec > 100


def test_rate_and_delta_change_at_once(start, states, urdf_file, set_parameters):
    start(MODULE, urdf_file, rate=1)
    states.wait_for()
    assert set_parameters(NODE, rate=100, delta=0.5) == ""
    states.wait_until(lambda m: m[-1].position[0] == 3.0, "the sweep at the upper limit")
    states.wait_until(lambda m: m[-1].position[0] == -3.0, "the sweep at the lower limit")


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ({"rate": 0}, "Parameter rate out of range. Min: 1, Max: 10000, value: 0"),
        ({"delta": 0.5, "source_list": ["x"]}, "Trying to set a read-only parameter: source_list"),
    ],
)
def test_a_change_that_cannot_be_is_refused_whole(
    start, states, urdf_file, set_parameters, values, reason
):
    start(MODULE, urdf_file)
    states.wait_for()
    assert set_parameters(NODE, **values).startswith(reason)
    states.clear()
    assert states.wait_for(2)[1].position[0] == 0.0


def test_joints_that_mimic_in_a_circle_end_it(start, describe):
    node = start(MODULE)
    describe(CIRCLE)
    assert node.wait() == 1
    assert "Found an infinite recursive mimic chain: ['j', 'k', 'j']" in node.output


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (["/no/such.urdf"], 1, "cannot read /no/such.urdf: No such file or directory"),
        (["a", "b"], 2, "unrecognized arguments: b"),
    ],
)
def test_a_start_that_cannot_be_ends_with_a_sentence(start, arguments, code, sentence):
    node = start(MODULE, *arguments)
    assert node.wait() == code
    assert sentence in node.output
    assert "Traceback" not in node.output


def test_a_file_that_is_no_robot_ends_it(start, tmp_path):
    file = tmp_path / "robot.urdf"
    file.write_text("<robot name='r'>\n<joint name='j' type='revolute'/></robot>")
    node = start(MODULE, str(file))
    assert node.wait() == 1
    assert "line 2: joint 'j'" in node.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_with_exit_code_0_and_without_a_word(start, states, urdf_file, number):
    node = start(MODULE, urdf_file)
    states.wait_for()
    assert node.stop(number) == 0
    assert node.own_words == []
