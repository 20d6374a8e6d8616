"""The simulated myCobot with move_group, and a client beside it that speaks MoveIt's messages."""

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import pytest
from geometry_msgs.msg import Pose
from moveit_msgs.action import MoveGroup
from moveit_msgs.msg import (
    AttachedCollisionObject,
    CollisionObject,
    Constraints,
    JointConstraint,
    MotionPlanRequest,
    PlanningScene,
    PositionConstraint,
)
from moveit_msgs.srv import ApplyPlanningScene, GetMotionPlan, GetPlanningScene, GetStateValidity
from programs import Program
from rclpy.action import ActionClient
from sensor_msgs.msg import JointState
from shape_msgs.msg import SolidPrimitive

ARM_JOINTS = (
    "link1_to_link2",
    "link2_to_link3",
    "link3_to_link4",
    "link4_to_link5",
    "link5_to_link6",
    "link6_to_link6_flange",
)
TIMEOUT_S = 60.0


class Goal:
    """A goal that an action server has accepted, and what it has said since."""

    def __init__(self, client: Any, handle: Any, feedback: Any) -> None:
        self._client = client
        self._handle = handle
        self._result = client.run_in_executor(handle.get_result_async)
        self.feedback = feedback

    def cancel(self) -> Any:
        """Ask the server to cancel it; return its answer."""
        return self._client.run_in_executor(self._handle.cancel_goal_async)()

    def end(self) -> Any:
        """Wait for its end; return the envelope with `status` and `result`."""
        return self._result()


class Planning:
    """What a program that uses move_group does, in plain rclpy."""

    def __init__(self, client: Any) -> None:
        self.client = client
        self._action_type = ActionClient
        self._actions: dict[str, Any] = {}
        self._said: dict[bytes, Any] = defaultdict(client.collector)
        self._services: dict[str, Any] = {}
        self._publishers: dict[str, Any] = {}
        self.joint_states = client.subscribe(JointState, "/joint_states")

    def run_in_executor(self, start: Callable[[], Any]) -> Callable[[], Any]:
        """Start something on the executor's thread; return a function that waits for its end.

        There an answer cannot come before its request is noted.
        """

        async def run() -> Any:
            return await start()

        task = self.client.executor.create_task(run)
        return lambda: self.client.result_of(task, "move_group")

    def call(self, name: str, request: Any) -> Any:
        """Call a service with a request; the class of the request says which type."""
        if name not in self._services:
            from moveit_msgs import srv

            kind = getattr(srv, type(request).__name__.removesuffix("_Request"))
            self._services[name] = self.client.node.create_client(kind, name)
        service = self._services[name]
        assert service.wait_for_service(TIMEOUT_S), name
        return self.run_in_executor(lambda: service.call_async(request))()

    def send(self, kind: Any, name: str, goal: Any) -> Goal:
        """Send a goal to an action; it must be accepted."""
        if name not in self._actions:
            self._actions[name] = self._action_type(self.client.node, kind, name)
            self._hear_feedback(kind, name)
        action = self._actions[name]
        self.client.wait_until(action.server_is_ready, f"the action {name}")
        handle = self.run_in_executor(lambda: action.send_goal_async(goal))()
        assert handle.accepted
        return Goal(self, handle, self._said[bytes(handle.goal_id.uuid)])

    def _hear_feedback(self, kind: Any, name: str) -> None:
        """Collect the states of an action's goals.

        rclpy drops feedback that it reads after the result, although it was sent before.
        """

        def take(message: Any) -> None:
            self._said[bytes(message.goal_id.uuid)](message.feedback.state)

        node = self.client.node
        node.create_subscription(kind.Impl.FeedbackMessage, f"{name}/_action/feedback", take, 10)
        self.client.be_known_to_server(f"{name}/_action/send_goal")

    def publish(self, topic: str, message: Any) -> None:
        """Publish to a topic that move_group is known to read."""
        if topic not in self._publishers:
            self._publishers[topic] = self.client.publisher(type(message), topic)
        self._publishers[topic].publish(message)

    # What programs ask for again and again.

    def plan(self, request: Any) -> Any:
        """Return the answer to a request to plan."""
        asked = GetMotionPlan.Request(motion_plan_request=request)
        return self.call("/plan_kinematic_path", asked).motion_plan_response

    def start_move(self, request: Any, **options: Any) -> Goal:
        """Send a request to move_action as MoveGroupInterface does."""
        goal = MoveGroup.Goal(request=request)
        goal.planning_options.planning_scene_diff.is_diff = True
        goal.planning_options.planning_scene_diff.robot_state.is_diff = True
        for name, value in options.items():
            setattr(goal.planning_options, name, value)
        return self.send(MoveGroup, "/move_action", goal)

    def move(self, request: Any, **options: Any) -> Any:
        """Do the same, and wait for its end."""
        return self.start_move(request, **options).end()

    def scene(self) -> Any:
        """Return the whole scene."""
        return self.call("/get_planning_scene", GetPlanningScene.Request()).scene

    def apply(self, scene: Any) -> bool:
        """Change the scene; return whether all was possible."""
        return self.call("/apply_planning_scene", ApplyPlanningScene.Request(scene=scene)).success

    def apply_object(self, thing: Any) -> bool:
        """Change one object of the scene; return whether it was possible."""
        scene = PlanningScene(is_diff=True)
        scene.robot_state.is_diff = True
        scene.world.collision_objects = [thing]
        return self.apply(scene)

    def positions(self) -> dict[str, float]:
        """Return the joints' positions in a joint state that arrives from now on."""
        self.joint_states.clear()
        message = self.joint_states.wait_for(1)[-1]
        return dict(zip(message.name, message.position, strict=True))

    def is_free(self, positions: Mapping[str, float]) -> bool:
        """Return whether the arm touches nothing at these positions."""
        request = GetStateValidity.Request(group_name="arm")
        request.robot_state.is_diff = True
        state = request.robot_state.joint_state
        state.name, state.position = list(positions), list(positions.values())
        return self.call("/check_state_validity", request).valid

    def joint_moves(self, joint: str, by: float) -> None:
        """Block until a joint has moved from where it is now."""
        before = self.positions()[joint]

        def has_moved(messages: list) -> bool:
            last = messages[-1] if messages else None
            return last is not None and abs(position_of(last, joint) - before) > by

        self.joint_states.wait_until(has_moved, f"{joint} moves by {by}")

    def stands_still(self, within: float = 1e-4) -> dict[str, float]:
        """Block until twenty joint states in a row are this near, in rad; return the positions."""
        self.joint_states.clear()

        def still(messages: list) -> bool:
            last = messages[-20:]
            return len(last) == 20 and all(
                abs(position_of(each, joint) - position_of(last[0], joint)) < within
                for each in last
                for joint in ARM_JOINTS
            )

        message = self.joint_states.wait_until(still, "the arm stands still")[-1]
        return dict(zip(message.name, message.position, strict=True))


def position_of(message: Any, joint: str) -> float:
    """Return a joint's position in a joint state."""
    return message.position[message.name.index(joint)]


@pytest.fixture(scope="module")
def planning_for_file(launched: Program, client_for_file: Any) -> Planning:
    """Return the client of the whole file."""
    return Planning(client_for_file)


@pytest.fixture
def planning(planning_for_file: Planning) -> Iterator[Planning]:
    """Return the client, in a scene without objects."""
    clear(planning_for_file)
    yield planning_for_file
    clear(planning_for_file)


def clear(planning: Planning) -> None:
    """Remove all objects, attached ones first: they come back into the world."""
    scene = PlanningScene(is_diff=True)
    scene.robot_state.is_diff = True
    attached = AttachedCollisionObject()
    attached.object.operation = CollisionObject.REMOVE
    scene.robot_state.attached_collision_objects = [attached]
    planning.apply(scene)
    planning.apply_object(CollisionObject(operation=CollisionObject.REMOVE))
    left = planning.scene()
    assert not left.world.collision_objects
    assert not left.robot_state.attached_collision_objects


@pytest.fixture(scope="session")
def joints() -> Callable[..., dict[str, float]]:
    """Return a function that names positions of the arm's joints; those not given are 0."""

    def named(*positions: float) -> dict[str, float]:
        filled = [*positions, *[0.0] * (len(ARM_JOINTS) - len(positions))]
        return dict(zip(ARM_JOINTS, filled, strict=True))

    return named


@pytest.fixture(scope="session")
def request_of() -> Callable[..., Any]:
    """Return a function that makes a request to plan for the arm, from where it is or a start."""

    def make(
        *goals: Constraints, start: Mapping[str, float] | None = None, **fields: Any
    ) -> MotionPlanRequest:
        given = {"group_name": "arm", "allowed_planning_time": 5.0, **fields}
        request = MotionPlanRequest(goal_constraints=list(goals), **given)
        request.start_state.is_diff = True
        if start:
            request.start_state.joint_state.name = list(start)
            request.start_state.joint_state.position = list(start.values())
        return request

    return make


@pytest.fixture(scope="session")
def joint_goal() -> Callable[[Mapping[str, float]], Any]:
    """Return a function that makes a goal of joints, as MoveGroupInterface writes it."""

    def make(positions: Mapping[str, float]) -> Constraints:
        return Constraints(
            joint_constraints=[
                JointConstraint(
                    joint_name=name,
                    position=position,
                    tolerance_above=1e-4,
                    tolerance_below=1e-4,
                    weight=1.0,
                )
                for name, position in positions.items()
            ]
        )

    return make


@pytest.fixture(scope="session")
def position_goal() -> Callable[..., Any]:
    """Return a function that makes the goal that a link is at a place, as pymoveit2 writes it."""

    def make(x: float, y: float, z: float, link: str = "link6_flange", frame: str = "base_link"):
        constraint = PositionConstraint(link_name=link, weight=1.0)
        constraint.header.frame_id = frame
        centre = Pose()
        centre.position.x, centre.position.y, centre.position.z = x, y, z
        sphere = SolidPrimitive(type=SolidPrimitive.SPHERE, dimensions=[0.001])
        constraint.constraint_region.primitives = [sphere]
        constraint.constraint_region.primitive_poses = [centre]
        return Constraints(position_constraints=[constraint])

    return make


@pytest.fixture(scope="session")
def box() -> Callable[..., Any]:
    """Return a function that makes a box as an object of the scene; its centre is in the world."""

    def make(name: str, centre: Sequence[float], size: Sequence[float], frame: str = "world"):
        thing = CollisionObject(id=name, operation=CollisionObject.ADD)
        thing.header.frame_id = frame
        pose = Pose()
        pose.position.x, pose.position.y, pose.position.z = centre
        thing.primitives = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=list(size))]
        thing.primitive_poses = [pose]
        return thing

    return make
