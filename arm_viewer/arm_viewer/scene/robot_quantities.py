"""A robot's centre of mass and the loads of its joints, in the 3D view."""

import math
from collections.abc import Mapping

from viser import CylinderHandle, IcosphereHandle, SceneApi

from arm_description.urdf.robot import Robot
from arm_node.rigid_transform import Quaternion, RigidTransform, Vector
from arm_viewer.scene.frames import Frames
from arm_viewer.snapshot import JointReading

CENTRE_RADIUS_M, CENTRE_RGB = 0.012, (255, 120, 90)
DISC_RADIUS_M, DISC_HEIGHT_M = 0.035, 0.008
IDLE, HALF, FULL = (46, 160, 67), (240, 173, 0), (201, 42, 42)
"""Colours of no load, half of the largest and the largest."""
STEPS = 20
"""Colours are sent in steps of this part of the range."""


def centre_of_mass(
    robot: Robot, places: Mapping[str, str], poses: Mapping[str, RigidTransform]
) -> tuple[float, Vector] | None:
    """Return a robot's mass in kg, and its centre of mass in the world's frame.

    Returns:
        None if no link has a mass, or one that has is nowhere.
    """
    mass, moment = 0.0, [0.0, 0.0, 0.0]
    for link in robot.links:
        if link.inertial is None or not link.inertial.mass > 0.0:
            continue
        pose = poses.get(places[link.name])
        if pose is None:
            return None
        centre = pose.then(RigidTransform(link.inertial.origin.xyz)).position
        mass += link.inertial.mass
        moment = [m + link.inertial.mass * c for m, c in zip(moment, centre, strict=True)]
    if not mass:
        return None
    x, y, z = (component / mass for component in moment)
    return mass, (x, y, z)


def joint_loads(robot: Robot, readings: Mapping[str, JointReading]) -> dict[str, float]:
    """Return the part of its largest effort that each joint applies, in -1 to 1 and beyond.

    Joints without a limit or a measured effort are left out.
    """
    return {
        joint.name: readings[joint.name].effort / joint.limit.effort
        for joint in robot.movable_joints
        if joint.limit is not None
        and 0.0 < joint.limit.effort < math.inf
        and joint.name in readings
        and math.isfinite(readings[joint.name].effort)
    }


def load_colour(load: float) -> tuple[int, int, int]:
    """Return the colour of a load, in steps."""
    share = round(min(abs(load), 1.0) * STEPS) / STEPS
    low, high, part = (IDLE, HALF, 2 * share) if share < 0.5 else (HALF, FULL, 2 * share - 1)
    red, green, blue = (round(a + part * (b - a)) for a, b in zip(low, high, strict=True))
    return red, green, blue


class RobotQuantities:
    """Draws them for one robot; use it in viser's event loop."""

    def __init__(
        self, scene: SceneApi, frames: Frames, name: str, robot: Robot, places: Mapping[str, str]
    ) -> None:
        """Prepare a robot without drawing; see `RobotModel` for the arguments."""
        self._scene = scene
        self._frames = frames
        self._name = name
        self.robot = robot
        self.places = places
        self._centre: IcosphereHandle | None = None
        self._discs: dict[str, CylinderHandle] = {}

    def show_centre(self, point: Vector | None) -> None:
        """Show the centre of mass at a point in the world's frame, or hide it."""
        if point is None:
            if self._centre is not None:
                self._centre.remove()
                self._centre = None
        elif self._centre is None:
            self._centre = self._scene.add_icosphere(
                f"/quantities/{self._name}",
                CENTRE_RADIUS_M,
                CENTRE_RGB,
                position=point,
                cast_shadow=False,
            )
        elif tuple(self._centre.position) != point:
            self._centre.position = point

    def show_loads(self, loads: Mapping[str, float]) -> None:
        """Show a disc of the load's colour at each of these joints, and no others."""
        for name in self._discs.keys() - loads.keys():
            self._discs.pop(name).remove()
        for joint in self.robot.movable_joints:
            if joint.name not in loads:
                continue
            colour = load_colour(loads[joint.name])
            if joint.name not in self._discs:
                path = f"{self._frames.path(self.places[joint.child])}/load"
                self._discs[joint.name] = self._scene.add_cylinder(
                    path,
                    DISC_RADIUS_M,
                    DISC_HEIGHT_M,
                    color=colour,
                    opacity=0.85,
                    cast_shadow=False,
                    wxyz=_turn_to(joint.axis),
                )
            elif self._discs[joint.name].color != colour:
                self._discs[joint.name].color = colour

    def remove(self) -> None:
        """Remove everything from the scene."""
        self.show_centre(None)
        self.show_loads({})


def _turn_to(axis: Vector) -> Quaternion:
    """Return the quaternion (w, x, y, z) of the shortest turn from z to a unit vector."""
    x, y, z = axis
    if z < -0.999999:
        return (0.0, 1.0, 0.0, 0.0)
    length = math.sqrt(2.0 * (1.0 + z))
    return (length / 2.0, -y / length, x / length, 0.0)
