"""arm_controller_node beside a robot of topics."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest
import yaml
from ament_index_python.packages import get_package_share_directory
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters

from arm_node.testing import DiscoveryCheck

pytestmark = pytest.mark.ros

NAME = "arm_controller_node"
CONFIG = Path(get_package_share_directory("arm_controller")) / "config"
COURSES = Path(get_package_share_directory("arm_control")) / "config/courses"
DEFAULT_POSE = [0.4, -0.1, 0.5, 0.4]
PARAMETERS = {
    "params.yaml": {"desired_param": DEFAULT_POSE, "print_period": 1.0},
    "params_left_bent.yaml": {"desired_param": [1.0, 0.5, 0.1, 0.5]},
    "params_left_straight.yaml": {"desired_param": [1.0, 0.5, 0.0, 0.0]},
    "params_right_folded.yaml": {"desired_param": [-2.57, 0.5, -1.2, -1.0]},
    "params_ros1.yaml": {
        "command_topic": "{joint}p_controller/command",
        "desired_param": [-5.0, 0.5, -1.2, -1.0],
        "check_limits": False,
        "publish_rate": 10.0,
        "print_period": 1.0,
    },
}


def test_the_parameter_files_hold_the_poses_of_the_originals():
    found = {path.name: yaml.safe_load(path.read_text()) for path in CONFIG.glob("params*.yaml")}
    names = {name: next(iter(sections)) for name, sections in found.items()}
    assert {name: s[names[name]]["ros__parameters"] for name, s in found.items()} == PARAMETERS
    assert names.pop("params_ros1.yaml") == "/arm/arm_controller_node"
    assert set(names.values()) == {"arm_controller_node"}


def course_file(course: str) -> tuple[str, ...]:
    return ("--ros-args", "--params-file", str(COURSES / f"{course}.yaml"))


@pytest.fixture
def set_pose(robot) -> Callable:
    """Set desired_param through the node's service, as a command line does."""
    node = robot.node("parameter_client")
    client = node.create_client(SetParameters, "/arm_controller_node/set_parameters")
    check = DiscoveryCheck.with_server(node, client.service_name)
    types = {
        "double_array_value": ParameterType.PARAMETER_DOUBLE_ARRAY,
        "integer_array_value": ParameterType.PARAMETER_INTEGER_ARRAY,
        "bool_array_value": ParameterType.PARAMETER_BOOL_ARRAY,
        "string_value": ParameterType.PARAMETER_STRING,
    }

    def set_to(until: Callable, **value: object):
        kind = types[next(iter(value))] if value else ParameterType.PARAMETER_NOT_SET
        request = SetParameters.Request(
            parameters=[Parameter(name="desired_param", value=ParameterValue(type=kind, **value))]
        )
        until(client.service_is_ready, "the parameter service")
        until(lambda: check.complete, "known to the parameter service")
        future = client.call_async(request)
        until(future.done, "an answer of the parameter service")
        return future.result().results[0]

    return set_to


def test_publishes_the_pose_of_its_file_exactly_once(robot, run, until):
    commands = robot.listen()
    robot.describe()
    robot.broadcast()
    program = run(NAME, "--ros-args", "--params-file", str(CONFIG / "params.yaml"))
    program.wait_for_line("Publishing positions: [0.400000, -0.100000, 0.500000, 0.400000]")
    # Two prints of the joint states later it would have been published again, if ever.
    until(lambda: program.output.count("Joint State: 'j3'") >= 3, "three prints")
    assert commands == [DEFAULT_POSE]
    assert program.stop() == 0
    assert program.output.count("Publishing") == 1


def test_publishes_nothing_without_a_pose_and_prints_by_name(robot, run):
    commands = robot.listen()
    robot.positions.update(j0=0.1, j1=-0.2, j2=0.3, j3=1.5)
    robot.broadcast()
    program = run(NAME, print_period=0.2)
    program.wait_for_line("Joint State: 'j3'")
    for name, position in robot.positions.items():
        assert (
            f"Joint State: '{name}' Position: {position:.6f} Velocity: 0.250000 "
            f"Effort: {10 * position:.6f}" in program.output
        )
    assert program.stop() == 0
    assert commands == []


def test_publishes_repeatedly_at_a_rate_and_logs_it_once(robot, run, until):
    commands = robot.listen()
    robot.describe()
    program = run(NAME, publish_rate=50, desired_param="[0.1, 0.2, 0.3, 0.4]")
    until(lambda: len(commands) >= 10, "ten commands")
    assert commands[9] == [0.1, 0.2, 0.3, 0.4]
    assert program.output.count("Publishing positions") == 1


def test_logs_each_publication_if_told_to(robot, run, until):
    commands = robot.listen()
    robot.describe()
    program = run(
        NAME, publish_rate=20, log_each_publication=True, desired_param="[0.1, 0.2, 0.3, 0.4]"
    )
    line = "Publishing positions: [0.100000, 0.200000, 0.300000, 0.400000]"
    until(lambda: program.output.count(line) >= 3, "three lines")
    assert program.stop() == 0
    # The end of the node may overtake its last message.
    assert program.output.count(line) - len(commands) in (0, 1)


def test_prints_the_header_and_the_lines_of_its_format(robot, run, until):
    robot.positions.update(j0=0.1, j1=-0.2)
    robot.broadcast()
    program = run(
        NAME,
        print_period=0.1,
        print_header="'Joint States:'",
        print_format="'{name} ({index}): {position}'",
    )
    until(lambda: program.output.count("Joint States:") >= 2, "two prints")
    lines = [line.partition("]: ")[2] for line in program.output.splitlines()]
    first = lines.index("Joint States:")
    assert lines[first + 1 : first + 3] == ["j0 (0): 0.100000", "j1 (1): -0.200000"]
    assert "Joint State:" not in program.output


def soonest_and_middle_s(times_s: Sequence[float]) -> tuple[float, float]:
    """Return two periods of a timer: on a busy machine many are late, hardly any is early."""
    soonest, middle = np.quantile(np.diff(times_s), (0.1, 0.5))
    return soonest, middle


@pytest.mark.parametrize(
    ("course", "pose", "lines"),
    [
        ("S0", [1.0, 0.5, 0.1, 0.5], ["Joint States:", "j0 Position: 0.100000"]),
        ("S1", [1.0, 0.5, 0.0, 0.0], ["Current Joint Positions:", "Joint 0: 0.100000"]),
        ("S2", DEFAULT_POSE, ["Joint State: 'j0' Position: 0.100000 Velocity: 0.250000 Effort: "]),
    ],
)
def test_a_course_has_its_own_pose_and_prints(robot, run, until, course, pose, lines):
    robot.positions.update(j0=0.1)
    robot.broadcast()
    program = run(NAME, *course_file(course))
    for line in lines:
        program.wait_for_line(line)
    commands = robot.listen()
    until(lambda: len(commands) >= 5, "a pose again and again")
    assert commands == [pose] * len(commands)
    soonest_s, middle_s = soonest_and_middle_s(np.array(robot.sent_ns) * 1e-9)
    period_s = 1.0 if course == "S2" else 0.5
    assert soonest_s < 1.25 * period_s
    assert middle_s > 0.75 * period_s


def test_course_s2_logs_each_publication(robot, run, until):
    robot.listen()
    program = run(NAME, *course_file("S2"))
    line = "Publishing positions: [0.400000, -0.100000, 0.500000, 0.400000]"
    until(lambda: program.output.count(line) >= 2, "two publications")
    assert program.stop() == 0


def test_course_s0_prints_thirty_times_a_second(robot, run, until):
    robot.broadcast()
    program = run(NAME, *course_file("S0"))
    until(lambda: program.output.count("Joint States:") >= 31, "a second of prints")
    lines = [line for line in program.output.splitlines() if line.endswith("Joint States:")]
    stamps = [float(line.split("[")[2].partition("]")[0]) for line in lines[:31]]
    soonest_s, middle_s = soonest_and_middle_s(stamps)
    assert soonest_s < 1.25 / 30.0
    assert middle_s > 0.75 / 30.0


def test_each_setting_of_the_parameter_publishes_once(robot, run, until, set_pose):
    commands = robot.listen()
    robot.describe()
    run(NAME, print_period=0)
    assert set_pose(until, double_array_value=[0.1, 0.2, 0.3, 0.4]).successful
    until(lambda: len(commands) == 1, "the first pose")
    assert set_pose(until, integer_array_value=[1, 0, 0, -1]).successful
    until(lambda: len(commands) == 2, "a pose of integers")
    assert set_pose(until, string_value="[1, 0.5, 0, 0]").successful
    until(lambda: len(commands) == 3, "a pose of integers and doubles")
    assert commands == [[0.1, 0.2, 0.3, 0.4], [1.0, 0.0, 0.0, -1.0], [1.0, 0.5, 0.0, 0.0]]


def test_refuses_poses_with_a_reason_and_keeps_the_old_one(robot, run, until, set_pose):
    commands = robot.listen()
    robot.describe()
    program = run(NAME, print_period=0, desired_param="[0.1, 0.2, 0.3, 0.4]")
    # Once this is published, the description is known.
    until(lambda: len(commands) == 1, "the first pose")
    refusals = [
        (set_pose(until, double_array_value=[-5.0, 0.5, -1.2, -1.0]), "limits are -2.57 to 2.57"),
        (set_pose(until, double_array_value=[1.0, 2.0]), "2 were given"),
        (set_pose(until, double_array_value=[float("nan"), 0.0, 0.0, 0.0]), "not a finite number"),
        (set_pose(until, string_value="home"), "Wrong parameter type"),
    ]
    for result, reason in refusals:
        assert not result.successful
        assert reason in result.reason
    assert set_pose(until, double_array_value=[0.0] * 4).successful
    until(lambda: len(commands) == 2, "the next good pose")
    assert commands == [[0.1, 0.2, 0.3, 0.4], [0.0] * 4]
    assert program.stop() == 0


def test_a_pose_beyond_limits_that_come_later_is_not_published(robot, run):
    commands = robot.listen()
    robot.describe()
    program = run(NAME, print_period=0, desired_param="[-5.0, 0.5, -1.2, -1.0]")
    program.wait_for_line(
        "Not publishing [-5.000000, 0.500000, -1.200000, -1.000000]: joint 'j0' cannot go to "
        "-5: its limits are -2.57 to 2.57"
    )
    assert program.stop() == 0
    assert commands == []


def test_warns_without_a_subscriber_and_publishes_when_the_controller_comes(robot, run, until):
    program = run(NAME, desired_param="[0.1, 0.2, 0.3, 0.4]")
    program.wait_for_line("is the position_controller active?")
    assert "nobody listens on /position_controller/commands" in program.output
    program.wait_for_line("/joint_states has been silent for 5 s")
    commands = robot.listen()
    until(lambda: commands, "the pose")
    assert commands == [[0.1, 0.2, 0.3, 0.4]]


def test_a_pose_can_be_taken_back_while_it_waits(robot, run, until, set_pose):
    program = run(NAME, print_period=0.1, desired_param="[0.1, 0.2, 0.3, 0.4]")
    # As `ros2 param set ... "[]"` sends it: an empty list has no type of its own.
    assert set_pose(until, bool_array_value=[]).successful
    robot.broadcast()
    commands = robot.listen()
    until(lambda: program.output.count("Joint State: 'j3'") >= 10, "a second of prints")
    assert commands == []
    assert program.stop() == 0


def test_another_subscriber_does_not_take_the_controllers_pose(robot, run, until):
    seen = robot.listen("recorder")
    program = run(NAME, print_period=0.1, desired_param="[0.1, 0.2, 0.3, 0.4]")
    until(lambda: robot.sees("arm_controller_node"), "the node")
    commands = robot.listen("position_controller")
    until(lambda: commands and seen, "the pose at both")
    assert commands == seen == [[0.1, 0.2, 0.3, 0.4]]
    assert program.stop() == 0


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        ({"desired_param": "[0.1, 0.2]"}, "parameter desired_param: a pose is 4 numbers"),
        (
            {"desired_param": "home"},
            "parameter desired_param: must be a list of 4 numbers, not 'home'",
        ),
        ({"desired_param": "[.nan, 0.0, 0.0, 0.0]"}, "joint 'j0' cannot go to nan"),
        (
            {"print_period": "-1"},
            "Parameter print_period out of range Min: 0.0, Max: 1000000000.0, value: -1.0",
        ),
        ({"joints": "[]"}, "parameter joints: must not be an empty list"),
        ({"print_period": "[]"}, "parameter print_period: must not be an empty list"),
        ({"print_header": "[]"}, "parameter print_header: must not be an empty list"),
        ({"joints": "[a, b, a]"}, "parameter joints: must be different names"),
        (
            {"command_topic": "5"},
            "'command_topic' to '5' of type 'INTEGER', expecting type 'STRING'",
        ),
        ({"command_topic": "''"}, "Invalid topic name: topic name must not be empty"),
        (
            {"publish_rate": "-1"},
            "Parameter publish_rate out of range Min: 0.0, Max: 1000.0, value: -1.0",
        ),
        ({"print_format": "'{speed}'"}, "parameter print_format: '{speed}' may contain"),
        ({"print_format": "'{name'"}, "parameter print_format: '{name' may contain"),
        ({"print_header": "5"}, "'print_header' to '5' of type 'INTEGER', expecting type 'STRING'"),
        ({"check_limits": "3"}, "'check_limits' to '3' of type 'INTEGER', expecting type 'BOOL'"),
    ],
)
def test_a_start_with_nonsense_ends_with_a_sentence(run, parameters, sentence):
    program = run(NAME, **parameters)
    assert program.wait() == 1
    assert sentence in program.output
    assert "Traceback" not in program.output
