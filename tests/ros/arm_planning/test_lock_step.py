"""A simulation in lock-step repeats to the last bit while move_group plans and moves the arm."""

from collections.abc import Callable
from pathlib import Path

from programs import Program
from run_python import run_python

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile

PARTNER = Path(__file__).with_name("lock_step_planner.py")
TIMEOUT_S = 240.0
LAST = 300
SETTINGS = ("lockstep:=/partner", "real_time_factor:=0", "lockstep_timeout:=60")
SUCCESS = "1"
SAID = ("plan", "end")


def what_the_partner_saw(launch: Callable[..., Program], recording: Path) -> list[list[str]]:
    """Return its lines, each cut into words."""
    program = launch("mycobot", "planning:=true", f"record_run:={recording}", *SETTINGS)
    program.wait_until_ready()
    partner = run_python(str(PARTNER), str(LAST), check=True, timeout_s=TIMEOUT_S)
    program.close()
    # Fast DDS prints its complaints to stdout, on a busy machine.
    lines = [line.split() for line in partner.stdout.splitlines()]
    return [words for words in lines if words and (words[0] in SAID or words[0].isdigit())]


def test_a_run_repeats_to_the_last_bit_while_move_group_plans_and_moves_the_arm(launch, tmp_path):
    recordings = [tmp_path / f"{name}.run" for name in ("first", "second")]
    first, second = (what_the_partner_saw(launch, each) for each in recordings)
    plans = [words for words in first if words[0] == "plan"]
    assert {words[1] for words in plans} == {SUCCESS}
    assert first.pop() == second.pop() == ["end", SUCCESS]
    states = [words for words in first if words[0] != "plan"]
    assert [words[0] for words in states] == [str(period) for period in range(1, LAST + 1)]
    assert len({tuple(words[1:]) for words in states}) > LAST // 3
    assert first == second
    replayed = [Replay(RunFile(each)).run() for each in recordings]
    assert [each.difference for each in replayed] == [None, None]
    assert all(each.periods >= LAST for each in replayed)
