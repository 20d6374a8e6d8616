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
from contextlib import suppress
from dataclasses import asdict, dataclass
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
    """

    def __init__(self, loop: EventLoop, log_file: Path) -> None:
        self._loop = loop
        self._log_file = log_file
        self._processes: list[_ProbeProcess] = []

    def watch(
        self,
        condition: Probe,
        environment: Mapping[str, str],
        on_met: Callable[[], None],
        on_failed: Callable[[str], None],
    ) -> Callable[[], None]:
        """Call back once the condition is met, seen from a process with this environment.

        Args:
            condition: what is watched for.
            environment: that of the process.
            on_met: called when the condition is met.
            on_failed: called instead, with the reason, where that can never be known.

        Returns:
            A function that stops watching.
        """
        domain = environment.get("ROS_DOMAIN_ID", "")
        open_ones = (p for p in self._processes if p.domain == domain and not p.closed)
        process = next(open_ones, None)
        if process is None:
            process = _ProbeProcess(self._loop, domain, environment, self._log_file)
            self._processes.append(process)
        return process.watch(condition, _Watch(on_met, on_failed))

    @property
    def pids(self) -> set[int]:
        """The process ids of the running probes."""
        return {process.pid for process in self._processes if not process.ended}

    def reap(self) -> None:
        """Notice ended probes; to be called when SIGCHLD has come."""
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
    """Whom to tell what has become of a condition."""

    on_met: Callable[[], None]
    on_failed: Callable[[str], None]


class _ProbeProcess:
    """One running probe: a line of JSON for each condition in, one for each that is met out."""

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
                preexec_fn=linux.death_pact(),
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

    def watch(self, condition: Probe, watch: _Watch) -> Callable[[], None]:
        number = next(self._ids)
        self._watched[number] = watch
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
        self._stdin.close()

    def _send(self, message: Mapping[str, object]) -> None:
        if not self.closed:
            with suppress(BrokenPipeError):  # Then its output ends, too.
                self._stdin.write(json.dumps(message).encode() + b"\n")

    def _read(self) -> None:
        data = os.read(self._stdout.fileno(), 65536)
        if not data:
            self._end()
        for line in self._splitter.feed(data):
            answer = json.loads(line)
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
