"""Resets and snapshots over ROS: the clock jumps, goals end with the reason, everything goes on."""

import threading
from typing import Any

import pytest
from action_msgs.msg import GoalStatus
from control_msgs.action import FollowJointTrajectory, GripperCommand
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from simulated import OK, PAUSED, PLAYING, Simulated
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

ARM, GRIPPER = "/arm_controller/follow_joint_trajectory", "/gripper_action_controller/gripper_cmd"
JOINTS = (
    *("link1_to_link2", "link2_to_link3", "link3_to_link4", "link4_to_link5"),
    *("link5_to_link6", "link6_to_link6_flange"),
)
RESETS = 25
MEMORY_MB = 30.0
START_TIMEOUT_S = 60.0
NO_RESOURCE = 102
SCOPE_TIME, SCOPE_ALL = 1, 255
ABORTED = "Goal aborted: the simulation was reset."


class User(Simulated):
    """Sends goals, and resets the simulation."""

    def step(self, count: int) -> None:
        self.do("StepSimulation", steps=count)

    def follow(self, position: float, seconds: int) -> Any:
        """Start a trajectory, and wait until it moves the arm; return the future of its result."""
        point = JointTrajectoryPoint(positions=[position] * len(JOINTS))
        point.time_from_start.sec = seconds
        goal = FollowJointTrajectory.Goal(
            trajectory=JointTrajectory(joint_names=list(JOINTS), points=[point])
        )
        # A goal is accepted some moments before it starts, and a reset in between does not end it.
        moving = threading.Event()
        pending = self._start(FollowJointTrajectory, ARM, goal, lambda _: moving.set())
        assert moving.wait(START_TIMEOUT_S), "the goal does not start"
        return pending

    def grip(self, position: float) -> Any:
        """Start a motion of the gripper; return the future of its result."""
        goal = GripperCommand.Goal()
        goal.command.position, goal.command.max_effort = position, 5.0
        return self._start(GripperCommand, GRIPPER, goal)

    def _start(self, kind: Any, name: str, goal: Any, take_feedback: Any = None) -> Any:
        action = self.client.action(kind, name)
        pending = self.client.send_goal(action, goal, take_feedback)
        assert pending is not None, f"{name} rejects the goal"
        return pending

    def result_of(self, pending: Any) -> Any:
        return self.client.result_of(pending, "the goal")


@pytest.fixture(scope="module")
def simulation(launch_for_file):
    launched = launch_for_file("mycobot", "use_camera:=false")
    launched.wait_until_ready()
    return launched


@pytest.fixture
def user(simulation, client) -> User:
    return User(client)


def seconds(stamp: Any) -> float:
    return stamp.sec + stamp.nanosec * 1e-9


def jumped_back(times_s: list[float]) -> bool:
    """Return whether time went back once, to near zero, and on from there."""
    back = [i for i in range(1, len(times_s)) if times_s[i] < times_s[i - 1] - 0.5]
    return len(back) == 1 and times_s[back[0]] < 0.5 and times_s[-1] > times_s[back[0]] + 0.3


def test_clock_states_and_transforms_start_anew_and_goals_end_with_the_reason(user, client):
    clock, states = client.subscribe(Clock, "/clock"), client.subscribe(JointState, "/joint_states")
    frames = client.subscribe(TFMessage, "/tf")
    clock.wait_until(lambda m: bool(m) and seconds(m[-1].clock) > 1.0, "a second of time")
    follow, grip = user.follow(0.5, 100), user.grip(-0.7)
    frames.wait_for(1)
    user.reset()
    followed = user.result_of(follow)
    assert followed.status == GoalStatus.STATUS_ABORTED
    assert followed.result.error_string == ABORTED
    assert user.result_of(grip).status in (GoalStatus.STATUS_ABORTED, GoalStatus.STATUS_SUCCEEDED)
    clock.wait_until(lambda m: jumped_back([seconds(c.clock) for c in m]), "/clock starts anew")
    states.wait_until(
        lambda m: jumped_back([seconds(s.header.stamp) for s in m]), "/joint_states start anew"
    )
    frames.wait_until(
        lambda m: jumped_back([seconds(t.header.stamp) for f in m for t in f.transforms]),
        "/tf starts anew",
    )
    at = dict(zip(states.messages[-1].name, states.messages[-1].position, strict=True))
    assert max(abs(at[name]) for name in JOINTS) < 0.05, "nothing snaps back"
    assert user.result_of(user.follow(0.3, 1)).status == GoalStatus.STATUS_SUCCEEDED


def test_the_clock_alone_is_reset_and_a_goal_goes_on(user, client):
    follow = user.follow(-0.3, 2)
    user.reset(SCOPE_TIME)
    assert user.result_of(follow).status == GoalStatus.STATUS_SUCCEEDED


def test_a_parameter_lets_the_clock_go_on(user, client):
    assert user.set(reset_clock=False) == ""
    clock = client.subscribe(Clock, "/clock")
    clock.wait_until(lambda m: bool(m) and seconds(m[-1].clock) > 1.0, "a second of time")
    refused = user.ask("ResetSimulation", scope=SCOPE_TIME).result
    assert refused.result != OK
    assert refused.error_message == (
        "the clock is not reset, because the parameter reset_clock is false"
    )
    user.reset(SCOPE_ALL)
    clock.clear()
    clock.wait_until(lambda m: len(m) > 10, "time goes on")
    assert seconds(clock.messages[0].clock) > 1.0
    assert user.set(reset_clock=True) == ""


def position(state: Any) -> float:
    """Return the position of the first joint of the arm."""
    return dict(zip(state.name, state.position, strict=True))[JOINTS[0]]


def bits(states: list) -> dict[float, bytes]:
    """Return the numbers of joint states by their stamps."""
    return {
        seconds(state.header.stamp): bytes(state.position) + bytes(state.velocity)
        for state in states
    }


def test_a_restored_run_publishes_the_same_bits_and_its_goal_goes_on(user, client, tmp_path):
    def stepped() -> dict[float, bytes]:
        # A new subscription gets nothing that was published before the pause.
        new = client.subscribe(JointState, "/joint_states", 1000)
        user.step(100)
        return bits(new.wait_for(100))

    states = client.subscribe(JointState, "/joint_states", 1000)
    states.wait_for(1)
    follow, file = user.follow(0.4, 2), str(tmp_path / "a.snapshot")
    user.go_to(PAUSED)
    saved = user.snapshot("save", file)
    assert saved.result == OK, saved
    first = stepped()
    user.go_to(PLAYING)
    assert user.result_of(follow).status == GoalStatus.STATUS_SUCCEEDED
    user.go_to(PAUSED)
    restored = client.subscribe(JointState, "/joint_states", 1000)
    assert user.snapshot("restore", file).result == OK
    # On a busy machine the last state before the pause may come late.
    saved_s = pytest.approx(min(first) - 0.01)
    assert restored.wait_until(
        lambda m: any(seconds(state.header.stamp) == saved_s for state in m), "shown at once"
    )
    assert stepped() == first
    user.go_to(PLAYING)
    # Its client has got the result already: the motion ends without one.
    states.wait_until(lambda m: bool(m) and abs(position(m[-1]) - 0.4) < 1e-3, "the motion ends")
    assert user.result_of(user.follow(0.1, 1)).status == GoalStatus.STATUS_SUCCEEDED


def test_goals_that_a_snapshot_does_not_have_are_aborted(user):
    assert user.snapshot("save", "idle").result == OK
    follow = user.follow(0.4, 100)
    assert user.snapshot("restore", "idle").result == OK
    ended = user.result_of(follow)
    assert ended.status == GoalStatus.STATUS_ABORTED
    assert ended.result.error_string == (
        "Goal aborted: the simulation was restored to a snapshot without this goal."
    )
    assert user.snapshot("remove", "idle").result == OK
    refused = user.snapshot("restore", "idle")
    assert (refused.result, refused.error_message) == (
        NO_RESOURCE,
        "no snapshot 'idle'; there is none",
    )


def test_many_resets_leave_nothing_behind_and_no_goal_is_missed(user, client, simulation):
    (process,) = simulation.processes("arm_gazebo_node")

    def load() -> tuple[int, int, float]:
        return process.num_threads(), process.num_fds(), process.memory_info().rss / 1e6

    def reset() -> None:
        follow = user.follow(0.2, 100)
        user.reset()
        assert user.result_of(follow).result.error_string == ABORTED

    for _ in range(3):
        reset()
    threads, files, memory_mb = load()
    for _ in range(RESETS):
        reset()

    def is_as_before() -> bool:
        # What ends with an answer that has just been sent may still be ending.
        after = load()
        return after[0] <= threads and after[1] <= files + 2 and after[2] < memory_mb + MEMORY_MB

    client.wait_until(is_as_before, f"{threads} threads, {files} files, {memory_mb} MB", 30.0)
    assert user.result_of(user.follow(0.1, 1)).status == GoalStatus.STATUS_SUCCEEDED
