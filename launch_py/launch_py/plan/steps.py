"""The plan of a launch description: its steps, and the events that each of them waits for."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum

from launch_py.events import LaunchDescriptionEntity, ProcessEvent, ProcessIO, ShutdownEvent
from launch_py.plan.readiness import Finished, Readiness
from launch_py.plan.restart_policy import RestartPolicy

SIGTERM_TIMEOUT_S = 5.0
"""From SIGINT to SIGTERM; the default of ros2 launch."""

SIGKILL_TIMEOUT_S = 5.0
"""From SIGTERM to SIGKILL."""


class TriggerKind(Enum):
    """What a step waits for another process to do; the value completes "after PROCESS ..."."""

    STARTED = "started"
    READY = "ready"
    EXITED = "ended"


@dataclass(frozen=True, slots=True)
class Trigger:
    """One event that a step waits for; before `finish`, `process` may be an action."""

    kind: TriggerKind
    process: str | LaunchDescriptionEntity


@dataclass(frozen=True, slots=True)
class StopDelays:
    """The time limits after SIGINT and after SIGTERM, before the next signal is sent."""

    sigterm_timeout_s: float = SIGTERM_TIMEOUT_S
    sigkill_timeout_s: float = SIGKILL_TIMEOUT_S


@dataclass(frozen=True, slots=True)
class GeneratedFile:
    """A file that a command line refers to, written when the process starts."""

    suffix: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One step of a plan, taken `delay_s` after all of `after` has happened."""

    after: tuple[Trigger, ...] = ()
    delay_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessStep(Step):
    """Starts and supervises a process.

    `environment` holds only the variables that the launch file sets, with None for those that it
    unsets; with `replace_environment` it is the process's whole environment. `shown` names the
    streams that go to the screen; all streams go to the log file. An empty `ready` means ready once
    started. `action` is the process's action in the launch file. `node_names` returns the full
    names of its ROS nodes that are known before it runs.
    """

    name: str
    command: tuple[str | GeneratedFile, ...]
    cwd: str | None = None
    environment: Mapping[str, str | None] = field(default_factory=dict)
    replace_environment: bool = False
    shown: frozenset[str] = frozenset({"stdout", "stderr"})
    emulate_tty: bool = False
    ready: tuple[Readiness, ...] = ()
    restart: RestartPolicy = field(default_factory=RestartPolicy)
    stop_delays: StopDelays = field(default_factory=StopDelays)
    action: LaunchDescriptionEntity | None = field(default=None, compare=False, repr=False)
    node_names: Callable[[], Sequence[str]] = field(default=tuple, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageStep(Step):
    """Prints a message for the user."""

    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ShutdownStep(Step):
    """Begins the shutdown with the exit code of the process whose exit triggered it."""

    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SignalStep(Step):
    """Stops the processes that an event concerns, or sends them a signal."""

    concerns: Callable[[ProcessEvent], bool]
    signal_number: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class DeferredStep(Step):
    """Calls a function of the launch file when due; it returns the steps that follow."""

    expand: Callable[[ProcessEvent | None], Sequence[Step]]


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputHandlerStep(Step):
    """Once due, calls a function of the launch file with every line of some processes.

    Before `finish`, a process may be an action; None stands for all processes.
    """

    processes: tuple[str | LaunchDescriptionEntity, ...] | None
    expand: Callable[[ProcessIO], Sequence[Step]]


@dataclass(frozen=True, slots=True, kw_only=True)
class ShutdownHandlerStep(Step):
    """Once due, calls a function of the launch file when the shutdown begins."""

    expand: Callable[[ShutdownEvent], Sequence[Step]]


@dataclass(frozen=True, slots=True)
class PanelEntry:
    """The content of a `ReadyPanel`."""

    title: str | None
    topics: tuple[tuple[str, str], ...]
    commands: tuple[tuple[str, str], ...]
    notes: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class LaunchPlan:
    """The checked steps in the order of the launch file."""

    steps: tuple[Step, ...]
    panels: tuple[PanelEntry, ...] = ()
    warnings: tuple[str, ...] = ()

    @property
    def processes(self) -> tuple[ProcessStep, ...]:
        """The steps that start processes."""
        return tuple(step for step in self.steps if isinstance(step, ProcessStep))

    def start_up(self) -> frozenset[str]:
        """Return the names of the processes that must be ready before the launch is ready.

        A process that waits for the exit of a one-shot process (ready when it has exited) belongs
        to the start-up. A process that waits for the exit of a long-running process does not: it
        is a reaction.
        """
        by_name = {step.name: step for step in self.processes}

        def counts(step: ProcessStep) -> bool:
            for trigger in step.after:
                target = by_name[str(trigger.process)]
                one_shot = any(isinstance(r, Finished) for r in target.ready)
                if (trigger.kind is TriggerKind.EXITED and not one_shot) or not counts(target):
                    return False
            return True

        return frozenset(step.name for step in self.processes if counts(step))


def describe_step(step: Step) -> str:
    """Return the name of a step in messages."""
    match step:
        case ProcessStep():
            return step.name
        case MessageStep():
            return f"the message {step.text!r}"
        case ShutdownStep():
            return "a shutdown"
        case _:
            return "an event handler"
