"""Starts the processes of a plan on this machine."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from launch_py.child_environment import for_program
from launch_py.plan import GeneratedFile, ProcessStep
from launch_py.readiness import Probe
from launch_py.supervision.child_process import ChildProcess, ChildSpec
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.log_folder import LogFolder
from launch_py.supervision.probe_client import ProbeClient


class LocalRunner:
    """Gives each process its environment, its generated files and its probes.

    Args:
        loop: the event loop.
        environment: what every process gets.
        logs: the folder for generated files.
        probes: watches conditions.
        look_at_segments: called while processes live that may not end in order: when all are
            ready, and before SIGKILL is sent to one.
    """

    def __init__(
        self,
        loop: EventLoop,
        environment: Mapping[str, str],
        logs: LogFolder,
        probes: ProbeClient,
        look_at_segments: Callable[[], None],
    ) -> None:
        self._loop = loop
        self._environment = environment
        self._logs = logs
        self._probes = probes
        self._look_at_segments = look_at_segments

    def start(
        self,
        step: ProcessStep,
        on_line: Callable[[str, str], None],
        on_end: Callable[[int], None],
    ) -> ChildProcess:
        """Start the process of a step.

        Raises:
            StartError: it cannot be started.
        """
        command = [self._word(step, i, word) for i, word in enumerate(step.command)]
        environment = for_program(command[0], self._merged_environment(step))
        spec = ChildSpec(command, environment, step.cwd, step.emulate_tty)
        return ChildProcess(self._loop, spec, on_line, on_end, self._look_at_segments)

    def watch(
        self,
        step: ProcessStep,
        condition: Probe,
        on_met: Callable[[], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Call back once the condition is met, or can never be; return how to stop watching."""
        return self._probes.watch(condition, self._merged_environment(step), on_met, on_failed)

    def settled(self) -> None:
        """End the probes that nothing waits for; a later condition starts a new one."""
        self._look_at_segments()
        self._probes.close_idle()

    def _merged_environment(self, step: ProcessStep) -> dict[str, str]:
        inherited = {} if step.replace_environment else self._environment
        merged = {**inherited, **step.environment}
        return {name: value for name, value in merged.items() if value is not None}

    def _word(self, step: ProcessStep, index: int, word: str | GeneratedFile) -> str:
        if isinstance(word, str):
            return word
        return str(self._logs.generate(f"{step.name}-{index}{word.suffix}", word.text))
