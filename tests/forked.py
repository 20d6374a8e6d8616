"""Python programs of tests that begin with rclpy imported: forks of a process that has imported it.

An interpreter needs 0.3 s of a processor until it has imported rclpy, more than what most of these
programs then do. A fork has an identity, signals, standard streams and an end of its own, as any
process; only its imports are done. What must not be so is started by `subprocess` as before:
a program whose environment may change what an import does, and `arm launch`, which starts others.
"""

import atexit
import gc
import json
import os
import queue
import re
import runpy
import selectors
import shlex
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NoReturn

HARMLESS = {
    "FASTRTPS_DEFAULT_PROFILES_FILE",
    "PATH",
    "PYTHONUNBUFFERED",
    "ROS_DOMAIN_ID",
    "ROS_HOME",
    "ROS_LOG_DIR",
    *("PYTEST_ADDOPTS", "PYTEST_CURRENT_TEST", "PYTEST_VERSION"),
    "TERM",
}
"""Variables of the environment that no import reads."""
QUOTED = re.compile(r"'[^']*'|\"[^\"$`\\]*\"")
"""What means the same to a shell and to `shlex`."""
MESSAGE_BYTES = 1 << 18
STREAMS = 3


def popen(
    command: Sequence[str | Path],
    environment: Mapping[str, str],
    *,
    stdin: int = subprocess.DEVNULL,
    stderr: int = subprocess.STDOUT,
    cwd: Path | str | None = None,
) -> Any:
    """Start a program, with pipes from its output; return its `Popen`, or what serves as one.

    Its `stdin` is a pipe, or ends at once.
    """
    words = [os.fspath(word) for word in command]
    server = _server()
    if _is_python(words) and server.has_imported_for(environment):
        return ForkedProcess(server, words[1:], environment, stdin, stderr, cwd)
    return subprocess.Popen(
        words,
        stdin=stdin,
        stdout=subprocess.PIPE,
        stderr=stderr,
        env=dict(environment),
        cwd=cwd,
        text=True,
        errors="replace",
    )


def words_of_arm(line: str) -> list[str]:
    """Return the words of a command line of `arm`, none where it needs a shell."""
    if not line.startswith("arm ") or set(QUOTED.sub("", line)) & set("|&;<>()$`*?~'\""):
        return []
    return [sys.executable, "-m", "arm_cli", *shlex.split(line)[1:]]


def _is_python(words: Sequence[str]) -> bool:
    """Whether these are the words of a Python module or script."""
    if words[0] != sys.executable or len(words) < 2 or words[2:4] == ["arm_cli", "launch"]:
        return False
    return words[1] == "-m" or not words[1].startswith("-")


class ForkedProcess:
    """What `subprocess.Popen` is for others."""

    def __init__(
        self,
        server: "Server",
        words: Sequence[str],
        environment: Mapping[str, str],
        stdin: int,
        stderr: int,
        cwd: Path | str | None,
    ) -> None:
        self._server = server
        self.args = words
        self.returncode: int | None = None
        read_in, write_in = os.pipe() if stdin == subprocess.PIPE else (_null(), None)
        read_out, write_out = os.pipe()
        both = stderr == subprocess.STDOUT
        read_err, write_err = (None, os.dup(write_out)) if both else os.pipe()
        given = (read_in, write_out, write_err)
        try:
            self.pid = server.fork(words, environment, os.fspath(cwd or os.getcwd()), given)
        finally:
            for descriptor in given:
                os.close(descriptor)
        self.stdin = _opened(write_in, "w")
        self.stdout = _opened(read_out, "r")
        self.stderr = _opened(read_err, "r")

    def poll(self) -> int | None:
        """Return the exit code, None as long as it runs."""
        self.returncode = self._server.code_of(self.pid, 0.0)
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait for its end; return the exit code."""
        self.returncode = self._server.code_of(self.pid, timeout)
        if self.returncode is None:
            raise subprocess.TimeoutExpired(list(self.args), timeout or 0.0)
        return self.returncode

    def send_signal(self, number: int) -> None:
        """Send a signal, unless it has ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def terminate(self) -> None:
        """Send SIGTERM."""
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """Send SIGKILL."""
        self.send_signal(signal.SIGKILL)


def _null() -> int:
    return os.open(os.devnull, os.O_RDONLY)


def _opened(descriptor: int | None, mode: str) -> Any:
    return None if descriptor is None else os.fdopen(descriptor, mode, errors="replace")


class Server:
    """The process that forks, seen from the tests. Any thread."""

    def __init__(self) -> None:
        self._environment = dict(os.environ)
        self._socket, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with far:
            words = [sys.executable, __file__, str(far.fileno())]
            self._process = subprocess.Popen(
                words, stdin=subprocess.DEVNULL, pass_fds=[far.fileno()]
            )
        self._asking = threading.Lock()
        self._forked: queue.Queue[int] = queue.Queue()
        self._codes: dict[int, int] = {}
        self._changed = threading.Condition()
        threading.Thread(target=self._listen, daemon=True).start()

    def has_imported_for(self, environment: Mapping[str, str]) -> bool:
        """Whether what it has imported is what a program with this environment would import."""
        names = self._environment.keys() | environment.keys()
        differ = {n for n in names if self._environment.get(n) != environment.get(n)}
        return differ <= HARMLESS

    def fork(
        self, words: Sequence[str], environment: Mapping[str, str], cwd: str, streams: Sequence[int]
    ) -> int:
        """Return the id of a new process that runs these words after the interpreter's."""
        request = json.dumps({"words": list(words), "environment": dict(environment), "cwd": cwd})
        with self._asking:
            socket.send_fds(self._socket, [request.encode()], list(streams))
            pid = self._forked.get(timeout=60.0)
        return pid

    def code_of(self, pid: int, timeout_s: float | None) -> int | None:
        """Return a process's exit code, None if it has not ended in this time."""
        with self._changed:
            self._changed.wait_for(lambda: pid in self._codes, timeout_s)
            return self._codes.get(pid)

    def close(self) -> None:
        """End it."""
        self._socket.shutdown(socket.SHUT_RDWR)
        self._process.wait()

    def _listen(self) -> None:
        while answer := self._socket.recv(MESSAGE_BYTES):
            pid, code = json.loads(answer)
            with self._changed:
                if code is None:
                    self._codes.pop(pid, None)  # of an earlier process with this id
                    self._forked.put(pid)
                else:
                    self._codes[pid] = code
                    self._changed.notify_all()


@cache
def _server() -> Server:
    server = Server()
    atexit.register(server.close)
    return server


def serve(control: socket.socket) -> tuple[dict[str, Any], list[int]] | None:
    """Fork for each request; return it and its streams in the fork, and None in the end."""
    wake, woken = os.pipe()
    os.set_blocking(woken, False)
    os.set_blocking(wake, False)
    signal.set_wakeup_fd(woken, warn_on_full_buffer=False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with selectors.DefaultSelector() as selector:
        selector.register(control, selectors.EVENT_READ)
        selector.register(wake, selectors.EVENT_READ)
        while True:
            for key, _ in selector.select():
                if key.fileobj is control:
                    request, streams, *_ = socket.recv_fds(control, MESSAGE_BYTES, STREAMS)
                    if not request:
                        return None
                    pid = os.fork()
                    if pid == 0:
                        signal.set_wakeup_fd(-1)
                        os.close(wake)
                        os.close(woken)
                        return json.loads(request), streams
                    for stream in streams:
                        os.close(stream)
                    control.send(json.dumps([pid, None]).encode())
                else:
                    os.read(wake, 4096)
                    for pid, code in _ended():
                        control.send(json.dumps([pid, code]).encode())


def _ended() -> list[tuple[int, int]]:
    ended: list[tuple[int, int]] = []
    while True:
        try:
            pid, status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return ended
        if pid == 0:
            return ended
        ended.append((pid, os.waitstatus_to_exitcode(status)))


def become(request: Mapping[str, Any], streams: Sequence[int]) -> None:
    """Run a request's program in this process, as its main program."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
        os.close(stream)
    os.environ.clear()
    os.environ.update(request["environment"])
    os.chdir(request["cwd"])
    sys.stdin = sys.__stdin__ = os.fdopen(0, encoding="utf-8", closefd=False)
    sys.stdout = sys.__stdout__ = os.fdopen(1, "w", encoding="utf-8", closefd=False)
    sys.stdout.reconfigure(write_through=bool(os.environ.get("PYTHONUNBUFFERED")))
    sys.stderr = sys.__stderr__ = os.fdopen(
        2, "w", 1, encoding="utf-8", errors="backslashreplace", closefd=False
    )
    words = request["words"]
    if words[0] == "-m":
        sys.argv = words[1:]
        sys.path[0] = request["cwd"]
        runpy.run_module(words[1], run_name="__main__", alter_sys=True)
    else:
        sys.argv = words
        sys.path[0] = str(Path(words[0]).resolve().parent)
        runpy.run_path(words[0], run_name="__main__")


def main() -> NoReturn:
    """Import, serve, and in a fork be its program."""
    control = socket.socket(fileno=int(sys.argv[1]))
    import arm_cli.ros.session  # noqa: F401

    gc.freeze()
    forked = serve(control)
    control.close()
    if forked is not None:
        become(*forked)
    sys.exit(0)


if __name__ == "__main__":
    main()
