"""Which rclpy is in use, and does it load? A sourced ROS may be in the way of the wheels."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.trial import try_python

NAME = "rclpy"
DISTRIBUTION = "jazzy"
CODE = (
    "import importlib.util as u; s = u.find_spec('rclpy'); print(s.origin if s else ''); "
    "import rclpy.node"
)
OPEN_ANOTHER = (
    "use a terminal in which no setup.bash was sourced, or: "
    "unset PYTHONPATH AMENT_PREFIX_PATH LD_LIBRARY_PATH ROS_DISTRO; "
    "also look for `source /opt/ros/...` in ~/.bashrc"
)
INSTALL = "pip install . from the arm suite's folder"


@dataclass(frozen=True, slots=True)
class ClientLibrary:
    """Imports rclpy in a child process that has the environment."""

    environ: Mapping[str, str]

    def examine(self) -> Finding:
        """Look where rclpy comes from, and whether it can be imported."""
        trial = try_python(["-c", CODE], self.environ)
        origin = trial.out.strip()
        if self._is_sourced(origin):
            sourced = f"rclpy comes from {Path(origin).parent}, by PYTHONPATH: {self._which()}"
            if trial.worked:
                return Finding.warning(NAME, f"{sourced}; the wheels are not used", OPEN_ANOTHER)
            return Finding.error(
                NAME, f"{sourced}, which does not load: {trial.complaint}", OPEN_ANOTHER
            )
        if not origin:
            return Finding.error(NAME, "rclpy is not installed for this Python", INSTALL)
        if not trial.worked:
            return Finding.error(
                NAME,
                f"rclpy from {Path(origin).parent} does not load: {trial.complaint}",
                OPEN_ANOTHER if self.environ.get("ROS_DISTRO") else f"{INSTALL}, again",
            )
        other = self.environ.get("ROS_DISTRO", DISTRIBUTION)
        if other != DISTRIBUTION:
            return Finding.warning(
                NAME,
                f"rclpy loads from {Path(origin).parent}, but {self._which()}: its libraries may "
                "be in the way, and its messages differ",
                OPEN_ANOTHER,
            )
        return Finding.ok(NAME, f"rclpy loads from {Path(origin).parent}")

    def _is_sourced(self, origin: str) -> bool:
        folders = self.environ.get("PYTHONPATH", "").split(os.pathsep)
        return bool(origin) and any(f and Path(origin).is_relative_to(f) for f in folders)

    def _which(self) -> str:
        distribution = self.environ.get("ROS_DISTRO")
        return f"ROS {distribution} is sourced in this shell" if distribution else "not a wheel's"
