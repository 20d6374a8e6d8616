"""The look of the page: a light theme without features that are slow without a graphics card."""

import numpy as np
from numpy.typing import NDArray
from viser import ViserServer

ACCENT = (28, 126, 214)
BACKGROUND = (235, 242, 248)
"""Background colour of a screenshot."""
SKY_ZENITH, SKY_HORIZON = (176, 206, 233), (242, 246, 249)
SKY_HEIGHT_PX = 256
FLOOR_COLOUR = (226, 229, 231)
GRID_CELL, GRID_SECTION = (208, 212, 216), (178, 184, 190)
GRID_FADE_M = 14.0
CAMERA_POSITION, CAMERA_TARGET = (0.75, -0.75, 0.55), (0.0, 0.0, 0.2)
CAMERA_FOV_RAD = 0.8
RIGHT_PANEL_WIDTH_PX, LEFT_PANEL_WIDTH_PX = 236.0, 224.0
"""Narrow enough that a browser window of 960 px shows more of the robots than of the panels."""


def apply_look(server: ViserServer) -> None:
    """Set colours, lights, sky, floor and the camera's pose."""
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
