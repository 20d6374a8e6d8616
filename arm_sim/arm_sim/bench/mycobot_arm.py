"""An emulated myCobot 280 behind its serial protocol.

`python -m arm_sim.bench.mycobot_arm --port /tmp/mycobot` runs it for `hardware:=mycobot_280
port:=/tmp/mycobot`. The frames are written here once more, so that the driver is not its own judge.
"""

import sys
from collections.abc import Iterator, Sequence

from arm_sim.bench.serial_device import TimedBytes, run_emulator

LIMITS_DEGREES = ((-168, 168), (-140, 140), (-150, 150), (-150, 150), (-155, 160), (-180, 180))
DEGREES_PER_S = 1.6
"""For each step of the speed, from 1 to 100."""
ANSWER_S = 0.002


class EmulatedMyCobot:
    """The arm: it moves towards its goals, and refuses angles outside its limits.

    Attributes:
        baud: of the line.
        angles: in degrees; set them to move the arm by hand.
        powered: whether the servos hold.
        power_fails: whether it does not power on, as with the emergency stop pressed.
        gripper: from 0, closed, to 100, open.
        error: what it reports as its error.
        queue_mode: whether it queues goals instead of taking the newest one.
    """

    def __init__(self, baud: int = 115_200) -> None:
        self.baud = baud
        self.angles = [0.0] * 6
        self.powered = True
        self.power_fails = False
        self.gripper = 100
        self.error = 0
        self.queue_mode = True
        self._goals = list(self.angles)
        self._speed = 0.0
        self._rest = b""
        self._last_s: float | None = None

    def receive(self, data: bytes, now_s: float) -> list[TimedBytes]:
        """Answer requests; see `SerialDevice`."""
        period_s = now_s - self._last_s if self._last_s is not None else 0.0
        self._last_s = now_s
        reach = self._speed * period_s if self.powered else 0.0
        self.angles = [
            angle + min(max(goal - angle, -reach), reach)
            for angle, goal in zip(self.angles, self._goals, strict=True)
        ]
        self._rest += data
        return [
            TimedBytes(_framed(command, reply), ANSWER_S)
            for command, request in self._requests()
            if (reply := self._answer(command, request)) is not None
        ]

    def shorten(self, reply: bytes) -> bytes:
        """Return a well-formed reply that lacks the last byte; see `SerialDevice`."""
        return _framed(reply[3], reply[4:-2])

    def _requests(self) -> Iterator[tuple[int, bytes]]:
        while (start := self._rest.find(b"\xfe\xfe")) >= 0:
            frame = self._rest[start:]
            if len(frame) < 3 or len(frame) < frame[2] + 3:
                self._rest = frame
                return
            size = frame[2] + 3
            sound = frame[2] >= 2 and frame[size - 1] == 0xFA
            self._rest = frame[size if sound else 1 :]
            if sound:
                yield frame[3], frame[4 : size - 1]

    def _answer(self, command: int, data: bytes) -> bytes | None:
        if command == 0x10:
            self.powered = not self.power_fails
        elif command == 0x13:
            self.powered = False
        elif command == 0x16:
            self.queue_mode = data != b"\x01"
        elif command == 0x22:
            self._take_goals(data)
        elif command == 0x67:
            self.gripper = data[0]
        replies = {
            0x07: bytes((self.error,)),
            0x12: bytes((self.powered,)),
            0x20: b"".join(round(100 * a).to_bytes(2, "big", signed=True) for a in self.angles),
            0x65: bytes((self.gripper,)),
        }
        acknowledged = (0x10, 0x13, 0x16, 0x22, 0x67)
        return b"\x01" if command in acknowledged else replies.get(command)

    def _take_goals(self, data: bytes) -> None:
        goals = [
            int.from_bytes(data[at : at + 2], "big", signed=True) / 100 for at in range(0, 12, 2)
        ]
        for place, (goal, (low, high)) in enumerate(zip(goals, LIMITS_DEGREES, strict=True)):
            if not low <= goal <= high:
                self.error = place + 1
                return
        self._goals = goals
        self._speed = DEGREES_PER_S * data[12]


def _framed(command: int, data: bytes) -> bytes:
    return b"\xfe\xfe" + bytes((len(data) + 2, command)) + data + b"\xfa"


def main(argv: Sequence[str] | None = None) -> int:
    """Run until a signal."""
    return run_emulator("a myCobot 280", EmulatedMyCobot(), "/tmp/mycobot", argv)


if __name__ == "__main__":
    sys.exit(main())
