"""`arm dataset record --expert`, ended before it is done."""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing

import psutil
import pytest
from programs import Program

from arm_sim.dataset import check_dataset

pytestmark = pytest.mark.gl
END_TIMEOUT_S = 60.0


@pytest.fixture
def recording(tmp_path) -> Iterator[Callable[[str], Program]]:
    """Start a recording of a thousand episodes into a folder."""
    words = ["dataset", "record", "--expert", "pick", "--episodes", "1000", "--workers", "1"]
    with ExitStack() as ending:

        def start(folder: str) -> Program:
            command = [sys.executable, "-m", "arm_cli", *words, tmp_path / folder]
            return ending.enter_context(closing(Program(command)))

        yield start


def test_ctrl_c_keeps_the_episodes_so_far_and_a_second_one_discards_them(recording, tmp_path):
    kept, discarded = recording("kept"), recording("discarded")
    for program in (kept, discarded):
        program.wait_for_line("seed 0: episode 1 of 1000")

    assert kept.stop() == 0
    discarded.process.send_signal(signal.SIGINT)
    discarded.wait_for_line("Ctrl-C again discards all of them")
    assert discarded.stop() != 0

    assert "ends after this episode with those so far" in kept.output
    assert "wrote" in kept.output
    assert check_dataset(tmp_path / "kept") == []
    assert [path.name for path in tmp_path.iterdir()] == ["kept"]


def test_its_workers_end_with_it_even_if_it_is_killed(recording):
    program = recording("killed")
    program.wait_for_line("seed 0: episode 1 of 1000")
    workers = program.processes("spawn_main")
    assert workers

    program.process.kill()

    _, alive = psutil.wait_procs(workers, END_TIMEOUT_S)
    assert alive == []
