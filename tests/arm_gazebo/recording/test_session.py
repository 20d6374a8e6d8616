"""Recordings that begin while a run goes on."""

import numpy as np
import pytest

from arm_control.controllers.joint_trajectory.goals import GoalRequest
from arm_control.controllers.joint_trajectory.trajectory import TrajectoryPoint, TrajectoryRequest
from arm_control.manager.settings import ManagerSettings
from arm_gazebo.errors import RecordingError
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.recording.recorder import RunRecorder
from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_gazebo.run.robot import ManagedRobot, SimulatedRobot
from arm_gazebo.run.run import SimulationRun
from arm_gazebo.world.editor import SpawnRequest, WorldEditor
from arm_gazebo.world.loading import WorldLoader
from arm_gazebo.world.spawn_model import ModelSource

from .conftest import MANAGER, load_controller, robot_settings

TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
JOINTS = ("j0", "j1", "j2", "j3")
BALL = """<mujoco><worldbody><body><freejoint/><geom size="0.05" mass="0.1"/></body></worldbody>
  </mujoco>"""


class RunningArm:
    """The 4-DOF arm with a trajectory controller; nobody records it yet."""

    def __init__(self, parts) -> None:
        settings = robot_settings(parts.arm())
        timing = physics_timing(100.0)
        built = parts.build(settings.robot_description, "objects", step_s=timing.step_s)
        managed = ManagedRobot(settings, ManagerSettings(), MANAGER)
        robot = SimulatedRobot(managed)
        self.whole = SimulationRun([robot], Physics(built, timing), WorldLoader(()), 0)
        self.simulation, self.tick = self.whole.physics, self.whole.tick
        self.arm, _ = load_controller(
            robot.manager,
            robot.document,
            "arm",
            TRAJECTORY,
            joints=JOINTS,
            command_interfaces=("position",),
            state_interfaces=("position", "velocity"),
        )
        self.editor = WorldEditor(
            self.simulation,
            lambda function: function(),
            robot.hardware,
            [],
            ModelSource(timing.step_s),
        )

    def move(self, *positions: float, time_s: float = 1.0) -> None:
        trajectory = TrajectoryRequest(JOINTS, [TrajectoryPoint(time_s, positions)])
        assert self.arm.submit_goal(GoalRequest(b"goal", trajectory)) is None

    def run(self, periods: int) -> None:
        for _ in range(periods):
            self.tick()

    def drop_a_ball(self, name: str) -> None:
        pose = np.eye(4)
        pose[:3, 3] = 1.0, 0.0, 0.3
        self.editor.spawn(SpawnRequest(name, "", BALL, pose))


@pytest.fixture
def running(parts) -> RunningArm:
    return RunningArm(parts)


def test_a_recording_begins_in_the_middle_of_a_motion(running, tmp_path):
    running.run(7)
    running.move(0.5, 0.3, -0.2, 0.1)
    running.run(30)
    recorder = RunRecorder.to_file(running.whole, tmp_path / "a.run")
    running.run(30)
    running.move(-0.5, 0.3, -0.2, 0.1, time_s=0.5)
    running.run(40)
    recorder.end()
    replay = Replay(RunFile(tmp_path / "a.run"))
    result = replay.run()
    assert result.difference is None
    assert result.periods == 70
    assert result.time_s == pytest.approx(1.07)
    np.testing.assert_array_equal(replay.simulation.data.qpos, running.simulation.data.qpos)


def test_a_recording_begins_in_a_world_that_has_changed(running, tmp_path):
    running.run(3)
    running.drop_a_ball("first")
    running.move(0.5, 0.3, -0.2, 0.1)
    running.run(10)
    recorder = RunRecorder.to_file(running.whole, tmp_path / "a.run")
    running.run(20)
    running.drop_a_ball("second")
    running.run(20)
    running.editor.delete("first")
    running.run(20)
    recorder.end()
    result = Replay(RunFile(tmp_path / "a.run")).run()
    assert result.difference is None
    assert result.periods == 60


def test_one_recording_follows_another(running, tmp_path):
    for name in ("a.run", "b.run"):
        recorder = RunRecorder.to_file(running.whole, tmp_path / name)
        running.move(*np.random.default_rng(len(name)).uniform(-0.5, 0.5, 4))
        running.run(20)
        recorder.end()
        assert Replay(RunFile(tmp_path / name)).run().difference is None


def test_a_run_is_not_changed_by_being_recorded(running, parts, tmp_path):
    other = RunningArm(parts)
    recorder = RunRecorder.to_file(running.whole, tmp_path / "a.run")
    for run in (running, other):
        run.run(5)
        run.move(0.5, 0.3, -0.2, 0.1)
        run.run(50)
    recorder.end()
    np.testing.assert_array_equal(running.simulation.data.qpos, other.simulation.data.qpos)
    np.testing.assert_array_equal(running.simulation.data.qvel, other.simulation.data.qvel)


def test_a_controller_whose_state_cannot_be_saved_is_named_and_leaves_no_file(
    running, tmp_path, monkeypatch
):
    monkeypatch.setattr(running.arm, "save_state", lambda: {"socket": object()})
    path = tmp_path / "a.run"
    with pytest.raises(RecordingError, match=r"cannot be recorded: .*'arm'"):
        RunRecorder.to_file(running.whole, path)
    assert not path.exists()
    assert running.arm.input_gate is None
    monkeypatch.undo()
    RunRecorder.to_file(running.whole, path).end()
    assert path.exists()
