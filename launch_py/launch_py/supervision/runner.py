"""Starts the processes of a plan on this machine."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping

from launch_py.output.log_folder import LogFolder
from launch_py.plan.readiness import ProbedCondition
from launch_py.plan.steps import GeneratedFile, ProcessStep
from launch_py.supervision.child_process import ChildProcess, ChildSpec
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.probe_client import ProbeClient
from launch_py.system.child_environment import for_program


class LocalRunner:
    """Gives each process its environment, its generated files and its probes.

    Args:
        loop: the event loop.
        environment: the variables that every process gets.
        logs: the folder for generated files.
        probes: watches conditions.
        observe_segments: called before SIGKILL is sent to a process, which then leaves its
            shared-memory files.
        on_settled: called when everything is ready.
    """

    def __init__(
        self,
        loop: EventLoop,
        environment: Mapping[str, str],
        logs: LogFolder,
        probes: ProbeClient,
        observe_segments: Callable[[], None],
        on_settled: Callable[[], None],
    ) -> None:
        self.sessions: set[int] = set()
        """The session of every process that was started; each process leads its own."""
        self._loop = loop
        self._environment = environment
        self._logs = logs
        self._probes = probes
        self._observe_segments = observe_segments
        self._on_settled = on_settled

    def start(
        self,
        step: ProcessStep,
        on_line: Callable[[str, str], None],
        on_end: Callable[[int], None],
    ) -> ChildProcess:
        """Start the process of a step.

        Raises:
            StartError: the process cannot be started.
        """
        command = [self._word(step, i, word) for i, word in enumerate(step.command)]
        environment = for_program(command[0], self.environment_of(step))
        spec = ChildSpec(command, environment, step.cwd, step.emulate_tty)
        child = ChildProcess(self._loop, spec, on_line, on_end, self._observe_segments)
        self.sessions.add(child.pid)
        return child

    def watch(
        self,
        step: ProcessStep,
        condition: ProbedCondition,
        on_met: Callable[[], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Call back once the condition is met or can never be; return a function to stop that."""
        environment = for_program(sys.executable, self.environment_of(step))
        return self._probes.watch(condition, environment, on_met, on_failed)

    def settled(self) -> None:
        """Report that everything is ready."""
        self._on_settled()

    def environment_of(self, step: ProcessStep) -> dict[str, str]:
        """Return the environment of a step's process, before it is adapted to the program."""
        inherited = {} if step.replace_environment else self._environment
        merged = {**inherited, **step.environment}
        return {name: value for name, value in merged.items() if value is not None}

    def _word(self, step: ProcessStep, index: int, word: str | GeneratedFile) -> str:
        if isinstance(word, str):
            return word
        return str(self._logs.generate(f"{step.name}-{index}{word.suffix}", word.text))
