"""A browser's half of viser's protocol without the browser: what the page costs by itself."""

import threading
import time
from typing import Any

import msgspec
import viser
import zstandard
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

HEAD_BYTES = 16


class PageClient:
    """Connects to a page, reads all that it sends and moves its sliders."""

    def __init__(self, port: int) -> None:
        """Connect, and say where the camera is: only then viser counts a client."""
        self._socket = connect(
            f"ws://127.0.0.1:{port}",
            origin=f"http://127.0.0.1:{port}",  # pyright: ignore[reportArgumentType]
            subprotocols=[f"viser-v{viser.__version__}"],  # pyright: ignore[reportArgumentType]
            max_size=None,
        )
        self.sliders: dict[str, str] = {}
        self.images = 0
        self.received_bytes = 0
        self._image_ids: set[str] = set()
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()
        self._send(
            type="ViewerCameraMessage",
            wxyz=(1.0, 0.0, 0.0, 0.0),
            position=(1.0, 1.0, 1.0),
            fov=0.8,
            near=0.01,
            far=100.0,
            image_height=800,
            image_width=1280,
            look_at=(0.0, 0.0, 0.0),
            up_direction=(0.0, 0.0, 1.0),
        )

    def wait_for_slider(self, label: str, timeout_s: float = 60.0) -> str:
        """Return a slider's identity once the page has it."""
        deadline_s = time.monotonic() + timeout_s
        while label not in self.sliders:
            if time.monotonic() > deadline_s:
                raise SystemExit(f"no slider '{label}'; there are {', '.join(self.sliders)}")
            time.sleep(0.05)
        return self.sliders[label]

    def move(self, slider: str, value: float) -> None:
        """Do what a browser does when a slider is dragged."""
        self._send(type="GuiUpdateMessage", uuid=slider, updates={"value": value})

    def close(self) -> None:
        """Leave."""
        self._socket.close()
        self._reading.join()

    def _send(self, **message: Any) -> None:
        self._socket.send(msgspec.msgpack.encode(message))

    def _read(self) -> None:
        decompress = zstandard.ZstdDecompressor().decompress
        while True:
            try:
                data = self._socket.recv()
            except ConnectionClosed:
                return
            assert isinstance(data, bytes)
            self.received_bytes += len(data)
            length = int.from_bytes(data[8:HEAD_BYTES], "little")
            window = msgspec.msgpack.decode(decompress(data[HEAD_BYTES : HEAD_BYTES + length]))
            for message in window["messages"]:
                self._take(message)

    def _take(self, message: dict[str, Any]) -> None:
        if message["type"] == "GuiSliderMessage":
            self.sliders[message["props"]["label"]] = message["uuid"]
        elif message["type"] == "GuiImageMessage":
            self._image_ids.add(message["uuid"])
        elif message["type"] == "GuiUpdateMessage" and message["uuid"] in self._image_ids:
            self.images += "_data" in message["updates"]
