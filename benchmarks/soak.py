"""A long run with everything that can happen to it: nothing grows, nothing is lost, and it repeats.

    python benchmarks/soak.py [--minutes 10] [--seed 0]

The myCobot runs as fast as possible, and at random gets goals, cancellations, gripper commands,
switches, parameters, resets, snapshots that are restored, spawned, moved and deleted things. It is
recorded from its first to its last control period, and the recording is replayed. Memory, file
descriptors and threads are looked at every second; a straight line through the later half says what
grows. The lock-step partners that die are those of `lock_step.py`, over ROS.
"""

import argparse
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import harness
import numpy as np
import psutil
from harness import Row

from arm_control.manager.switch_planner import SwitchRequest
from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_sim import Simulation

ARM, GRIPPER = "arm_controller", "gripper_action_controller"
CAN = """<mujoco><worldbody><body><freejoint/>
<geom type="cylinder" size="0.03 0.05" mass="0.1"/></body></worldbody></mujoco>"""
MAX_THINGS = 6
SAMPLE_S = 1.0


@dataclass
class Soak:
    """The run and what it remembers."""

    sim: Simulation
    random: np.random.Generator
    counts: Counter[str] = field(default_factory=Counter)
    things: list[str] = field(default_factory=list)
    saved: tuple[object, list[str]] | None = None
    number: int = 0

    def act(self) -> None:
        """Do one thing at random, then let time pass."""
        actions: list[Callable[[], None]] = [
            *[self.goal] * 6,
            *[self.grip] * 3,
            self.cancelled_goal,
            self.switch,
            self.parameters,
            self.spawn,
            self.delete,
            self.move,
            self.save,
            self.restore,
            self.reset,
        ]
        action = actions[self.random.integers(len(actions))]
        action()
        self.counts[action.__name__] += 1
        self.sim.run(float(self.random.uniform(0.05, 0.6)))
        if not np.isfinite(self.sim.joints.position).all():
            sys.exit(f"a position is not finite after {action.__name__} at {self.sim.time_s} s")

    def target(self) -> list[float]:
        """Return a pose of the arm at random."""
        return self.random.uniform(-0.8, 0.8, 6).tolist()

    def goal(self) -> None:
        """Begin to follow a trajectory."""
        points = [self.target() for _ in range(self.random.integers(1, 4))]
        times_s = np.cumsum(self.random.uniform(0.3, 1.0, len(points)))
        self.sim[ARM].follow({"positions": points, "times_s": times_s.tolist()})

    def cancelled_goal(self) -> None:
        """Follow a trajectory for a moment."""
        goal = self.sim[ARM].follow({"positions": [self.target()], "times_s": [1.0]})
        self.sim.run(0.2)
        if not goal.done:
            goal.cancel()

    def grip(self) -> None:
        """Move the gripper."""
        self.sim[GRIPPER].grip(float(self.random.uniform(-0.6, 0.1)))

    def switch(self) -> None:
        """Deactivate the arm's controller, and activate it again."""
        manager = self.sim.parts.robot.manager
        for request in (SwitchRequest(deactivate=(ARM,)), SwitchRequest(activate=(ARM,))):
            if not manager.switch_controller(request).ok:
                sys.exit("a switch failed")
            self.sim.run(0.1)

    def parameters(self) -> None:
        """Change a parameter of a running controller."""
        controller = self.sim.parts.robot.manager.controllers[ARM].controller
        given = controller.configured_with
        rate_hz = float(self.random.integers(5, 50))
        controller.change_parameters(replace(given, action_monitor_rate=rate_hz))

    def spawn(self) -> None:
        """Drop a thing."""
        if len(self.things) >= MAX_THINGS:
            self.delete()
        self.number += 1
        position = (*self.random.uniform(-0.5, 0.5, 2).tolist(), 0.6)
        self.things.append(self.sim.spawn(CAN, name=f"can{self.number}", pose=position))

    def delete(self) -> None:
        """Delete a thing."""
        if self.things:
            self.sim.delete(self.things.pop(self.random.integers(len(self.things))))

    def move(self) -> None:
        """Put a thing elsewhere."""
        if self.things:
            name = self.things[self.random.integers(len(self.things))]
            self.sim.place(name, (*self.random.uniform(-0.5, 0.5, 2).tolist(), 0.6))

    def save(self) -> None:
        """Take a snapshot."""
        self.saved = self.sim.save(), list(self.things)

    def restore(self) -> None:
        """Go back to the latest snapshot."""
        if self.saved is not None:
            snapshot, things = self.saved
            self.sim.restore(snapshot)  # pyright: ignore[reportArgumentType]
            self.things = list(things)

    def reset(self) -> None:
        """Go back to the start."""
        self.sim.reset()
        self.things.clear()


def growth(times_s: list[float], values: list[float]) -> float:
    """Return the slope in the later half, for each minute."""
    half = len(times_s) // 2
    return float(np.polyfit(times_s[half:], values[half:], 1)[0] * 60.0)


def soak(seconds: float, seed: int, path: Path) -> list[Row]:
    """Run, record and replay; return the table."""
    process = psutil.Process()
    times_s: list[float] = []
    samples: list[tuple[float, float, float]] = []
    began_s = time.monotonic()
    periods = 0
    with Simulation("mycobot", seed=seed, record=path) as sim:
        run = Soak(sim, np.random.default_rng(seed))
        while time.monotonic() - began_s < seconds:
            run.act()
            now_s = time.monotonic() - began_s
            if not times_s or now_s - times_s[-1] >= SAMPLE_S:
                memory_mb = process.memory_info().rss / 1e6
                times_s.append(now_s)
                samples.append((memory_mb, process.num_fds(), process.num_threads()))
        periods = sim.parts.tick.costs.ticks
    memory, descriptors, threads = (list(column) for column in zip(*samples, strict=True))
    result = Replay(RunFile(path)).run()
    equal = "all equal" if result.difference is None else result.difference.lines[0]
    return [
        Row("control periods", f"{periods}, {periods * 0.01 / 3600:.2f} h of simulated time"),
        Row("what happened", ", ".join(f"{n} {what}" for what, n in run.counts.most_common())),
        Row("memory", f"{memory[-1]:.0f} MB, {growth(times_s, memory):+.2f} MB a minute", "0"),
        Row(
            "file descriptors",
            f"{descriptors[-1]:.0f}, {growth(times_s, descriptors):+.2f} a minute",
            "0",
        ),
        Row("threads", f"{threads[-1]:.0f}, {growth(times_s, threads):+.2f} a minute", "0"),
        Row("the recording", f"{path.stat().st_size / 1e6:.0f} MB"),
        Row("its replay", f"{result.periods} control periods: {equal}", "all equal"),
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows = soak(options.minutes * 60.0, options.seed, Path(folder, "soak.run"))
    harness.print_table("Soak: the myCobot as fast as possible", rows)


if __name__ == "__main__":
    main()
