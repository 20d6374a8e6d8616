"""Scenarios through the node over ROS and through the library: the states are equal to the bit.

The node records its run. The library then gives the same inputs, by its own interface, before the
same control periods, and records its run as well.
"""

import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from control_msgs.action import FollowJointTrajectory, GripperCommand
from robots import MYCOBOT_ARM
from sensor_msgs.msg import JointState
from simulated import Simulated
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_control.controllers.joint_trajectory.goals import GoalRequest
from arm_gazebo.recording.comparison import compare
from arm_gazebo.recording.run_file import RecordedInput, RunFile, StateBlock
from arm_sim import NAMED_ROBOTS, Goal, Simulation

ARM, GRIPPER = "arm_controller", "gripper_action_controller"
CAN = """<sdf version='1.9'><model name='can'><link name='body'>
<inertial><mass>0.05</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial>
<collision name='shape'><geometry><cylinder><radius>0.03</radius><length>0.1</length></cylinder>
</geometry></collision></link></model></sdf>"""
CAN_POSE = (0.4, 0.1, 0.2)
FOLLOWER = "joint_trajectory_controller"
OF_OTHERS = (
    *("load_controller", "configure_controller", "cleanup_controller", "switch_controller"),
    "serve_requests",
    "restore",
)
FEWEST_PERIODS = 100


class User:
    """A user of the node: goals of two actions, and a thing in the world."""

    def __init__(self, client: Any) -> None:
        self._client = client

    def follow(self, position: float, seconds: int, cancel: bool = False) -> int:
        """Let the arm follow a trajectory; return the status of the goal."""
        point = JointTrajectoryPoint(positions=[position] * len(MYCOBOT_ARM))
        point.time_from_start.sec = seconds
        trajectory = JointTrajectory(joint_names=list(MYCOBOT_ARM), points=[point])
        goal = FollowJointTrajectory.Goal(trajectory=trajectory)
        action = f"/{ARM}/follow_joint_trajectory"
        return self._status_of(FollowJointTrajectory, action, goal, cancel)

    def grip(self, position: float) -> int:
        """Move the gripper; return the status of the goal."""
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, 5.0
        return self._status_of(GripperCommand, f"/{GRIPPER}/gripper_cmd", goal)

    def spawn(self) -> None:
        """Spawn the can."""
        Simulated(self._client).spawn("can", CAN, *CAN_POSE)

    def _status_of(self, kind: Any, name: str, goal: Any, cancel: bool = False) -> int:
        action = self._client.action(kind, name)

        async def send() -> Any:
            handle = await action.send_goal_async(goal)
            assert handle.accepted
            if cancel:
                await handle.cancel_goal_async()
            return await handle.get_result_async()

        # In the executor's thread: an answer must not come before its request is noted.
        result = self._client.result_of(self._client.executor.create_task(send), name)
        return result.status


def mycobot_run(launch: Any, client: Any, recorded: Path) -> None:
    """Trajectories, a cancelled one among them, a grip, and a thing that falls beside the arm."""
    robot = NAMED_ROBOTS["mycobot"]
    launched = launch(
        "arm_gazebo",
        "sim.launch.py",
        f"model:={robot.model}",
        "model_args:=use_gazebo:=true",
        f"controllers:={robot.controllers}",
        f"spawn:={','.join(robot.spawn)}",
        f"world:={robot.world}",
        f"pose:={list(robot.pose)}",
        "use_robot_state_pub:=false",
        f"record_run:={recorded}",
    )
    launched.wait_until_ready()
    user = User(client)
    assert user.follow(0.3, 1) == GoalStatus.STATUS_SUCCEEDED
    user.spawn()
    assert user.grip(-0.4) == GoalStatus.STATUS_SUCCEEDED
    assert user.follow(-0.2, 5, cancel=True) == GoalStatus.STATUS_CANCELED
    assert user.follow(0.1, 1) == GoalStatus.STATUS_SUCCEEDED
    assert launched.stop(signal.SIGINT) == 0


def arm_run(launch: Any, client: Any, recorded: Path) -> None:
    """Commands on a topic, and a controller that is loaded and takes over."""
    launched = launch("arm_gazebo", "sim.launch.py", f"record_run:={recorded}", *arm_arguments())
    launched.wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")
    for pose in ([0.5, 0.4, 0.3, 0.2], [1.0, 0.5, 0.1, 0.5]):
        commands.publish(Float64MultiArray(data=pose))
        states.wait_until(
            lambda m, pose=pose: bool(m) and np.allclose(m[-1].position, pose, atol=0.01),
            f"the pose {pose}",
        )
    control("load_controller", FOLLOWER, "--set-state", "inactive")
    control("switch_controllers", "--deactivate", "position_controller", "--activate", FOLLOWER)
    count = len(states.messages)
    states.wait_until(lambda m: len(m) > count + 20, "some periods with the other controller")
    assert launched.stop(signal.SIGINT) == 0


def arm_arguments() -> list[str]:
    robot = NAMED_ROBOTS["arm"]
    return [
        f"model:={robot.model}",
        f"controllers:={robot.controllers}",
        f"spawn:={','.join(robot.spawn)}",
        "use_robot_state_pub:=false",
    ]


def control(*words: str) -> None:
    command = [sys.executable, "-m", "arm_cli", "control", *words]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr


class LibraryUser:
    """Gives the library the inputs that the node has got."""

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._goals: dict[object, Goal[Any]] = {}

    def give(self, item: RecordedInput) -> None:
        match item.method:
            case "submit_goal":
                self._start(item.controller or "", *item.arguments.values())
            case "cancel_goal":
                self._goals[item.arguments["goal_id"]].cancel()
            case "swap":
                self._sim.spawn(CAN, name="can", pose=CAN_POSE)
            case "offer":
                self._sim[item.controller or ""].command(item.arguments["values"])
            case "load_controller" if item.period:
                self._sim.controllers.load(item.arguments["controller"])
            case "switch_controller" if item.period:
                request = item.arguments["request"]
                self._sim.controllers.switch(request.activate, request.deactivate)
            case method:
                # The library does the rest itself: at its start, and with a goal or a controller.
                assert method in OF_OTHERS, item

    def _start(self, controller: str, request: Any) -> None:
        handle = self._sim[controller]
        if isinstance(request, GoalRequest):
            goal: Goal[Any] = handle.follow(request.trajectory)
        else:
            goal = handle.grip(request.positions[0], request.efforts[0])
        self._goals[request.id] = goal


def inputs(file: RunFile) -> list[RecordedInput]:
    return [record for record in file.records() if isinstance(record, RecordedInput)]


def hashes(file: RunFile) -> np.ndarray:
    blocks = [record.hashes for record in file.records() if isinstance(record, StateBlock)]
    return np.concatenate(blocks)


@pytest.mark.parametrize(
    ("robot", "run", "given", "times"),
    [("mycobot", mycobot_run, "submit_goal", 4), ("arm", arm_run, "offer", 2)],
)
def test_the_library_runs_as_the_node_does(launch, client, tmp_path, robot, run, given, times):
    run(launch, client, tmp_path / "node.run")
    node_run = RunFile(tmp_path / "node.run")
    end = next(item.period for item in inputs(node_run) if item.method == "shutdown")
    assert end > FEWEST_PERIODS
    waiting = [item for item in inputs(node_run) if item.method != "shutdown"]
    assert [item.method for item in waiting].count(given) == times
    with Simulation(robot, record=tmp_path / "library.run") as sim:
        user = LibraryUser(sim)
        for period in range(end):
            while waiting and waiting[0].period <= period:
                user.give(waiting.pop(0))
            sim.step()
    library_run = RunFile(tmp_path / "library.run")
    assert compare(node_run, library_run).settings == ()
    assert hashes(library_run).tolist() == hashes(node_run)[:end].tolist()
