"""Read `<lens><intrinsics>` and `<distortion>` of a camera."""

from dataclasses import replace

import numpy as np

from arm_gazebo.sensors.camera import MAX_SIDE, CameraSensor
from arm_gazebo.sensors.tags import SensorTags

INTRINSICS = {"fx": 277.0, "fy": 277.0, "cx": 160.0, "cy": 120.0}
"""SDF's defaults, which hold for a picture of 320x240 and are used for every size."""
COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3")
MIDDLE = (0.5, 0.5)
FOCAL_LENGTHS = (1.0, 1e6)
OFFSETS = (-1e5, 1e5)
"""Limits in pixels of the principal point and the skew."""
LARGEST = 1e6
"""Limit of a coefficient."""
HALF_PIXEL = 0.5


def with_lens(camera: CameraSensor, tags: SensorTags) -> CameraSensor:
    """Return a camera with the lens that its tags describe.

    `<center>` is the principal point as a fraction of the picture's sides. It counts if there are
    coefficients, as in Gazebo, and if `<intrinsics>` does not say where that point is.

    Raises:
        SensorError: a value is invalid, or the distortion cannot be undone in the whole picture.
    """
    intrinsics = _intrinsics(tags)
    distortion = tuple(
        _number(tags, f"distortion/{name}", 0.0, (-LARGEST, LARGEST)) for name in COEFFICIENTS
    )
    center = tags.numbers("distortion/center", MIDDLE)
    point = center[0] * camera.width, center[1] * camera.height
    if any(distortion) and center != MIDDLE:
        if not all(0 <= share <= 1 for share in center):
            raise tags.error("distortion/center", f"must be from 0 to 1, not {center}")
        if not intrinsics:
            focal_length = camera.lens.fx
            intrinsics = (focal_length, focal_length, *point, 0.0)
        elif np.abs(np.subtract(intrinsics[2:4], point)).max() > HALF_PIXEL:
            used = " ".join(f"{value:g}" for value in intrinsics[2:4])
            tags.doubt(
                "distortion/center",
                f"this is the pixel {point[0]:g} {point[1]:g}, but the principal point of "
                f"<intrinsics>, {used}, is the centre of the distortion",
            )
    camera = replace(camera, intrinsics=intrinsics, distortion=distortion)
    _check_size(camera, tags)
    return camera


def _intrinsics(tags: SensorTags) -> tuple[float, ...]:
    """Return fx, fy, cx, cy and skew; empty without `<intrinsics>`."""
    where = "lens/intrinsics"
    if not tags.has(where):
        return ()
    missing = {name: value for name, value in INTRINSICS.items() if not tags.has(f"{where}/{name}")}
    if missing:
        values = ", ".join(f"<{name}> {value:g}" for name, value in missing.items())
        tags.doubt(where, f"what it leaves out has SDF's value for 320x240: {values}")
    numbers = [
        _number(tags, f"{where}/{name}", value, FOCAL_LENGTHS if name[0] == "f" else OFFSETS)
        for name, value in INTRINSICS.items()
    ]
    return (*numbers, _number(tags, f"{where}/s", 0.0, OFFSETS))


def _number(tags: SensorTags, tag: str, default: float, limits: tuple[float, float]) -> float:
    least, largest = limits
    must_be = f"from {least:g} to {largest:g}"
    return tags.number(tag, default, lambda value: least <= value <= largest, must_be)


def _check_size(camera: CameraSensor, tags: SensorTags) -> None:
    lens, size = camera.lens, (camera.width, camera.height)
    if lens.is_pinhole:
        return
    problem = lens.problem(*size)
    if not problem:
        drawn = np.ptp(lens.outline(*size), axis=0) * (lens.fx, lens.fy)
        if drawn.max() > MAX_SIDE:
            problem = (
                f"a picture without it would have {drawn[0]:.0f}x{drawn[1]:.0f} pixels; at most "
                f"{MAX_SIDE} can be rendered"
            )
    if problem:
        raise tags.error("distortion", problem)
