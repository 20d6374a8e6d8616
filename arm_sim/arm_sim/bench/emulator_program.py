"""The command line of the emulated devices."""

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from arm_sim.bench.serial_device import EmulatedPort, ReplyFaults, SerialDevice
from arm_sim.errors import BenchError


def run_emulator(
    what: str, device: SerialDevice, path: str, argv: Sequence[str] | None = None
) -> int:
    """Run an emulated device until a signal; return the exit code.

    Args:
        what: the device, for messages.
        device: answers the requests.
        path: default of the port's path.
        argv: arguments; default sys.argv.
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
