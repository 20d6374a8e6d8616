"""Camera images, each with a switch; the page subscribes only to images that are shown."""

from collections.abc import Callable
from html import escape

import numpy as np
from viser import GuiApi, GuiImageHandle

from arm_viewer.errors import PictureError
from arm_viewer.panels.panel import Hideable, say, show
from arm_viewer.picture_pixels import colours
from arm_viewer.requests import Send, ShowPictures
from arm_viewer.snapshot import Picture, Snapshot

JPEG_QUALITY = 60
"""At this size it looks like 75, which takes a third more bytes."""
MAX_PIXELS_WIDE = 480
"""Wider images are shrunk, because they are shown in a narrow column and encoding takes time."""
BUTTON = '<button type="button" class="arm-camera-button" data-arm-reads'
NOTHING = np.zeros((3, 4, 3), dtype=np.uint8)


class CameraPanel:
    """A switch and an image for every image topic; the first topic is shown by default."""

    def __init__(
        self,
        send: Send,
        is_watched: Callable[[], bool],
        window: Hideable,
        also: Callable[[], frozenset[str]] = frozenset,
    ) -> None:
        """Show the images that are wanted, also those of the topics that something else shows.

        The window, which holds this panel, is hidden while there is no image topic.
        """
        self._also = also
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
        wanted = self._also().union(shown) if self._is_watched() else frozenset()
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
            gui.add_html(
                f'{BUTTON} data-picture="{escape(topic)}">Full size</button>'
                f'{BUTTON} data-view-from="{escape(topic)}" '
                'title="the 3D view as this camera sees it">Look from here</button>'
            )
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
            say(self._problem, "")
            self._picture = None
        elif picture is not None and picture is not self._picture:
            self._picture = picture
            self._show(picture)

    def _show(self, picture: Picture) -> None:
        problem = ""
        try:
            self._image.image = colours(picture, MAX_PIXELS_WIDE)
        except PictureError as error:
            problem = str(error)
        say(self._problem, problem)
        show(self._image, not problem)
