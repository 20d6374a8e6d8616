#!/usr/bin/env bash
# canopen 2.4.1: a negative default that an EDS file writes in hexadecimal is a positive one that fits nowhere.
#
# EDS files write numbers in hexadecimal, negative ones as two's complement, and tools for drives do so for
# limits and defaults alike: LowLimit=0x8000, DefaultValue=0xFFFB of an INTEGER16. A good guess is that both
# are read alike. LowLimit becomes -32768, the default 65531 (-5 was meant). A LocalNode, a simulated drive,
# cannot give its own default then: each read of the object ends with "Value does not fit in specified
# type", and code that compares with variable.default is off by 65536. DefaultValue=-5, in decimal, is
# right.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'canopen==2.4.1'

"$folder/venv/bin/python" -W ignore - "$folder/drive.eds" 2> /dev/null <<'PYTHON'
import sys
from importlib.metadata import version

import canopen

path = sys.argv[1]
EDS = """[FileInfo]
FileName=drive.eds
[DeviceInfo]
[MandatoryObjects]
SupportedObjects=0
[OptionalObjects]
SupportedObjects=2
1=0x607A
2=0x60B0
[ManufacturerObjects]
SupportedObjects=0
"""
OBJECT = """[{index}]
ParameterName={name}
ObjectType=0x7
DataType=0x0003
AccessType=rw
LowLimit=0x8000
HighLimit=0x7FFF
DefaultValue={default}
PDOMapping=0
"""
with open(path, "w") as file:
    file.write(EDS)
    file.write(OBJECT.format(index="607A", name="hexadecimal", default="0xFFFB"))
    file.write(OBJECT.format(index="60B0", name="decimal", default="-5"))
objects = canopen.import_od(path, node_id=1)
node = canopen.LocalNode(1, objects)
print("canopen", version("canopen"))
found = {}
for index in (0x607A, 0x60B0):
    variable = objects[index]
    try:
        read = node.sdo[index].raw
    except ValueError as error:
        read = str(error)
    found[variable.name] = (variable.min, variable.max, variable.default, read)
    print(f"{variable.name}: limits {variable.min} {variable.max}, default {variable.default}, read: {read}")
expected = {
    "hexadecimal": (-32768, 32767, 65531, "Value does not fit in specified type"),
    "decimal": (-32768, 32767, -5, -5),
}
if found != expected:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# canopen 2.4.1
# hexadecimal: limits -32768 32767, default 65531, read: Value does not fit in specified type
# decimal: limits -32768 32767, default -5, read: -5
