"""Wheels whose rim is a ring of free rollers: mecanum and omni wheels.

A URDF describes such a wheel as a cylinder, and Gazebo gives the cylinder friction in only one
direction, <fdir1>. This is the axis of the roller that touches the floor: the roller grips along
its axis and turns across it. The friction of MuJoCo's contacts cannot depend on a direction fixed
to the floor, so the wheel gets real rollers: `COUNT` bodies on hinges without a drive.

A roller is an ellipsoid. Let R be the wheel's radius, r the roller's radius in its middle,
h = R - r, and alpha the angle between the roller's axis and the wheel's direction of travel. The
rim stays at R if the roller's radius at a distance s from its middle is
R - sqrt(h^2 + (s cos alpha)^2). An ellipsoid of half length sqrt(r h) / cos alpha has the same
curvature there. At the transition to the next roller its rim is less than 0.1 % of R too low.
"""

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import rotation_about
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.robot import Cylinder, Joint, Robot
from arm_gazebo.build_report import BuildReport
from arm_gazebo.mjcf.names import free_name
from arm_gazebo.robot.gazebo_tags import GazeboTags, LinkTags
from arm_gazebo.robot.link_geometry import COLLISION_GROUP, set_friction
from arm_node.frozen import frozen

Array = NDArray[np.float64]

COUNT = 16
ROLLER_RADIUS = 0.25
"""Radius of a roller as a fraction of the wheel's radius."""
MASS = 0.1
"""Mass of all rollers as a fraction of the wheel's mass."""
SLIPPERY = 0.1
"""Largest ratio <mu2> / <mu1> that counts as friction in only one direction."""
MIN_COSINE = 0.3
"""Smallest cosine between a roller's axis and the direction of travel that gives any drive."""
ALIGNED = 0.999
"""Smallest cosine between the axes of a cylinder and its joint that counts as parallel."""
ARMATURE = 1e-7
DAMPING = 1e-6
"""Damping of a roller's bearing, in N m s/rad: off the floor it stops within seconds."""
STIFF = (0.005, 1.0)
"""solref of a roller's contacts: MuJoCo's default of 0.02 s lets a heavy robot sink in by 1 %."""
PREVAILING = 1e3
"""solmix of a roller: its stiffness prevails over that of the other shape in contact."""
DOWN = np.array([0.0, 0.0, -1.0])


def add_rollers(
    spec: mujoco.MjSpec,
    bodies: Mapping[str, mujoco.MjsBody],
    robot: Robot,
    tags: GazeboTags,
    report: BuildReport,
) -> None:
    """Add rollers to each wheel with friction in only one direction.

    The root of the robot is upright. The report gets the wheels that have rollers, and those that
    cannot have any.
    """
    rotations = {robot.root: np.eye(3)}
    made: list[str] = []
    for joint in robot.joints_in_tree_order:
        rotations[joint.child] = rotations[joint.parent] @ joint.origin.matrix()[:3, :3]
        link_tags = tags.link(joint.child)
        if link_tags.grip is None or not _is_directed(link_tags):
            continue
        problem = _unfit(robot, joint)
        if not problem:
            grip = _grip_in(rotations, joint.child, link_tags)
            down = rotations[joint.child].T @ DOWN
            problem = _add(spec, bodies[joint.child], robot, joint, (grip, down), link_tags)
        if problem:
            report.warn(f"link '{joint.child}'", f"its <fdir1> is left out: {problem}", joint.line)
        else:
            made.append(f"'{joint.child}'")
    if made:
        report.inform(f"links {', '.join(made)}", f"are wheels with {COUNT} rollers each")


def _is_directed(tags: LinkTags) -> bool:
    """Return whether the friction across the grip is negligible."""
    along, lowest = tags.friction_along, tags.friction
    return along is not None and lowest is not None and lowest <= SLIPPERY * along


def _unfit(robot: Robot, joint: Joint) -> str:
    """Return why a link cannot have rollers; empty if it can."""
    shapes = [shape.geometry for shape in robot.link(joint.child).collisions]
    if joint.type is not JointType.CONTINUOUS:
        return f"joint '{joint.name}' is not continuous, so the link is not a wheel"
    if len(shapes) != 1 or not isinstance(shapes[0], Cylinder):
        return "a wheel with rollers needs exactly one collision shape, a cylinder"
    axis = robot.link(joint.child).collisions[0].origin.matrix()[:3, 2]
    if abs(axis @ joint.axis) < ALIGNED * float(np.linalg.norm(joint.axis)):
        return f"its cylinder does not turn about its own axis with joint '{joint.name}'"
    return ""


def _grip_in(rotations: Mapping[str, Array], link: str, tags: LinkTags) -> Array:
    """Return the direction of the grip in the link's axes at position 0, shape (3,)."""
    grip = np.array(tags.grip)
    frame = rotations.get(tags.grip_frame or link)
    return grip if frame is None else rotations[link].T @ frame @ grip


def _add(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    robot: Robot,
    joint: Joint,
    directions: tuple[Array, Array],
    tags: LinkTags,
) -> str:
    """Add the rollers of one wheel; return why that is impossible, or an empty string.

    `directions` are the grip's direction and down, in the link's axes; `tags` have the friction
    along the grip.
    """
    [collision] = robot.link(joint.child).collisions
    assert isinstance(collision.geometry, Cylinder)
    axis = np.array(joint.axis) / np.linalg.norm(joint.axis)
    grip, down = directions
    down = down - down @ axis * axis
    if not (np.linalg.norm(down) > 0.5 and np.linalg.norm(grip) > 0):
        return "its axis is vertical, or the direction is 0 0 0"
    down /= np.linalg.norm(down)
    grip = grip - grip @ down * down
    travel = np.cross(axis, down)
    length = float(np.linalg.norm(grip))
    if length == 0 or abs(grip @ travel) < MIN_COSINE * length:
        return "its rollers would be parallel to the wheel's axis and could not drive"
    grip /= length
    model = next(geom for geom in body.geoms if geom.group == COLLISION_GROUP)
    wheel_radius = collision.geometry.radius
    radius = ROLLER_RADIUS * wheel_radius
    height = wheel_radius - radius
    length = float(np.sqrt(radius * height) / abs(grip @ travel))
    shape = _RollerShape((radius, radius, length), MASS * body.mass / COUNT, model, tags)
    body.mass *= 1 - MASS
    body.inertia = body.inertia * (1 - MASS)
    taken = {other.name for other in spec.bodies}
    for index in range(COUNT):
        turn = rotation_about(axis.tolist(), 2 * np.pi * index / COUNT)
        roller = body.add_body(
            name=free_name(f"{body.name}::roller{index}", taken),
            pos=np.array(collision.origin.xyz) + height * (turn @ down),
            quat=_quaternion_of_z(turn @ grip),
        )
        shape.add_to(roller)
    model.contype = model.conaffinity = 0
    return ""


@frozen
class _RollerShape:
    """The common properties of a wheel's rollers.

    Attributes:
        size: half lengths of the ellipsoid, in m; the last one is along the axis.
        mass: mass of one roller, in kg.
        wheel: the wheel's shape; the rollers collide with the same things.
        tags: the friction along the axis.
    """

    size: tuple[float, float, float]
    mass: float
    wheel: mujoco.MjsGeom
    tags: LinkTags

    def add_to(self, roller: mujoco.MjsBody) -> None:
        """Add the hinge and the shape of a roller to a body; the axis is its z axis."""
        default = mujoco.MjSpec().default
        roller.add_joint(
            default,
            name=roller.name,
            type=mujoco.mjtJoint.mjJNT_HINGE,
            axis=[0, 0, 1],
            armature=ARMATURE,
            damping=DAMPING,
        )
        geom = roller.add_geom(
            default, type=mujoco.mjtGeom.mjGEOM_ELLIPSOID, size=self.size, mass=self.mass
        )
        geom.solref, geom.solmix = STIFF, PREVAILING
        geom.group = COLLISION_GROUP
        geom.contype, geom.conaffinity = self.wheel.contype, self.wheel.conaffinity
        set_friction(geom, self.tags.friction_along or 1.0)


def _quaternion_of_z(direction: Array) -> Array:
    """Return a rotation that takes the z axis to a unit direction, as w x y z."""
    quaternion = np.zeros(4)
    mujoco.mju_quatZ2Vec(quaternion, direction)
    return quaternion
