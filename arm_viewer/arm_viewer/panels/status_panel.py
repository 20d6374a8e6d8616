"""The banner that reports problems, and the screenshot button."""

import html
from typing import Any

import cv2
import numpy as np
from viser import GuiApi, GuiEvent, Icon

from arm_viewer.panels.panel import fill
from arm_viewer.snapshot import Snapshot

SILENT_S = 2.0
WAITING = "Waiting for a robot on /robot_description"
GONE = "The simulation has ended; the page continues when it restarts"
NO_ROBOT = "No robot up to here: the recording has no message on /robot_description"
LOST = "{topic} is no longer published; the page continues when it is"
SILENT = "Nothing on {topic} for {silence:.0f} s: what is shown of its joints is old"


def status_message(snapshot: Snapshot) -> str:
    """Return the problem to report to the user, empty if there is none."""
    if snapshot.replay:
        return "" if snapshot.descriptions else NO_ROBOT
    if not snapshot.descriptions:
        return GONE if snapshot.lost else WAITING
    for topic in sorted(snapshot.lost - snapshot.descriptions.keys()):
        if f"{topic.rpartition('/')[0]}/robot_description" in snapshot.descriptions:
            return LOST.format(topic=topic)
    if snapshot.run is not None and not snapshot.run.is_playing:
        # The time bar says so.
        return ""
    for topic, states in sorted(snapshot.joint_states.items()):
        silence_s = snapshot.made_s - states.received_s
        if silence_s > SILENT_S:
            return SILENT.format(topic=topic, silence=silence_s)
    return ""


BANNER = (
    '<div role="alert" style="margin: 0.6em 0.8em; padding: 0.5em 0.8em; border-radius: 4px; '
    'background: #fff3bf; color: #7a4100; font-size: 0.85em">{text}</div>'
)
MAX_WAIT_S = 60.0
PICTURE_NAME = "arm.png"
BACKGROUND = (235, 242, 248)
"""Background colour of a screenshot."""


class StatusPanel:
    """Shows a banner while something is wrong, and the screenshot button."""

    def build(self, gui: GuiApi) -> None:
        """Create the banner and the button."""
        self._banner = gui.add_html("", visible=False)
        gui.add_button("Screenshot", icon=Icon.CAMERA, color="gray").on_click(_take_screenshot)

    def update(self, snapshot: Snapshot) -> None:
        """Show the present problem."""
        message = status_message(snapshot)
        fill(self._banner, message and BANNER.format(text=html.escape(message)))


def _take_screenshot(event: GuiEvent[Any]) -> None:
    """Let the user's browser render its 3D view and download the image."""
    client = event.client
    if client is None:
        return
    try:
        drawn = client.get_render(
            height=client.camera.image_height,
            width=client.camera.image_width,
            transport_format="png",
            timeout=MAX_WAIT_S,
        )
    except TimeoutError:
        client.add_notification("No screenshot", f"Not drawn within {MAX_WAIT_S:.0f} s.")
        return
    except RuntimeError:
        # The browser has disconnected in the meantime.
        return
    covered = drawn[:, :, 3:] / 255.0
    picture = drawn[:, :, :3] * covered + np.array(BACKGROUND) * (1.0 - covered)
    _, png = cv2.imencode(".png", picture[:, :, ::-1].astype(np.uint8))
    client.send_file_download(PICTURE_NAME, png.tobytes(), save_immediately=True)
