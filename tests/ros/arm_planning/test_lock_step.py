"""A simulation in lock-step repeats to the last bit while move_group plans beside it."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from programs import Program

pytestmark = pytest.mark.ros

PARTNER = Path(__file__).with_name("lock_step_planner.py")
TIMEOUT_S = 240.0
LAST = 300
SETTINGS = ("lockstep:=/partner", "real_time_factor:=0", "lockstep_timeout:=60")
SUCCESS = "1"


def what_the_partner_saw(launch: Callable[..., Program]) -> list[list[str]]:
    """Return its lines, each cut into words."""
    program = launch("mycobot", "planning:=true", *SETTINGS)
    program.wait_until_ready()
    partner = subprocess.run(
        [sys.executable, str(PARTNER), str(LAST)],
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=True,
    )
    program.close()
    # Fast DDS prints its complaints to stdout, on a busy machine.
    lines = [line.split() for line in partner.stdout.splitlines()]
    return [words for words in lines if words and (words[0] == "plan" or words[0].isdigit())]


def test_joint_states_repeat_to_the_last_bit_while_move_group_plans(launch):
    first, second = what_the_partner_saw(launch), what_the_partner_saw(launch)
    plans = [words for words in first if words[0] == "plan"]
    assert {words[1] for words in plans} == {SUCCESS}
    states = [words for words in first if words[0] != "plan"]
    assert [words[0] for words in states] == [str(period) for period in range(1, LAST + 1)]
    assert len({tuple(words[1:]) for words in states}) > LAST // 3
    assert first == second
