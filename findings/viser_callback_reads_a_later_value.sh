#!/usr/bin/env bash
# viser 1.1.1: a slider's callback runs beside its other calls, and reads the value of a later one.
#
# A good guess is that each move of a slider calls its callback with that move, one call after the
# other, as toolkits of windows do. A plain function is called in a pool of threads, while the next
# moves are taken already, and the event carries no value of its own: event.target.value is what the
# slider has by then. So one of two quick moves is handled twice, the other one never, and calls may
# overtake each other: a robot that is sent each value gets them twice or out of order. A coroutine
# (async def) is called before the next move is taken, and sees each value once.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'viser==1.1.1'

"$folder/venv/bin/python" - <<'PYTHON'
import asyncio
import sys
import threading

import msgspec
import viser
import websockets

PORT = 18099
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": (1.0, 0.0, 0.0, 0.0),
    "position": (1.0, 1.0, 1.0),
    "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
    "fov": 1.0,
    "near": 0.1,
    "far": 10.0,
    "image_height": 100,
    "image_width": 100,
}

server = viser.ViserServer(host="127.0.0.1", port=PORT, verbose=False)
slider = server.gui.add_slider("joint", min=0.0, max=1.0, step=0.01, initial_value=0.0)
both_run = threading.Barrier(2)
by_function: list[float] = []
by_coroutine: list[float] = []


@slider.on_update
def _(event):
    both_run.wait(timeout=20.0)  # passes only if two calls run at once
    by_function.append(event.target.value)


@slider.on_update
async def _(event):
    by_coroutine.append(event.target.value)


async def move() -> None:
    """Do what a browser does: say where its camera is, and move the slider twice."""
    protocol = f"viser-v{viser.__version__}"
    async with websockets.connect(f"ws://127.0.0.1:{PORT}", subprotocols=[protocol]) as browser:
        await browser.send(msgspec.msgpack.encode(CAMERA))
        for value in (0.25, 0.75):
            moved = {"type": "GuiUpdateMessage", "uuid": slider._impl.uuid, "updates": {"value": value}}
            await browser.send(msgspec.msgpack.encode(moved))
        for _ in range(200):
            if len(by_function) == 2:
                break
            await asyncio.sleep(0.1)


asyncio.run(move())
print("viser", viser.__version__)
print(f"moved to 0.25 and 0.75; a function saw {by_function}, a coroutine {by_coroutine}")
if (by_function, by_coroutine) != ([0.75, 0.75], [0.25, 0.75]):
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# viser 1.1.1
# moved to 0.25 and 0.75; a function saw [0.75, 0.75], a coroutine [0.25, 0.75]
