"""load_ros2_controllers.launch.py: which controllers it starts, and in which order."""

import pytest

from arm_cli.main import main

FILE = ("mycobot_moveit_config", "load_ros2_controllers.launch.py")
ORDER = ("joint_state_broadcaster", "arm_controller", "gripper_action_controller")


@pytest.mark.parametrize(("use_gripper", "started"), [("true", ORDER), ("false", ORDER[:2])])
def test_each_waits_for_the_one_before(capsys, use_gripper, started):
    assert main(["launch", *FILE, "--print", f"use_gripper:={use_gripper}"]) == 0
    blocks = capsys.readouterr().out.split("\n\n")[1:]

    assert [block.strip().splitlines()[0] for block in blocks] == [f"spawner_{n}" for n in started]
    assert "starts after" not in blocks[0]
    for block, before in zip(blocks[1:], started, strict=False):
        assert f"starts after spawner_{before}" in " ".join(block.split())
