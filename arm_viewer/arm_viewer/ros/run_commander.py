"""Serve the user's requests to the simulation: time, speed, reset and snapshots."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future
from simulation_interfaces.msg import Resource, SimulationState
from simulation_interfaces.srv import (
    LoadWorld,
    ResetSimulation,
    SetSimulationState,
    StepSimulation,
)

from arm_viewer.requests import (
    ResetRun,
    RunRequest,
    SetPlaying,
    SetSpeed,
    SnapshotDeed,
    StepRun,
    UseSnapshot,
)
from arm_viewer.ros.observer import Observer, TopicTypes
from arm_viewer.ros.run_observer import SERVICE, SPEED
from arm_viewer.snapshot import ControlAnswer

ANSWER_S = 10.0
"""A request without an answer within this time is given up; restoring a world takes seconds."""
RESULT_OK = 1
SET_PARAMETERS = "/arm_gazebo/set_parameters"
SERVICES = {
    "/set_simulation_state": SetSimulationState,
    "/step_simulation": StepSimulation,
    SET_PARAMETERS: SetParameters,
    "/reset_simulation": ResetSimulation,
    "/save_snapshot": LoadWorld,
    "/restore_snapshot": LoadWorld,
    "/remove_snapshot": LoadWorld,
}
DONE = {
    SnapshotDeed.SAVE: "Saved '{name}': {about}",
    SnapshotDeed.RESTORE: "Restored '{name}': {about}",
    SnapshotDeed.REMOVE: "Removed '{name}'",
}


class ControlAnswers:
    """The answer to the user's last request; use it in the executor's thread."""

    def __init__(self) -> None:
        self.last = ControlAnswer(0, "", True)

    def add(self, text: str, is_done: bool) -> None:
        """Keep a newer answer."""
        self.last = ControlAnswer(self.last.number + 1, text, is_done)


class RunCommander(Observer):
    """Calls the services of the simulation, and keeps what they answer."""

    def __init__(self, node: Node, answers: ControlAnswers, changed: Callable[[], None]) -> None:
        """Start without a simulation; `changed` is called after each answer."""
        self._node = node
        self._answers = answers
        self._changed = changed
        self._clients: dict[str, Client] = {}
        self._pending: list[_RunCall] = []

    def discover(self, topics: TopicTypes) -> None:
        """Create the clients as soon as there is a simulation, so that no request waits for it."""
        found = self._node.count_services(SERVICE) > 0
        if found and not self._clients:
            self._clients = {
                name: self._node.create_client(class_, name) for name, class_ in SERVICES.items()
            }
        elif not found and self._clients:
            self._pending.clear()
            for client in self._clients.values():
                self._node.destroy_client(client)
            self._clients = {}

    def collect(self, now_s: float) -> None:
        """Give up what is not answered."""
        for call in self._pending:
            call.deadline_s = call.deadline_s or now_s + ANSWER_S
        for call in [call for call in self._pending if now_s > call.deadline_s]:
            self._pending.remove(call)
            self._clients[call.service].remove_pending_request(call.future)
            self._answers.add(
                f"The simulation did not answer {call.service} within {ANSWER_S:g} s", False
            )

    def serve(self, request: RunRequest) -> None:
        """Call the simulation, which serves steps one after another."""
        service, question = _call_of(request)
        client = self._clients.get(service)
        if client is None or not client.service_is_ready():
            self._answers.add(f"There is no simulation that serves {service}", False)
            return
        call = _RunCall(service, client.call_async(question))
        self._pending.append(call)
        call.future.add_done_callback(lambda _: self._take(call, request))

    def _take(self, call: "_RunCall", request: RunRequest) -> None:
        if call not in self._pending:
            return
        self._pending.remove(call)
        problem = _problem_of(call.future.result())
        self._answers.add(problem or _done(request, call.future.result()), not problem)
        self._changed()


@dataclass(slots=True, eq=False)
class _RunCall:
    """A call that is not answered yet; its deadline is set when it is first looked at."""

    service: str
    future: Future
    deadline_s: float = 0.0


def _call_of(request: RunRequest) -> tuple[str, Any]:
    """Return the service that serves a request, and the question to it."""
    match request:
        case SetPlaying(playing):
            state = SimulationState.STATE_PLAYING if playing else SimulationState.STATE_PAUSED
            question = SetSimulationState.Request(state=SimulationState(state=state))
            return "/set_simulation_state", question
        case StepRun(count):
            return "/step_simulation", StepSimulation.Request(steps=count)
        case SetSpeed(factor):
            value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=factor)
            return SET_PARAMETERS, SetParameters.Request(
                parameters=[Parameter(name=SPEED, value=value)]
            )
        case ResetRun(keeps_clock):
            scope = ResetSimulation.Request.SCOPE_ALL
            if keeps_clock:
                scope = ResetSimulation.Request.SCOPE_STATE | ResetSimulation.Request.SCOPE_SPAWNED
            return "/reset_simulation", ResetSimulation.Request(scope=scope)
        case UseSnapshot(deed, name):
            question = LoadWorld.Request(world_resource=Resource(uri=name))
            return f"/{deed.value}_snapshot", question


def _problem_of(answer: Any) -> str:
    """Return why a request was refused, "" if it was done."""
    if isinstance(answer, SetParameters.Response):
        refused = [result.reason or "refused" for result in answer.results if not result.successful]
        return "; ".join(refused)
    if isinstance(answer, SetSimulationState.Response):
        # Two browsers may press the same button.
        already = answer.result.result == SetSimulationState.Response.ALREADY_IN_TARGET_STATE
        if already:
            return ""
    if answer.result.result == RESULT_OK:
        return ""
    return answer.result.error_message or f"refused (result {answer.result.result})"


def _done(request: RunRequest, answer: Any) -> str:
    """Return what was done, "" where it shows by itself."""
    match request:
        case ResetRun(keeps_clock):
            return "Reset; the clock goes on" if keeps_clock else "Reset to the start"
        case UseSnapshot(deed, name):
            about = answer.world.description if deed is not SnapshotDeed.REMOVE else ""
            return DONE[deed].format(name=name, about=about)
        case _:
            return ""
