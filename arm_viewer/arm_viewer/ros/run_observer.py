"""Ask the simulation for the state of its run, its speed and its snapshots."""

import math
import time
from collections.abc import Callable
from typing import Any

from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from simulation_interfaces.srv import GetAvailableWorlds, GetSimulationState

from arm_viewer.ros.observer import Observer, TopicTypes
from arm_viewer.ros.service_caller import ServiceCaller
from arm_viewer.snapshot import NamedSnapshot, RunStatus

SERVICE = "/get_simulation_state"
"""Each simulation has this service."""
STATES = ("stopped", "playing", "paused", "quitting", "no world", "loading a world")
"""The states of simulation_interfaces/msg/SimulationState, by number."""
SPEED = "real_time_factor"
ANSWERED_S = 4.0
"""After this time without an answer the state of the run counts as unknown."""
RARE = 3
"""Speed and snapshots seldom change behind the page's back: they are asked in every third look."""


class RunObserver(Observer):
    """Asks once a second, and at once after a change.

    Attributes:
        status: what the simulation says; None if none answers.
    """

    def __init__(self, node: Node, is_watched: Callable[[], bool]) -> None:
        """Start without a simulation; ask only while somebody watches."""
        self._node = node
        self._is_watched = is_watched
        self._questions: dict[str, _Question] = {}
        self._due: set[str] = set()
        self._looks = 0
        self._answered_s = -math.inf
        self._state, self._speed = "", math.nan
        self._snapshots: tuple[NamedSnapshot, ...] = ()
        self.status: RunStatus | None = None

    def discover(self, topics: TopicTypes) -> None:
        """Find the simulation, and ask it."""
        found = self._node.count_services(SERVICE) > 0
        if found and not self._questions:
            self._begin()
        elif not found and self._questions:
            self._end()
        if found and self._is_watched():
            self._due.add("state")
            if self._looks % RARE == 0:
                self.ask_again()
            self._looks += 1

    def ask_again(self) -> None:
        """Ask for everything as soon as possible."""
        self._due.update(self._questions)

    def collect(self, now_s: float) -> None:
        """Send the questions that are due; forget a state that is no longer confirmed."""
        self._due -= {name for name in self._due if self._questions[name].ask()}
        if now_s - self._answered_s > ANSWERED_S:
            self.status = None

    def _begin(self) -> None:
        node, names = self._node, [SPEED]
        self._looks = 0
        self._questions = {
            "state": _Question(node, GetSimulationState, SERVICE, self._take_state),
            "speed": _Question(
                node, GetParameters, "/arm_gazebo/get_parameters", self._take_speed, names=names
            ),
            "snapshots": _Question(
                node, GetAvailableWorlds, "/list_snapshots", self._take_snapshots
            ),
        }

    def _end(self) -> None:
        for question in self._questions.values():
            question.caller.close()
        self._questions, self._due = {}, set()
        self._speed, self._snapshots, self.status = math.nan, (), None

    def _take_state(self, answer: GetSimulationState.Response) -> None:
        number = answer.state.state
        self._state = STATES[number] if number < len(STATES) else f"state {number}"
        self._answered_s = time.monotonic()
        self._combine()

    def _take_speed(self, answer: GetParameters.Response) -> None:
        values = list(answer.values)
        self._speed = values[0].double_value if values else math.nan
        self._combine()

    def _take_snapshots(self, answer: GetAvailableWorlds.Response) -> None:
        self._snapshots = tuple(
            NamedSnapshot(found.world_resource.uri, found.description) for found in answer.worlds
        )
        self._combine()

    def _combine(self) -> None:
        # The state alone tells that there is a simulation.
        if self._state:
            self.status = RunStatus(self._state, self._speed, self._snapshots)


class _Question:
    """A question that is asked again and again."""

    def __init__(
        self, node: Node, class_: Any, service: str, take: Callable[[Any], None], **fields: Any
    ) -> None:
        self.caller = ServiceCaller(node, class_, service)
        self._request = class_.Request(**fields)
        self._take = take

    def ask(self) -> bool:
        """Return whether it could be asked; not while an earlier answer is awaited."""
        return self.caller.ask(self._request, self._take)
