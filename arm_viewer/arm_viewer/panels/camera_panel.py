"""Camera images, each with a switch; the page subscribes only to images that are shown."""

from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from viser import GuiApi, GuiImageHandle

from arm_viewer.errors import PictureError
from arm_viewer.panels.panel import PROBLEM_COLOUR, Hideable, note, show
from arm_viewer.requests import Send, ShowPictures
from arm_viewer.snapshot import Picture, Snapshot

JPEG_QUALITY = 60
"""At this size it looks like 75, which takes a third more bytes."""
NOTHING = np.zeros((3, 4, 3), dtype=np.uint8)


class CameraPanel:
    """A switch and an image for every image topic; the first topic is shown by default."""

    def __init__(self, send: Send, is_watched: Callable[[], bool], window: Hideable) -> None:
        """Show the images that are wanted.

        Args:
            send: takes requests for images.
            is_watched: returns whether any browser is connected.
            window: what holds this panel; it is hidden while there is no image topic.
        """
        self._window = window
        self._send = send
        self._is_watched = is_watched
        self._cameras: dict[str, _Camera] = {}
        self._wanted: frozenset[str] = frozenset()

    def build(self, gui: GuiApi) -> None:
        """Create the folder for the images."""
        self._gui = gui
        self._place = gui.add_folder(None)

    def update(self, snapshot: Snapshot) -> None:
        """Show the newest images."""
        for topic in snapshot.image_topics:
            if topic not in self._cameras:
                with self._place:
                    self._cameras[topic] = _Camera(self._gui, topic, shown=not self._cameras)
        show(self._window, bool(snapshot.image_topics))
        for topic, camera in self._cameras.items():
            camera.update(topic in snapshot.image_topics, snapshot.pictures.get(topic))
        shown = [topic for topic, camera in self._cameras.items() if camera.is_shown]
        wanted = frozenset(shown if self._is_watched() else ())
        if wanted != self._wanted:
            self._wanted = wanted
            self._send(ShowPictures(wanted))


class _Camera:
    """The image of one topic."""

    def __init__(self, gui: GuiApi, topic: str, shown: bool) -> None:
        self._folder = gui.add_folder(topic)
        with self._folder:
            self._switch = gui.add_checkbox("Show", shown)
            self._image: GuiImageHandle = gui.add_image(
                NOTHING, format="jpeg", jpeg_quality=JPEG_QUALITY, visible=False
            )
            self._problem = gui.add_html("", visible=False)
        self._picture: Picture | None = None

    @property
    def is_shown(self) -> bool:
        """Whether the user has switched it on and the topic is published."""
        return self._switch.value and self._folder.visible

    def update(self, is_published: bool, picture: Picture | None) -> None:
        """Show a new image; without one the last image stays."""
        show(self._folder, is_published)
        if not self._switch.value:
            show(self._image, False)
            show(self._problem, False)
            self._picture = None
        elif picture is not None and picture is not self._picture:
            self._picture = picture
            self._show(picture)

    def _show(self, picture: Picture) -> None:
        try:
            self._image.image = colours(picture)
        except PictureError as error:
            self._problem.content = note(str(error), PROBLEM_COLOUR)
            show(self._problem, True)
            show(self._image, False)
        else:
            show(self._problem, False)
            show(self._image, True)


MAX_PIXELS_WIDE = 480
"""Wider images are shrunk, because they are shown in a narrow column and encoding takes time."""

_CHANNELS = {
    "rgb8": (np.uint8, 3),
    "bgr8": (np.uint8, 3),
    "rgba8": (np.uint8, 4),
    "bgra8": (np.uint8, 4),
    "mono8": (np.uint8, 1),
    "8UC1": (np.uint8, 1),
    "mono16": (np.uint16, 1),
    "16UC1": (np.uint16, 1),
    "32FC1": (np.float32, 1),
}
"""Type and number of a pixel's values, by encoding."""
_DISTANCES = ("16UC1", "32FC1")
"""Encodings of depth images, shown with near points red, far points blue and unknown ones black."""


def colours(picture: Picture) -> NDArray[np.uint8]:
    """Return the image (h, w, 3), at most MAX_PIXELS_WIDE wide.

    Raises:
        PictureError: the encoding is unknown, or there is too little data.
    """
    pixels = _shrunk(_pixels(picture))
    encoding = picture.encoding
    if encoding in _DISTANCES:
        return _distance_colours(pixels[:, :, 0].astype(np.float64))
    if encoding == "mono16":
        pixels = (pixels >> 8).astype(np.uint8)
    if encoding.startswith("bgr"):
        pixels = pixels[:, :, 2::-1]
    elif pixels.shape[2] == 1:
        pixels = np.repeat(pixels, 3, axis=2)
    return np.ascontiguousarray(pixels[:, :, :3])


def _pixels(picture: Picture) -> NDArray[Any]:
    if picture.encoding not in _CHANNELS:
        known = ", ".join(_CHANNELS)
        raise PictureError(f"cannot show the encoding '{picture.encoding}'; known: {known}")
    kind, channels = _CHANNELS[picture.encoding]
    kind = np.dtype(kind).newbyteorder(">" if picture.is_bigendian else "<")
    row = picture.width * channels * kind.itemsize
    if not 0 < row <= picture.step or not picture.height:
        raise PictureError(
            f"an image of {picture.width}x{picture.height} pixels of {picture.encoding} cannot "
            f"have rows of {picture.step} bytes"
        )
    if picture.data.size < picture.height * picture.step:
        raise PictureError(
            f"an image with {picture.height} rows of {picture.step} bytes has only "
            f"{picture.data.size} bytes"
        )
    rows = picture.data[: picture.height * picture.step].reshape(picture.height, picture.step)
    values = np.ascontiguousarray(rows[:, :row]).view(kind)
    return values.reshape(picture.height, picture.width, channels)


def _shrunk(pixels: NDArray[Any]) -> NDArray[Any]:
    every = -(-pixels.shape[1] // MAX_PIXELS_WIDE)
    return pixels[::every, ::every]


def _distance_colours(distances: NDArray[np.float64]) -> NDArray[np.uint8]:
    known = np.isfinite(distances) & (distances > 0.0)
    if not known.any():
        return np.zeros((*distances.shape, 3), dtype=np.uint8)
    nearest, farthest = distances[known].min(), distances[known].max()
    seen = np.where(known, distances, farthest)
    share = (farthest - seen) / max(farthest - nearest, 1e-6)
    coloured = cv2.applyColorMap((share * 255.0).astype(np.uint8), cv2.COLORMAP_TURBO)
    coloured[~known] = 0
    return np.ascontiguousarray(coloured[:, :, ::-1], dtype=np.uint8)
