"""The figures of a run, with a clock of the test's."""

import pytest

from arm_control.loop.pacer import Pacer
from arm_control.testing import ManualClock
from arm_gazebo.feed.schedule import StreamCount
from arm_gazebo.physics.statistics import SimulationStatistics
from arm_gazebo.physics.tick import TickCosts


class Run:
    """A pendulum that is held, and what is counted of it."""

    def __init__(self, bench, parts, factor: float = 2.0) -> None:
        self.bench = bench(parts.pendulum(), 100.0)
        self.clock = ManualClock(1000.0)
        self.costs = TickCosts()
        self.pictures = 0
        self.statistics = SimulationStatistics(
            self.bench.simulation,
            self.costs,
            Pacer(0.01, real_time_factor=factor, clock=self.clock),
            [lambda: [StreamCount("eye", "camera", 30.0, 40, self.pictures, 3)]],
            self.clock,
        )

    def advance(self, ticks: int, wall_s: float) -> None:
        for _ in range(ticks):
            self.bench.simulation.advance()
        self.costs.ticks += ticks
        self.costs.physics += 100e-6 * ticks
        self.costs.publish += 50e-6 * ticks
        self.clock.advance(wall_s)

    def report(self) -> dict[str, dict[str, str]]:
        return {part.name: dict(part.values) for part in self.statistics.report()}


@pytest.fixture
def run(bench, parts) -> Run:
    return Run(bench, parts)


def test_the_pace_of_the_latest_window_is_reported(run):
    run.advance(500, 1.0)
    run.statistics.sample()
    run.advance(150, 1.0)
    time = run.report()["time"]
    assert time["simulated time (s)"] == "6.500000000"
    assert time["wall time (s)"] == "2.000"
    assert time["requested real-time factor"] == "2"
    assert time["achieved real-time factor"] == "1.500"


def test_a_clock_that_was_set_back_does_not_count_backwards(run):
    run.advance(500, 1.0)
    run.statistics.sample()
    run.bench.simulation.reset(0.0)
    run.advance(100, 1.0)
    assert run.report()["time"]["simulated time (s)"] == "1.000000000"
    assert run.report()["time"]["achieved real-time factor"] == "1.000"


def test_a_window_that_has_just_begun_does_not_count(run):
    run.advance(100, 1.0)
    run.statistics.sample()
    run.advance(1, 0.001)
    assert run.report()["time"]["achieved real-time factor"] == f"{1.01 / 1.001:.3f}"


def test_the_cost_of_a_tick_is_split_into_its_phases(run):
    assert run.report()["tick"]["whole (us)"] == "0.0"
    run.advance(10, 1.0)
    tick = run.report()["tick"]
    assert (tick["physics (us)"], tick["publish (us)"], tick["update (us)"]) == (
        *("100.0", "50.0", "0.0"),
    )
    assert (tick["whole (us)"], tick["ticks measured"]) == ("150.0", "10")


def test_rates_are_per_second_of_simulation_time(run):
    run.advance(100, 4.0)
    run.pictures = 25
    camera = run.report()["camera: eye"]
    assert camera["achieved rate (Hz of simulation time)"] == "25.00"
    assert (camera["requested rate (Hz of simulation time)"], camera["dropped"]) == ("30", "3")


def test_the_energy_is_that_of_the_present_state(run):
    # 1 kg, 2 m above the origin, at rest.
    assert float(run.report()["physics"]["potential energy (J)"]) == pytest.approx(2 * 9.81)
    assert float(run.report()["physics"]["kinetic energy (J)"]) == pytest.approx(0.0, abs=1e-12)


def test_a_report_leaves_the_run_as_it_is(bench, parts):
    watched, alone = Run(bench, parts), Run(bench, parts)
    for _ in range(50):
        watched.advance(1, 0.01)
        watched.report()
        alone.advance(1, 0.01)
    assert (
        watched.bench.simulation.data.qpos.tobytes() == alone.bench.simulation.data.qpos.tobytes()
    )
