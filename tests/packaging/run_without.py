"""Imports all modules of the suite and reads mesh files where other modules cannot be imported.

Arguments: the modules to hide and the packages, both as JSON lists, and a folder of mesh files.
Prints the names of the files that could be read and drawn.
"""

import importlib
import json
import pkgutil
import sys
from collections.abc import Iterable
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path

from arm_gazebo.errors import MissingWarpError
from arm_node.environment import prepare_environment
from arm_planning.errors import MissingOmplError
from arm_sim.errors import MissingPackageError


class WithoutThese(PathFinder):
    """Finds no module of the hidden ones, as where they are not installed."""

    hidden: frozenset[str] = frozenset()

    @classmethod
    def find_spec(
        cls, fullname: str, path: object = None, target: object = None
    ) -> ModuleSpec | None:
        if fullname.partition(".")[0] in cls.hidden:
            return None
        return super().find_spec(fullname, path, target)


def import_all(packages: Iterable[str]) -> None:
    for package in packages:
        folders = importlib.import_module(package).__path__
        for module in pkgutil.walk_packages(folders, f"{package}."):
            # pytest alone loads its plugin.
            if not module.name.endswith((".__main__", ".pytest_plugin")):
                try:
                    importlib.import_module(module.name)
                except (MissingPackageError, MissingWarpError, MissingOmplError):
                    # A part that needs an extra says so.
                    continue


def draw(path: Path) -> None:
    from arm_description.mesh.file import check_mesh_file, read_mesh_file
    from arm_viewer.scene.triangles import edges, smooth

    check_mesh_file(path)
    for part in read_mesh_file(path):
        part.check()
        smooth(part).check()
        edges(part)


def main(hidden: str, packages: str, folder: str) -> None:
    WithoutThese.hidden = frozenset(json.loads(hidden))
    sys.meta_path[sys.meta_path.index(PathFinder)] = WithoutThese
    prepare_environment()
    import_all(json.loads(packages))
    for path in sorted(Path(folder).iterdir()):
        draw(path)
        print(path.name)


if __name__ == "__main__":
    main(*sys.argv[1:])
