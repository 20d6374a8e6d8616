"""Videos whose frame k is at k / fps, as LeRobot looks frames up."""

from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from numpy.typing import NDArray

CODEC, ENCODER = "h264", "libx264"
PIXELS = "yuv420p"
KEY_FRAME_EVERY = 2
"""A loader that jumps to any frame decodes at most two."""
QUALITY, PRESET = "18", "veryfast"
"""libx264's constant rate factor; the losses are hard to see. Slower presets take twice the time
for files a fifth smaller."""

REPEATABLE = {"threads": "1", "mbtree": "0"}
"""The same images give the same bytes. libx264's macroblock tree depends on what memory held before
(MALLOC_PERTURB_ shows it); it would make files a seventh smaller, and a little worse."""


class VideoFile:
    """A video that is being written.

    Height and width are in pixels, and even; the folder of the MP4 file exists.

    Attributes:
        frames: how many there are so far.
    """

    def __init__(self, path: Path, height: int, width: int, fps: int) -> None:
        self.frames = 0
        self._tick = Fraction(1, fps)
        self._container = av.open(str(path), "w", options={"movflags": "faststart"})
        options = {"crf": QUALITY, "preset": PRESET, "g": str(KEY_FRAME_EVERY), **REPEATABLE}
        self._stream: Any = self._container.add_stream(ENCODER, rate=fps, options=options)
        self._stream.width, self._stream.height, self._stream.pix_fmt = width, height, PIXELS
        self._stream.time_base = self._stream.codec_context.time_base = self._tick

    def add(self, image: NDArray[np.uint8]) -> None:
        """Write an image, RGB, (h, w, 3)."""
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(image), format="rgb24")
        frame.pts, frame.time_base = self.frames, self._tick
        self._container.mux(self._stream.encode(frame))
        self.frames += 1

    def close(self) -> None:
        """Write what the encoder still holds, and complete the file."""
        self._container.mux(self._stream.encode())
        self._container.close()


def video_info(height: int, width: int, fps: int) -> dict[str, object]:
    """Return a dataset feature's description of such a video."""
    return {
        "video.height": height,
        "video.width": width,
        "video.codec": CODEC,
        "video.pix_fmt": PIXELS,
        "video.is_depth_map": False,
        "is_depth_map": False,
        "video.fps": fps,
        "video.channels": 3,
        "has_audio": False,
    }


def frame_times_s(path: Path) -> list[float]:
    """Return the times of a video's frames."""
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        base = float(stream.time_base or 0)
        times = [packet.pts * base for packet in container.demux(stream) if packet.pts is not None]
    return sorted(times)
