"""The supervisor's end of the probe process, which watches topics, services and web pages.

The probe is a process of its own, started only where a condition needs it: rclpy brings threads,
100 MB and shared-memory files, none of which the supervisor should have.
"""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path

from launch_py.readiness import Probe
from launch_py.supervision import linux
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.line_splitter import LineSplitter

PROBE_COMMAND = (sys.executable, "-P", "-c", "from launch_py.ros.probe import main; main()")


class ProbeClient:
    """Watches conditions by probe processes, one for each ROS domain; belongs to the loop's thread.

    Args:
        loop: the event loop.
        log_file: where a probe's own complaints go.
        on_message: called with what a probe has to say to the user.
    """

    def __init__(self, loop: EventLoop, log_file: Path, on_message: Callable[[str], None]) -> None:
        self._loop = loop
        self._log_file = log_file
        self._on_message = on_message
        self._processes: dict[str, _ProbeProcess] = {}

    def watch(
        self, condition: Probe, environment: Mapping[str, str], on_met: Callable[[], None]
    ) -> Callable[[], None]:
        """Call back once the condition is met, seen from a process with this environment.

        Returns:
            A function that stops watching.
        """
        domain = environment.get("ROS_DOMAIN_ID", "")
        process = self._processes.get(domain)
        if process is None or process.ended:
            process = _ProbeProcess(self._loop, environment, self._log_file, self._on_message)
            self._processes[domain] = process
        return process.watch(condition, on_met)

    @property
    def pids(self) -> set[int]:
        """The process ids of the running probes."""
        return {process.pid for process in self._processes.values() if not process.ended}

    def reap(self) -> None:
        """Notice ended probes; to be called when SIGCHLD has come."""
        for process in self._processes.values():
            process.reap()

    def close(self) -> None:
        """End all probes."""
        for process in self._processes.values():
            process.close()


class _ProbeProcess:
    """One running probe: a line of JSON for each condition in, one for each that is met out."""

    def __init__(
        self,
        loop: EventLoop,
        environment: Mapping[str, str],
        log_file: Path,
        on_message: Callable[[str], None],
    ) -> None:
        self.ended = False
        self._loop = loop
        self._on_message = on_message
        self._ids = itertools.count()
        self._watched: dict[int, Callable[[], None]] = {}
        self._splitter = LineSplitter()
        with log_file.open("ab") as log:
            self._process = subprocess.Popen(
                PROBE_COMMAND,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                env=environment,
                start_new_session=True,
                preexec_fn=linux.death_pact(),
            )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self.pid = self._process.pid
        self._stdin = self._process.stdin
        self._stdout = self._process.stdout
        os.set_blocking(self._stdout.fileno(), False)
        loop.add_reader(self._stdout.fileno(), self._read)

    def watch(self, condition: Probe, on_met: Callable[[], None]) -> Callable[[], None]:
        number = next(self._ids)
        self._watched[number] = on_met
        self._send({"id": number, "kind": type(condition).__name__, **asdict(condition)})

        def stop_watching() -> None:
            if self._watched.pop(number, None) is not None:
                self._send({"id": number, "kind": "Forget"})

        return stop_watching

    def reap(self) -> None:
        if self._process.poll() is not None and not self.ended:
            self._end()

    def close(self) -> None:
        """Ask the probe to end, which it does when its standard input ends."""
        if not self.ended and not self._stdin.closed:
            self._stdin.close()

    def _send(self, message: Mapping[str, object]) -> None:
        if self.ended or self._stdin.closed:
            return
        try:
            self._stdin.write(json.dumps(message).encode() + b"\n")
            self._stdin.flush()
        except BrokenPipeError:
            self._on_message("the probe for readiness conditions has ended unexpectedly")

    def _read(self) -> None:
        data = os.read(self._stdout.fileno(), 65536)
        if not data:
            self._end()
        for line in self._splitter.feed(data):
            message = json.loads(line)
            if "error" in message:
                self._on_message(message["error"])
            on_met = self._watched.pop(message.get("id", -1), None)
            if on_met is not None:
                on_met()

    def _end(self) -> None:
        if not self.ended:
            self.ended = True
            self._loop.remove_reader(self._stdout.fileno())
            self._stdout.close()
            self._stdin.close()
