"""Camera images, each with a switch; the page subscribes only to images that are shown."""

from collections.abc import Callable

import numpy as np
from viser import GuiApi, GuiImageHandle

from arm_viewer.errors import PictureError
from arm_viewer.panels.panel import PROBLEM_COLOUR, note
from arm_viewer.picture_colours import colours
from arm_viewer.requests import Send, ShowPictures
from arm_viewer.snapshot import Picture, Snapshot

NOTHING = np.zeros((3, 4, 3), dtype=np.uint8)
NO_CAMERA = "No image topic is published."


class CameraPanel:
    """A switch and an image for every image topic; the first topic is shown by default."""

    def __init__(self, send: Send, is_watched: Callable[[], bool]) -> None:
        """Show images while `is_watched` returns whether any browser is connected."""
        self._send = send
        self._is_watched = is_watched
        self._cameras: dict[str, _Camera] = {}
        self._wanted: frozenset[str] = frozenset()

    def build(self, gui: GuiApi) -> None:
        """Create the folder for the images."""
        self._gui = gui
        self._place = gui.add_folder(None)
        with self._place:
            self._hint = gui.add_html(note(NO_CAMERA))

    def update(self, snapshot: Snapshot) -> None:
        """Show the newest images."""
        for topic in snapshot.image_topics:
            if topic not in self._cameras:
                with self._place:
                    self._cameras[topic] = _Camera(self._gui, topic, shown=not self._cameras)
        self._hint.visible = not snapshot.image_topics
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
            self._image: GuiImageHandle = gui.add_image(NOTHING, format="jpeg", visible=False)
            self._problem = gui.add_html("", visible=False)
        self._picture: Picture | None = None

    @property
    def is_shown(self) -> bool:
        """Whether the user has switched it on and the topic is published."""
        return self._switch.value and self._folder.visible

    def update(self, is_published: bool, picture: Picture | None) -> None:
        """Show a new image; without one the last image stays."""
        self._folder.visible = is_published
        if not self._switch.value:
            self._image.visible = self._problem.visible = False
            self._picture = None
        elif picture is not None and picture is not self._picture:
            self._picture = picture
            self._show(picture)

    def _show(self, picture: Picture) -> None:
        try:
            self._image.image = colours(picture)
        except PictureError as error:
            self._problem.content = note(str(error), PROBLEM_COLOUR)
            self._problem.visible, self._image.visible = True, False
        else:
            self._problem.visible, self._image.visible = False, True
