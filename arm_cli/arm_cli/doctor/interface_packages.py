"""Do the interface packages load that the ROS wheels lack?"""

from collections.abc import Mapping
from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.trial import try_python
from arm_node.environment import INTERFACE_PACKAGES

NAME = "arm_interfaces"
CODE = """
import importlib, sys
for name, member in zip(sys.argv[1::2], sys.argv[2::2]):
    getattr(importlib.import_module(name), member).__class__.__import_type_support__()
"""
SAMPLES = {
    "tf2_msgs": ("tf2_msgs.msg", "TFMessage"),
    "control_msgs": ("control_msgs.msg", "DynamicJointState"),
    "controller_manager_msgs": ("controller_manager_msgs.srv", "ListControllers"),
    "simulation_interfaces": ("simulation_interfaces.msg", "Result"),
}
"""A type of each package."""


@dataclass(frozen=True, slots=True)
class InterfacePackages:
    """Loads a type of each package, with its compiled part, in a child process."""

    environ: Mapping[str, str]

    def examine(self) -> Finding:
        """Look at all packages at once."""
        samples = [word for package in INTERFACE_PACKAGES for word in SAMPLES[package]]
        trial = try_python(["-c", CODE, *samples], self.environ)
        if not trial.worked:
            return Finding.error(
                NAME,
                f"the interface packages do not load: {trial.complaint}",
                "pip install ./arm_interfaces from the arm suite's folder; it compiles a minute",
            )
        return Finding.ok(NAME, f"{', '.join(INTERFACE_PACKAGES)} load")
