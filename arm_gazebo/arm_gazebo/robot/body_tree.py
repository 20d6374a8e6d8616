"""The links and joints of a robot as bodies and joints of a MuJoCo specification."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.robot import Inertial, Joint, Link, Pose, Robot
from arm_description.transform_tree import STANDING
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError
from arm_gazebo.free_name import free_name
from arm_gazebo.quaternion import wxyz
from arm_gazebo.robot.inertia_repair import (
    LARGEST_GYRATION_M2,
    PrincipalInertia,
    missing_inertia,
    repair_inertia,
)
from arm_gazebo.robot.link_geometry import LinkGeometry

WORLD_LINK = "world"
DEEPEST = 1000
"""Links below each other; MuJoCo takes 1023 bodies, after minutes of work for many more."""
MOST_MOVING = 1000
"""Joints that move, whose inertia matrix is dense where drives are sized: 8 MB in each pose."""
LOCKED_RANGE = 1e-4
"""Half width, in rad or m, of the range of a joint whose two limits are equal."""
SHORTEST_STROKE = 1e-9
"""Limits less than this apart, in rad or m, are equal."""
HINGE = mujoco.mjtJoint.mjJNT_HINGE
SLIDE = mujoco.mjtJoint.mjJNT_SLIDE
BALL = mujoco.mjtJoint.mjJNT_BALL


@dataclass(frozen=True, slots=True)
class TreeOptions:
    """How a robot's tree stands in the world.

    Attributes:
        step_s: physics step.
        default: values of what is not set: the world file's own defaults are for the world.
        free: whether a root link that is no `world` link can move.
        spawn: pose of the root in the world.
    """

    step_s: float
    default: mujoco.MjsDefault
    free: bool
    spawn: Pose


class BodyTree:
    """Adds the links of a robot to a specification, each a body of its own.

    Fixed joints are not fused: every link keeps its frame. A root link called `world` is the
    world; one below the root is a body like the others, under another name.

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
        self._laden = _laden_links(robot)
        self._geometry = geometry
        self._step_s = options.step_s
        self._default = options.default
        self._free = options.free
        self._spawn = options.spawn
        self._report = report
        self._bodies: dict[str, mujoco.MjsBody] = {}
        self._joint_names = {joint.name for joint in (*spec.joints, *robot.joints)}
        # MuJoCo reads angles of the whole specification in the unit that the world file chose.
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
            self._add_link(body, self._robot.link(joint.child), moves=joint.type not in STANDING)
        return self._bodies

    def _add_root(self) -> None:
        root = self._robot.link(self._robot.root)
        world = self._spec.worldbody
        if self._is_world(root.name):
            self._bodies[root.name] = world
            self._geometry.add(world, root)
            return
        body = world.add_body(name=root.name, pos=self._spawn.xyz, quat=wxyz(self._spawn.rpy))
        self._bodies[root.name] = body
        if self._free:
            body.add_freejoint(name=self._joint_name(f"{root.name}_free"))
        self._add_link(body, root, moves=self._free)

    def _is_world(self, link: str) -> bool:
        return link == self._robot.root == WORLD_LINK

    def _body_name(self, link: str) -> str:
        """Return the name of a link that is not the root; MuJoCo's own world is a body too."""
        if link != WORLD_LINK:
            return link
        taken = (*self._spec.bodies, *self._robot.links)
        return free_name(link, {element.name for element in taken})

    def _joint_name(self, name: str) -> str:
        """Return a made-up name, or where some joint has it a similar one."""
        name = free_name(name, self._joint_names)
        self._joint_names.add(name)
        return name

    def _placement(self, parent: str, origin: Pose) -> dict[str, NDArray[np.float64]]:
        """Return position and quaternion of a child; the spawn pose moves the `world` link."""
        if not self._is_world(parent):
            return {"pos": np.asarray(origin.xyz), "quat": wxyz(origin.rpy)}
        matrix = self._spawn.matrix() @ origin.matrix()
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(matrix[:3, :3]).ravel())
        return {"pos": matrix[:3, 3], "quat": quaternion}

    def _add_link(self, body: mujoco.MjsBody, link: Link, moves: bool) -> None:
        self._geometry.add(body, link)
        inertial = link.inertial
        if inertial is not None and (inertial.mass > 0 or moves):
            inertia = repair_inertia(inertial, self._doubtful_box(inertial, link))
            for remark in inertia.remarks:
                self._report.repair(f"link '{link.name}'", remark, link.line)
        elif moves and link.name not in self._laden:
            box = self._geometry.bounds(link)
            inertia = missing_inertia(box)
            reason = "it has no shape to go by" if box is None else "going by its size"
            self._report.repair(
                f"link '{link.name}'",
                f"it moves but has no mass; {inertia.mass:.3g} kg is used, {reason}",
                link.line,
            )
        else:
            return
        _set_inertia(body, inertia)

    def _doubtful_box(self, inertial: Inertial, link: Link) -> NDArray[np.float64] | None:
        """Return the link's bounds only where its inertia may need them: meshes take time."""
        trace = inertial.inertia[0] + inertial.inertia[3] + inertial.inertia[5]
        doubtful = trace > LARGEST_GYRATION_M2 * inertial.mass
        return self._geometry.bounds(link) if doubtful else None

    def _add_joints(self, body: mujoco.MjsBody, joint: Joint) -> None:
        match joint.type:
            case "revolute" | "continuous":
                self._add_scalar(body, joint, HINGE)
            case "prismatic":
                self._add_scalar(body, joint, SLIDE)
            case "floating" if self._is_world(joint.parent):
                body.add_freejoint(name=joint.name)
            case "floating":
                # MuJoCo's free joint is for children of the world only.
                for axis, direction in zip("xyz", np.eye(3), strict=True):
                    name = self._joint_name(f"{joint.name}_{axis}")
                    body.add_joint(self._default, name=name, type=SLIDE, axis=direction)
                name = self._joint_name(f"{joint.name}_rotation")
                body.add_joint(self._default, name=name, type=BALL)
            case "planar":
                # Nothing could stop it, and /tf has the link where the joint's origin is.
                self._report.repair(
                    f"joint '{joint.name}'",
                    "a planar joint can be neither commanded nor observed; link "
                    f"'{joint.child}' is fixed to '{joint.parent}'",
                    joint.line,
                )
            case "fixed":
                pass

    def _add_scalar(self, body: mujoco.MjsBody, joint: Joint, kind: mujoco.mjtJoint) -> None:
        added = body.add_joint(self._default, name=joint.name, type=kind, axis=joint.axis)
        # Stiff stops, two steps being the stiffest that MuJoCo's solver takes.
        added.solref_limit = [max(0.004, 2 * self._step_s), 1.0]
        added.damping = np.array([joint.dynamics.damping, 0.0, 0.0])
        added.frictionloss = joint.dynamics.friction
        if joint.limit is not None and joint.dynamics.friction >= joint.limit.effort:
            # MuJoCo's own friction is so soft that a drive would pass through it all the same. One
            # that only hinders is left so: stiff, it costs a standing error of 1 mrad and more.
            added.solref_friction = [max(0.004, 2 * self._step_s), 1.0]
            added.solimp_friction = [0.999, 0.9999, 0.001, 0.5, 2.0]
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
        if upper > lower and not math.isclose(upper, lower, abs_tol=SHORTEST_STROKE):
            return lower, upper
        self._report.warn(
            f"joint '{joint.name}'",
            f"its limits of {lower:g} and {upper:g} leave it no way to move",
            joint.line,
        )
        return lower - LOCKED_RANGE, lower + LOCKED_RANGE


def _check_size(robot: Robot) -> None:
    """Refuse a robot that would take minutes or all memory before anything is made of it."""
    moving = sum(joint.type not in STANDING for joint in robot.joints)
    if moving > MOST_MOVING:
        raise ModelError(
            f"robot '{robot.name}' has {moving} joints that move; at most {MOST_MOVING} are "
            "simulated"
        )
    depths = {robot.root: 0}
    for joint in robot.joints_in_tree_order:
        depths[joint.child] = depths[joint.parent] + 1
        if depths[joint.child] > DEEPEST:
            raise ModelError(
                f"line {joint.line}: link '{joint.child}' hangs on '{robot.root}' over more than "
                f"{DEEPEST} joints, which is deeper than MuJoCo goes"
            )


def _laden_links(robot: Robot) -> frozenset[str]:
    """Return the links to which something with mass is fixed."""
    laden: set[str] = set()
    for joint in reversed(robot.joints_in_tree_order):
        inertial = robot.link(joint.child).inertial
        heavy = inertial is not None and inertial.mass > 0
        if joint.type in STANDING and (heavy or joint.child in laden):
            laden.add(joint.parent)
    return frozenset(laden)


def _set_inertia(body: mujoco.MjsBody, inertia: PrincipalInertia) -> None:
    body.explicitinertial = True
    body.mass = inertia.mass
    body.ipos = inertia.position
    body.iquat = inertia.quaternion
    body.inertia = inertia.moments
