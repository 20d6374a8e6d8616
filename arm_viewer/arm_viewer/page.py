"""Build the page from its panels, and keep it up to date.

Change the page only in viser's event loop: viser wakes its message senders with asyncio events,
which other threads must not set (doing so sometimes raises "deque mutated during iteration").
"""

import asyncio
import logging
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray
from viser import GuiApi, GuiTabHandle, ViserServer

from arm_viewer.channel import Channel
from arm_viewer.page_server import PageServer
from arm_viewer.panels.calls import Calls
from arm_viewer.panels.camera_panel import CameraPanel
from arm_viewer.panels.config_panel import ConfigPanel
from arm_viewer.panels.controller_panel import ControllerPanel
from arm_viewer.panels.graph_panel import GraphPanel
from arm_viewer.panels.joint_panel import JointPanel
from arm_viewer.panels.observations import Observations
from arm_viewer.panels.overlay_panel import OverlayPanel
from arm_viewer.panels.panel import Panel
from arm_viewer.panels.picture_panel import PicturePanel
from arm_viewer.panels.planning_panel import PlanningPanel
from arm_viewer.panels.plots import PlotFeed
from arm_viewer.panels.robot_panel import RobotPanel
from arm_viewer.panels.status_panel import StatusPanel
from arm_viewer.panels.time_bar import TimeBar
from arm_viewer.panels.timeline import TimelinePanel
from arm_viewer.panels.view_from_camera import ViewFromCamera
from arm_viewer.panels.world_panel import WorldPanel
from arm_viewer.recordings.player import Player
from arm_viewer.recordings.recorder import Recorder
from arm_viewer.requests import Send, Watch
from arm_viewer.rviz_config import PageConfig
from arm_viewer.scene.first_view import CAMERA_FOV_RAD, CAMERA_POSITION, CAMERA_TARGET, FirstView
from arm_viewer.scene.frames import Frames
from arm_viewer.scene.poses import Poses
from arm_viewer.snapshot import Snapshot

TICK_S = 1.0 / 30.0
UNWATCHED_TICK_S = 0.2
"""Time between two updates while no browser is connected."""

ACCENT = (28, 126, 214)
SKY_ZENITH, SKY_HORIZON = (176, 206, 233), (242, 246, 249)
SKY_HEIGHT_PX = 256
FLOOR_COLOUR = (226, 229, 231)
GRID_CELL, GRID_SECTION = (208, 212, 216), (178, 184, 190)
GRID_FADE_M = 14.0
RIGHT_PANEL_WIDTH_PX, LEFT_PANEL_WIDTH_PX = 236.0, 224.0
"""Narrow enough that a browser window of 960 px shows more of the robots than of the panels."""

Tabs = Mapping[str, tuple[Panel, ...]]
"""The panels of each tab, by title."""


@contextmanager
def page_running(
    server: PageServer,
    latest: Callable[[], Snapshot],
    send: Send,
    config: PageConfig | None = None,
    recordings: tuple[Player, Recorder] | None = None,
) -> Iterator[None]:
    """Build the page, and keep it up to date while the context lasts.

    `config` is what it shows first; without `recordings` it has no timeline.
    """
    loop = server.get_event_loop()
    panels = asyncio.run_coroutine_threadsafe(
        _build(server, send, config, recordings), loop
    ).result()
    ended = threading.Event()
    updates = asyncio.run_coroutine_threadsafe(_update(server, panels, latest, send, ended), loop)
    try:
        yield
    finally:
        ended.set()
        updates.result()


async def _build(
    server: PageServer,
    send: Send,
    config: PageConfig | None,
    recordings: tuple[Player, Recorder] | None,
) -> tuple[Panel, ...]:
    _apply_look(server)
    gui = server.gui
    poses = Poses(server.channel, lambda: len(server.get_clients()))
    frames = Frames(server.scene, poses)
    status = StatusPanel()
    status.build(gui)
    bar = TimeBar(server.channel, send)
    bar.build(gui)
    timeline = () if recordings is None else (TimelinePanel(server.channel, *recordings),)
    for panel in timeline:
        panel.build(gui)
    view = FirstView(server)
    world = WorldPanel(server.scene, server.channel, send)

    def is_watched() -> bool:
        return bool(server.get_clients())

    robots = RobotPanel(server.scene, frames, poses, view, world.choose, send, is_watched)
    overlays = OverlayPanel(server.scene, frames)
    main = {
        "Robot": (
            JointPanel(server.channel, send),
            robots,
            overlays,
            ConfigPanel(server, robots, view, config),
        ),
        "World": (world,),
        "Control": (ControllerPanel(send),),
        "System": (GraphPanel(),),
    }
    left = gui.add_panel(visible=False)
    left.dock_left()
    left.set_width(LEFT_PANEL_WIDTH_PX)
    pictures = PicturePanel(server.channel)
    pictures.build(gui)
    cameras = {"Cameras": (CameraPanel(send, is_watched, left, pictures.wanted),)}
    channelled = _build_without_tab(server.channel, frames, send, gui)
    tabs = gui.add_tab_group()
    planning = PlanningPanel(server.scene, frames, send, tabs.add_tab)
    planning.build(gui)
    return (
        status,
        bar,
        *timeline,
        *_build_tabs(main, gui, tabs.add_tab),
        pictures,
        *_build_tabs(cameras, gui, left.add_tab),
        *channelled,
        planning,
    )


def _apply_look(server: ViserServer) -> None:
    """Set a light theme, lights, sky, floor and the camera's pose, all cheap in software."""
    server.gui.configure_theme(
        dark_mode=False, show_logo=False, show_share_button=False, brand_color=ACCENT
    )
    server.gui.main_panel.dock_right()
    server.gui.main_panel.set_width(RIGHT_PANEL_WIDTH_PX)
    scene = server.scene
    # Without a graphics card the environment map costs most. Shadows cost as much as all else, and
    # front/software_rendering.js switches them off there.
    scene.configure_environment_map(None)
    scene.configure_default_lights(enabled=False)
    scene.add_light_directional(
        "/lights/key", intensity=2.4, position=(1.0, -1.5, 2.5), cast_shadow=True
    )
    # Without a second light, faces that are turned away from the first one would be black.
    scene.add_light_directional("/lights/fill", intensity=0.9, position=(-2.0, 0.5, 0.6))
    scene.add_light_ambient("/lights/ambient", intensity=1.1)
    scene.set_background_image(_sky(), format="png")
    scene.add_grid(
        "/ground",
        infinite_grid=True,
        fade_distance=GRID_FADE_M,
        cell_size=0.1,
        section_size=1.0,
        cell_color=GRID_CELL,
        section_color=GRID_SECTION,
        cell_thickness=0.6,
        section_thickness=0.9,
        shadow_opacity=0.28,
        plane_color=FLOOR_COLOUR,
        plane_opacity=1.0,
    )
    camera = server.initial_camera
    camera.position, camera.look_at = CAMERA_POSITION, CAMERA_TARGET
    camera.fov = CAMERA_FOV_RAD


def _sky() -> NDArray[np.uint8]:
    """Return an image with a gradient from the zenith's colour to the horizon's."""
    share = np.linspace(0.0, 1.0, SKY_HEIGHT_PX)[:, None, None]
    column = (1.0 - share) * np.array(SKY_ZENITH) + share * np.array(SKY_HORIZON)
    return np.repeat(column, 2, axis=1).astype(np.uint8)


def _build_without_tab(
    channel: Channel, frames: Frames, send: Send, gui: GuiApi
) -> tuple[Panel, ...]:
    """Build what lies over the scene or has its own HTML."""
    panels = (
        ViewFromCamera(channel, frames),
        PlotFeed(channel, send),
        Observations(channel, send),
        Calls(channel, send),
    )
    for panel in panels:
        panel.build(gui)
    return panels


def _build_tabs(
    tabs: Tabs, gui: GuiApi, add_tab: Callable[[str], GuiTabHandle]
) -> tuple[Panel, ...]:
    for title, panels in tabs.items():
        with add_tab(title):
            for panel in panels:
                panel.build(gui)
    return tuple(panel for panels in tabs.values() for panel in panels)


async def _update(
    server: PageServer,
    panels: Sequence[Panel],
    latest: Callable[[], Snapshot],
    send: Send,
    ended: threading.Event,
) -> None:
    was_watched = True
    while not ended.is_set():
        is_watched = bool(server.get_clients())
        if is_watched != was_watched:
            was_watched = is_watched
            send(Watch(is_watched))
        await asyncio.sleep(TICK_S if is_watched else UNWATCHED_TICK_S)
        snapshot = latest()
        # One for all panels, because the end of each wakes viser's senders.
        with server.atomic():
            for panel in panels:
                try:
                    panel.update(snapshot)
                except Exception:
                    # The page's top-level handler: a panel that fails must not stop the others.
                    logging.getLogger(__name__).exception("%s failed", type(panel).__name__)
