"""Plans motions of the simulated robot around what is in its world."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from numbers import Integral, Real
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from arm_description.resources import ResourceFinder
from arm_gazebo.world.shapes import WorldShapes
from arm_node.rigid_transform import RigidTransform
from arm_planning.configuration import PLANNING, SEMANTIC, move_group_parameters
from arm_planning.kinematics.pose_target import as_rigid_transform
from arm_planning.pipeline import Timing
from arm_planning.planner import Planner
from arm_planning.robot.limits import joint_limit_settings
from arm_planning.scene.objects import CollisionObject
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.world_things import WorldSolid, objects_of_solids
from arm_sim.errors import CallError
from arm_sim.joints import Joints
from arm_sim.pose import AnyPose, Matrix, pose_matrix
from arm_sim.trajectory import JointTrajectory

if TYPE_CHECKING:
    from arm_gazebo.run.run import SimulationRun

MotionGoal: TypeAlias = "Mapping[str, float] | str | AnyPose"
"""Positions of joints by name, the name of a state, or a pose in the world."""


class MotionPlanning:
    """Plans from the present state in the present world; for the thread of the simulation."""

    def __init__(
        self, run: "SimulationRun", joints: Joints, pose: Callable[[str], Matrix], config: str
    ) -> None:
        """Read the robot for planning.

        Args:
            run: the simulation.
            joints: the states of its joints.
            pose: returns the pose of a link in the world, (4, 4).
            config: URI of a MoveIt configuration; "" to make groups and allowed pairs from the
                URDF, which takes two seconds.

        Raises:
            PlanningError: the configuration cannot be used.
        """
        settings = run.robot.managed.settings
        self._run, self._joints, self._pose = run, joints, pose
        resources = ResourceFinder.of_description(settings.robot_description, settings.package_path)
        given = move_group_parameters(resources.find(config)) if config else {}
        self._planner = Planner.of_urdf(
            settings.robot_description,
            given.get(SEMANTIC, ""),
            limits=joint_limit_settings(given.get(PLANNING, {}), _ignore),
            resources=resources,
        )

    def plan(
        self,
        goal: MotionGoal,
        group: str,
        *,
        link: str,
        speed: float,
        allowed_time_s: float,
        seed: int,
    ) -> JointTrajectory:
        """Return a motion to a goal; see `Simulation.plan`.

        Raises:
            PlanningError: there is no such motion.
            CallError: the goal is not a goal, or an option is not usable.
        """
        _check_options(speed, allowed_time_s, seed)
        model = self._planner.model
        root = self._root()
        motion = self._planner.move(
            group or model.default_group().name,
            _goal(goal, root),
            link=link,
            allowed_time_s=allowed_time_s,
            timing=Timing(velocity_scaling=speed),
            seed=seed,
            scene=self._scene(root),
        )
        return JointTrajectory(
            motion.times_s, motion.positions, motion.joints, motion.velocities, motion.accelerations
        )

    def collision_check(
        self, joints: Sequence[str], ignored: Collection[str]
    ) -> Callable[[np.ndarray], bool]:
        """Return a check of the present world; see `Simulation.collision_check`."""
        scene = self._scene(self._root())
        objects = {name: one for name, one in scene.objects.items() if name not in ignored}
        checker = self._planner.checker(replace(scene, objects=objects))
        present = np.array([scene.positions[joint] for joint in checker.model.joints])
        places = [checker.model.joints.index(joint) for joint in joints]

        def is_free(positions: np.ndarray) -> bool:
            state = present.copy()
            state[places] = positions
            return checker.is_free(state)

        return is_free

    def _root(self) -> RigidTransform:
        """Return the pose of the root link in the world.

        A root link may be called `world`, which the simulation keeps for its own frame, so it is
        seen from the link below it.
        """
        robot = self._planner.model.robot
        below = robot.children(robot.root)
        link = below[0].child if below else robot.root
        own = self._planner.link_pose(link, PlanningScene(self._positions()))
        return as_rigid_transform(self._pose(link)).then(own.inverse())

    def _positions(self) -> dict[str, float]:
        return {joint: self._joints[joint].position for joint in self._planner.model.joints}

    def _scene(self, root: RigidTransform) -> PlanningScene:
        things, allowed = self._things(root.inverse()), self._planner.scene.allowed
        return PlanningScene(self._positions(), things, allowed=allowed)

    def _things(self, world: RigidTransform) -> dict[str, CollisionObject]:
        editor = self._run.editor
        shapes = WorldShapes(editor.model, editor.entities)
        poses = shapes.poses(*editor.motions().geom_poses)
        solids = [
            WorldSolid(shape.owner, shape.solid.value, shape.size, _pose_of(row), shape.corners)
            for shape, row in zip(shapes.shapes, poses, strict=True)
        ]
        return objects_of_solids(solids, world)


def _check_options(speed: float, allowed_time_s: float, seed: int) -> None:
    """Refuse what MoveIt replaces by defaults: at full speed instead of none, a robot is dangerous.

    Raises:
        CallError: an option is not usable.
    """
    if not (isinstance(speed, Real) and 0.0 < speed <= 1.0):
        raise CallError(f"the speed is {speed!r}; it is a fraction above 0, and at most 1")
    if not (isinstance(allowed_time_s, Real) and allowed_time_s > 0.0):
        raise CallError(f"the time to plan in is {allowed_time_s!r}; it is a number above 0, in s")
    if not (isinstance(seed, Integral) and seed >= 0):
        raise CallError(f"the seed is {seed!r}; it is a whole number from 0")


def _goal(goal: MotionGoal, root: RigidTransform) -> Mapping[str, float] | str | RigidTransform:
    if isinstance(goal, str):
        return goal
    if isinstance(goal, Mapping):
        for joint, position in goal.items():
            if not isinstance(position, Real):
                raise CallError(f"the position of joint '{joint}' is {position!r}, not a number")
        return goal
    if goal is None:
        raise CallError("a goal is joint positions by name, the name of a state, or a pose")
    return root.inverse().then(as_rigid_transform(pose_matrix(goal)))


def _pose_of(row: np.ndarray) -> RigidTransform:
    x, y, z, *rotation = row.tolist()
    return RigidTransform((x, y, z), (rotation[0], rotation[1], rotation[2], rotation[3]))


def _ignore(_sentence: str) -> None:
    """Keep quiet about keys of joint_limits.yaml that planning does not know."""
