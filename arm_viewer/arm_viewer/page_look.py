"""How the page looks: dark, without what costs time where no graphics card is."""

from viser import ViserServer

ACCENT = (77, 171, 247)
BACKGROUND = (20, 20, 20)
"""The colour that the dark theme has behind the 3D view."""
GRID_CELL, GRID_SECTION = (48, 51, 56), (70, 75, 82)
CAMERA_POSITION, CAMERA_TARGET = (0.75, -0.75, 0.55), (0.0, 0.0, 0.2)
CAMERA_FOV_RAD = 0.8
PANEL_WIDTH_PX = 320.0


def apply_look(server: ViserServer) -> None:
    """Set colours, lights, ground grid and the camera's place."""
    server.gui.configure_theme(
        dark_mode=True, show_logo=False, show_share_button=False, brand_color=ACCENT
    )
    server.gui.main_panel.dock_right()
    server.gui.main_panel.set_width(PANEL_WIDTH_PX)
    scene = server.scene
    # The map is what costs most where a browser draws without a graphics card; shadows follow.
    scene.configure_environment_map(None)
    scene.configure_default_lights(enabled=False)
    # Without a second one, faces turned away from the first would be black.
    scene.add_light_directional("/lights/key", intensity=2.6, position=(1.0, -1.5, 2.5))
    scene.add_light_directional("/lights/fill", intensity=1.2, position=(-2.0, 0.5, 0.6))
    scene.add_light_ambient("/lights/ambient", intensity=0.5)
    scene.add_grid(
        "/ground",
        width=4.0,
        height=4.0,
        cell_size=0.1,
        section_size=0.5,
        cell_color=GRID_CELL,
        section_color=GRID_SECTION,
        cell_thickness=0.6,
        section_thickness=0.8,
    )
    camera = server.initial_camera
    camera.position, camera.look_at = CAMERA_POSITION, CAMERA_TARGET
    camera.fov = CAMERA_FOV_RAD
