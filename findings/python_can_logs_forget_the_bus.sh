#!/usr/bin/env bash
# python-can 4.6.1: of the formats that can.Logger() writes, four change frames that are read back.
#
# The ending of the name chooses the format, and a good guess is that each of them gives back what it was
# given, with another accuracy of the time at most. .csv and .db (SQLite) drop the channel, so that the
# frames of two arms on can0 and can1 are mixed; they drop the direction as well, and that a frame is
# CAN FD, so that twelve bytes come back in a classic frame of at most eight. .asc turns can1 into 1 and
# the time into seconds since the first frame. .trc leaves out CAN FD and remote frames, with a line in the
# log, and makes can0 bus 1. .blf keeps all but the text of the channel; .log, as candump writes it, keeps all that is
# looked at here but the length that a remote frame asks for.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'python-can==4.6.1'

"$folder/venv/bin/python" -W ignore - "$folder" 2> /dev/null <<'PYTHON'
import sys
from importlib.metadata import version

import can

folder = sys.argv[1]
START = 1700000000.125
FRAMES = (
    can.Message(START, 0x141, is_extended_id=False, data=[1, 2], channel="can0"),
    can.Message(START + 0.5, 0x141, is_extended_id=False, data=[3], channel="can1", is_rx=False),
    can.Message(START + 1, 0x200, is_extended_id=False, is_fd=True, data=bytes(range(12)), channel="can1"),
    can.Message(START + 1.5, 0x201, is_extended_id=False, is_remote_frame=True, dlc=4, channel="can0"),
)
FIELDS = ("timestamp", "arbitration_id", "is_fd", "is_remote_frame", "is_rx", "channel", "dlc", "data")
CHANGED = {
    "log": {"dlc"},
    "blf": {"channel"},
    "asc": {"timestamp", "channel"},
    "csv": {"is_fd", "is_rx", "channel"},
    "db": {"is_fd", "is_rx", "channel"},
    "trc": {"channel"},
}


def read_back(ending: str) -> list[can.Message]:
    """Return the frames as a log of that format has them."""
    path = f"{folder}/frames.{ending}"
    with can.Logger(path) as logger:
        for frame in FRAMES:
            logger.on_message_received(frame)
    with can.LogReader(path) as reader:
        return list(reader)


print("python-can", version("python-can"))
right = []
for ending, expected in CHANGED.items():
    frames = read_back(ending)
    differ = {}
    for frame, read in zip(FRAMES, frames):
        for field in FIELDS:
            if getattr(frame, field) != getattr(read, field):
                differ.setdefault(field, f"{getattr(frame, field)} -> {getattr(read, field)}")
    print(f".{ending}: {len(frames)} of {len(FRAMES)} frames, changed:", differ)
    right.append((set(differ), len(frames)) == (expected, 2 if ending == "trc" else 4))
if not all(right):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# python-can 4.6.1
# .log: 4 of 4 frames, changed: {'dlc': '4 -> 0'}
# .blf: 4 of 4 frames, changed: {'channel': 'can0 -> 0'}
# .asc: 4 of 4 frames, changed: {'timestamp': '1700000000.125 -> 0.0', 'channel': 'can0 -> 0'}
# .csv: 4 of 4 frames, changed: {'channel': 'can0 -> None', 'is_rx': 'False -> True', 'is_fd': 'True -> False'}
# .db: 4 of 4 frames, changed: {'channel': 'can0 -> None', 'is_rx': 'False -> True', 'is_fd': 'True -> False'}
# .trc: 2 of 4 frames, changed: {'channel': 'can0 -> 1'}
