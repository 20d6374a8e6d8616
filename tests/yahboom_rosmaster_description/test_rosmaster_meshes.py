"""The meshes of the ROSMASTER X3: closed, small, as large as the robot, and made by the script."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from arm_description import Mesh, Robot, expand_xacro, parse_urdf, resolve_uri

PACKAGE = Path(__file__).parents[2] / "robots" / "yahboom_rosmaster_description"
MESHES, URDF = PACKAGE / "meshes", PACKAGE / "urdf"
SCRIPT = PACKAGE / "scripts" / "make_meshes.py"
BOUNDS = {
    "base_link": ((-175.91, -82.44, -54.03), (116.5, 82.59, 190.52)),
    "front_left_wheel_link": ((-32.3, -20.05, -32.3), (32.3, 15.15, 32.3)),
    "back_right_wheel_link": ((-32.3, -15.2, -32.3), (32.3, 20.0, 32.3)),
    "cam_1_link": ((-21.85, -45.0, -12.5), (3.2, 45.0, 12.5)),
    "imu_link": ((-19.495, -18.925, -6.69), (19.495, 18.925, 6.69)),
}
"""Bounding boxes in mm, in the link's frame."""


@pytest.fixture(scope="module")
def robot() -> Robot:
    return parse_urdf(expand_xacro(URDF / "robots" / "rosmaster_x3.urdf.xacro"))


def load(path: Path) -> trimesh.Trimesh:
    mesh = trimesh.load(path, force="mesh")
    assert isinstance(mesh, trimesh.Trimesh)
    return mesh


def mesh_files() -> list[Path]:
    return sorted(MESHES.glob("*.stl"))


def visuals(robot: Robot, link: str) -> list[Path]:
    geometries = [visual.geometry for visual in robot.link(link).visuals]
    return [resolve_uri(g.uri) for g in geometries if isinstance(g, Mesh)]


@pytest.mark.parametrize(("link", "bounds"), BOUNDS.items())
def test_a_link_is_as_large_as_the_original(robot, link, bounds):
    meshes = [load(path) for path in visuals(robot, link)]

    lower = np.min([mesh.bounds[0] for mesh in meshes], axis=0) * 1000
    upper = np.max([mesh.bounds[1] for mesh in meshes], axis=0) * 1000
    assert np.array([lower, upper]) == pytest.approx(np.array(bounds), abs=1.5)


@pytest.mark.parametrize("end", ["front", "back"])
def test_the_right_wheel_is_the_left_one_s_mirror_image(robot, end):
    left = [load(path) for path in visuals(robot, f"{end}_left_wheel_link")]
    right = [load(path) for path in visuals(robot, f"{end}_right_wheel_link")]

    for ours, theirs in zip(left, right, strict=True):
        (x0, y0, z0), (x1, y1, z1) = ours.bounds
        assert theirs.bounds == pytest.approx(np.array([[x0, -y1, z0], [x1, -y0, z1]]), abs=2e-5)
        assert theirs.volume == pytest.approx(ours.volume, rel=1e-3)


def test_the_barrels_on_top_point_to_the_middle_of_the_robot(robot):
    for wheel in ("front_left", "front_right", "back_left", "back_right"):
        rollers, _ = (load(path) for path in visuals(robot, f"{wheel}_wheel_link"))
        # So near the top a level cut meets one barrel alone.
        cut = rollers.section([0, 0, 1], [0, 0, 0.032])
        assert cut is not None
        x, y, _ = cut.vertices[(np.abs(cut.vertices[:, :2]) < 0.006).all(axis=1)].T
        pointing = 1.0 if wheel in ("front_left", "back_right") else -1.0
        assert np.polyfit(x, y, 1)[0] * pointing > 0.3, wheel


@pytest.mark.parametrize("path", mesh_files(), ids=lambda path: path.stem)
def test_a_mesh_is_closed_and_small(path):
    mesh = load(path)

    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 0
    assert path.stat().st_size < 110_000


def test_the_robot_uses_every_mesh_and_no_other(robot):
    used = {path.name for link in robot.links for path in visuals(robot, link.name)}

    assert used == {path.name for path in mesh_files()}


def test_the_script_makes_the_same_files(tmp_path):
    subprocess.run(
        [sys.executable, str(SCRIPT), "--output", str(tmp_path)], check=True, timeout=120
    )

    made = sorted(path.name for path in (tmp_path / "meshes").iterdir())
    assert made == [path.name for path in mesh_files()]
    for path in mesh_files():
        ours, anew = load(path), load(tmp_path / "meshes" / path.name)
        # Another version of the libraries may cut the same surface into other triangles.
        assert anew.bounds == pytest.approx(ours.bounds, abs=1e-6), path.name
        assert anew.volume == pytest.approx(ours.volume, rel=1e-4), path.name
    macros = Path("mech/rosmaster_x3_parts.xacro")
    anew, ours = (tmp_path / "urdf" / macros).read_text(), (URDF / macros).read_text()
    assert anew.count("<xacro:macro") == ours.count("<xacro:macro")
