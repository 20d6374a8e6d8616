"""The executable `fake_servo`: simulates motors behind a pseudo-terminal."""

import argparse
import contextlib
import os
import sys
import time
import tty
from collections.abc import Iterator, Sequence
from pathlib import Path

INERTIA = 0.02
FRICTION = 0.1
STEP_S = 0.002
WATCHDOG_S = 0.5
"""Without a command for this long the motors switch off, in case the program has crashed."""


class Motors:
    """Motors with inertia and friction, in real time."""

    def __init__(self, joints: int, now_s: float) -> None:
        self._positions = [0.0] * joints
        self._velocities = [0.0] * joints
        self._efforts = [0.0] * joints
        self._is_on = False
        self._time_s = self._commanded_s = now_s

    def answer(self, request: str, now_s: float) -> str:
        """Execute a line of the protocol and return the answer."""
        self._advance(now_s)
        match request.split():
            case ["get"]:
                pairs = zip(self._positions, self._velocities, strict=True)
                return " ".join(f"{position:.6f} {velocity:.6f}" for position, velocity in pairs)
            case ["set", *words] if len(words) == len(self._efforts):
                try:
                    self._efforts = [float(word) for word in words]
                except ValueError:
                    return f"error: not numbers: {request}"
                self._commanded_s = now_s
                return "ok"
            case ["on" | "off" as word]:
                self._is_on = word == "on"
                self._efforts = [0.0] * len(self._efforts)
                self._commanded_s = now_s
                return "ok"
        return f"error: unknown: {request}"

    def _advance(self, now_s: float) -> None:
        while self._time_s + STEP_S <= now_s:
            self._time_s += STEP_S
            is_driven = self._is_on and self._time_s <= self._commanded_s + WATCHDOG_S
            for i, effort in enumerate(self._efforts):
                drive = effort if is_driven else 0.0
                velocity = self._velocities[i]
                velocity += STEP_S * (drive - FRICTION * velocity) / INERTIA
                self._velocities[i] = velocity
                self._positions[i] += STEP_S * velocity


def serve(port: int, joints: int) -> None:
    """Answer every line that arrives at a port, for ever."""
    motors = Motors(joints, time.monotonic())
    received = b""
    while True:
        received += os.read(port, 1024)
        *lines, received = received.split(b"\n")
        for line in lines:
            answer = motors.answer(line.decode(errors="replace"), time.monotonic())
            os.write(port, f"{answer}\n".encode())


@contextlib.contextmanager
def pseudo_terminal(link: Path) -> Iterator[int]:
    """Open a pseudo-terminal, link its slave end at `link`, and yield its master end."""
    master, slave = os.openpty()
    # Keep the slave end open here as well; otherwise the master fails while it has no client.
    tty.setraw(slave)
    link.unlink(missing_ok=True)
    link.symlink_to(os.ttyname(slave))
    try:
        yield master
    finally:
        link.unlink(missing_ok=True)
        os.close(slave)
        os.close(master)


def main(argv: Sequence[str] | None = None) -> int:
    """Run until a signal."""
    parser = argparse.ArgumentParser(description="Simulated servos on a pseudo-terminal.")
    parser.add_argument(
        "--link", type=Path, default=Path("/tmp/servo_arm"), help="path of the port"
    )
    parser.add_argument("--joints", type=int, default=2, help="number of servos")
    options = parser.parse_args(argv)
    with pseudo_terminal(options.link) as port, contextlib.suppress(KeyboardInterrupt):
        sys.stdout.write(f"{options.joints} servos at {options.link}\n")
        sys.stdout.flush()
        serve(port, options.joints)
    return 0


if __name__ == "__main__":
    sys.exit(main())
