"""The meshes of every robot that has a make_meshes.py: closed, small, used, made by that script."""

import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
import trimesh

from arm_description import Mesh, expand_xacro, parse_urdf, resolve_uri

REPOSITORY = Path(__file__).parents[2]


@dataclass(frozen=True)
class MadeRobot:
    """A package whose script writes meshes, and macros with inertias and contact boxes."""

    folder: str
    description: str
    macros: str

    @property
    def package(self) -> Path:
        return REPOSITORY / self.folder

    @property
    def meshes(self) -> list[Path]:
        return sorted((self.package / "meshes").glob("*.stl"))


ROBOTS = (
    MadeRobot("arm_description", "urdf/arm.urdf.xacro", "urdf/arm_parts.xacro"),
    MadeRobot(
        "robots/mycobot_description",
        "urdf/robots/mycobot_280.urdf.xacro",
        "urdf/mech/mycobot_280_parts.xacro",
    ),
    MadeRobot(
        "robots/yahboom_rosmaster_description",
        "urdf/robots/rosmaster_x3.urdf.xacro",
        "urdf/mech/rosmaster_x3_parts.xacro",
    ),
)
MESHES = [path for robot in ROBOTS for path in robot.meshes]


@pytest.fixture(scope="module", params=ROBOTS, ids=lambda robot: robot.folder)
def robot(request) -> MadeRobot:
    return request.param


@pytest.fixture(scope="module")
def made_anew(robot, tmp_path_factory) -> Path:
    """A folder with what the script makes now."""
    folder = tmp_path_factory.mktemp("made_anew")
    script = robot.package / "scripts" / "make_meshes.py"
    subprocess.run([sys.executable, str(script), "--output", str(folder)], check=True, timeout=120)
    return folder


@pytest.mark.parametrize("path", MESHES, ids=lambda path: path.stem)
def test_a_mesh_is_closed_and_small(path):
    mesh = trimesh.load_mesh(path)

    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 0
    assert path.stat().st_size < 110_000


def test_the_robot_uses_every_mesh_and_no_other(robot):
    model = parse_urdf(expand_xacro(robot.package / robot.description))

    geometries = [visual.geometry for link in model.links for visual in link.visuals]
    used = {resolve_uri(g.uri).name for g in geometries if isinstance(g, Mesh)}
    assert used == {path.name for path in robot.meshes}


def test_the_script_makes_the_same_meshes(robot, made_anew):
    made = sorted((made_anew / "meshes").iterdir())

    assert [path.name for path in made] == [path.name for path in robot.meshes]
    for path, again in zip(robot.meshes, made, strict=True):
        ours, anew = trimesh.load_mesh(path), trimesh.load_mesh(again)
        # Another version of the libraries may cut the same surface into other triangles.
        assert anew.bounds == pytest.approx(ours.bounds, abs=1e-6), path.name
        assert anew.volume == pytest.approx(ours.volume, rel=1e-4), path.name
        assert anew.area == pytest.approx(ours.area, rel=1e-4), path.name


def test_the_script_makes_the_same_inertias_and_boxes(robot, made_anew):
    number = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")
    ours = (robot.package / robot.macros).read_text(encoding="utf-8")
    anew = (made_anew / robot.macros).read_text(encoding="utf-8")

    assert number.sub("#", anew) == number.sub("#", ours)
    for mine, theirs in zip(number.findall(ours), number.findall(anew), strict=True):
        assert float(theirs) == pytest.approx(float(mine), rel=2e-3, abs=2e-8)
