"""Write arm_gazebo/worlds/house.xml from house/: scenery, models, and the pose of each thing.

In house/*.yaml, `low` and `size` are the bounding box of a model in its own frame, in m. A part is
a shape, a material of the scenery, and the part's extent along x, y and z: in `parts` in percent of
that box, in `parts_m` in m. The shapes are box, ellipsoid, cylinder_x, _y and _z, plane, and mat, a
box without collisions.
"""

import argparse
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import lxml.etree as etree
import numpy as np
import yaml
from numpy.typing import NDArray

TOOLS = Path(__file__).resolve().parent
SOURCES = TOOLS / "house"
MODEL_FILES = ("building.yaml", "furniture.yaml", "belongings.yaml")
WORLD = TOOLS.parent / "arm_gazebo" / "worlds" / "house.xml"

MADE_BY = " Made by tools/make_house.py from tools/house/. "
NO_COLLISION = {"contype": "0", "conaffinity": "0"}
CYLINDER_ROTATIONS = {"x": "0 90 0", "y": "90 0 0", "z": "0 0 0"}


def house() -> str:
    """Return the world as MuJoCo XML."""
    scenery = etree.parse(str(SOURCES / "scenery.xml"), etree.XMLParser(remove_blank_text=True))
    worldbody = scenery.find("worldbody")
    models = {name: model for file in MODEL_FILES for name, model in _read(file).items()}
    for name, model, *pose in _read("things.yaml"):
        body = etree.SubElement(worldbody, "body", name=name, pos=_words(pose[:3]))
        if any(pose[3:]):
            body.set("quat", _words(_quaternion(*pose[3:])))
        for attributes in _geoms(models[model]):
            etree.SubElement(body, "geom", **attributes)
    scenery.getroot().insert(0, etree.Comment(MADE_BY))
    etree.indent(scenery)
    return etree.tostring(scenery, encoding="unicode") + "\n"


def _read(name: str) -> Any:
    return yaml.safe_load((SOURCES / name).read_text(encoding="utf-8"))


def _geoms(model: Mapping[str, Any]) -> Iterator[dict[str, str]]:
    """Yield the attributes of a model's geoms."""
    if "parts_m" in model:
        origin, unit, parts = np.zeros(3), np.ones(3), model["parts_m"]
    else:
        origin, unit, parts = np.array(model["low"]), np.array(model["size"]) / 100, model["parts"]
    for part in parts:
        shape, material, *numbers = part.split()
        ends = np.array(numbers, dtype=np.float64).reshape(3, 2)
        low, high = origin + unit * ends[:, 0], origin + unit * ends[:, 1]
        yield {
            **_shape(shape, (high - low) / 2),
            "pos": _words((low + high) / 2),
            "material": material,
        }


def _shape(shape: str, half: NDArray[np.float64]) -> dict[str, str]:
    """Return the attributes of a shape that fills a box of this half size."""
    kind, _, axis = shape.partition("_")
    if kind == "cylinder":
        along = "xyz".index(axis)
        size = [min(np.delete(half, along)), half[along]]
        return {"type": kind, "size": _words(size), "euler": CYLINDER_ROTATIONS[axis]}
    if kind == "plane":
        return {"type": kind, "size": _words([half[0], half[1], 1])}
    if kind == "mat":
        return {"type": "box", "size": _words(half), **NO_COLLISION}
    return {"type": kind, "size": _words(half)}


def _quaternion(roll: float, pitch: float, yaw: float) -> NDArray[np.float64]:
    """Return the rotation about fixed x, y and z as (w, x, y, z)."""
    (cr, cp, cy), (sr, sp, sy) = (f(np.array([roll, pitch, yaw]) / 2) for f in (np.cos, np.sin))
    return np.array(
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    )


def _words(numbers: Sequence[float] | NDArray[np.float64]) -> str:
    """Return numbers rounded to a micrometre, without trailing zeros."""
    return " ".join(f"{round(float(number), 6) + 0.0:.9g}" for number in numbers)


def main(argv: list[str] | None = None) -> int:
    """Write the file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--output", type=Path, default=WORLD, help="file to write")
    output: Path = parser.parse_args(argv).output
    output.write_text(house(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
