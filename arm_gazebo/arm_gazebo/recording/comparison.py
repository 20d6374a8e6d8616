"""Compare two recordings of runs."""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from itertools import zip_longest

from arm_control.state.encoding import encode
from arm_gazebo.recording.recorded_run import run_of
from arm_gazebo.recording.replay import Difference, differing
from arm_gazebo.recording.run_file import RecordedInput, RecordedPeriod, RunFile
from arm_gazebo.recording.run_state import state_names


@dataclass(frozen=True, slots=True)
class Comparison:
    """What two recordings have in common.

    Attributes:
        settings: what differs before the first period, a line each.
        periods: number of the first periods that are equal.
        difference: the first difference; None if there is none in the periods of both.
        longer: how many periods the second recording has more than the first; negative if fewer.
    """

    settings: tuple[str, ...]
    periods: int
    difference: Difference | None
    longer: int

    @property
    def is_equal(self) -> bool:
        """Whether they are recordings of the same run, of the same length."""
        return not self.settings and self.difference is None and not self.longer


def compare(first: RunFile, second: RunFile) -> Comparison:
    """Return the first difference of two recordings.

    Raises:
        RecordingError: one of them is damaged.
    """
    settings = tuple(_differing_settings(first, second))
    inputs: list[RecordedInput] = []
    equal = longer = 0
    difference = None
    for one, other in zip_longest(_periods(first), _periods(second)):
        if one is None or other is None:
            longer += 1 if one is None else -1
            continue
        inputs += one.inputs
        if difference is None:
            difference = _difference(first, inputs, one, other)
            equal += difference is None
    return Comparison(settings, equal, difference, longer)


def _periods(file: RunFile) -> Iterator[RecordedPeriod]:
    return (each for each in file.periods() if isinstance(each, RecordedPeriod))


def _difference(
    file: RunFile, inputs: list[RecordedInput], one: RecordedPeriod, other: RecordedPeriod
) -> Difference | None:
    lines: list[str] = []
    if encode(one.inputs) != encode(other.inputs):
        lines.append(f"inputs: {_listed(other.inputs)} instead of {_listed(one.inputs)}")
    elif one.hash == other.hash:
        return None
    state, then = other.block.state(other.number), one.block.state(one.number)
    if state is not None and then is not None:
        lines += differing(_names(file, inputs), then, state)
    elif not lines:
        lines.append("the hashes of the states differ; the states are not stored here")
    time_s = run_of(file).timing.period_s * (one.number + 1)
    return Difference(one.number, time_s, tuple(lines))


def _names(file: RunFile, inputs: list[RecordedInput]) -> list[str]:
    """Return the names of a state's numbers after these inputs."""
    run = run_of(file)
    models = [item.arguments["model"] for item in inputs if item.method == "swap"]
    model = (models[-1] if models else run.model).load().model
    return state_names(model, run.build().managers)


def _differing_settings(first: RunFile, second: RunFile) -> Iterator[str]:
    here, there = first.header.get("made_with", {}), second.header.get("made_with", {})
    for key in here:
        if here[key] != there.get(key):
            yield f"made with {key} {there.get(key)} instead of {here[key]}"
    one, other = run_of(first), run_of(second)
    if one.model.content != other.model.content:
        yield "the models differ"
    for name in (field.name for field in fields(one) if field.name not in ("model", "robots")):
        if getattr(one, name) != getattr(other, name):
            yield f"{name} {getattr(other, name)} instead of {getattr(one, name)}"
    if len(one.robots) != len(other.robots):
        yield f"{len(other.robots)} robots instead of {len(one.robots)}"
    for robot, its_twin in zip(one.robots, other.robots, strict=False):
        for name in ("settings", "manager"):
            here, there = getattr(robot, name), getattr(its_twin, name)
            for field in fields(here):
                if encode(getattr(here, field.name)) != encode(getattr(there, field.name)):
                    yield f"{field.name} of {robot.manager_name} differs"


def _listed(inputs: tuple[RecordedInput, ...]) -> str:
    each = (" ".join(filter(None, (i.controller, i.method))) for i in inputs)
    return ", ".join(each) or "none"
