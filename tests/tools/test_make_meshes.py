"""The meshes that make_meshes.py writes: closed, small, used, and the same as the shipped ones."""

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
    """A package with written meshes, and macros with inertias and contact boxes."""

    name: str
    folder: str
    description: str
    macros: str
    visual: str = "meshes"

    @property
    def package(self) -> Path:
        return REPOSITORY / self.folder

    @property
    def meshes(self) -> list[Path]:
        return sorted((self.package / self.visual).glob("*.stl"))


ROBOTS = (
    MadeRobot("arm", "arm_description", "urdf/arm.urdf.xacro", "urdf/arm_parts.xacro"),
    MadeRobot(
        "mycobot",
        "robots/mycobot_description",
        "urdf/robots/mycobot_280.urdf.xacro",
        "urdf/mech/mycobot_280_parts.xacro",
        "meshes/mycobot_280/visual",
    ),
    MadeRobot(
        "rosmaster",
        "robots/yahboom_rosmaster_description",
        "urdf/robots/rosmaster_x3.urdf.xacro",
        "urdf/mech/rosmaster_x3_parts.xacro",
    ),
)
MESHES = [path for robot in ROBOTS for path in robot.meshes]


@pytest.fixture(scope="module", params=ROBOTS, ids=lambda robot: robot.name)
def robot(request) -> MadeRobot:
    return request.param


@pytest.fixture(scope="module")
def rewritten(robot, tmp_path_factory) -> Path:
    """A folder with what the script makes now."""
    folder = tmp_path_factory.mktemp("rewritten")
    script = REPOSITORY / "tools" / "make_meshes.py"
    command = [sys.executable, str(script), robot.name, "--output", str(folder)]
    subprocess.run(command, check=True, timeout=120)
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


def test_the_script_makes_the_same_meshes(robot, rewritten):
    made = sorted((rewritten / robot.visual).glob("*.stl"))

    assert [path.name for path in made] == [path.name for path in robot.meshes]
    for path, again in zip(robot.meshes, made, strict=True):
        ours, written = trimesh.load_mesh(path), trimesh.load_mesh(again)
        # Another version of the libraries may cut the same surface into other triangles.
        assert written.bounds == pytest.approx(ours.bounds, abs=1e-6), path.name
        assert written.volume == pytest.approx(ours.volume, rel=1e-4), path.name
        assert written.area == pytest.approx(ours.area, rel=1e-4), path.name


def test_the_script_makes_the_same_files_of_whole_parts(robot, rewritten):
    def whole_parts(folder: Path) -> dict[Path, Path]:
        found = [*folder.glob("meshes/*/visual/*.dae"), *folder.glob("meshes/*/collision/*.stl")]
        return {path.relative_to(folder): path for path in found}

    ours, written = whole_parts(robot.package), whole_parts(rewritten)
    assert written.keys() == ours.keys()
    assert len(ours) == (30 if robot.name == "mycobot" else 0)
    for name, path in ours.items():
        assert trimesh.load_scene(written[name]).bounds == pytest.approx(
            trimesh.load_scene(path).bounds, abs=1e-6
        )


def test_the_script_makes_the_same_inertias_and_boxes(robot, rewritten):
    number = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")
    ours = (robot.package / robot.macros).read_text(encoding="utf-8")
    written = (rewritten / robot.macros).read_text(encoding="utf-8")

    assert number.sub("#", written) == number.sub("#", ours)
    for mine, theirs in zip(number.findall(ours), number.findall(written), strict=True):
        assert float(theirs) == pytest.approx(float(mine), rel=2e-3, abs=2e-8)
