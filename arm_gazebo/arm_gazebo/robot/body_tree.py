"""Add the links and joints of a robot to a MuJoCo specification as bodies and joints."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import wxyz_from_rpy
from arm_description.urdf.joint_type import JointType
from arm_description.urdf.robot import Inertial, Joint, Link, Pose, Robot
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError
from arm_gazebo.mjcf.dry_friction import sticking
from arm_gazebo.mjcf.names import free_name
from arm_gazebo.robot.inertia_repair import (
    MAX_GYRATION_M2,
    PrincipalInertia,
    missing_inertia,
    repair_inertia,
)
from arm_gazebo.robot.link_geometry import LinkGeometry
from arm_node.frozen import frozen

WORLD_LINK = "world"
MAX_TREE_DEPTH = 1000
"""Limit on the length of a chain of links. MuJoCo takes 1023 bodies, and works for minutes before
it refuses many more."""
MAX_MOVING_JOINTS = 1000
"""Limit on moving joints: sizing the drives needs a dense inertia matrix of 8 MB in each pose."""
LOCKED_RANGE = 1e-4
"""Half width, in rad or m, of the range of a joint whose two limits are equal."""
MIN_STROKE = 1e-9
"""Limits that differ by less than this, in rad or m, count as equal."""
HINGE = mujoco.mjtJoint.mjJNT_HINGE
SLIDE = mujoco.mjtJoint.mjJNT_SLIDE
BALL = mujoco.mjtJoint.mjJNT_BALL


@frozen
class TreeOptions:
    """How a robot's tree is placed in the world.

    Attributes:
        step_s: physics step.
        default: default values; the world file's own defaults are for the world only.
        free: whether a root link other than `world` can move.
        spawn: pose of the root in the world.
        weightless: names of the links on which gravity does not act.
    """

    step_s: float
    default: mujoco.MjsDefault
    free: bool
    spawn: Pose
    weightless: frozenset[str] = frozenset()


class BodyTree:
    """Adds every link of a robot to a specification as a separate body.

    Fixed joints are not fused, so every link keeps its frame. A root link called `world` is the
    world. A link called `world` below the root is an ordinary body with another name.

    Raises:
        ModelError: the robot is too large to be simulated.
    """

    def __init__(
        self,
        spec: mujoco.MjSpec,
        robot: Robot,
        geometry: LinkGeometry,
        options: TreeOptions,
        report: BuildReport,
    ) -> None:
        _check_size(robot)
        self._spec = spec
        self._robot = robot
        self._links_carrying_mass = _links_carrying_mass(robot)
        self._geometry = geometry
        self._options = options
        self._report = report
        self._bodies: dict[str, mujoco.MjsBody] = {}
        self._joint_names = {joint.name for joint in (*spec.joints, *robot.joints)}
        # MuJoCo reads all angles of the specification in the unit that the world file sets.
        self._angle = math.degrees(1.0) if spec.compiler.degree else 1.0

    def add(self) -> dict[str, mujoco.MjsBody]:
        """Add every link and joint; return the bodies by link name."""
        self._add_root()
        for joint in self._robot.joints_in_tree_order:
            body = self._bodies[joint.parent].add_body(
                name=self._body_name(joint.child), **self._placement(joint.parent, joint.origin)
            )
            self._bodies[joint.child] = body
            self._add_joints(body, joint)
            self._add_link(body, self._robot.link(joint.child), moves=not joint.type.is_static)
        return self._bodies

    def _add_root(self) -> None:
        root = self._robot.link(self._robot.root)
        world = self._spec.worldbody
        if self._is_world(root.name):
            self._bodies[root.name] = world
            self._geometry.add(world, root)
            return
        body = world.add_body(
            name=root.name, pos=self._options.spawn.xyz, quat=wxyz_from_rpy(self._options.spawn.rpy)
        )
        self._bodies[root.name] = body
        if self._options.free:
            body.add_freejoint(name=self._joint_name(f"{root.name}_free"))
        self._add_link(body, root, moves=self._options.free)

    def _is_world(self, link: str) -> bool:
        return link == self._robot.root == WORLD_LINK

    def _body_name(self, link: str) -> str:
        """Return the body name of a link below the root; MuJoCo's world body is called `world`."""
        if link != WORLD_LINK:
            return link
        taken = (*self._spec.bodies, *self._robot.links)
        return free_name(link, {element.name for element in taken})

    def _joint_name(self, name: str) -> str:
        """Return a generated joint name, changed if it is already taken."""
        name = free_name(name, self._joint_names)
        self._joint_names.add(name)
        return name

    def _placement(self, parent: str, origin: Pose) -> dict[str, NDArray[np.float64]]:
        """Return position and quaternion of a child; the spawn pose moves the `world` link."""
        if not self._is_world(parent):
            return {"pos": np.asarray(origin.xyz), "quat": wxyz_from_rpy(origin.rpy)}
        matrix = self._options.spawn.matrix() @ origin.matrix()
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(matrix[:3, :3]).ravel())
        return {"pos": matrix[:3, 3], "quat": quaternion}

    def _add_link(self, body: mujoco.MjsBody, link: Link, moves: bool) -> None:
        self._geometry.add(body, link)
        body.gravcomp = float(link.name in self._options.weightless)
        inertial = link.inertial
        if inertial is not None and (inertial.mass > 0 or moves):
            inertia = repair_inertia(inertial, self._box_if_implausible(inertial, link))
            for remark in inertia.remarks:
                self._report.repair(f"link '{link.name}'", remark, link.line)
        elif moves and link.name not in self._links_carrying_mass:
            box = self._geometry.bounds(link)
            inertia = missing_inertia(box)
            reason = "because it has no shape" if box is None else "estimated from its size"
            self._report.repair(
                f"link '{link.name}'",
                f"it moves but has no mass; {inertia.mass:.3g} kg is used, {reason}",
                link.line,
            )
        else:
            return
        _set_inertia(body, inertia)

    def _box_if_implausible(self, inertial: Inertial, link: Link) -> NDArray[np.float64] | None:
        """Return the link's bounds only if its inertia may need them, because meshes take time."""
        trace = inertial.inertia[0] + inertial.inertia[3] + inertial.inertia[5]
        doubtful = trace > MAX_GYRATION_M2 * inertial.mass
        return self._geometry.bounds(link) if doubtful else None

    def _add_joints(self, body: mujoco.MjsBody, joint: Joint) -> None:
        match joint.type:
            case JointType.REVOLUTE | JointType.CONTINUOUS:
                self._add_scalar(body, joint, HINGE)
            case JointType.PRISMATIC:
                self._add_scalar(body, joint, SLIDE)
            case JointType.FLOATING if self._is_world(joint.parent):
                body.add_freejoint(name=joint.name)
            case JointType.FLOATING:
                # In MuJoCo only children of the world can have a free joint.
                for axis, direction in zip("xyz", np.eye(3), strict=True):
                    name = self._joint_name(f"{joint.name}_{axis}")
                    body.add_joint(self._options.default, name=name, type=SLIDE, axis=direction)
                name = self._joint_name(f"{joint.name}_rotation")
                body.add_joint(self._options.default, name=name, type=BALL)
            case JointType.PLANAR:
                # Nothing could stop it, and /tf shows the link at the joint's origin.
                self._report.repair(
                    f"joint '{joint.name}'",
                    "a planar joint can be neither commanded nor observed; link "
                    f"'{joint.child}' is fixed to '{joint.parent}'",
                    joint.line,
                )
            case JointType.FIXED:
                pass

    def _add_scalar(self, body: mujoco.MjsBody, joint: Joint, kind: mujoco.mjtJoint) -> None:
        added = body.add_joint(self._options.default, name=joint.name, type=kind, axis=joint.axis)
        # Stiff stops; two steps are the shortest time constant that MuJoCo's solver accepts.
        added.solref_limit = [max(0.004, 2 * self._options.step_s), 1.0]
        added.damping = np.array([joint.dynamics.damping, 0.0, 0.0])
        added.frictionloss = joint.dynamics.friction
        solver = sticking(self._options.step_s)
        added.solref_friction, added.solimp_friction = solver.solref, solver.solimp
        bounds = self._bounds(joint)
        added.limited = mujoco.mjtLimited.mjLIMITED_FALSE
        if bounds is not None:
            added.limited = mujoco.mjtLimited.mjLIMITED_TRUE
            unit = self._angle if kind == HINGE else 1.0
            added.range = [bound * unit for bound in bounds]

    def _bounds(self, joint: Joint) -> tuple[float, float] | None:
        if joint.limit is None or not math.isfinite(joint.limit.upper - joint.limit.lower):
            return None
        lower, upper = joint.limit.lower, joint.limit.upper
        if upper > lower and not math.isclose(upper, lower, abs_tol=MIN_STROKE):
            return lower, upper
        self._report.warn(
            f"joint '{joint.name}'",
            f"its limits of {lower:g} and {upper:g} leave it no room to move; it gets "
            f"{LOCKED_RANGE:g} to each side",
            joint.line,
        )
        return lower - LOCKED_RANGE, lower + LOCKED_RANGE


def _check_size(robot: Robot) -> None:
    """Refuse a robot that would take minutes or all memory to build."""
    moving = sum(not joint.type.is_static for joint in robot.joints)
    if moving > MAX_MOVING_JOINTS:
        raise ModelError(
            f"robot '{robot.name}' has {moving} joints that move; at most {MAX_MOVING_JOINTS} are "
            "simulated"
        )
    depths = {robot.root: 0}
    for joint in robot.joints_in_tree_order:
        depths[joint.child] = depths[joint.parent] + 1
        if depths[joint.child] > MAX_TREE_DEPTH:
            raise ModelError(
                f"line {joint.line}: link '{joint.child}' is more than {MAX_TREE_DEPTH} joints "
                f"below '{robot.root}', which is deeper than MuJoCo supports"
            )


def _links_carrying_mass(robot: Robot) -> frozenset[str]:
    """Return the links that have something with mass fixed to them."""
    laden: set[str] = set()
    for joint in reversed(robot.joints_in_tree_order):
        inertial = robot.link(joint.child).inertial
        heavy = inertial is not None and inertial.mass > 0
        if joint.type.is_static and (heavy or joint.child in laden):
            laden.add(joint.parent)
    return frozenset(laden)


def _set_inertia(body: mujoco.MjsBody, inertia: PrincipalInertia) -> None:
    body.explicitinertial = True
    body.mass = inertia.mass
    body.ipos = inertia.position
    body.iquat = inertia.quaternion
    body.inertia = inertia.moments
