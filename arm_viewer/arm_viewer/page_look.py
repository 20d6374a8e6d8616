"""How the page looks: dark, without what costs time where no graphics card is."""

from viser import ViserServer

ACCENT = (77, 171, 247)
GRID_CELL, GRID_SECTION = (52, 56, 62), (72, 78, 86)
BACKGROUND = (24, 26, 29)


def apply_look(server: ViserServer) -> None:
    """Set colours, lights, ground grid and the camera's place."""
    server.gui.configure_theme(
        dark_mode=True, show_logo=False, show_share_button=False, brand_color=ACCENT
    )
    server.gui.main_panel.dock_right()
    scene = server.scene
    scene.configure_environment_map(None)
    # Without a second one, faces turned away from the first would be black.
    scene.add_light_directional("/lights/key", intensity=1.6, position=(1.0, -1.5, 2.5))
    scene.add_light_directional("/lights/fill", intensity=0.7, position=(-1.5, 1.0, 0.8))
    scene.add_grid("/ground", width=4.0, height=4.0, cell_size=0.1, section_size=0.5)
