"""Commands that move the arm, and commands that run until Ctrl-C."""

import re
import signal
import threading

import pytest
from control_msgs.action import GripperCommand
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse
from rclpy.task import Future
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.usefixtures("simulation")

TRAJECTORY = (
    "{trajectory: {joint_names: [j0, j1, j2, j3], points: [{positions: [%s], "
    "time_from_start: {sec: %s}}]}}"
)
SET_POSE = 'arm param set /arm_controller_node desired_param "[0.2, 0.0, 0.1, 0.0]"'
FOLLOW = (
    "arm action send_goal /joint_trajectory_controller/follow_joint_trajectory "
    "control_msgs/action/FollowJointTrajectory"
)


@pytest.fixture
def arrives(client):
    """Return a function that waits until the arm is at a pose."""
    states = client.subscribe(JointState, "/joint_states")

    def wait(*pose):
        def there(messages):
            return bool(messages) and list(messages[-1].position) == pytest.approx(pose, abs=0.02)

        states.wait_until(there, f"the arm at {pose}")

    return wait


def test_a_message_moves_the_arm(run, arrives):
    text = run(
        "arm topic pub --times 3 --rate 10 /position_controller/commands "
        'std_msgs/msg/Float64MultiArray "data: [0.1, 0.2, 0, -0.1]"'
    )
    assert text.startswith(
        "publisher: beginning loop\npublishing #1: std_msgs.msg.Float64MultiArray("
    )
    assert "\npublishing #3: " in text
    assert text.endswith("data=[0.1, 0.2, 0.0, -0.1])\n\n")
    # The controller's subscription is best effort, as ros2_control's: it may miss one of them.
    arrives(0.1, 0.2, 0.0, -0.1)


def test_a_parameter_moves_the_arm(run_until, arrives):
    run_until(SET_POSE, lambda text: text == "Set parameter successful\n")
    arrives(0.2, 0.0, 0.1, 0.0)
    values = "Double values are: array('d', [0.2, 0.0, 0.1, 0.0])\n"
    run_until("arm param get /arm_controller_node desired_param", lambda text: text == values)
    too_short = 'arm param set /arm_controller_node desired_param "[0.2]"'
    refused = run_until(too_short, lambda text: "Setting parameter failed: " in text, code=1)
    assert "Traceback" not in refused


def test_parameters_go_to_a_file_and_back(run_until, start):
    run_until(SET_POSE, lambda text: text == "Set parameter successful\n")
    dump = "arm param dump /arm_controller_node --output-dir folder"
    run_until(f"mkdir -p folder && {dump}", lambda _: True)
    text = start("cp folder/arm_controller_node.yaml params.yaml && cat params.yaml")
    text.wait()
    assert text.out.startswith("/arm_controller_node:\n  ros__parameters:\n")
    loaded = ("Set parameter desired_param successful\n", "Set parameter joints failed: ")
    load = "arm param load /arm_controller_node params.yaml"
    run_until(load, lambda text: all(sentence in text for sentence in loaded), code=1)


def test_the_course_project_s_executable_moves_the_arm(start, arrives):
    node = start("arm run arm_control arm_controller")
    arrives(1.0, 0.5, 0.1, 0.5)
    assert node.interrupt() == 0


@pytest.mark.timeout(600)  # Some thirty commands, each of which starts a process.
def test_controllers_are_switched_and_a_goal_is_executed(run, run_until, start, arrives):
    state = "arm control set_controller_state joint_trajectory_controller"
    load = "arm control load_controller --set-state inactive joint_trajectory_controller"
    assert run(load).endswith("joint_trajectory_controller into state inactive\n")
    assert "Error activating controller, check" in run(f"{state} active", code=1)
    switch = (
        "arm control switch_controllers --activate joint_trajectory_controller "
        "--deactivate position_controller --strict"
    )
    assert run(switch) == "Successfully switched controllers!\n"
    action = (
        "/joint_trajectory_controller/follow_joint_trajectory "
        "[control_msgs/action/FollowJointTrajectory]\n"
    )
    run_until("arm action list -t", lambda text: text == action)
    done = start(f'{FOLLOW} "{TRAJECTORY % ("0.3, 0.2, 0.1, 0.0", "1.5")}"')
    assert done.wait() == 0
    # Before it says, on a busy machine, that it waits for the server.
    assert done.err.startswith(
        "arm action send_goal: trajectory.points[0].time_from_start.sec: 1.5 is truncated to 1 "
        "(int32)\n"
    )
    assert re.search(
        r"^Goal accepted with ID: [0-9a-f]{32}\n\nResult:\n    error_code: 0\n",
        done.out,
        re.MULTILINE,
    )
    assert done.out.endswith("Goal finished with status: SUCCEEDED\n")
    arrives(0.3, 0.2, 0.1, 0.0)
    _a_goal_is_cancelled_by_ctrl_c(start)
    faulty = "Empty trajectory received."
    assert faulty in _rejected(run_until, "{trajectory: {joint_names: [j9]}}")
    _what_nothing_obeys_says_so(run, run_until, arrives)
    assert run(f"{state} inactive") == "Successfully deactivated joint_trajectory_controller\n"
    assert "Controller is not running" in _rejected(run_until, TRAJECTORY % ("0.1, 0, 0, 0", "1"))
    unload = "arm control unload_controller joint_trajectory_controller"
    assert run(unload) == "Successfully unloaded controller joint_trajectory_controller\n"
    again = run("arm control switch_controllers --activate position_controller")
    assert again.startswith("Successfully switched controllers!\n")


def _rejected(run_until, goal):
    """Return the reason that the command prints for a goal that is rejected."""
    title = "Goal was rejected.\nReason, from the server's log: "
    # The reason comes on another connection; the command does not wait long for it.
    return run_until(f'{FOLLOW} "{goal}"', lambda text: title in text).partition(title)[2]


def _what_nothing_obeys_says_so(run, run_until, arrives):
    goal, hardware = TRAJECTORY % ("0.4, 0.3, 0.2, 0.1", "1"), "HardwareInterface_MuJoCo"
    set_hardware = f"arm control set_hardware_component_state {hardware}"
    inactive = f"Can't accept new action goals: hardware component '{hardware}' is inactive.\n"
    stopped = "Can't accept new action goals: emergency stop.\n"
    run(f"{set_hardware} inactive")
    listed = run("arm control list_controllers").splitlines()
    [line] = [line for line in listed if line.startswith("joint_trajectory_controller")]
    assert line.split()[-1] == "active"
    assert _rejected(run_until, goal) == inactive
    assert run("arm stop") == "/emergency_stop: stopped\n"
    assert _rejected(run_until, goal) == stopped
    run(f"{set_hardware} active")
    assert _rejected(run_until, goal) == stopped
    run(f"{set_hardware} inactive")
    run("arm stop --release")
    assert _rejected(run_until, goal) == inactive
    run(f"{set_hardware} active")
    assert run(f'{FOLLOW} "{goal}"').endswith("Goal finished with status: SUCCEEDED\n")
    arrives(0.4, 0.3, 0.2, 0.1)
    # Unconfigured hardware stops its controllers, which say so and start again.
    run(f"{set_hardware} unconfigured")
    assert "Controller is not running" in _rejected(run_until, goal)
    run(f"{set_hardware} active")
    switch = "arm control switch_controllers --activate"
    run(f"{switch} joint_trajectory_controller joint_state_broadcaster")
    goal = TRAJECTORY % ("0.1, 0.2, 0.1, 0.0", "1")
    assert run(f'{FOLLOW} "{goal}"').endswith("Goal finished with status: SUCCEEDED\n")
    arrives(0.1, 0.2, 0.1, 0.0)


def _a_goal_is_cancelled_by_ctrl_c(start):
    goal = start(f'{FOLLOW} --feedback "{TRAJECTORY % ("0.0, 0.0, 0.0, 0.0", "60")}"')
    goal.wait_for("Feedback:\n    header:")
    assert goal.interrupt() == signal.SIGINT
    # Feedback comes until the server has cancelled it.
    assert goal.out.count("Canceling goal...\n") == 1
    assert goal.out.endswith("Goal canceled.\n")


@pytest.fixture
def slow_server(client):
    """Offer an action that accepts late; return the event that lets it, and its goals."""
    told, may_answer, ended = [], threading.Event(), Future()

    def take(_):
        told.append("goal")
        assert may_answer.wait(100.0)
        return GoalResponse.ACCEPT

    def cancel(_):
        told.append("cancel")
        ended.set_result(None)
        return CancelResponse.ACCEPT

    async def carry_out(handle):
        await ended
        handle.canceled()
        return GripperCommand.Result()

    name = "/slow_gripper"
    server = client.run(
        lambda: ActionServer(
            client.node, GripperCommand, name, carry_out, goal_callback=take, cancel_callback=cancel
        ),
        name,
    )
    yield may_answer, told
    client.run(server.destroy, name)


def test_a_goal_that_is_not_yet_accepted_is_cancelled_too(start, slow_server):
    may_answer, told = slow_server
    goal = start("arm action send_goal /slow_gripper control_msgs/action/GripperCommand '{}'")
    goal.wait_until(lambda: told == ["goal"], "the server has the goal")
    goal.process.send_signal(signal.SIGINT)
    may_answer.set()
    assert goal.wait() == signal.SIGINT
    assert goal.out.endswith("Canceling goal...\nGoal canceled.\n")
    assert told == ["goal", "cancel"]


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("arm topic echo /clock", "---\n"),
        ("arm topic hz /joint_states", "\tmin: 0."),
        ("arm topic bw /joint_states", "B/s from "),
        ("arm topic delay -s /joint_states", "average delay: "),
        ("arm topic hz /nothing", "waiting for topic /nothing on ROS_DOMAIN_ID="),
        ("arm topic pub /chatter std_msgs/msg/String 'data: hi' -r 50", "publishing #3: "),
        (
            "arm service call /nothing std_srvs/srv/Trigger",
            "waiting for service to become available",
        ),
    ],
)
def test_ctrl_c_ends_a_running_command(start, line, text):
    command = start(line)
    command.wait_for(text)
    assert command.interrupt() == signal.SIGINT
    assert "Traceback" not in command.err


def test_a_closed_pipe_ends_the_command_silently(start):
    command = start("set -o pipefail; arm topic echo /clock | head -n 1")
    assert command.wait() == 128 + signal.SIGPIPE
    said = [line for line in command.err.splitlines() if not line.startswith("waiting for ")]
    assert (command.out, said) == ("clock:\n", [])
