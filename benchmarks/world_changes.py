"""What a world costs: one with many things, one with many that move, and one that changes."""

import argparse
import os
import sys
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from statistics import median

import harness
import mujoco
import numpy as np

from arm_control.hardware.info import parse_hardware_info
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.pacer import Pacer
from arm_description.urdf.parser import parse_urdf
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.mjcf.size import BYTES_PER_CELL
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.world.changes import Spawned, WorldChanges, changed_model
from arm_gazebo.world.editor import SpawnRequest, WorldEditor
from arm_gazebo.world.spawn_model import ModelSource

ARM = Path(__file__).parents[1] / "arm_description" / "urdf" / "arm.urdf.xacro"
CRATE = """<robot name="crate"><link name="base">
  <inertial><mass value="0.2"/>
  <inertia ixx="0.0003" iyy="0.0003" izz="0.0003" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link></robot>"""
HEIGHT_FIELD = """<mujoco><asset>
  <hfield name='h' nrow='{cells}' ncol='{cells}' size='1 1 1 1'/></asset>
  <worldbody><body><geom type='hfield' hfield='h'/></body></worldbody></mujoco>"""
CELLS = 2200
"""On each side of a height field: just below the limit of a spawn, 100 MB as estimated."""
BEFORE_S = 3.0
THINGS = 50
TICKS = 500
CHANGES = 20


def simulation(world: str) -> Physics:
    """Return the arm in a world, at 100 Hz."""
    text = expand_xacro(ARM, {"camera": "none"})
    timing = physics_timing(100)
    options = BuildOptions(step_s=timing.step_s)
    built = build_model(parse_urdf(text), parse_hardware_info(text), (), world, options)
    return Physics(built, timing)


def timed_ms(action: Callable[[], object]) -> float:
    """Return how long an action takes."""
    start_s = time.perf_counter()
    action()
    return (time.perf_counter() - start_s) * 1e3


def step_us(running: Physics) -> float:
    """Return what a physics step costs, the median of many ticks."""
    steps = running.timing.steps
    return median(timed_ms(running.advance) for _ in range(TICKS)) / steps * 1e3


def crates(running: Physics, count: int) -> WorldChanges:
    """Return changes that put stacks of five crates beside the arm."""
    model = ModelSource(running.timing.step_s).read("", CRATE)
    changes = WorldChanges()
    for number in range(count):
        pose = np.eye(4)
        pose[:3, 3] = 1.0 + 0.3 * (number // 5), 1.0, 0.06 + 0.11 * (number % 5)
        changes = changes.with_spawned(Spawned(f"crate_{number}", model, pose))
    return changes


def swap(running: Physics, changes: WorldChanges) -> tuple[float, float]:
    """Go on with changes; return the ms for the new model, and those on the loop's thread."""
    start_s = time.perf_counter()
    base = running.built
    following = running.prepare(changed_model(base, changes), base.robot_roots)
    built_ms = (time.perf_counter() - start_s) * 1e3
    return built_ms, timed_ms(lambda: running.swap(following))


def moving_rows() -> list[harness.Row]:
    """Return the figures of many free things, awake and asleep."""
    running = simulation("empty")
    swap(running, crates(running, THINGS))
    awake = []
    for _ in range(TICKS):
        running.data.tree_asleep[:] = -(1 + mujoco.mjMINAWAKE)
        awake.append(timed_ms(running.advance))
    awake_us = median(awake) / running.timing.steps * 1e3
    asleep_us = step_us(running)
    step_s = running.timing.step_s
    return [
        harness.Row(
            f"{THINGS} crates in stacks of five: physics step, kept awake; steps a second",
            f"{awake_us:.0f} us; {1e6 / awake_us:.0f} ({step_s * 1e6 / awake_us:.0f} x)",
            "",
        ),
        harness.Row(
            "the same once they lie still", f"{asleep_us:.1f} us; {1e6 / asleep_us:.0f}", ""
        ),
    ]


def change_row(world: str) -> harness.Row:
    """Return what one thing more costs in a world."""
    times = []
    for _ in range(CHANGES):
        running = simulation(world)
        times.append(swap(running, crates(running, 1)))
    built_ms, swap_ms = (median(column) for column in zip(*times, strict=True))
    return harness.Row(
        f"{world}: a thing more: new model beside the loop; swap on it",
        f"{built_ms:.1f} ms; {swap_ms:.2f} ms",
        "swap under 10 ms",
    )


def compiling_row() -> harness.Row:
    """Return what the control loop keeps of its rate while a spawn at the memory limit compiles."""
    running = simulation("empty")
    ticks_s: list[float] = []

    def tick() -> None:
        running.advance()
        ticks_s.append(time.perf_counter())

    loop = ControlLoop(tick, Pacer(running.timing.period_s))
    source = ModelSource(running.timing.step_s)
    # The process that tries models starts before the figures are taken.
    source.read("", HEIGHT_FIELD.format(cells=10))
    editor = WorldEditor(running, lambda function: loop.call(function).result(), (), (), source)
    loop.start()
    time.sleep(BEFORE_S)
    spans_s: list[tuple[float, float]] = []
    for _ in range(CHANGES):
        start_s = time.perf_counter()
        editor.spawn(SpawnRequest("field", "", HEIGHT_FIELD.format(cells=CELLS), np.eye(4)))
        spans_s.append((start_s, time.perf_counter()))
        editor.delete("field")
    loop.stop()
    loop.join()
    before = [at for at in ticks_s if at < spans_s[0][0]]
    before_hz = (len(before) - 1) / (before[-1] - before[0])
    during = sum(start_s <= at < end_s for at in ticks_s for start_s, end_s in spans_s)
    during_hz = during / sum(end_s - start_s for start_s, end_s in spans_s)
    gaps_ms = [1e3 * longest_gap_s(ticks_s, span_s) for span_s in spans_s]
    taken_s = median(end_s - start_s for start_s, end_s in spans_s)
    size_mb = CELLS**2 * BYTES_PER_CELL / 1e6
    return harness.Row(
        f"spawn of an MJCF of {size_mb:.0f} MB: control rate meanwhile; longest gap; time",
        f"{100 * during_hz / before_hz:.0f} % of that before; median {median(gaps_ms):.0f} ms, "
        f"worst {max(gaps_ms):.0f} ms; {taken_s:.2f} s",
        "",
    )


def longest_gap_s(ticks_s: list[float], span_s: tuple[float, float]) -> float:
    """Return the longest time between two ticks, at least one of which is in a span."""
    start_s, end_s = span_s
    gaps = [(a, b) for a, b in pairwise(ticks_s) if b >= start_s and a < end_s]
    return max(b - a for a, b in gaps)


def main() -> None:
    """Print the table."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)
    rows = [
        harness.Row(f"{world} and arm: physics step", f"{step_us(simulation(world)):.1f} us", "")
        for world in ("empty", "house")
    ]
    changes = [change_row(world) for world in ("empty", "house")]
    harness.print_table(
        "Worlds with many things, and changes", [*rows, *moving_rows(), *changes, compiling_row()]
    )


if __name__ == "__main__":
    main()
