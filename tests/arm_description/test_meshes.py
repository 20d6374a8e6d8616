"""The meshes: like the original's in size, closed, small, and what the script makes."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from arm_description import Mesh, expand_xacro, parse_urdf, resolve_uri

REPOSITORY = Path(__file__).parents[2]
SCRIPT = REPOSITORY / "arm_description" / "scripts" / "make_meshes.py"
MESHES = resolve_uri("package://arm_description/meshes")
URDF = resolve_uri("package://arm_description/urdf")

BOUNDS = {
    ("base_link",): ((-45.18, -45.15, -31.32), (45.18, 44.93, 48.68)),
    ("base_turn",): ((-28.53, -27.87, -1.94), (31.47, 50.38, 5.06)),
    ("base_turn_table_rot",): ((-28.0, -27.8, -7.11), (28.0, 27.8, 13.59)),
    ("dyn", "dyn_trim", "dyn_horn"): ((-11.5, -16.0, -19.0), (38.5, 16.0, 21.0)),
    ("f4_n_f3",): ((-27.35, -60.29, -14.26), (20.65, 31.34, 14.35)),
    ("wrist",): ((-20.19, -27.34, -31.45), (28.02, 27.37, 11.5)),
    ("the_crawer_base",): ((-52.23, -23.99, -2.0), (52.17, 33.81, 3.0)),
    ("the_crawer",): ((-14.7, -15.6, -14.16), (48.2, 15.6, 26.66)),
}
"""Bounding boxes of the original's meshes in mm, by the files that stand for each."""


def load(path: Path) -> trimesh.Trimesh:
    mesh = trimesh.load(path, force="mesh")
    assert isinstance(mesh, trimesh.Trimesh)
    return mesh


def mesh_files() -> list[Path]:
    return sorted(MESHES.glob("*.stl"))


@pytest.fixture(scope="module")
def made_anew(tmp_path_factory) -> Path:
    """Return a folder with what the script makes now."""
    folder = tmp_path_factory.mktemp("made_anew")
    subprocess.run([sys.executable, str(SCRIPT), "--output", str(folder)], check=True, timeout=120)
    return folder


@pytest.mark.parametrize(("files", "bounds"), BOUNDS.items(), ids=lambda value: str(value))
def test_a_part_is_as_large_as_the_original(files, bounds):
    meshes = [load(MESHES / f"{name}.stl") for name in files]

    lower = np.min([mesh.bounds[0] for mesh in meshes], axis=0) * 1000
    upper = np.max([mesh.bounds[1] for mesh in meshes], axis=0) * 1000
    assert np.array([lower, upper]) == pytest.approx(np.array(bounds), abs=1.0)


def test_the_foot_is_flat_below():
    mesh = load(MESHES / "base_link.stl")

    down = mesh.facets_normal[:, 2] < -0.999
    underside = [facet for facet, is_down in zip(mesh.facets, down, strict=True) if is_down]
    lowest = max(underside, key=lambda facet: mesh.area_faces[facet].sum())
    assert mesh.triangles[lowest][:, :, 2] == pytest.approx(-0.0313, abs=1e-7)
    assert mesh.area_faces[lowest].sum() > 0.007


@pytest.mark.parametrize("path", mesh_files(), ids=lambda path: path.stem)
def test_a_mesh_is_closed_and_small(path):
    mesh = load(path)

    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 0
    assert path.stat().st_size < 100_000


def test_all_meshes_together_are_small():
    assert sum(path.stat().st_size for path in mesh_files()) < 400_000


def test_the_robot_uses_every_mesh_and_no_other():
    robot = parse_urdf(expand_xacro(URDF / "arm.urdf.xacro"))

    geometries = [visual.geometry for link in robot.links for visual in link.visuals]
    used = {resolve_uri(geometry.uri) for geometry in geometries if isinstance(geometry, Mesh)}
    assert used == set(mesh_files())


def test_the_script_makes_the_same_files(made_anew):
    assert sorted(path.name for path in made_anew.glob("meshes/*")) == sorted(
        path.name for path in MESHES.iterdir()
    )


@pytest.mark.parametrize("path", mesh_files(), ids=lambda path: path.stem)
def test_the_script_makes_the_same_shape(made_anew, path):
    ours, anew = load(path), load(made_anew / "meshes" / path.name)

    # Another version of the libraries may cut the same surface into other triangles.
    assert anew.bounds == pytest.approx(ours.bounds, abs=1e-6)
    assert anew.volume == pytest.approx(ours.volume, rel=1e-4)
    assert anew.area == pytest.approx(ours.area, rel=1e-4)


def test_the_script_makes_the_same_inertias_and_boxes(made_anew):
    number = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")
    ours = (URDF / "arm_parts.xacro").read_text(encoding="utf-8")
    anew = (made_anew / "urdf" / "arm_parts.xacro").read_text(encoding="utf-8")

    assert number.sub("#", anew) == number.sub("#", ours)
    for mine, theirs in zip(number.findall(ours), number.findall(anew), strict=True):
        assert float(theirs) == pytest.approx(float(mine), rel=2e-3, abs=2e-8)
