"""Two robots in one world, in another process, are stopped by a service, a topic and a verb."""

from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from control_msgs.action import FollowJointTrajectory
from rclpy.duration import Duration
from run_python import run_python
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64MultiArray
from std_srvs.srv import SetBool
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_cli.doctor.ros_observer import observe
from arm_cli.doctor.verb import examine_running
from arm_cli.ros.connection import connect
from arm_description.resources import resolve_uri
from arm_description.xacro.expansion import expand_xacro

START_TIMEOUT_S = 120.0
MOVING_RAD_S = 0.05
LEFT, RIGHT = ([f"{name}_j{number}" for number in range(4)] for name in ("left", "right"))


@pytest.fixture(scope="module")
def robots(simulate):
    """Run two arms: `left` follows trajectories, `right` follows positions."""
    arm = str(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    settings = {"robots": "left,right"}
    for name, y in (("left", -1.0), ("right", 1.0)):
        settings[f"{name}.robot_description"] = expand_xacro(arm, {"prefix": f"{name}_"})
        settings[f"{name}.pose"] = [0.0, y, 0.0, 0.0, 0.0, 0.0]
        settings[f"{name}.spawn"] = "joint_state_broadcaster,mover"
    types = {
        "/left": "joint_trajectory_controller/JointTrajectoryController",
        "/right": "position_controllers/JointGroupPositionController",
    }
    interfaces = {"command_interfaces": ["position"], "state_interfaces": ["position", "velocity"]}
    parameters = {
        "arm_gazebo": settings,
        "/left/mover": {"joints": LEFT, **interfaces},
        "/right/mover": {"joints": RIGHT},
    }
    for namespace, type_ in types.items():
        parameters[f"{namespace}/controller_manager"] = {
            "joint_state_broadcaster": {"type": "joint_state_broadcaster/JointStateBroadcaster"},
            "mover": {"type": type_},
        }
    simulate(parameters)


class Arms:
    """What a client sees and does of the two arms."""

    def __init__(self, client) -> None:
        self._client = client
        self._states = {
            name: client.subscribe(JointState, f"/{name}/joint_states", 1000)
            for name in ("left", "right")
        }
        for states in self._states.values():
            states.wait_for(1, START_TIMEOUT_S)

    def stop(self, namespace: str = "", *, engaged: bool = True) -> str:
        answer = self._client.call(
            SetBool, f"{namespace}/emergency_stop", SetBool.Request(data=engaged)
        )
        assert answer.success, answer
        return answer.message

    def seen(self, name: str, seconds: float) -> tuple[np.ndarray, np.ndarray]:
        """Return positions and velocities of the next seconds of simulation time."""
        states = self._states[name]
        first = stamp_s(states.messages[-1])
        messages = states.wait_until(
            lambda m: stamp_s(m[-1]) >= first + seconds, f"{seconds} s of {name}"
        )
        newer = [message for message in messages if stamp_s(message) > first]
        return (
            np.array([message.position for message in newer]),
            np.array([message.velocity for message in newer]),
        )

    def move(self, name: str, send) -> Any:
        """Let `send` send what makes an arm move; return its result once the arm has moved."""
        states = self._states[name]
        states.clear()
        sent = send()
        # It may have arrived before this thread looks.
        states.wait_until(
            lambda m: any(np.abs(each.velocity).max() > MOVING_RAD_S for each in m),
            f"{name} moving",
        )
        return sent

    def is_at_rest(self, name: str) -> bool:
        positions, velocities = self.seen(name, 0.5)
        return bool(np.ptp(positions, axis=0).max() < 1e-3 and np.abs(velocities).max() < 0.01)


def stamp_s(message) -> float:
    return message.header.stamp.sec + message.header.stamp.nanosec * 1e-9


@pytest.fixture
def arms(robots, client) -> Arms:
    return Arms(client)


@pytest.fixture
def goals(arms, client):
    """Send goals to the left arm's action, by a function: see `Client.send_goal`."""
    name = "/left/mover/follow_joint_trajectory"
    action = client.action(FollowJointTrajectory, name, START_TIMEOUT_S)

    def send(position: float, seconds: float):
        point = JointTrajectoryPoint(positions=[position] * len(LEFT))
        point.time_from_start = Duration(seconds=seconds).to_msg()
        goal = FollowJointTrajectory.Goal(
            trajectory=JointTrajectory(joint_names=LEFT, points=[point])
        )
        return client.send_goal(action, goal)

    return send


def test_one_robot_stops_and_the_other_goes_on(arms, goals, client):
    commands = client.publisher(Float64MultiArray, "/right/mover/commands")
    # So long that it is not over before the stop, however busy the machine.
    goal = arms.move("left", lambda: goals(0.8, 10.0))
    assert arms.stop("/left") == "stopped"
    ended = client.result_of(goal, "the result")
    assert ended.status == GoalStatus.STATUS_ABORTED
    assert ended.result.error_string == "Goal aborted: emergency stop."
    client.wait_until(lambda: arms.is_at_rest("left"), "the left arm at rest")
    assert arms.stop("/left") == "already stopped"
    assert goals(0.0, 1.0) is None
    arms.move("right", lambda: commands.publish(Float64MultiArray(data=[0.4] * len(LEFT))))
    assert arms.is_at_rest("left")
    assert arms.stop("/left", engaged=False) == "released"
    # No jump, and new goals are reached.
    assert arms.is_at_rest("left")
    again = goals(0.2, 1.0)
    ended = client.result_of(again, "the result")
    assert ended.status == GoalStatus.STATUS_SUCCEEDED, ended.result.error_string


def test_all_stop_by_the_topic_and_are_released_by_the_verb(arms, client, latched):
    commands = client.publisher(Float64MultiArray, "/right/mover/commands")
    stop = client.publisher(Bool, "/emergency_stop")
    arms.move("right", lambda: commands.publish(Float64MultiArray(data=[-0.6] * len(LEFT))))
    stop.publish(Bool(data=True))
    told = client.subscribe(Bool, "/emergency_stop/active", latched)
    told.wait_until(lambda m: bool(m) and m[-1].data, "the news of the stop")
    client.wait_until(lambda: arms.is_at_rest("right"), "the right arm at rest")

    def diagnosed() -> bool:
        # One look may be too short to find the robots on a busy machine.
        with connect() as session:
            found = examine_running(observe(session))
        latched = "an emergency stop is latched (/emergency_stop/active"
        return any(latched in finding.sentence for finding in found)

    client.wait_until(diagnosed, "the doctor tells the stop", START_TIMEOUT_S)
    # Neither a command nor a false on the topic moves anything.
    commands.publish(Float64MultiArray(data=[0.3] * len(LEFT)))
    stop.publish(Bool(data=False))
    assert arms.is_at_rest("right")
    assert told.messages[-1].data
    out = run_python("-m", "arm_cli", "stop", "--release", check=True).stdout
    # Each service is called as soon as it is found, in whichever order that is.
    answers = dict(line.split(": ") for line in out.splitlines())
    assert answers
    assert set(answers.values()) <= {"released", "already released"}
    told.wait_until(lambda m: not m[-1].data, "the news of the release")
    assert arms.is_at_rest("right")
    arms.move("right", lambda: commands.publish(Float64MultiArray(data=[0.3] * len(LEFT))))


def test_the_verb_stops_one_robot(arms):
    for words, answer in (([], "stopped"), (["--release"], "released")):
        out = run_python("-m", "arm_cli", "stop", "-n", "left", *words, check=True).stdout
        assert out == f"/left/emergency_stop: {answer}\n"
