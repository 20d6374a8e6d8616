#!/usr/bin/env bash
# minimalmodbus 2.1.1: write_register(address, 1.15, 2) writes 114.
#
# With number_of_decimals=2 a value is multiplied by 100 on its way to the register, and a good guess is
# that it is rounded, all the more for values that have exactly two decimals. It is cut off: 1.15 * 100 is
# 114.99999999999999, so 114 goes out, and read_register() gives 1.14. Of the values from 0.00 to 10.00, 69
# are one step too small. A program that reads a set-point and writes it back lowers it, and 1.16 reaches
# 1.12 step by step. Multiply and round yourself, and write with no decimals.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'minimalmodbus==2.1.1' 'pyserial==3.5'

"$folder/venv/bin/python" - <<'PYTHON'
import os
import pty
import struct
import sys
import threading
import tty
from importlib.metadata import version

import minimalmodbus

device, port = pty.openpty()
tty.setraw(device)
tty.setraw(port)
register = [0]


def checked(body: bytes) -> bytes:
    """Return a frame with its checksum (CRC-16 of Modbus)."""
    crc = 0xFFFF
    for byte in body:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return body + crc.to_bytes(2, "little")


def answer() -> None:
    """Be a device with one register: function 3 reads it, function 6 writes it."""
    while True:
        frame = os.read(device, 8)
        while len(frame) < 8:
            frame += os.read(device, 8 - len(frame))
        if frame[1] == 6:
            (register[0],) = struct.unpack(">h", frame[4:6])
            os.write(device, frame)
        else:
            os.write(device, checked(frame[:2] + b"\2" + struct.pack(">h", register[0])))


threading.Thread(target=answer, daemon=True).start()
drive = minimalmodbus.Instrument(os.ttyname(port), 1)
drive.serial.baudrate = 115200
drive.serial.timeout = 5


def written(value: float) -> int:
    """Return what stands in the register after a value with two decimals was written."""
    drive.write_register(0, value, 2, functioncode=6, signed=True)
    return register[0]


print("minimalmodbus", version("minimalmodbus"))
found = {value: written(value) for value in (1.15, 0.29, 4.35, -1.15, 1.25)}
print("written:", found)
low = sum(int(n / 100 * 100) != n for n in range(1001))
print("values of 0.00 to 10.00 whose product is cut:", low)
held = [1.16]
for _ in range(5):
    written(held[-1])
    held.append(drive.read_register(0, 2, signed=True))
print("read and written back:", held)
if list(found.values()) != [114, 28, 434, -114, 125] or held[-1] >= 1.16:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# minimalmodbus 2.1.1
# written: {1.15: 114, 0.29: 28, 4.35: 434, -1.15: -114, 1.25: 125}
# values of 0.00 to 10.00 whose product is cut: 69
# read and written back: [1.16, 1.15, 1.14, 1.13, 1.12, 1.12]
