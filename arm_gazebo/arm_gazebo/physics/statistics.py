"""The figures of a running simulation: pace, cost of a tick, physics, cameras and sensors."""

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import fields, replace

import mujoco

from arm_control.loop.clock import Clock, MonotonicClock
from arm_control.loop.pacer import Pacer
from arm_gazebo.feed.schedule import StreamCount
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.tick import TickCosts
from arm_node.frozen import frozen

PHASES = tuple(field.name for field in fields(TickCosts) if field.name != "ticks")
LEAST_WINDOW_S = 0.5
"""Shortest window of wall time that a report covers, if the simulation has run that long."""
SAMPLES = 3


@frozen
class StatusReport:
    """The figures of one part of the simulation.

    Attributes:
        name: the part, such as "tick".
        message: the most important figures in a few words.
        values: the figures; each key ends with the unit.
    """

    name: str
    message: str
    values: Mapping[str, str]


@frozen
class RunSample:
    """What had been counted at one moment.

    Attributes:
        time_s: simulation time.
        wall_s: wall time.
        costs: of all ticks so far.
        streams: the cameras and sensors.
    """

    time_s: float
    wall_s: float
    costs: TickCosts
    streams: tuple[StreamCount, ...]


class SimulationStatistics:
    """Samples what the loop counts anyway, and reports the last second or two.

    A tick pays for six readings of the clock. Loop thread only. The ticks update `costs`; `streams`
    return the figures of the cameras and sensors.
    """

    def __init__(
        self,
        simulation: Physics,
        costs: TickCosts,
        pacer: Pacer,
        streams: Sequence[Callable[[], Sequence[StreamCount]]] = (),
        clock: Clock | None = None,
    ) -> None:
        self._simulation = simulation
        self._costs = costs
        self._pacer = pacer
        self._streams = tuple(streams)
        self._now_s = (clock or MonotonicClock()).now_s
        self._start_s = self._now_s()
        self._samples = deque([self._sample()], maxlen=SAMPLES)

    def sample(self) -> None:
        """Start a new window; call it about once a second."""
        self._samples.append(self._sample())

    def restart(self) -> None:
        """Forget the windows so far, because the clock was set."""
        self._samples = deque([self._sample()], maxlen=SAMPLES)

    def report(self) -> tuple[StatusReport, ...]:
        """Return the figures of the present state and of the latest window."""
        now = self._sample()
        before = next(
            (s for s in reversed(self._samples) if now.wall_s - s.wall_s >= LEAST_WINDOW_S),
            self._samples[0],
        )
        return (
            self._time(before, now),
            _tick(before.costs, now.costs),
            self._physics(),
            *_streams(before, now, self._simulated_s(before, now)),
        )

    def _sample(self) -> RunSample:
        streams = tuple(count for counts in self._streams for count in counts())
        return RunSample(self._simulation.time_s, self._now_s(), replace(self._costs), streams)

    def _simulated_s(self, before: RunSample, now: RunSample) -> float:
        """Return how much was simulated; the clock may have been set back meanwhile."""
        return (now.costs.ticks - before.costs.ticks) * self._simulation.timing.period_s

    def _time(self, before: RunSample, now: RunSample) -> StatusReport:
        pacer, pace = self._pacer.statistics, self._pacer.real_time_factor
        wall_s = now.wall_s - before.wall_s
        reached = self._simulated_s(before, now) / wall_s if wall_s > 0.0 else 0.0
        asked = f"{pace:g}" if pace else "as fast as possible"
        return StatusReport(
            "time",
            f"{now.time_s:.3f} s, real-time factor {reached:.2f} of {asked}",
            {
                "simulated time (s)": f"{now.time_s:.9f}",
                "wall time (s)": f"{now.wall_s - self._start_s:.3f}",
                "control period (s)": repr(self._simulation.timing.period_s),
                "physics step (s)": repr(self._simulation.timing.step_s),
                "requested real-time factor": f"{pace:g}",
                "achieved real-time factor": f"{reached:.3f}",
                "ticks": str(now.costs.ticks),
                "lag (ms)": f"{1e3 * pacer.lag_s:.3f}",
                "greatest lag (ms)": f"{1e3 * pacer.max_lag_s:.3f}",
                "overruns": str(pacer.overruns),
                "time given up (s)": f"{pacer.lost_s:.3f}",
            },
        )

    def _physics(self) -> StatusReport:
        simulation = self._simulation
        model, data = simulation.model, simulation.data
        # In the gap of a geom MuJoCo lists shapes that are only near each other, too.
        contacts = int((data.contact.efc_address >= 0).sum())
        islands = max(int(data.nisland), 1)
        iterations = int(data.solver_niter[:islands].sum())
        # A copy of the state: the quantities derived here never reach the simulation.
        seen = simulation.observe()
        mujoco.mj_energyPos(model, seen)
        mujoco.mj_energyVel(model, seen)
        potential, kinetic = seen.energy.tolist()
        return StatusReport(
            "physics",
            f"{contacts} contacts, {iterations} solver iterations",
            {
                "contacts": str(contacts),
                "constraints": str(int(data.nefc)),
                "solver iterations": str(iterations),
                "potential energy (J)": f"{potential:.6g}",
                "kinetic energy (J)": f"{kinetic:.6g}",
            },
        )


def _tick(before: TickCosts, now: TickCosts) -> StatusReport:
    ticks = now.ticks - before.ticks
    each = {
        phase: 1e6 * (getattr(now, phase) - getattr(before, phase)) / ticks if ticks else 0.0
        for phase in PHASES
    }
    whole = sum(each.values())
    return StatusReport(
        "tick",
        f"{whole:.0f} us per tick" if ticks else "no tick",
        {
            "ticks measured": str(ticks),
            **{f"{phase} (us)": f"{cost:.1f}" for phase, cost in each.items()},
            "whole (us)": f"{whole:.1f}",
        },
    )


def _streams(before: RunSample, now: RunSample, simulated_s: float) -> Iterator[StatusReport]:
    for then, count in zip(before.streams, now.streams, strict=True):
        came = count.published - then.published
        reached = came / simulated_s if simulated_s > 0.0 else 0.0
        yield StatusReport(
            f"{count.kind}: {count.name}",
            f"{reached:.1f} of {count.rate_hz:g} Hz",
            {
                "requested rate (Hz of simulation time)": f"{count.rate_hz:g}",
                "achieved rate (Hz of simulation time)": f"{reached:.2f}",
                "due": str(count.due),
                "published": str(count.published),
                "dropped": str(count.dropped),
            },
        )
