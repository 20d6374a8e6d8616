"""What the robot sees and feels with: depth camera, lidar and IMU."""

from arm_meshes.outline import rectangle
from arm_meshes.part import Part, Piece
from arm_meshes.solid import bevelled_box, box, cylinder, prism, union

CAMERA_LOWER, CAMERA_UPPER = (-21.0, -45.0, -12.5), (3.2, 45.0, 12.5)
LENSES = {-30.0: 4.0, -8.0: 6.0, 15.0: 5.5, 35.0: 4.0}
"""Radius by y: projector, two infrared eyes and the one for colours."""
LIDAR_UNDERSIDE, LIDAR_TURRET_FROM, LIDAR_TOP = -20.85, -1.0, 18.0
IMU_HALF = (19.495, 18.925, 6.69)


def camera() -> Part:
    """Return the link cam_1_link, which looks along its x axis."""
    case = bevelled_box(CAMERA_LOWER, CAMERA_UPPER, bevel=5.0)
    face = CAMERA_UPPER[0]
    rooms = union(cylinder("x", (y, 0.0), r, face - 1.0, face + 1.0) for y, r in LENSES.items())
    lenses = union(cylinder("x", (y, 0.0), r, face - 1.2, face - 0.4) for y, r in LENSES.items())
    pieces = (Piece("cam_1", "grey", case - rooms), Piece("cam_1_lenses", "dark", lenses))
    return Part("cam_1_link", pieces, body=case, mass_kg=0.072)


def lidar() -> Part:
    """Return the link laser_frame: a turret on a square foot."""
    foot = prism(
        rectangle((-38.5, -38.2), (38.5, 38.2), corner=10.0),
        "z",
        LIDAR_UNDERSIDE,
        LIDAR_TURRET_FROM,
    )
    turret = cylinder("z", (0.0, 0.0), 37.0, LIDAR_TURRET_FROM, LIDAR_TOP, 48)
    window = cylinder("z", (0.0, 0.0), 38.0, 3.0, 13.0, 48)
    pieces = (
        Piece("laser_frame", "black", foot + (turret - window)),
        Piece("laser_frame_window", "dark", window ^ cylinder("z", (0, 0), 36.6, 2.8, 13.2, 48)),
    )
    return Part("laser_frame", pieces, body=foot + turret, mass_kg=0.185)


def imu() -> Part:
    """Return the link imu_link: a board with a chip, as large as the original's box."""
    x, y, z = IMU_HALF
    board = box((-x, -y, -z), (x, y, -z + 2.0))
    chip = bevelled_box((-12.0, -12.0, -z + 2.0), (12.0, 12.0, z), bevel=1.0)
    return Part(
        "imu_link", (Piece("imu_link", "black", board + chip),), body=board + chip, mass_kg=0.031
    )
