"""Finds the headers, libraries and templates of the ROS 2 wheels."""

import importlib.util
from dataclasses import dataclass
from pathlib import Path

from interface_build.errors import MissingRosError
from interface_build.project import read_project


@dataclass(frozen=True, slots=True)
class RosPrefix:
    """The folder with ``include``, ``lib`` and ``share`` of the wheels."""

    root: Path

    def template_folder(self, generator: str) -> Path:
        """Return the folder with the templates of one rosidl generator."""
        return self.root / "share" / generator / "resource"

    def description_folders(self) -> dict[str, Path]:
        """Map each interface package of the wheels to its type descriptions."""
        return {
            folder.name: folder
            for folder in sorted((self.root / "share").iterdir())
            if next(folder.glob("msg/*.json"), None) or next(folder.glob("srv/*.json"), None)
        }

    def include_folders(self) -> list[Path]:
        """List the include folders; most packages have one more level: ``<p>/<p>/x.h``."""
        include = self.root / "include"
        nested = [path for path in sorted(include.iterdir()) if (path / path.name).is_dir()]
        return [include, *nested]

    @property
    def library_folder(self) -> Path:
        """Return the folder with the shared libraries."""
        return self.root / "lib"


def find_ros_prefix() -> RosPrefix:
    """Find the prefix from the path of a package in it.

    ``sys.prefix`` would be wrong: with pip's build isolation the wheels are in an overlay.

    Raises:
        MissingRosError: the wheels are not installed, or have another layout.
    """
    spec = importlib.util.find_spec("rosidl_runtime_c")
    for location in (spec and spec.submodule_search_locations) or ():
        for folder in Path(location).resolve().parents:
            headers = folder / "include" / "rosidl_runtime_c"
            templates = folder / "share" / "rosidl_generator_c"
            if headers.is_dir() and templates.is_dir():
                return RosPrefix(folder)
    raise MissingRosError(
        f"{read_project().name} needs the ROS 2 wheels to build, but they were not found; "
        "install it with 'pip install' and build isolation, which downloads them"
    )
