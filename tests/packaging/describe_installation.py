"""Prints as JSON what a process finds of the suite: run by the Python of an installation.

Arguments: the names of the packages.
"""

import importlib
import json
import sys

from ament_index_python.packages import get_package_share_directory

from arm_description.resources import ResourceFinder
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Mesh
from arm_description.xacro.expansion import expand_xacro


def describe(packages: list[str]) -> dict:
    """Return where modules and data are, and what the robot's description leads to."""
    shares = {package: get_package_share_directory(package) for package in packages}
    modules = {package: importlib.import_module(package).__file__ for package in packages}
    xacro = f"{shares['arm_description']}/urdf/arm.urdf.xacro"
    text = expand_xacro(xacro, {})
    robot = parse_urdf(text, xacro)
    finder = ResourceFinder.of_description(text)
    meshes = {
        visual.geometry.uri
        for link in robot.links
        for visual in link.visuals
        if isinstance(visual.geometry, Mesh)
    }
    return {
        "shares": shares,
        "modules": modules,
        "joints": [joint.name for joint in robot.movable_joints],
        "meshes": {uri: str(finder.find(uri)) for uri in sorted(meshes)},
    }


if __name__ == "__main__":
    json.dump(describe(sys.argv[1:]), sys.stdout)
