"""A jog: from commands to positions and speeds of the joints, one period after the other."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from arm_node.rigid_transform import RigidTransform, rotated
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.collision.model import CollisionModel
from arm_planning.collision.proximity import Proximity
from arm_planning.errors import InvalidRequestError
from arm_planning.kinematics.chain import Chain
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.scene import PlanningScene
from arm_planning.servo.collision_slowdown import CollisionSlowdown
from arm_planning.servo.commands import JogCommand, JointSpeeds, TipTarget, TipTwist
from arm_planning.servo.joint_bounds import JointBounds
from arm_planning.servo.settings import UNITLESS, ServoSettings
from arm_planning.servo.status import JogStatus, Slowdown, StatusCode, slowest
from arm_planning.servo.tip_velocity import TipVelocity, pose_difference

Array = NDArray[np.float64]

AT_REST = 1e-9
COLLISION = (StatusCode.DECELERATE_FOR_COLLISION, StatusCode.HALT_FOR_COLLISION)
TRACKING_GAIN = 4.0
"""Speed towards a target pose over its distance, 1/s."""
OTHERS_MOVED = 1e-3
"""Motion of joints outside of the group after which distances are computed anew, rad or m."""


@dataclass(frozen=True, slots=True, eq=False)
class JogStep:
    """What a jog does in a period.

    Attributes:
        positions: of the group's joints at the period's end, (n,).
        speeds: likewise, (n,).
        status: what slows it down.
        is_moving: whether there is something to command; False once the last command was at rest.
    """

    positions: Array
    speeds: Array
    status: JogStatus
    is_moving: bool


class Jog:
    """Jogs a group of a robot. For one thread at a time.

    Attributes:
        group: the group.

    Raises:
        PlanningError: there is no such group, or none that is a chain.
    """

    def __init__(
        self, model: PlanningModel, settings: ServoSettings, meshes: MeshPieces | None = None
    ) -> None:
        self.group = model.group(settings.group) if settings.group else model.default_group()
        self._model, self._settings = model, settings
        self._meshes = meshes or MeshPieces()
        factor = settings.override_velocity_scaling_factor or 1.0
        self._bounds = JointBounds(self.group, settings.joint_limit_margins, factor)
        n = len(self.group.joints)
        self._q, self._speeds = np.zeros(n), np.zeros(n)
        self._is_moving = False
        self._others: JointPositions = {}
        self._scene: PlanningScene | None = None
        self._chain: Chain | None = None
        self._tip: TipVelocity | None = None
        self._collisions: CollisionSlowdown | None = None

    @property
    def positions(self) -> Array:
        """The commanded positions, (n,)."""
        return self._q.copy()

    @property
    def is_moving(self) -> bool:
        """Whether it has not come to rest yet."""
        return self._is_moving

    def stop_s(self, speeds: Array) -> float:
        """Return how long the joints take to stop from speeds, (n,)."""
        return self._bounds.stop_s(speeds)

    def halt(self) -> None:
        """Forget the motion: the next one starts from the robot's state then."""
        self._speeds = np.zeros_like(self._speeds)
        self._is_moving = False

    def step(
        self,
        command: JogCommand | None,
        scene: PlanningScene,
        positions: JointPositions,
        period_s: float,
    ) -> JogStep:
        """Go on by a period; without a command, come to rest.

        The scene is the same object as long as nothing in it changes. A motion starts from the
        positions of the robot.

        Raises:
            PlanningError: the command cannot be used, or a shape of the scene; nothing moves on.
        """
        if not self._is_moving:
            if command is None:
                return JogStep(self.positions, np.zeros_like(self._q), JogStatus(), False)
            self._q = self.group.positions(positions)
        self._see(scene, positions)
        wanted, reason = np.zeros_like(self._q), Slowdown()
        if command is not None:
            wanted, reason = self._wanted(command, scene, positions, period_s)
        is_urgent = reason.status.code in COLLISION
        speeds = self._bounds.ramped(self._speeds, wanted, period_s, is_urgent=is_urgent)
        speeds = self._bounds.kept_inside(self._q, speeds, period_s)
        if self._collisions is not None and speeds.any():
            forbidden = self._collisions.forbids(self._q, speeds, period_s)
            if forbidden.factor < 1.0:
                reason, speeds = forbidden, np.zeros_like(speeds)
        self._q = self._q + period_s * speeds
        rests = not speeds.any() or float(np.abs(speeds).max()) < AT_REST
        moved = self._is_moving or not rests
        self._speeds, self._is_moving = speeds, not rests
        return JogStep(self.positions, speeds.copy(), reason.status, moved)

    def _wanted(
        self, command: JogCommand, scene: PlanningScene, positions: JointPositions, period_s: float
    ) -> tuple[Array, Slowdown]:
        """Return the speeds to go for, (n,), and what makes them slower than the command."""
        in_tip = not isinstance(command, JointSpeeds)
        singular = Slowdown()
        if isinstance(command, JointSpeeds):
            unit = self._unit(self._settings.joint_scale)
            wanted = np.array([unit * command.speeds.get(name, 0.0) for name in self.group.joints])
        else:
            wanted, singular = self._of_tip(command, scene, positions)
        wanted = self._bounds.within_velocities(wanted * singular.factor)
        halts_all = (
            self._settings.halt_all_joints_in_cartesian_mode
            if in_tip
            else self._settings.halt_all_joints_in_joint_mode
        )
        wanted, bound = self._bounds.within_positions(
            self._q, wanted, period_s, halts_all=halts_all
        )
        near = Slowdown()
        if self._collisions is not None and wanted.any():
            near = self._collisions.of(self._q, wanted, period_s)
        return wanted * near.factor, slowest(near, bound, singular)

    def _of_tip(
        self, command: TipTwist | TipTarget, scene: PlanningScene, positions: JointPositions
    ) -> tuple[Array, Slowdown]:
        chain, tip = self._chain, self._tip
        if chain is None or tip is None:
            raise InvalidRequestError(
                f"group '{self.group.name}' is not a chain, so its tip cannot be moved; its joints "
                "can"
            )
        known = {**positions, **self._named(self._q)}
        frame = frame_pose(scene, LinkPoses(self._model, known), command.frame)
        if isinstance(command, TipTarget):
            twist = self._towards(frame.then(command.pose))
        else:
            linear = self._unit(self._settings.linear_scale)
            angular = self._unit(self._settings.rotational_scale)
            twist = np.concatenate(
                [
                    linear * np.array(rotated(frame.rotation, command.linear)),
                    angular * np.array(rotated(frame.rotation, command.angular)),
                ]
            )
        return tip.solve(self._q, twist)

    def _towards(self, target: RigidTransform) -> Array:
        """Return the velocity towards a pose, (6,); 0 once it is reached."""
        assert self._chain is not None
        settings = self._settings
        way = pose_difference(self._chain.pose(self._q), np.array(target.matrix()))
        linear, angular = np.linalg.norm(way[:3]), np.linalg.norm(way[3:])
        if linear <= settings.linear_tolerance_m and angular <= settings.angular_tolerance_rad:
            return np.zeros(6)
        speeds = TRACKING_GAIN * way
        speeds[:3] /= max(1.0, TRACKING_GAIN * float(linear) / settings.linear_scale)
        speeds[3:] /= max(1.0, TRACKING_GAIN * float(angular) / settings.rotational_scale)
        return speeds

    def _unit(self, scale: float) -> float:
        return scale if self._settings.command_in_type == UNITLESS else 1.0

    def _named(self, q: Array) -> Mapping[str, float]:
        return dict(zip(self.group.joints, q.tolist(), strict=True))

    def _see(self, scene: PlanningScene, positions: JointPositions) -> None:
        """Compile what depends on the scene and on joints outside of the group, if it changed."""
        others = {name: each for name, each in positions.items() if name not in self.group.joints}
        if scene is self._scene and not _moved(self._others, others):
            return
        if self.group.tip:
            self._chain = Chain(self._model.robot, self.group.tip, self.group.joints, others)
            self._tip = TipVelocity(self._chain, self._bounds, self._settings)
        if self._settings.check_collisions:
            placed = replace(scene, positions={**scene.positions, **positions})
            model = CollisionModel(self._model, placed, self.group.name, self._meshes)
            reach_m = self._chain.reach_m if self._chain is not None else 1.0
            self._collisions = CollisionSlowdown(
                Proximity(model), self._bounds, reach_m, self._settings
            )
        self._scene, self._others = scene, others


def _moved(before: JointPositions, after: JointPositions) -> bool:
    return before.keys() != after.keys() or any(
        math.fabs(after[name] - before[name]) > OTHERS_MOVED for name in after
    )
