"""How many control periods `arm sim step` asks for."""

import argparse

import pytest

from arm_cli.errors import CommandUsageError, SimulationRefusedError
from arm_cli.sim import changing


class Paused:
    """Stands for a paused simulation; notes what is asked of it."""

    def __init__(self, now_s: float, period_s: float) -> None:
        self._figures = {"control period (s)": repr(period_s), "simulated time (s)": f"{now_s:.9f}"}
        self.asked: list[tuple[str, int]] = []

    def __enter__(self) -> "Paused":
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def statistics(self) -> dict[str, dict[str, str]]:
        return {"time": self._figures}

    def ask(self, _type: str, service: str, *, patiently: bool, steps: int) -> None:
        assert patiently
        self.asked.append((service, steps))


@pytest.fixture
def ask(monkeypatch):
    """Run the verb beside a paused simulation; return what it asks for."""

    def run(*words: str, now_s: float = 0.0, period_s: float = 0.01) -> list[tuple[str, int]]:
        simulation = Paused(now_s, period_s)
        monkeypatch.setattr(changing, "ask_simulation", lambda _namespace: simulation)
        parser = argparse.ArgumentParser()
        changing.step.add_arguments(parser)
        changing.step.run(parser.parse_args(words))
        return simulation.asked

    return run


@pytest.mark.parametrize(
    ("words", "steps"),
    [
        ([], 1),
        (["12"], 12),
        (["--seconds", "0.5"], 50),
        (["--seconds", "0.501"], 51),
        (["--seconds", "1e-9"], 1),
        (["--until", "2.5"], 50),
        (["--until", "2.001"], 1),
    ],
)
def test_time_becomes_whole_control_periods(ask, words, steps):
    assert ask(*words, now_s=2.0) == [("step_simulation", steps)]


def test_rounding_errors_add_no_step(ask):
    assert ask("--seconds", "0.3", period_s=1 / 30) == [("step_simulation", 9)]
    assert ask("--until", "0.3", now_s=0.1 + 1e-9) == [("step_simulation", 20)]


def test_sensors_are_waited_for_if_asked(ask):
    assert ask("3", "--with-sensors") == [("step_simulation_with_sensors", 3)]


def test_a_time_that_is_past_is_refused(ask):
    with pytest.raises(SimulationRefusedError, match=r"already at 2\.000 s, past 1\.5 s"):
        ask("--until", "1.5", now_s=2.0)


@pytest.mark.parametrize("words", [["0"], ["-3"], ["2", "--seconds", "1"], ["2", "--until", "1"]])
def test_a_number_that_is_none_or_one_too_many_is_refused(ask, words):
    with pytest.raises(CommandUsageError):
        ask(*words)
