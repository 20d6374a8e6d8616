#!/usr/bin/env bash
# python-can 4.6.1: Message(arbitration_id=0x141) is an extended frame, which a servo of 11 bits does not hear.
#
# A good guess is that an identifier up to 0x7FF makes the standard frame of 11 bits, as candump's and
# cansend's notation have it, and one above it the extended frame. is_extended_id is True unless it is
# said, whatever the number: on the bus it is another identifier, so that a motor of CANopen or of the
# usual arm drives stays silent, and no error comes. A test on a virtual bus passes: a filter of 0x141
# with the mask 0x7FF lets standard and extended frames pass, even 0x10141, as "extended" in a filter
# is not looked at unless it is there.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'python-can==4.6.1'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import can

FILTER = {"can_id": 0x141, "can_mask": 0x7FF}
FRAMES = (
    can.Message(arbitration_id=0x141, data=[1]),
    can.Message(arbitration_id=0x141, data=[2], is_extended_id=False),
    can.Message(arbitration_id=0x10141, data=[3]),
)


def received(**extended: bool) -> list[int]:
    """Return which of the frames pass the filter on a virtual bus."""
    with can.Bus("arm", "virtual") as sender, can.Bus("arm", "virtual", can_filters=[FILTER | extended]) as receiver:
        for frame in FRAMES:
            sender.send(frame)
        found = [receiver.recv(timeout=0.2) for _ in FRAMES]
    return [frame.data[0] for frame in found if frame]


print("python-can", version("python-can"))
print(f"Message(arbitration_id=0x141).is_extended_id: {FRAMES[0].is_extended_id}")
passed = received(), received(extended=False)
print(f"filter without 'extended': frames {passed[0]}; with extended=False: {passed[1]}")
if [frame.is_extended_id for frame in FRAMES] != [True, False, True] or passed != ([1, 2, 3], [2]):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# python-can 4.6.1
# Message(arbitration_id=0x141).is_extended_id: True
# filter without 'extended': frames [1, 2, 3]; with extended=False: [2]
