"""The line above everything, where something is wrong, and the button for a picture."""

import html
from typing import Any

import cv2
import numpy as np
from viser import GuiApi, GuiEvent, Icon

from arm_viewer.page_look import BACKGROUND
from arm_viewer.simulation_watch import complaint
from arm_viewer.snapshot import Snapshot

BANNER = (
    '<div role="alert" style="margin: 0.6em 0.8em; padding: 0.5em 0.8em; border-radius: 4px; '
    'background: #5c3a10; color: #ffd8a8; font-size: 0.85em">{text}</div>'
)
LONGEST_WAIT_S = 60.0
PICTURE_NAME = "arm.png"


class StatusPanel:
    """Says that the simulation went away, until it returns."""

    def build(self, gui: GuiApi) -> None:
        """Make the line and the button."""
        self._said = ""
        self._banner = gui.add_html("", visible=False)
        gui.add_button("Screenshot", icon=Icon.CAMERA, color="gray").on_click(_give_picture)

    def update(self, snapshot: Snapshot) -> None:
        """Say what is wrong by now."""
        said = complaint(snapshot)
        if said != self._said:
            self._said = said
            self._banner.content = BANNER.format(text=html.escape(said))
            self._banner.visible = bool(said)


def _give_picture(event: GuiEvent[Any]) -> None:
    """Have the browser that asked draw the 3D view as it sees it, and download it there."""
    client = event.client
    if client is None:
        return
    try:
        drawn = client.get_render(
            height=client.camera.image_height,
            width=client.camera.image_width,
            transport_format="png",
            timeout=LONGEST_WAIT_S,
        )
    except TimeoutError:
        client.add_notification("No screenshot", f"Not drawn within {LONGEST_WAIT_S:.0f} s.")
        return
    except RuntimeError:
        # The browser has gone meanwhile.
        return
    covered = drawn[:, :, 3:] / 255.0
    picture = drawn[:, :, :3] * covered + np.array(BACKGROUND) * (1.0 - covered)
    _, png = cv2.imencode(".png", picture[:, :, ::-1].astype(np.uint8))
    client.send_file_download(PICTURE_NAME, png.tobytes(), save_immediately=True)
