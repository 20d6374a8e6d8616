"""Two hooks of the build: the ROS 2 wheels that the suite needs, and executables for ROS 2's tools.

The environment variable ROS_DISTRO chooses the wheels, since pip has no other way to replace a
dependency by another.

The executables of each package are put where ROS 2's own tools look: <prefix>/lib/<package>/.
`ros2 run`, `ros2 pkg executables` and launch_ros read that folder alone. Each file runs the script
of pip in <prefix>/bin. Packages that the suite stands in for, such as robot_state_publisher, get
theirs too, and a marker in the ament index; its text tells them from the real package.
"""

import os
import shlex
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

STAND_INS = "arm_cli/resource/executable_stand_ins/arm_cli"
MARKERS = "share/ament_index/resource_index/packages"
MARK = "stand-in of arm-suite\n"
SCRIPT = """#!/bin/sh
exec "$(dirname "$(realpath "$0")")/../../bin/{words}" "$@"
"""


class RosDependencies(MetadataHookInterface):
    """Adds the wheels of the distribution that ROS_DISTRO names."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Set the dependencies, or end with a sentence if there are no such wheels."""
        wheels: dict[str, list[str]] = self.config["ros"]
        chosen = os.environ.get("ROS_DISTRO") or next(iter(wheels))
        if chosen not in wheels:
            raise SystemExit(
                f"ROS_DISTRO is {chosen!r}, but the arm suite is made for {' or '.join(wheels)} "
                "only; set it to one of them, or unset it"
            )
        metadata["dependencies"] = [*wheels[chosen], *self.config["dependencies"]]


class LibFolders(BuildHookInterface[Any]):
    """Adds the files to the wheel, also to an editable one."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write the files to a temporary folder, and name them as data of the wheel."""
        self._folder = Path(tempfile.mkdtemp())
        scripts = {name: target.partition(".")[0] for name, target in self._scripts()}
        files = [(package, name, name) for name, package in scripts.items()]
        files += [(package, name, owned) for package, name, owned in self._stand_ins(scripts)]
        for number, (package, name, script) in enumerate(files):
            path = self._folder / f"{number}"
            path.write_text(SCRIPT.format(words=shlex.quote(script)))
            path.chmod(0o755)
            build_data["shared_data"][str(path)] = f"lib/{package}/{name}"
        for package in sorted({package for package, *_ in files} - set(self._packages())):
            path = self._folder / package
            path.write_text(MARK)
            build_data["shared_data"][str(path)] = f"{MARKERS}/{package}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove the temporary folder."""
        shutil.rmtree(self._folder)

    def _scripts(self) -> Iterator[tuple[str, str]]:
        yield from self.metadata.core.scripts.items()

    def _packages(self) -> list[str]:
        shared = self.build_config.target_config["shared-data"].values()
        return [path.rpartition("/")[2] for path in shared if path.startswith(f"{MARKERS}/")]

    def _stand_ins(self, scripts: dict[str, str]) -> Iterator[tuple[str, str, str]]:
        """Yield package and name of what a script replaces, and the script, nodes only."""
        replaced = self.metadata.core.entry_points["launch_py.packages"]
        for package, owner in replaced.items():
            own = [package] if package in scripts else [n for n, p in scripts.items() if p == owner]
            yield from ((package, name, name) for name in own)
        for line in (Path(self.root) / STAND_INS).read_text().splitlines():
            words = line.split()
            is_node = len(words) == 5 and words[2] == "=" and words[4] in scripts
            is_own = words[:1] and words[0] in self._packages()
            if is_node and not is_own and words[3] != "arm_cli" and "::" not in words[1]:
                yield words[0], words[1], words[4]
