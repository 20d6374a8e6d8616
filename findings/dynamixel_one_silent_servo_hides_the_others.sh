#!/usr/bin/env bash
# dynamixel-sdk 4.1.0: one servo that does not answer a sync read makes all of them unavailable, at position 0.
#
# GroupSyncRead asks all servos of an arm in one packet, and isAvailable(id, ...) takes a servo. A good
# guess is that it tells which servos have answered, so that five of six joints go on when one cable is
# loose. It tells whether the whole read succeeded: reading stops at the first silent servo, the replies of
# the next ones are taken for its own and dropped, and those read before do not count either. getData() then
# returns 0 for every servo, which is a position like any other. The status byte is dropped, too: an
# overheated servo reports its alert (128) in each reply, read4ByteTxRx() hands it on, and a sync read says
# nothing.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'dynamixel-sdk==4.1.0' 'pyserial==3.5'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import dynamixel_sdk as sdk

PRESENT_POSITION, LENGTH = 132, 4
POSITIONS = {1: 1000, 2: 2000, 3: 3000, 4: 4000}
ALERT = 0x80
packets = sdk.PacketHandler(2.0)


class Bus:
    """A port with four servos, some of which may be silent or report an alert."""

    def __init__(self) -> None:
        self.is_using = False
        self.silent: set[int] = set()
        self.alerts: set[int] = set()
        self._replies = bytearray()

    def clearPort(self) -> None:  # noqa: N802
        self._replies.clear()

    def setPacketTimeout(self, _length: int) -> None:  # noqa: N802
        pass

    def isPacketTimeout(self) -> bool:  # noqa: N802
        return not self._replies

    def readPort(self, length: int) -> bytes:  # noqa: N802
        taken = bytes(self._replies[:length])
        del self._replies[:length]
        return taken

    def writePort(self, packet: list[int]) -> int:  # noqa: N802
        asked = packet[12:-2] if packet[7] == sdk.INST_SYNC_READ else [packet[4]]
        for servo in asked:
            if servo not in self.silent:
                self._replies += self._status(servo)
        return len(packet)

    def _status(self, servo: int) -> bytes:
        error = ALERT if servo in self.alerts else 0
        head = [0xFF, 0xFF, 0xFD, 0, servo, LENGTH + 4, 0, 0x55, error]
        body = [*head, *POSITIONS[servo].to_bytes(LENGTH, "little")]
        return bytes(body) + packets.updateCRC(0, body, len(body)).to_bytes(2, "little")


def read_all(bus: Bus) -> tuple[str, list[bool], list[int]]:
    """Return the result of a sync read, and for each servo whether it is available, and its position."""
    group = sdk.GroupSyncRead(bus, packets, PRESENT_POSITION, LENGTH)
    for servo in POSITIONS:
        group.addParam(servo)
    result = packets.getTxRxResult(group.txRxPacket())
    where = PRESENT_POSITION, LENGTH
    return result, [group.isAvailable(s, *where) for s in POSITIONS], [group.getData(s, *where) for s in POSITIONS]


print("dynamixel-sdk", version("dynamixel-sdk"))
bus = Bus()
well = read_all(bus)
bus.silent = {2}
loose = read_all(bus)
bus.silent, bus.alerts = set(), {3}
hot = read_all(bus)
alone = packets.read4ByteTxRx(bus, 3, PRESENT_POSITION)
for name, found in {"all answer": well, "servo 2 is silent": loose, "servo 3 has an alert": hot}.items():
    print(f"{name}: {found[0]} available {found[1]} positions {found[2]}")
print("servo 3 alone: position, result, error", alone)
everywhere = list(POSITIONS.values())
if well[1:] != ([True] * 4, everywhere) or hot != well or alone != (3000, sdk.COMM_SUCCESS, ALERT):
    sys.exit("the behaviour has changed")
if loose[1:] != ([False] * 4, [0] * 4):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# dynamixel-sdk 4.1.0
# all answer: [TxRxResult] Communication success! available [True, True, True, True] positions [1000, 2000, 3000, 4000]
# servo 2 is silent: [TxRxResult] There is no status packet! available [False, False, False, False] positions [0, 0, 0, 0]
# servo 3 has an alert: [TxRxResult] Communication success! available [True, True, True, True] positions [1000, 2000, 3000, 4000]
# servo 3 alone: position, result, error (3000, 0, 128)
