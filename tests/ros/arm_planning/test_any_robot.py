"""Motion planning for a robot of which there is only a URDF: no controllers, no SRDF, no pose."""

import signal
import sys
from contextlib import closing
from pathlib import Path

import pytest
from programs import RosProgram
from robots import box, joint, link, robot
from sensor_msgs.msg import JointState


@pytest.fixture
def urdf(tmp_path) -> Path:
    """The file of an arm of three joints on a column."""
    file = tmp_path / "arm.urdf"
    file.write_text(
        robot(
            *(link(name, box("visual", "collision")) for name in ("base", "a", "b", "c")),
            joint("j1", "base", "a", axis="0 0 1", xyz="0 0 0.3"),
            joint("j2", "a", "b", xyz="0 0 0.3"),
            joint("j3", "b", "c", xyz="0 0 0.3"),
        )
    )
    return file


def test_arm_move_plans_and_moves_it(launch, client, urdf):
    launch(str(urdf), "planning:=true").wait_until_ready()
    states = client.subscribe(JointState, "/joint_states")
    words = [sys.executable, "-m", "arm_cli", "move", "--joints", "j1=0.4", "j2=-0.3"]
    with closing(RosProgram(words)) as program:
        assert "moved group 'arm'" in program.succeed()
    wanted = {"j1": 0.4, "j2": -0.3, "j3": 0.0}

    def are_there(messages: list[JointState]) -> bool:
        last = messages[-1] if messages else JointState()
        return dict(zip(last.name, last.position, strict=True)) == pytest.approx(wanted, abs=0.01)

    states.wait_until(are_there, f"the joints at {wanted}")
    with closing(RosProgram(words)) as program:
        assert "the robot is there already" in program.succeed()


def test_arm_move_finds_the_robot_in_its_namespace_and_ends_with_its_move_group(
    launch, client, urdf
):
    launched = launch(str(urdf), "planning:=true", "namespace:=left")
    launched.wait_until_ready()
    states = client.subscribe(JointState, "/left/joint_states")
    words = [sys.executable, "-m", "arm_cli", "move", "--joints", "j1=1.0", "--speed", "0.02"]
    with closing(RosProgram(words)) as program:
        assert program.fail().endswith("there is a robot with planning in -n /left")
    with closing(RosProgram([*words, "-n", "left"])) as program:
        states.wait_until(lambda heard: heard and max(heard[-1].velocity) > 0.01, "a motion")
        (move_group,) = launched.processes("'move_group'")
        move_group.send_signal(signal.SIGKILL)
        assert "no answer from /left/move_action: its server has ended" in program.fail()
