"""An emulated device behind a serial port: a pseudo terminal, paced bytes, faults, unplugging.

`run_emulator` is the command line of the programs that emulate one.
"""

import argparse
import contextlib
import heapq
import os
import random
import select
import signal
import sys
import termios
import threading
import time
import tty
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import count
from pathlib import Path
from types import TracebackType
from typing import Protocol

from arm_sim.errors import BenchError

BITS_PER_BYTE = 10
CHUNK = 4096
JOIN_TIMEOUT_S = 5.0


@dataclass(frozen=True, slots=True)
class TimedBytes:
    """Bytes that a device sends.

    Attributes:
        data: the bytes.
        delay_s: how long after the request, or after what it sent before.
    """

    data: bytes
    delay_s: float = 0.0


class SerialDevice(Protocol):
    """A device that answers requests. One thread.

    Attributes:
        baud: bits per second; the port delivers no faster. At another rate, if it is one of
            termios, the device is silent.
    """

    baud: int

    def receive(self, data: bytes, now_s: float) -> Sequence[TimedBytes]:
        """Take bytes from the line, and return what the device sends, in order."""
        ...

    def shorten(self, reply: bytes) -> bytes:
        """Return a well-formed reply that lacks the last byte of its data."""
        ...


@dataclass(slots=True)
class ReplyFaults:
    """Faults of replies, by chance.

    Attributes:
        rate: fraction of replies with a fault, from 0 to 1.
        kinds: which faults; each is as likely as any other.
        late_s: how much later a late reply comes.
        seed: of the random choice.
        counts: how often each fault has happened.
    """

    rate: float = 0.0
    kinds: tuple[str, ...] = ("lost", "damaged", "late", "doubled", "short", "noise")
    late_s: float = 0.03
    seed: int = 0
    counts: dict[str, int] = field(default_factory=dict)
    _random: random.Random = field(init=False)

    def __post_init__(self) -> None:
        unknown = sorted(set(self.kinds) - FAULTS.keys())
        if unknown:
            raise BenchError(f"no fault '{unknown[0]}' of replies; there are {', '.join(FAULTS)}")
        self._random = random.Random(self.seed)

    def apply(
        self, reply: TimedBytes, shorten: Callable[[bytes], bytes]
    ) -> list[tuple[TimedBytes, float]]:
        """Return what arrives of a reply, each with how much later than it should."""
        if self._random.random() >= self.rate:
            return [(reply, 0.0)]
        kind = self._random.choice(self.kinds)
        self.counts[kind] = self.counts.get(kind, 0) + 1
        return FAULTS[kind](self, reply, shorten)


def _damaged(faults: ReplyFaults, reply: TimedBytes) -> TimedBytes:
    chance = faults._random  # pyright: ignore[reportPrivateUsage]
    data = bytearray(reply.data)
    data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return replace(reply, data=bytes(data))


def _noisy(faults: ReplyFaults, reply: TimedBytes) -> TimedBytes:
    noise = faults._random.randbytes(faults._random.randint(1, 6))  # pyright: ignore[reportPrivateUsage]
    return replace(reply, data=noise + reply.data)


_Fault = Callable[
    [ReplyFaults, TimedBytes, Callable[[bytes], bytes]], list[tuple[TimedBytes, float]]
]
FAULTS: Mapping[str, _Fault] = {
    "lost": lambda faults, reply, shorten: [],
    "damaged": lambda faults, reply, shorten: [(_damaged(faults, reply), 0.0)],
    "late": lambda faults, reply, shorten: [(reply, faults.late_s)],
    "doubled": lambda faults, reply, shorten: [(reply, 0.0), (reply, 0.0)],
    "short": lambda faults, reply, shorten: [(replace(reply, data=shorten(reply.data)), 0.0)],
    "noise": lambda faults, reply, shorten: [(_noisy(faults, reply), 0.0)],
}


class EmulatedPort:
    """A serial port with an emulated device behind it, for a `with` block. Any thread.

    Attributes:
        path: of the port; a program opens it like /dev/ttyUSB0.
        faults: faults of the device's replies; may be replaced.
    """

    def __init__(self, device: SerialDevice, path: Path, faults: ReplyFaults | None = None) -> None:
        """Prepare the port; it exists as soon as it is plugged in."""
        self.path = path
        self.faults = faults or ReplyFaults()
        self._device = device
        self._thread: threading.Thread | None = None
        self._ends: tuple[int, int] | None = None
        self._wake = os.pipe()

    def __enter__(self) -> "EmulatedPort":
        self.plug()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.unplug()
        for end in self._wake:
            os.close(end)

    def plug(self) -> None:
        """Make the port appear.

        Raises:
            BenchError: the path cannot be made.
        """
        master, slave = os.openpty()
        tty.setraw(slave)
        os.set_blocking(master, False)
        try:
            self.path.unlink(missing_ok=True)
            self.path.symlink_to(os.ttyname(slave))
        except OSError as error:
            os.close(master)
            os.close(slave)
            raise BenchError(f"no port at {self.path}: {error.strerror}") from error
        self._ends = master, slave
        self._thread = threading.Thread(target=self._serve, args=(master, slave), daemon=True)
        self._thread.start()

    def unplug(self) -> None:
        """Make the port disappear, as when its plug is pulled."""
        if self._ends is None or self._thread is None:
            return
        os.write(self._wake[1], b"x")
        self._thread.join(JOIN_TIMEOUT_S)
        self.path.unlink(missing_ok=True)
        for end in self._ends:
            os.close(end)
        self._ends = None

    def _serve(self, master: int, slave: int) -> None:
        pending: list[tuple[float, int, bytes]] = []
        order = count()
        free_s = 0.0
        while True:
            now_s = time.monotonic()
            while pending and pending[0][0] <= now_s:
                with contextlib.suppress(BlockingIOError):  # As on a line to which nobody listens.
                    os.write(master, heapq.heappop(pending)[2])
            wait_s = max(0.0, pending[0][0] - now_s) if pending else None
            ready = select.select([master, self._wake[0]], [], [], wait_s)[0]
            if self._wake[0] in ready:
                os.read(self._wake[0], 1)
                return
            if master not in ready:
                continue
            data = os.read(master, CHUNK)
            if not self._is_understood(slave):
                continue
            now_s = time.monotonic()
            free_s = max(free_s, now_s) + self._wire_s(data)
            for reply in self._device.receive(data, now_s):
                for sent, late_s in self.faults.apply(reply, self._device.shorten):
                    due_s = free_s + sent.delay_s + self._wire_s(sent.data) + late_s
                    heapq.heappush(pending, (due_s, next(order), sent.data))
                    # A late reply leaves the line free for others meanwhile.
                    free_s = due_s if not late_s else free_s

    def _is_understood(self, slave: int) -> bool:
        """Return whether the program has opened the port at the device's rate."""
        wanted = getattr(termios, f"B{self._device.baud}", None)
        return wanted in (None, termios.tcgetattr(slave)[5])

    def _wire_s(self, data: bytes) -> float:
        return BITS_PER_BYTE * len(data) / self._device.baud


def run_emulator(
    what: str, device: SerialDevice, path: str, argv: Sequence[str] | None = None
) -> int:
    """Run an emulated device until a signal; return the exit code.

    Messages call the device `what`; `path` is the default of the port's path.
    """
    parser = argparse.ArgumentParser(description=f"Emulates {what} behind a serial port.")
    parser.add_argument(
        "--port", type=Path, default=Path(path), help="path of the port (default: %(default)s)"
    )
    parser.add_argument(
        "--faults", type=float, default=0.0, help="fraction of faulty replies, from 0 to 1"
    )
    options = parser.parse_args(argv)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        with EmulatedPort(device, options.port, ReplyFaults(options.faults)):
            sys.stdout.write(f"{what} at {options.port}\n")
            sys.stdout.flush()
            signal.pause()
    except KeyboardInterrupt:
        return 0
    except BenchError as error:
        sys.stderr.write(f"{error}\n")
        return 2
    return 0
