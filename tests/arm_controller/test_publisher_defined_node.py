"""publisher_defined beside a robot of topics."""

from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory

pytestmark = pytest.mark.ros

NAME = "publisher_defined"
FIVE_POSES = [
    [0.5, 0.5, 0.5, 0.5],
    [0.7, 1.4, 0.5, 0.5],
    [0.5, 1.0, 0.6, 0.6],
    [0.3, 0.6, 0.3, 0.3],
    [0.0, 0.0, 0.0, 0.0],
]


@pytest.fixture
def poses_file(tmp_path):
    def write(text: str):
        path = tmp_path / "poses.yaml"
        path.write_text(text)
        return path

    return write


def test_goes_through_the_five_poses_and_ends(robot, run):
    commands = robot.listen()
    robot.describe()
    robot.broadcast()
    program = run(NAME)
    assert program.wait() == 0
    assert commands == FIVE_POSES
    assert "Pose 5 of 5 reached after" in program.output
    assert "All 5 poses reached" in program.output


def test_poses_are_a_pause_apart(robot, run, poses_file):
    commands = robot.listen()
    robot.describe()
    robot.broadcast()
    poses = poses_file("poses:\n  - [0.1, 0.1, 0.4, 0.1]\n  - [0.2, 0.2, 0.0, 0.2]\n")
    program = run(NAME, poses_file=poses, pause=2)
    assert program.wait() == 0
    first_ns, second_ns = robot.sent_ns
    assert len(commands) == 2
    assert second_ns - first_ns >= 1.9e9


def test_course_s0_sends_poses_ten_seconds_apart_though_one_is_not_reached(robot, run, poses_file):
    commands = robot.listen()
    robot.describe()
    robot.broadcast()
    robot.tick()  # Ten times as fast as time passes.
    robot.stuck.add("j2")
    poses = poses_file("poses:\n  - [0.1, 0.1, 0.4, 0.1]\n  - [0.2, 0.2, 0.0, 0.2]\n")
    course = Path(get_package_share_directory("arm_control")) / "config/courses/S0.yaml"
    file = ("--ros-args", "--params-file", str(course))
    program = run(NAME, *file, poses_file=poses, use_sim_time="true")
    assert program.wait() == 1
    assert "Pose 1 of 2 not reached within 10 s" in program.output
    assert commands == [[0.1, 0.1, 0.4, 0.1], [0.2, 0.2, 0.0, 0.2]]


def test_a_joint_that_stays_behind_is_named_and_the_next_pose_comes(robot, run, poses_file):
    commands = robot.listen()
    robot.describe()
    robot.broadcast()
    robot.stuck.add("j2")
    poses = poses_file("poses:\n  - [0.1, 0.1, 0.4, 0.1]\n  - [0.2, 0.2, 0.0, 0.2]\n")
    program = run(NAME, poses_file=poses, timeout=3)
    assert program.wait() == 1
    assert (
        "Pose 1 of 2 not reached within 3 s: joint 'j2' is at 0.0000, 0.4000 from 0.4000"
        in program.output
    )
    assert "Pose 2 of 2 reached" in program.output
    assert "1 of 2 poses not reached" in program.output
    assert commands == [[0.1, 0.1, 0.4, 0.1], [0.2, 0.2, 0.0, 0.2]]


def test_a_pose_beyond_the_limits_is_left_out(robot, run, poses_file):
    commands = robot.listen()
    robot.describe()
    robot.broadcast()
    poses = poses_file("poses:\n  - [0.0, 0.0, 0.0, -5]\n  - [0.1, 0.0, 0.0, 0.0]\n")
    program = run(NAME, poses_file=poses)
    assert program.wait() == 1
    assert "is skipped: joint 'j3' cannot go to -5" in program.output
    assert commands == [[0.1, 0.0, 0.0, 0.0]]


def test_the_time_out_is_of_the_simulations_clock(robot, run, poses_file):
    robot.listen()
    robot.describe()
    robot.broadcast()
    robot.tick()
    robot.stuck.add("j0")
    program = run(
        NAME, poses_file=poses_file("poses: [[1, 0, 0, 0]]"), use_sim_time=True, timeout=10
    )
    # Ten seconds of a clock that runs ten times as fast.
    assert program.wait() == 1
    assert "not reached within 10 s" in program.output


def test_says_that_the_simulations_clock_is_silent(robot, run):
    robot.listen()
    robot.describe()
    robot.broadcast()
    program = run(NAME, use_sim_time=True, match_timeout=5)
    assert program.wait() == 1
    assert "use_sim_time is true and /clock is silent" in program.output


def test_says_that_joint_states_are_silent(robot, run, poses_file):
    robot.listen()
    robot.describe()
    program = run(NAME, poses_file=poses_file("poses: [[1, 0, 0, 0]]"), timeout=0.5)
    assert program.wait() == 1
    assert "/joint_states is silent: is the joint_state_broadcaster active?" in program.output


def test_gives_up_without_a_subscriber(run):
    program = run(NAME, match_timeout=1)
    assert program.wait() == 1
    assert "nobody listens on /position_controller/commands" in program.output
    assert "5 of 5 poses not reached" in program.output


def test_an_invalid_file_is_reported_with_name_and_line(run, poses_file):
    path = poses_file("poses:\n  - [0, 0, 0]\n")
    program = run(NAME, poses_file=path)
    assert program.wait() == 1
    assert f"{path}, line 2: a pose is 4 numbers" in program.output
    assert "Traceback" not in program.output


def test_ctrl_c_during_the_work_ends_it(robot, run):
    robot.listen()
    robot.describe()
    robot.broadcast()
    robot.stuck.add("j0")
    program = run(NAME)
    program.wait_for_line("Pose 1 of 5: publishing positions")
    assert program.stop() == 0
