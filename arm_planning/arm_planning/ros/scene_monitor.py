"""The present planning scene: changed by topics, services and the simulated world; published."""

import logging
import threading
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from moveit_msgs.msg import AttachedCollisionObject, PlanningSceneWorld
from moveit_msgs.msg import CollisionObject as ObjectMessage
from moveit_msgs.msg import PlanningScene as SceneMessage
from moveit_msgs.srv import ApplyPlanningScene, GetPlanningScene
from octomap_msgs.msg import OctomapWithPose
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from visualization_msgs.msg import Marker, MarkerArray

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.collision.model import CollisionModel
from arm_planning.errors import PlanningError
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.answering import offer_service
from arm_planning.ros.convert import robot_state_message
from arm_planning.ros.convert_scene import frames_in, scene_change_of, scene_message
from arm_planning.ros.joint_state_monitor import JointStateMonitor
from arm_planning.ros.transform_reader import TransformReader
from arm_planning.scene.frames import LinkPoses, frame_names
from arm_planning.scene.objects import AttachedBody, CollisionObject
from arm_planning.scene.occupancy_map import OccupancyMap
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import SceneOutcome, change_scene
from arm_planning.scene.shapes import TriangleMesh
from arm_planning.scene.world_things import WorldSolid, followed, objects_of_solids

SERVICES_DEPTH = 10
MONITORED_DEPTH = 100
WORLD_TOPIC = "/world_markers"
WORLD_DEPTH = 10
PUBLISH_HZ = 4.0
MOVED = 1e-6
"""Change of a joint from which the state is published again, rad or m."""
SOLIDS = {
    Marker.CUBE: "box",
    Marker.SPHERE: "ball",
    Marker.CYLINDER: "cylinder",
    Marker.TRIANGLE_LIST: "triangles",
}
LOGGER = logging.getLogger("move_group")
ThingT = TypeVar("ThingT", CollisionObject, AttachedBody)


class SceneMonitor:
    """Holds the present scene; any thread may read or change it.

    Attributes:
        states: the robot's state.
    """

    def __init__(
        self,
        node: Node,
        model: PlanningModel,
        scene: PlanningScene,
        meshes: MeshPieces,
        *others: Node,
    ) -> None:
        """Listen to the scene's topics, and offer its services; `others` take its time, too."""
        self._model, self._meshes = model, meshes
        self._scene = scene
        # Reading the scene takes in what has moved in the world, also within a change.
        self._lock = threading.RLock()
        self.states = JointStateMonitor(node, model, *others)
        self._frames = TransformReader(node)
        self._world: WorldObjects | None = None
        self._things: Mapping[str, CollisionObject] = {}
        self._followed: PlanningScene | None = None
        self._publisher = node.create_publisher(
            SceneMessage, "monitored_planning_scene", MONITORED_DEPTH
        )
        self._published: PlanningScene | None = None
        topics: dict[str, tuple[type[Any], Callable[[Any], None]]] = {
            "planning_scene": (SceneMessage, self._hear_scene),
            "planning_scene_world": (PlanningSceneWorld, self._hear_world),
            "collision_object": (ObjectMessage, self._hear_object),
            "attached_collision_object": (AttachedCollisionObject, self._hear_attached),
        }
        for topic, (message, take) in topics.items():
            node.create_subscription(message, topic, take, SERVICES_DEPTH)
        offer_service(node, GetPlanningScene, "get_planning_scene", self._serve_get)
        offer_service(node, ApplyPlanningScene, "apply_planning_scene", self._serve_apply)
        # Not on simulation time: it advances only when somebody reads the joint states.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        node.create_timer(1.0 / PUBLISH_HZ, self._publish, clock=steady)

    def follow_world(self, node: Node, robot: RigidTransform) -> None:
        """Let the simulation's things be objects of the scene, from now on and as they move.

        `robot` is the pose of the robot's root in the simulated world.
        """
        self._world = WorldObjects(node, robot, {link.name for link in self._model.robot.links})

    @property
    def scene(self) -> PlanningScene:
        """The scene without the latest joint states; the same object until something changes."""
        self._take_world()
        return self._scene

    def _take_world(self) -> None:
        if self._world is None:
            return
        with self._lock:
            things = self._world.take()
            if things is not self._things or self._scene is not self._followed:
                self._scene = self._followed = followed(self._scene, self._things, things)
                self._things = things

    def current(self) -> PlanningScene:
        """Return the scene with the robot where it is now."""
        scene, known = self.scene, self.states.positions()
        return replace(scene, positions={**scene.positions, **known})

    def with_frames(self, scene: PlanningScene, names: Iterable[str]) -> PlanningScene:
        """Return the scene with those frames on /tf that it does not know by itself."""
        known = frame_names(scene, LinkPoses(self._model, scene.positions))
        found: dict[str, RigidTransform] = {}
        for name in {name.lstrip("/") for name in names} - {"", *known}:
            pose = self._frames.pose(name, self._model.frame)
            if pose is not None:
                found[name] = pose
        return replace(scene, transforms={**scene.transforms, **found}) if found else scene

    def applied(self, scene: PlanningScene, message: SceneMessage) -> SceneOutcome:
        """Return what a message makes of a scene.

        Raises:
            PlanningError: the message cannot be used at all.
        """
        change = scene_change_of(self._model, message, LOGGER.warning)
        known = self.with_frames(scene, frames_in(message))
        outcome = change_scene(self._model, known, change, LOGGER.warning)
        if outcome.scene.transforms == known.transforms and known is not scene:
            # Frames on /tf move: they are looked up each time.
            outcome = replace(outcome, scene=replace(outcome.scene, transforms=scene.transforms))
        return outcome

    def change(self, message: SceneMessage) -> str:
        """Change the present scene; return what was not possible, or "". Any thread."""
        present = self.current()
        with self._lock:
            before = replace(self._scene, positions=present.positions)
            try:
                outcome = self.applied(before, message)
            except PlanningError as error:
                LOGGER.error("%s", error)
                return str(error)
            self._scene, unusable = without_unusable(
                self._model, before, outcome.scene, self._meshes
            )
        problems = (*outcome.problems, *unusable)
        for problem in problems:
            LOGGER.error("%s", problem)
        return "; ".join(map(str, problems))

    def update(self, change: Callable[[PlanningScene], PlanningScene]) -> None:
        """Change the present scene by a function; if it raises, nothing changes. Any thread.

        Raises:
            PlanningError: a mesh cannot be used.
        """
        with self._lock:
            before = self.current()
            scene, unusable = without_unusable(self._model, before, change(before), self._meshes)
            if unusable:
                raise unusable[0]
            self._scene = scene

    def set_octomap(self, octomap: OccupancyMap | None) -> None:
        """Replace the octomap; None removes it. Any thread."""
        with self._lock:
            self._scene = replace(self._scene, octomap=octomap)

    def _hear_scene(self, message: SceneMessage) -> None:
        self.change(message)

    def _hear_world(self, message: PlanningSceneWorld) -> None:
        removes_all = ObjectMessage(operation=ObjectMessage.REMOVE)
        self._change_objects([removes_all, *message.collision_objects], message.octomap)

    def _hear_object(self, message: ObjectMessage) -> None:
        self._change_objects([message])

    def _change_objects(
        self, objects: Sequence[ObjectMessage], octomap: OctomapWithPose | None = None
    ) -> None:
        scene = SceneMessage(is_diff=True)
        scene.robot_state.is_diff = True
        scene.world.collision_objects = objects
        if octomap is not None:
            scene.world.octomap = octomap
            scene.world.octomap.octomap.id = octomap.octomap.id or "cleared"
        self.change(scene)

    def _hear_attached(self, message: AttachedCollisionObject) -> None:
        scene = SceneMessage(is_diff=True)
        scene.robot_state.is_diff = True
        scene.robot_state.attached_collision_objects = [message]
        self.change(scene)

    def _serve_get(self, request: Any, answer: GetPlanningScene.Response) -> Any:
        answer.scene = scene_message(self._model, self.current(), request.components.components)
        return answer

    def _serve_apply(self, request: Any, answer: ApplyPlanningScene.Response) -> Any:
        answer.success = not self.change(request.scene)
        return answer

    def _publish(self) -> None:
        scene = self.current()
        before = self._published
        if before is None or replace(before, positions=scene.positions) != scene:
            self._publisher.publish(scene_message(self._model, scene))
        elif _has_moved(before, scene):
            message = SceneMessage(is_diff=True, robot_model_name=self._model.robot.name)
            message.robot_state = robot_state_message(self._model, scene.positions)
            message.robot_state.is_diff = True
            self._publisher.publish(message)
        else:
            return
        self._published = scene


def _has_moved(before: PlanningScene, after: PlanningScene) -> bool:
    return any(
        abs(position - before.positions.get(joint, position + 1.0)) > MOVED
        for joint, position in after.positions.items()
    )


def without_unusable(
    model: PlanningModel, before: PlanningScene, after: PlanningScene, meshes: MeshPieces
) -> tuple[PlanningScene, list[PlanningError]]:
    """Return a changed scene in which objects with unusable meshes are as before, and the reasons.

    Collision checks cannot use them, so each plan would fail. The meshes of the scene before the
    change are usable.
    """
    known = {id(mesh) for thing in _things(before) for mesh in _meshes(thing)}
    new = [
        thing for thing in _things(after) if any(id(mesh) not in known for mesh in _meshes(thing))
    ]
    if not new or _why_unusable(model, after, new, meshes) is None:
        return after, []
    problems = {thing.id: _why_unusable(model, after, [thing], meshes) for thing in new}
    unusable = {name: problem for name, problem in problems.items() if problem is not None}
    kept = replace(
        after,
        objects=_as_before(before.objects, after.objects, unusable),
        attached=_as_before(before.attached, after.attached, unusable),
    )
    return kept, list(unusable.values())


def _things(scene: PlanningScene) -> list[CollisionObject]:
    return [*scene.objects.values(), *(body.object for body in scene.attached.values())]


def _meshes(thing: CollisionObject) -> list[TriangleMesh]:
    shapes = (placed.shape for placed in thing.shapes)
    return [shape for shape in shapes if isinstance(shape, TriangleMesh)]


def _why_unusable(
    model: PlanningModel,
    scene: PlanningScene,
    things: Iterable[CollisionObject],
    meshes: MeshPieces,
) -> PlanningError | None:
    alone = PlanningScene(scene.positions, objects={thing.id: thing for thing in things})
    try:
        CollisionModel(model, alone, meshes=meshes)
    except PlanningError as error:
        return error
    return None


def _as_before(
    before: Mapping[str, ThingT], after: Mapping[str, ThingT], names: Iterable[str]
) -> dict[str, ThingT]:
    unusable = set(names)
    restored = {name: thing for name, thing in before.items() if name in unusable}
    return {name: thing for name, thing in after.items() if name not in unusable} | restored


class WorldObjects:
    """Reads the world's shapes as they are drawn; robots are not among them.

    One thread at a time.
    """

    def __init__(self, node: Node, robot: RigidTransform, links: Collection[str]) -> None:
        """Listen to the simulation; the robot's root is fixed at this pose in its world."""
        self._world, self._links = robot.inverse(), links
        self._polled = PolledSubscriptions(node)
        latched = QoSProfile(depth=WORLD_DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscription = self._polled.subscribe(MarkerArray, WORLD_TOPIC, latched)
        self._things: Mapping[str, CollisionObject] = {}

    def take(self) -> Mapping[str, CollisionObject]:
        """Return the things by their names; the same mapping until they have moved or changed."""
        heard = [raw for raw, _ in self._polled.take(self._subscription, WORLD_DEPTH)]
        if heard:
            # Each message has all shapes.
            solids = solids_of(deserialize_message(heard[-1], MarkerArray).markers)
            self._things = objects_of_solids(solids, self._world, self._links)
        return self._things


def solids_of(markers: Iterable[Marker]) -> Iterator[WorldSolid]:
    """Yield the solids that markers show; the namespace of a marker is the thing's name."""
    for marker in markers:
        if marker.action != Marker.ADD or marker.type not in SOLIDS:
            continue
        position, rotation = marker.pose.position, marker.pose.orientation
        yield WorldSolid(
            marker.ns,
            SOLIDS[marker.type],
            (marker.scale.x, marker.scale.y, marker.scale.z),
            RigidTransform(
                (position.x, position.y, position.z),
                (rotation.x, rotation.y, rotation.z, rotation.w),
            ),
            np.array([(point.x, point.y, point.z) for point in marker.points]).reshape(-1, 3),
        )
