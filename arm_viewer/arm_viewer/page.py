"""The page: its parts, where they stand, and what keeps them up to date.

All that changes the page happens in viser's event loop: viser wakes the senders of its messages by
asyncio's events, which other threads must not set (a message from elsewhere sometimes ends in
"deque mutated during iteration").
"""

import asyncio
import logging
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager

from viser import GuiApi, GuiTabHandle, ViserServer

from arm_viewer.page_look import PANEL_WIDTH_PX, apply_look
from arm_viewer.panels.camera_panel import CameraPanel
from arm_viewer.panels.clock_panel import ClockPanel
from arm_viewer.panels.controller_panel import ControllerPanel
from arm_viewer.panels.graph_panel import GraphPanel
from arm_viewer.panels.joint_panel import JointPanel
from arm_viewer.panels.panel import Panel
from arm_viewer.panels.plot_panel import PlotPanel
from arm_viewer.panels.robot_panel import RobotPanel
from arm_viewer.panels.status_panel import StatusPanel
from arm_viewer.panels.topic_panel import TopicPanel
from arm_viewer.requests import Send
from arm_viewer.scene.frames import Frames
from arm_viewer.snapshot import Snapshot

TICK_S = 1.0 / 30.0

Places = Mapping[str, tuple[Panel, ...]]
"""What stands under each tab."""


@contextmanager
def page_running(server: ViserServer, latest: Callable[[], Snapshot], send: Send) -> Iterator[None]:
    """Fill the page, and keep it up to date until the end.

    Args:
        server: serves the page.
        latest: gives the newest snapshot.
        send: takes what the user wants.
    """
    loop = server.get_event_loop()
    panels = asyncio.run_coroutine_threadsafe(_build(server, send), loop).result()
    ended = threading.Event()
    updates = asyncio.run_coroutine_threadsafe(_update(server, panels, latest, ended), loop)
    try:
        yield
    finally:
        ended.set()
        updates.result()


async def _build(server: ViserServer, send: Send) -> tuple[Panel, ...]:
    apply_look(server)
    gui = server.gui
    frames = Frames(server.scene)
    status = StatusPanel()
    status.build(gui)
    main = {
        "Robot": (JointPanel(send), RobotPanel(server.scene, frames)),
        "Control": (ClockPanel(), ControllerPanel(send)),
        "System": (GraphPanel(), TopicPanel(send)),
    }
    cameras = {"Cameras": (CameraPanel(send, lambda: bool(server.get_clients())),)}
    plots = {"Plots": (PlotPanel(),)}
    above, below = gui.add_panel(), gui.add_panel()
    above.dock_left()
    below.dock_below(above)
    above.set_width(PANEL_WIDTH_PX)
    return (
        status,
        *_placed(main, gui, gui.add_tab_group().add_tab),
        *_placed(cameras, gui, above.add_tab),
        *_placed(plots, gui, below.add_tab),
    )


def _placed(
    places: Places, gui: GuiApi, add_tab: Callable[[str], GuiTabHandle]
) -> tuple[Panel, ...]:
    for title, panels in places.items():
        with add_tab(title):
            for panel in panels:
                panel.build(gui)
    return tuple(panel for panels in places.values() for panel in panels)


async def _update(
    server: ViserServer,
    panels: Sequence[Panel],
    latest: Callable[[], Snapshot],
    ended: threading.Event,
) -> None:
    while not ended.is_set():
        await asyncio.sleep(TICK_S)
        snapshot = latest()
        for panel in panels:
            try:
                with server.atomic():
                    panel.update(snapshot)
            except Exception:
                # The page's last frame: one part that fails must not stop the others.
                logging.getLogger(__name__).exception("%s failed", type(panel).__name__)
