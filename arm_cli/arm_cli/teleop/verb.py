"""`arm teleop`: moves the running robot with keys or a gamepad."""

import argparse
import os
import select
import sys
import termios
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from arm_cli.arguments import verb
from arm_cli.errors import UnansweredError
from arm_cli.output import complain, say, say_in_place
from arm_cli.ros.connection import connect
from arm_cli.stop import EmergencyStop
from arm_cli.teleop.motions import HELP, Keyboard, Motion, keys_of
from arm_node.environment import PLANNING_PACKAGES

if TYPE_CHECKING:
    from arm_cli.ros.session import CommandSession
    from arm_cli.teleop.ros_jog import JogClient

PERIOD_S = 0.04
"""Between two commands; servo_node stops after 0.1 s without one."""
HELD_S = 0.12
"""How long a key counts as held. Terminals do not say when it is released; they repeat it."""
READ_BYTES = 1024


@verb(epilog="The keys are printed when it starts. A gamepad needs joy_node, which publishes /joy.")
def teleop(_options: argparse.Namespace) -> None:
    """Jog the robot with the keys of this terminal, and with what publishes /joy."""
    with connect(packages=PLANNING_PACKAGES) as session:
        from arm_cli.teleop.ros_jog import JogClient

        client = JogClient(session)
        keyboard = Keyboard(client.group.joints)
        with _keys(sys.stdin.fileno()) as read_keys:
            _begin(client, is_terminal=sys.stdin.isatty())
            _Teleop(session, client, keyboard).run(read_keys)


def _begin(client: "JogClient", *, is_terminal: bool) -> None:
    say(f"group '{client.group.name}' is jogged")
    for line in HELP.splitlines() if is_terminal else ["no terminal: only /joy moves the robot"]:
        say(line)
    joints = client.group.joints[:9]
    say("joints: " + ", ".join(f"{i} {joint}" for i, joint in enumerate(joints, 1)))
    say("gamepad: run joy_node and hold the left shoulder button")


@contextmanager
def _keys(fd: int) -> Iterator[Callable[[], list[str] | None]]:
    """Yield a function that returns the keys typed since its last call, None after the end."""
    if not os.isatty(fd):
        yield list
        return

    def read() -> list[str] | None:
        if not select.select([fd], [], [], 0.0)[0]:
            return []
        typed = os.read(fd, READ_BYTES)
        return keys_of(typed.decode(errors="ignore")) if typed else None

    before = termios.tcgetattr(fd)
    tty.setcbreak(fd)
    try:
        yield read
    finally:
        with suppress(termios.error):
            termios.tcsetattr(fd, termios.TCSADRAIN, before)


class _Teleop:
    """The loop of keys, gamepad and commands."""

    def __init__(self, session: "CommandSession", client: "JogClient", keyboard: Keyboard) -> None:
        self._session, self._client, self._keyboard = session, client, keyboard
        self._held: tuple[float, Motion] | None = None
        self._shown = ""

    def run(self, read_keys: Callable[[], list[str] | None]) -> None:
        """Move the robot until `q`, Ctrl-C or the end of the terminal."""
        due_s = 0.0
        while True:
            self._session.spin_once()
            keys = read_keys()
            if keys is None or "q" in keys:
                say("")
                return
            for key in keys:
                self._press(key)
            if (now_s := time.monotonic()) >= due_s:
                due_s = now_s + PERIOD_S
                self._command(now_s)
                self._show()

    def _press(self, key: str) -> None:
        if key == " ":
            self._held, self._shown = None, ""
            say("")
            try:
                EmergencyStop(self._session, engaged=True).call_all()
            except UnansweredError as error:
                complain(f"arm teleop: {error}")
            else:
                say("stopped; `arm stop --release` lets the robot move again")
            return
        motion = self._keyboard.press(key)
        if motion is not None:
            self._held = time.monotonic(), motion

    def _command(self, now_s: float) -> None:
        if self._held is not None and now_s - self._held[0] > HELD_S:
            self._held = None
        motion = self._held[1] if self._held is not None else self._client.gamepad()
        if motion is not None:
            self._client.send(motion, self._keyboard.in_tip_frame)

    def _show(self) -> None:
        said = self._client.problem or self._client.status
        line = self._keyboard.describe() + (f": {said}" if said else "")
        if line != self._shown:
            self._shown = line
            say_in_place(line)
