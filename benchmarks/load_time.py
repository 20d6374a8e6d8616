"""Time to load a 7-DOF arm with 20 meshes: the first time, and from the cache of meshes.

    python benchmarks/load_time.py [--triangles 5120]

Each load is a process of its own, imports included, from the URDF's text to the ready model.
"""

import argparse
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import harness
import numpy as np
import trimesh

MESHES = 20
DOF = 7
FORMATS = ("stl", "obj", "dae")
LOAD = """
import sys, time
started_s = time.perf_counter()
from pathlib import Path
from arm_description.urdf.parser import parse_urdf
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.model.builder import build_model
cache = Path(sys.argv[2]) if len(sys.argv) > 2 else None
built = build_model(parse_urdf(Path(sys.argv[1]).read_text()), [],
                    options=BuildOptions(mesh_cache=cache, strict=True))
assert built.model.njnt == 7
print(time.perf_counter() - started_s)
"""


def write_arm(folder: Path, suffix: str, triangles: int) -> Path:
    """Write an arm whose meshes are all different and all touched; return its URDF."""
    subdivisions = max(1, round(np.log(triangles / 20) / np.log(4)))
    random = np.random.default_rng(1)
    shapes: list[str] = []
    for index in range(MESHES):
        mesh = trimesh.creation.icosphere(subdivisions, 0.08)
        mesh.vertices *= random.uniform(0.5, 1.5, 3)
        file = folder / f"part{index}.{suffix}"
        mesh.export(file)
        geometry = f'<geometry><mesh filename="{file}"/></geometry>'
        shapes.append(f"<visual>{geometry}</visual><collision>{geometry}</collision>")
    links, joints, parent = ['<link name="base"/>'], [], "base"
    for index, group in enumerate(np.array_split(shapes, DOF)):
        links.append(
            f'<link name="l{index}"><inertial><mass value="2"/><inertia ixx="0.01" iyy="0.01" '
            f'izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>{"".join(group)}</link>'
        )
        joints.append(
            f'<joint name="j{index}" type="revolute"><parent link="{parent}"/>'
            f'<child link="l{index}"/><origin xyz="0 0 0.2"/><axis xyz="0 {index % 2} '
            f'{1 - index % 2}"/><limit lower="-3" upper="3" effort="50" velocity="2"/></joint>'
        )
        parent = f"l{index}"
    urdf = folder / "arm.urdf"
    urdf.write_text(f'<robot name="arm">{"".join(links + joints)}</robot>')
    return urdf


def load_s(urdf: Path, *cache: Path) -> float:
    """Return how long a new process takes to load a robot."""
    done = subprocess.run(
        [sys.executable, "-c", LOAD, str(urdf), *map(str, cache)],
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return float(done.stdout)


def spread(values: list[float]) -> str:
    """Return median and maximum as text."""
    return f"median {statistics.median(values):.2f} s, max {max(values):.2f} s (n={len(values)})"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--triangles", type=int, default=5120, help="of each mesh, about")
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    rows = []
    for suffix in FORMATS:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            urdf = write_arm(folder, suffix, arguments.triangles)
            caches = [folder / f"cache{run}" for run in range(arguments.runs)]
            first = [load_s(urdf, cache) for cache in caches]
            again = [load_s(urdf, cache) for cache in caches]
        what = f"{DOF}-DOF arm, {MESHES} .{suffix} meshes of {arguments.triangles} triangles"
        rows.append(harness.Row(f"{what}, first time", spread(first), "3 s"))
        rows.append(harness.Row(f"{what}, again", spread(again), "1 s"))
    harness.print_table("Load time of a robot", rows)


if __name__ == "__main__":
    main()
