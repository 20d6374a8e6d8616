"""pymoveit2 as it is on PyPI, in a program as its users write it."""

import sys
from contextlib import closing
from pathlib import Path

from programs import RosProgram


def test_a_program_of_pymoveit2_works_as_it_is(planning):
    script = Path(__file__).with_name("pymoveit2_client.py")
    with closing(RosProgram([sys.executable, str(script)])) as program:
        words = dict(line.split(maxsplit=1) for line in program.succeed().splitlines() if line)
    assert words["groups"] == "['arm', 'arm_with_gripper', 'gripper']"
    moved = ("named", "joints", "inverse", "pose", "cartesian")
    assert {step: words[step] for step in moved} == dict.fromkeys(moved, "True")
    assert words["unreachable"].startswith("False NO_IK_SOLUTION")
    assert "goal is out of reach: link 'link6_flange' cannot reach" in words["unreachable"]
    assert words["scene"] == "['box']"
    assert words["canceled"] == "True False"
