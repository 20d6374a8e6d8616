"""The world of a simulation: ask what is in it, and serve the user's requests to change it."""

import math
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Twist, Vector3
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParametersAtomically
from rclpy.node import Node
from simulation_interfaces.msg import EntityCategory, EntityFilters, EntityState, Resource
from simulation_interfaces.srv import (
    DeleteEntity,
    GetAvailableWorlds,
    GetCurrentWorld,
    GetEntities,
    GetEntitiesStates,
    GetEntityState,
    LoadWorld,
    SetEntityState,
    SpawnEntity,
)

from arm_node.rigid_transform import RigidTransform, Vector
from arm_viewer.requests import (
    AddFile,
    AddThing,
    LookAtThing,
    OpenWorld,
    PlaceThing,
    PushThing,
    RemoveThing,
    SetGravity,
    SetProperties,
    WorldRequest,
)
from arm_viewer.ros.observer import Observer, TopicTypes
from arm_viewer.ros.service_caller import ServiceCaller
from arm_viewer.world.dropped_file import FileCheck
from arm_viewer.world.world_view import (
    Thing,
    ThingProperties,
    WorldAnswer,
    WorldView,
    gravity_words,
)

SERVICE = "/get_entities_states"
SET_PARAMETERS = "/simulation/set_parameters_atomically"
GET_PARAMETERS = "/simulation/get_parameters"
GRAVITY, MASS, FRICTION = "gravity", "mass", "friction"
SERVICES = {
    SERVICE: GetEntitiesStates,
    "/get_entities": GetEntities,
    "/get_entity_state": GetEntityState,
    "/set_entity_state": SetEntityState,
    "/spawn_entity": SpawnEntity,
    "/delete_entity": DeleteEntity,
    "/load_world": LoadWorld,
    "/get_available_worlds": GetAvailableWorlds,
    "/get_current_world": GetCurrentWorld,
    SET_PARAMETERS: SetParametersAtomically,
}
CHANGING = {"/set_entity_state", "/spawn_entity", "/delete_entity", "/load_world", SET_PARAMETERS}
ANSWER_S = 60.0
"""Building a world with large meshes takes its time."""
FOLLOW_S = 0.1
RARE = 5
"""Which worlds there are is asked in every fifth look."""
RESULT_OK = 1
THINGS = EntityFilters(categories=[EntityCategory(category=EntityCategory.CATEGORY_OBJECT)])
MOVING = EntityFilters(categories=[EntityCategory(category=EntityCategory.CATEGORY_DYNAMIC_OBJECT)])


@dataclass(slots=True)
class _WorldChange:
    """A change that is not made yet.

    Attributes:
        service: what makes it.
        question: the request to it.
        done: what the user is told afterwards; a function of the answer, empty for nothing.
    """

    service: str
    question: Any
    done: Callable[[Any], str] = field(default=lambda _: "")


class WorldClient(Observer):
    """Asks once a second, and ten times a second for the thing that the user looks at.

    Attributes:
        view: what the simulation says; None if none serves its world.
    """

    def __init__(self, node: Node, is_watched: Callable[[], bool]) -> None:
        """Start without a simulation; ask only while somebody watches."""
        self._node = node
        self._is_watched = is_watched
        self._callers: dict[str, ServiceCaller] = {}
        self._properties: _PropertyObserver | None = None
        self._looks = 0
        self._moving: frozenset[str] = frozenset()
        self._followed, self._followed_s = "", -math.inf
        self._wishes: list[_WorldChange] = []
        self._checks: list[tuple[FileCheck, RigidTransform]] = []
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self.view: WorldView | None = None

    def discover(self, topics: TopicTypes) -> None:
        """Find the simulation, and ask it."""
        found = self._node.count_services(SERVICE) > 0
        if found and not self._callers:
            self._callers = {
                name: ServiceCaller(self._node, type_, name, ANSWER_S)
                for name, type_ in SERVICES.items()
            }
            self._properties = _PropertyObserver(self._node, self._take_properties)
            self.view, self._looks = WorldView(), 0
        elif not found and self._callers:
            for caller in self._callers.values():
                caller.close()
            self._callers, self.view, self._wishes = {}, None, []
            if self._properties is not None:
                self._properties.close()
                self._properties = None
        if found and self._is_watched():
            self._ask_for_things()
            self._ask_for_properties()
            if self._looks % RARE == 0:
                self._ask("/get_available_worlds", self._take_worlds)
                self._ask("/get_current_world", self._take_world)
            self._looks += 1

    def collect(self, now_s: float) -> None:
        """Make the changes that wait, and follow the thing that the user looks at."""
        for check, pose in [entry for entry in self._checks if entry[0].is_over]:
            self._checks.remove((check, pose))
            self._take_check(check, pose)
        for caller in self._callers.values():
            if caller.service in CHANGING and caller.is_overdue():
                caller.forget()
                self._say(f"{caller.service} did not answer within {ANSWER_S:g} s", False)
        for wish in tuple(self._wishes):
            caller = self._callers[wish.service]
            if caller.ask(wish.question, lambda answer, wish=wish: self._end(wish, answer)):
                self._wishes.remove(wish)
        if self._followed and self._callers and now_s - self._followed_s > FOLLOW_S:
            self._followed_s = now_s
            name = self._followed
            self._ask("/get_entity_state", lambda a: self._take_state(name, a), entity=name)

    def serve(self, request: WorldRequest) -> None:
        """Make a change as soon as possible."""
        if isinstance(request, LookAtThing):
            self._followed = request.name
            self._ask_for_properties()
        elif not self._callers:
            # Without a simulation there is no view that could say so: the panel does.
            return
        elif isinstance(request, AddFile):
            self._say(f"`arm check` reads {request.file.name} ...", True)
            self._checks.append((FileCheck(request.file, self._new_folder()), request.pose))
        else:
            wish = _wish(request)
            if isinstance(request, PlaceThing):
                # Only the newest pose of a thing that is being dragged counts.
                self._wishes = [w for w in self._wishes if not _places(w, request.name)]
            self._wishes.append(wish)

    def _new_folder(self) -> Path:
        self._folder = self._folder or tempfile.TemporaryDirectory(prefix="arm_page_")
        return Path(tempfile.mkdtemp(dir=self._folder.name))

    def _ask(self, service: str, take: Callable[[Any], None], **fields: Any) -> None:
        self._callers[service].ask(SERVICES[service].Request(**fields), take)

    def _ask_for_things(self) -> None:
        self._ask("/get_entities", self._take_moving, filters=MOVING)
        self._ask(SERVICE, self._take_things, filters=THINGS)

    def _ask_for_properties(self) -> None:
        if self._properties is not None:
            self._properties.ask(self._followed)

    def _take_properties(self) -> None:
        if self._properties is not None:
            observed = self._properties
            self._change(gravity=observed.gravity, properties=observed.properties)

    def _take_check(self, check: FileCheck, pose: RigidTransform) -> None:
        if check.checked is None:
            self._say(check.problem, False)
        elif self._callers:
            request = AddThing(check.checked.name, check.checked.text, pose)
            self._wishes.append(_wish(request, f"\n{check.checked.report}"))

    def _end(self, wish: _WorldChange, answer: Any) -> None:
        if problem := _problem(answer):
            self._say(problem, False)
        elif done := wish.done(answer):
            self._say(done, True)
        if wish.service == SET_PARAMETERS:
            self._ask_for_properties()
        elif wish.service != "/set_entity_state":
            self._ask_for_things()

    def _say(self, text: str, is_done: bool) -> None:
        if self.view is not None:
            answer = WorldAnswer(self.view.answer.number + 1, text, is_done)
            self.view = replace(self.view, answer=answer)

    def _change(self, **fields: Any) -> None:
        if self.view is not None:
            self.view = replace(self.view, **fields)

    def _take_moving(self, answer: GetEntities.Response) -> None:
        self._moving = frozenset(answer.entities)

    def _take_things(self, answer: GetEntitiesStates.Response) -> None:
        things = {
            name: _thing(state, name in self._moving)
            for name, state in zip(answer.entities, answer.states, strict=True)
        }
        self._change(things=MappingProxyType(dict(sorted(things.items()))))

    def _take_state(self, name: str, answer: GetEntityState.Response) -> None:
        if self.view is not None and name in self.view.things and answer.result.result == RESULT_OK:
            thing = _thing(answer.state, name in self._moving)
            self._change(things=MappingProxyType({**self.view.things, name: thing}))

    def _take_worlds(self, answer: GetAvailableWorlds.Response) -> None:
        worlds = {world.name: world.world_resource.uri for world in answer.worlds}
        self._change(worlds=MappingProxyType(worlds))

    def _take_world(self, answer: GetCurrentWorld.Response) -> None:
        self._change(world=answer.world.name)


def _parameter_of(thing: str, kind: str) -> str:
    """Return the name of a thing's parameter."""
    return f"entities.{thing}.{kind}"


class _PropertyObserver:
    """Asks for the gravity, and for mass and friction of a thing.

    Attributes:
        gravity: in m/s²; None until the simulation says it.
        properties: of the thing that was asked for last.
    """

    def __init__(self, node: Node, changed: Callable[[], None]) -> None:
        """Create the clients; `changed` is called after each answer."""
        self._changed = changed
        # One for each question: an answer to several has nothing if one of them is unknown.
        self._callers = {
            kind: ServiceCaller(node, GetParameters, GET_PARAMETERS)
            for kind in (GRAVITY, MASS, FRICTION)
        }
        self.gravity: Vector | None = None
        self.properties = ThingProperties()

    def ask(self, thing: str) -> None:
        """Ask for the gravity, and for a thing unless its name is empty."""
        if thing != self.properties.name:
            self.properties = ThingProperties(thing)
        self._callers[GRAVITY].ask(GetParameters.Request(names=[GRAVITY]), self._take_gravity)
        for kind in (MASS, FRICTION) if thing else ():
            self._callers[kind].ask(
                GetParameters.Request(names=[_parameter_of(thing, kind)]),
                lambda answer, kind=kind: self._take(thing, kind, answer),
            )

    def close(self) -> None:
        """Destroy the clients."""
        for caller in self._callers.values():
            caller.close()

    def _take_gravity(self, answer: GetParameters.Response) -> None:
        numbers = tuple(value for each in answer.values for value in each.double_array_value)
        self.gravity = (numbers[0], numbers[1], numbers[2]) if len(numbers) == 3 else None
        self._changed()

    def _take(self, thing: str, kind: str, answer: GetParameters.Response) -> None:
        if thing != self.properties.name:
            return
        # Empty if there is no such parameter: a thing that is fixed has no mass.
        value = next((each.double_value for each in answer.values), None)
        if kind == MASS:
            self.properties = replace(self.properties, mass_kg=value)
        else:
            self.properties = replace(self.properties, friction=value)
        self._changed()


def _wish(request: WorldRequest, report: str = "") -> _WorldChange:
    """Return the change that a request stands for; `report` follows what the user is told."""
    match request:
        case AddThing(name, text, pose):
            question = SpawnEntity.Request(
                name=name,
                allow_renaming=True,
                entity_resource=Resource(resource_string=text),
                initial_pose=PoseStamped(pose=_pose(pose)),
            )
            return _WorldChange(
                "/spawn_entity", question, lambda a: f"Added {a.entity_name}{report}"
            )
        case PlaceThing(name, pose):
            state = EntityState(pose=_pose(pose))
            question = SetEntityState.Request(entity=name, state=state, set_pose=True)
            return _WorldChange("/set_entity_state", question)
        case PushThing(name, velocity):
            x, y, z = velocity
            state = EntityState(twist=Twist(linear=Vector3(x=x, y=y, z=z)))
            question = SetEntityState.Request(entity=name, state=state, set_twist=True)
            return _WorldChange("/set_entity_state", question, lambda _: f"Pushed {name}")
        case RemoveThing(name):
            question = DeleteEntity.Request(entity=name)
            return _WorldChange("/delete_entity", question, lambda _: f"Deleted {name}")
        case OpenWorld(uri):
            question = LoadWorld.Request(world_resource=Resource(uri=uri))
            return _WorldChange("/load_world", question, lambda a: f"Loaded {a.world.name}")
        case SetGravity(gravity):
            return _setting({GRAVITY: gravity}, f"Gravity is {gravity_words(gravity)}")
        case SetProperties(name, mass_kg, friction):
            wanted = {MASS: mass_kg, FRICTION: friction}
            values = {_parameter_of(name, kind): v for kind, v in wanted.items() if v is not None}
            return _setting(values, f"{name}: {ThingProperties(name, mass_kg, friction).words()}")
        case _:
            raise TypeError(f"{type(request).__name__} changes nothing by a service")


def _setting(values: Mapping[str, float | Vector], done: str) -> _WorldChange:
    """Return the change that sets parameters, all or none."""
    parameters = [Parameter(name=name, value=_value(value)) for name, value in values.items()]
    question = SetParametersAtomically.Request(parameters=parameters)
    return _WorldChange(SET_PARAMETERS, question, lambda _: done)


def _value(value: float | Vector) -> ParameterValue:
    if isinstance(value, tuple):
        kind = ParameterType.PARAMETER_DOUBLE_ARRAY
        return ParameterValue(type=kind, double_array_value=list(value))
    return ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value)


def _problem(answer: Any) -> str:
    """Return why a change was refused, "" if it was made."""
    result = answer.result
    if isinstance(answer, SetParametersAtomically.Response):
        return "" if result.successful else result.reason or "refused"
    if result.result == RESULT_OK:
        return ""
    return result.error_message or f"refused (result {result.result})"


def _places(wish: _WorldChange, name: str) -> bool:
    return isinstance(wish.question, SetEntityState.Request) and (
        wish.question.entity == name and wish.question.set_pose
    )


def _pose(pose: RigidTransform) -> Pose:
    (x, y, z), (i, j, k, w) = pose.position, pose.rotation
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=i, y=j, z=k, w=w))


def _thing(state: EntityState, can_move: bool) -> Thing:
    p, q, v = state.pose.position, state.pose.orientation, state.twist.linear
    pose = RigidTransform((p.x, p.y, p.z), (q.x, q.y, q.z, q.w))
    return Thing(pose, math.hypot(v.x, v.y, v.z), can_move)
