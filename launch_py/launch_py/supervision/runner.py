"""Starts the processes of a plan on this machine, and the probes that watch for their readiness.

A probe watches topics, services and web pages. It is a process of its own, started only if a
condition needs it: rclpy brings threads, 100 MB and shared-memory files, which the supervisor
should not have.
"""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from launch_py.plan.readiness import ProbedCondition
from launch_py.plan.steps import GeneratedFile, ProcessStep
from launch_py.screen.log_folder import LogFolder
from launch_py.supervision import linux
from launch_py.supervision.child_process import ChildProcess, ChildSpec, LineSplitter
from launch_py.supervision.event_loop import EventLoop
from launch_py.system.child_environment import for_program

PROBE_COMMAND = (sys.executable, "-P", "-c", "from launch_py.ros.probe import main; main()")


class ProbeClient:
    """Watches conditions by probe processes, one for each ROS domain; belongs to the loop's thread.

    `log_file` receives the stderr of the probes.
    """

    def __init__(self, loop: EventLoop, log_file: Path) -> None:
        self._loop = loop
        self._log_file = log_file
        self._processes: list[_ProbeProcess] = []

    def watch(
        self,
        condition: ProbedCondition,
        environment: Mapping[str, str],
        on_met: Callable[[], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Watch a condition from a process with this environment; return a function to stop that.

        `on_met` is called when it is met, or `on_failed`, with the reason, if it cannot be watched.
        """
        fields = {"kind": type(condition).__name__, **asdict(condition)}
        return self._process_for(environment).watch(fields, _Watch(on_met, on_failed))

    def watch_nodes(
        self,
        environment: Mapping[str, str],
        on_seen: Callable[[Mapping[str, Any]], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Call back with the graph's nodes now and at each change; return a function to stop that.

        The nodes are those of `find_nodes` of `launch_py.ros.probe`. `on_failed` is called instead,
        with the reason, if the graph cannot be watched from this environment.
        """
        watch = _Watch(lambda: None, on_failed, on_seen)
        return self._process_for(environment).watch({"kind": "Nodes"}, watch)

    def _process_for(self, environment: Mapping[str, str]) -> _ProbeProcess:
        domain = environment.get("ROS_DOMAIN_ID", "")
        open_ones = (p for p in self._processes if p.domain == domain and not p.closed)
        process = next(open_ones, None)
        if process is None:
            process = _ProbeProcess(self._loop, domain, environment, self._log_file)
            self._processes.append(process)
        return process

    @property
    def pids(self) -> set[int]:
        """The process ids of the running probes."""
        return {process.pid for process in self._processes if not process.ended}

    def reap(self) -> None:
        """Check which probes have ended. Call it after SIGCHLD."""
        for process in self._processes:
            process.reap()

    def close_idle(self) -> None:
        """End the probes that have nothing to watch."""
        for process in self._processes:
            if process.idle:
                process.close()

    def close(self) -> None:
        """End all probes."""
        for process in self._processes:
            process.close()


@dataclass(frozen=True, slots=True)
class _Watch:
    """The callbacks of one watched condition."""

    on_met: Callable[[], None]
    on_failed: Callable[[str], None]
    on_seen: Callable[[Mapping[str, Any]], None] = lambda _: None


class _ProbeProcess:
    """One running probe process; see `launch_py.ros.probe` for its protocol."""

    def __init__(
        self,
        loop: EventLoop,
        domain: str,
        environment: Mapping[str, str],
        log_file: Path,
    ) -> None:
        self.ended = False
        self.domain = domain
        self._loop = loop
        self._log_file = log_file
        self._ids = itertools.count()
        self._watched: dict[int, _Watch] = {}
        self._splitter = LineSplitter()
        with log_file.open("ab") as log:
            self._process = subprocess.Popen(
                PROBE_COMMAND,
                bufsize=0,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                env=environment,
                start_new_session=True,
                preexec_fn=linux.kill_with_parent(),
            )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self.pid = self._process.pid
        self._stdin = self._process.stdin
        self._stdout = self._process.stdout
        os.set_blocking(self._stdout.fileno(), False)
        loop.add_reader(self._stdout.fileno(), self._read)

    @property
    def closed(self) -> bool:
        return self._stdin.closed

    @property
    def idle(self) -> bool:
        return not self._watched

    def watch(self, fields: Mapping[str, object], watch: _Watch) -> Callable[[], None]:
        number = next(self._ids)
        self._watched[number] = watch
        self._send({"id": number, **fields})

        def stop_watching() -> None:
            if self._watched.pop(number, None) is not None:
                self._send({"id": number, "kind": "Forget"})

        return stop_watching

    def reap(self) -> None:
        if self._process.poll() is not None and not self.ended:
            self._end()

    def close(self) -> None:
        """Ask the probe to end, which it does when its standard input ends."""
        self._stdin.close()

    def _send(self, message: Mapping[str, object]) -> None:
        if not self.closed:
            with suppress(BrokenPipeError):  # Its output then ends too, which `_read` handles.
                self._stdin.write(json.dumps(message).encode() + b"\n")

    def _read(self) -> None:
        data = os.read(self._stdout.fileno(), 65536)
        if not data:
            self._end()
        for line in self._splitter.feed(data):
            answer = json.loads(line)
            if "seen" in answer:
                if watch := self._watched.get(answer["id"]):
                    watch.on_seen(answer["seen"])
                continue
            watch = self._watched.pop(answer["id"], None)
            if watch is None:
                continue
            if "error" in answer:
                watch.on_failed(answer["error"])
            else:
                watch.on_met()

    def _end(self) -> None:
        if self.ended:
            return
        self.ended = True
        self._loop.remove_reader(self._stdout.fileno())
        self._stdout.close()
        self._stdin.close()
        watched, self._watched = self._watched, {}
        for watch in watched.values():
            watch.on_failed(f"the probe that watches for it has ended; see {self._log_file}")


class LocalRunner:
    """Gives each process its environment, its generated files and its probes.

    `observe_segments` is called before SIGKILL is sent to a process, which then leaves its
    shared-memory files; `on_settled` when everything is ready.
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
