"""The colours of Gazebo's named materials, as far as robots use them."""

from arm_description.mesh_data import Color

_PREFIX = "Gazebo/"
_RGB: dict[str, tuple[float, float, float]] = {
    "Black": (0.0, 0.0, 0.0),
    "Blue": (0.0, 0.0, 1.0),
    "DarkGray": (0.175, 0.175, 0.175),
    "DarkGrey": (0.175, 0.175, 0.175),
    "DarkYellow": (0.7, 0.7, 0.0),
    "FlatBlack": (0.1, 0.1, 0.1),
    "Gold": (0.8, 0.65, 0.12),
    "Gray": (0.7, 0.7, 0.7),
    "Green": (0.0, 1.0, 0.0),
    "Grey": (0.7, 0.7, 0.7),
    "Indigo": (0.33, 0.0, 0.5),
    "LightGray": (0.9, 0.9, 0.9),
    "LightGrey": (0.9, 0.9, 0.9),
    "Orange": (1.0, 0.51, 0.05),
    "Purple": (1.0, 0.0, 1.0),
    "Red": (1.0, 0.0, 0.0),
    "SkyBlue": (0.13, 0.44, 0.7),
    "Turquoise": (0.0, 1.0, 1.0),
    "White": (1.0, 1.0, 1.0),
    "Wood": (0.6, 0.45, 0.3),
    "Yellow": (1.0, 1.0, 0.0),
    "ZincYellow": (0.97, 0.95, 0.21),
}


def gazebo_color(name: str) -> Color | None:
    """Return the colour of a material such as "Gazebo/Orange", None for one not known."""
    rgb = _RGB.get(name.removeprefix(_PREFIX))
    return None if rgb is None else (*rgb, 1.0)
