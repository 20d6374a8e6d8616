"""`arm dataset record --expert`, ended by Ctrl-C."""

import signal
import sys
from contextlib import closing
from pathlib import Path

import pytest
from programs import Program

from arm_sim.dataset import check_dataset


@pytest.mark.gl
def test_ctrl_c_keeps_the_episodes_so_far_and_a_second_one_discards_them(tmp_path: Path):
    words = ["dataset", "record", "--expert", "pick", "--episodes", "1000", "--workers", "1"]
    kept, discarded = tmp_path / "kept", tmp_path / "discarded"
    with (
        closing(Program([sys.executable, "-m", "arm_cli", *words, str(kept)])) as one,
        closing(Program([sys.executable, "-m", "arm_cli", *words, str(discarded)])) as two,
    ):
        for program in (one, two):
            program.wait_for_line("seed 0: episode 1 of 1000")
        assert one.stop() == 0
        two.process.send_signal(signal.SIGINT)
        two.wait_for_line("Ctrl-C again discards all of them")
        assert two.stop() != 0
    assert "ends after this episode with those so far" in one.output
    assert "wrote" in one.output
    assert check_dataset(kept) == []
    assert not discarded.exists()
    assert [path.name for path in tmp_path.iterdir()] == ["kept"]
