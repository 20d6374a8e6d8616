"""Videos whose frame k is at k / fps, as LeRobot looks frames up."""

from collections.abc import Iterable
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
QUALITY = "18"
"""libx264's constant rate factor; the losses are hard to see."""


def write_video(
    path: Path, images: Iterable[NDArray[np.uint8]], height: int, width: int, fps: int
) -> None:
    """Write images (h, w, 3), RGB, as a video.

    Args:
        path: an MP4 file to create; its folder exists.
        images: one for each frame.
        height: in pixels, even.
        width: in pixels, even.
        fps: frames per second.
    """
    with av.open(str(path), "w", options={"movflags": "faststart"}) as container:
        # One thread: the same images give the same bytes.
        stream: Any = container.add_stream(
            ENCODER,
            rate=fps,
            options={"crf": QUALITY, "g": str(KEY_FRAME_EVERY), "threads": "1"},
        )
        stream.width, stream.height, stream.pix_fmt = width, height, PIXELS
        stream.time_base = stream.codec_context.time_base = Fraction(1, fps)
        for index, image in enumerate(images):
            frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(image), format="rgb24")
            frame.pts, frame.time_base = index, Fraction(1, fps)
            container.mux(stream.encode(frame))
        container.mux(stream.encode())


def video_info(height: int, width: int, fps: int) -> dict[str, object]:
    """Return a dataset feature's description of such a video."""
    return {
        "video.height": height,
        "video.width": width,
        "video.codec": CODEC,
        "video.pix_fmt": PIXELS,
        "video.is_depth_map": False,
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
