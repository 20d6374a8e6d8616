"""The node arm_viewer: observes topics and services for the page, and serves its requests."""

import logging
import time
from queue import Empty, SimpleQueue
from typing import TypeVar

from rclpy.context import Context
from rclpy.node import Node

from arm_node.names import listing
from arm_node.parameter_values import IntegerReader, read_flag, read_nonempty_text, read_text
from arm_node.parameters import declare
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.printable import printable
from arm_viewer.access import LOCAL_HOST
from arm_viewer.calls.call import EndCall, OpenForm, PlaceCall
from arm_viewer.requests import (
    Configure,
    ListNumbers,
    MeasureRates,
    MoveJoints,
    PlanningRequest,
    PlotCurves,
    Request,
    ResetRun,
    SetEmergencyStop,
    SetPlaying,
    SetSpeed,
    ShowContacts,
    ShowPictures,
    StepRun,
    SwitchControllers,
    UseSnapshot,
    Watch,
    WorldRequest,
)
from arm_viewer.ros.call_desk import CallDesk
from arm_viewer.ros.camera_observer import CameraObserver, ImageObserver
from arm_viewer.ros.clock_observer import ClockObserver
from arm_viewer.ros.command_observer import CommandObserver
from arm_viewer.ros.contact_observer import ContactObserver
from arm_viewer.ros.controller_observer import ControllerObserver, ManagerCaller
from arm_viewer.ros.field_observer import FieldObserver
from arm_viewer.ros.graph_observer import NodeObserver, TopicObserver
from arm_viewer.ros.joint_commander import JointCommander, JointStateSource
from arm_viewer.ros.joint_observer import HardwareObserver, JointStateObserver
from arm_viewer.ros.log_observer import DiagnosticObserver, LogObserver
from arm_viewer.ros.marker_observer import MarkerObserver
from arm_viewer.ros.observer import Observer
from arm_viewer.ros.planning_observer import PlanningObserver
from arm_viewer.ros.robot_observer import DescriptionObserver, TransformObserver
from arm_viewer.ros.run_commander import ControlAnswers, RunCommander
from arm_viewer.ros.run_observer import RunObserver
from arm_viewer.ros.stop_observer import StopObserver
from arm_viewer.ros.world_client import WorldClient
from arm_viewer.snapshot import ListedController, Snapshot

TICK_S = 1.0 / 30.0
UNWATCHED_TICK_S = 0.2
"""Time between two collections while no browser is connected."""
DISCOVERY_PERIOD_S = 1.0
DEFAULT_PORT = 8080

Observing = TypeVar("Observing", bound=Observer)
_read_port = IntegerReader("a port, from 0 to 65535", 0, 65535)


class Viewer(Node):
    """All ROS work happens in the executor's thread; any thread may call `latest` and `send`."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__("arm_viewer", context=context)
        self.port = declare(self, "port", DEFAULT_PORT, _read_port, "page's port")
        self.host = declare(
            self,
            "host",
            LOCAL_HOST,
            read_nonempty_text,
            "address that the page listens on; any but 127.0.0.1 needs the token that it prints",
        )
        self.is_read_only = declare(
            self, "read_only", False, read_flag, "let nobody do more than look at the page"
        )
        self.display_config = declare(
            self, "display_config", "", read_text, "RViz configuration that the page shows first"
        )
        displays = declare(
            self,
            "publish_joint_states",
            False,
            read_flag,
            "publish joint states from the sliders, for a robot that is not running",
        )
        self._is_watched = True
        self._observers: list[Observer] = []
        self._observe(PolledSubscriptions(self), displays)
        self._logged: set[str] = set()
        self._latest = Snapshot()
        self._requests: SimpleQueue[Request] = SimpleQueue()
        self._request_waits = self.create_guard_condition(self._serve)
        self._tick = self.create_timer(TICK_S, self._collect)
        self.create_timer(DISCOVERY_PERIOD_S, self._discover)

    def _observe(self, polled: PolledSubscriptions, displays: bool) -> None:
        """Create the observers; `displays` says whether the sliders publish joint states."""

        def is_watched() -> bool:
            return self._is_watched

        self._descriptions = self._observing(DescriptionObserver(self, polled))
        self._transforms = self._observing(TransformObserver(self, polled))
        self._joint_states = self._observing(JointStateObserver(self, polled))
        self._hardware = self._observing(HardwareObserver(self, polled))
        self._images = self._observing(ImageObserver(self, polled))
        self._cameras = self._observing(CameraObserver(self, polled))
        self._markers = self._observing(MarkerObserver(self, polled))
        self._contacts = self._observing(ContactObserver(self, polled))
        self._controllers = self._observing(ControllerObserver(self, is_watched))
        self._managers = self._observing(ManagerCaller(self, self._listed))
        self._commands = self._observing(CommandObserver(self, polled, self._listed))
        self._commander = self._observing(JointCommander(self, self.latest))
        self._source = JointStateSource(self, self.latest) if displays else None
        self._simulation_clock = self._observing(ClockObserver(self, polled))
        self._answers = ControlAnswers()
        self._run = self._observing(RunObserver(self, is_watched))
        self._run_commander = self._observing(
            RunCommander(self, self._answers, self._run.ask_again)
        )
        self._stops = self._observing(StopObserver(self, polled, self._answers))
        self._world = self._observing(WorldClient(self, is_watched))
        self._topics = self._observing(
            TopicObserver(self, polled, lambda: self._simulation_clock.time)
        )
        self._log = self._observing(LogObserver(self, polled))
        self._diagnoses = self._observing(DiagnosticObserver(self, polled))
        self._fields = self._observing(FieldObserver(self, polled))
        self._calls = self._observing(CallDesk(self))
        self._nodes = self._observing(NodeObserver(self))
        self._planning = self._observing(
            PlanningObserver(self, polled, self.latest, lambda: self._simulation_clock.time)
        )

    def _observing(self, observer: Observing) -> Observing:
        """Let an observer look and collect from now on; return it."""
        self._observers.append(observer)
        return observer

    def latest(self) -> Snapshot:
        """Return the latest snapshot; from any thread."""
        return self._latest

    def send(self, request: Request) -> None:
        """Serve a request as soon as possible; from any thread."""
        self._requests.put(request)
        self._request_waits.trigger()

    def _discover(self) -> None:
        topics = dict(self.get_topic_names_and_types())
        for observer in self._observers:
            try:
                observer.discover(topics)
            except Exception as error:
                # The discovery's top-level handler: a failing observer must not stop the others.
                failed = f"{type(observer).__name__} failed: {error}"
                if self._is_new(failed):
                    logging.getLogger(__name__).exception(failed)
        for topic, types in topics.items():
            clash = f"{topic} has several types ({listing(types)}): the page uses at most one"
            if len(types) > 1 and self._is_new(clash):
                self.get_logger().warning(printable(clash))

    def _is_new(self, message: str) -> bool:
        """Return whether a message is new, and record it."""
        is_new = message not in self._logged
        self._logged.add(message)
        return is_new

    def _collect(self) -> None:
        now_s = time.monotonic()
        described = self._descriptions.descriptions
        for observer in self._observers:
            observer.collect(now_s)
        if self._descriptions.descriptions is not described:
            # Frames of the previous description's links may remain.
            self._transforms.expect_again(now_s)
        self._latest = Snapshot(
            made_s=now_s,
            descriptions=self._descriptions.descriptions,
            transforms=self._transforms.transforms,
            joint_states=self._joint_states.joint_states,
            hardware_positions=self._hardware.positions,
            lost=self._descriptions.lost | self._joint_states.lost,
            image_topics=self._images.topics,
            pictures=self._images.pictures,
            cameras=self._cameras.views,
            markers=self._markers.markers,
            contacts=self._contacts.contacts,
            displayed=frozenset({self._source.namespace} if self._source else ()),
            controllers=self._controllers.controllers,
            refusal=self._managers.refusal,
            commands=self._commands.commands,
            time=self._simulation_clock.time,
            run=self._run.status,
            world=self._world.view,
            stops=self._stops.stops,
            control_answer=self._answers.last,
            topics=self._topics.topics,
            log=self._log.entries,
            diagnoses=self._diagnoses.diagnoses,
            numbers=self._fields.numbers,
            curves=self._fields.curves,
            callees=self._calls.callees,
            calls=self._calls.states,
            nodes=self._nodes.nodes,
            planning=self._planning.views,
        )

    def _serve(self) -> None:
        while True:
            try:
                request = self._requests.get_nowait()
            except Empty:
                return
            match request:
                case MoveJoints():
                    self._commander.move(request)
                    if self._source is not None:
                        self._source.move(request)
                case Watch():
                    self._watch(request.wanted)
                case ShowPictures():
                    self._images.serve(request)
                case ShowContacts():
                    self._contacts.show(request.wanted)
                case PlotCurves() | ListNumbers():
                    self._fields.serve(request)
                case OpenForm() | PlaceCall() | EndCall():
                    self._calls.serve(request)
                case SwitchControllers() | Configure():
                    self._managers.serve(request)
                case MeasureRates():
                    self._topics.measure(request.wanted)
                case SetEmergencyStop():
                    self._stops.serve(request)
                case SetPlaying() | StepRun() | SetSpeed() | ResetRun() | UseSnapshot():
                    self._run_commander.serve(request)
                case _ if isinstance(request, WorldRequest):
                    self._world.serve(request)
                case _ if isinstance(request, PlanningRequest):
                    self._planning.serve(request)

    def _watch(self, wanted: bool) -> None:
        self._is_watched = wanted
        self._tick.timer_period_ns = int(1e9 * (TICK_S if wanted else UNWATCHED_TICK_S))
        if wanted:
            # What is asked for only while somebody watches is asked for at once.
            self._discover()

    def _listed(self) -> tuple[ListedController, ...]:
        return self._controllers.controllers
