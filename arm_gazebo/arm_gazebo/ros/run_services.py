"""The services of simulation_interfaces for the state, steps, snapshots and world of a run."""

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from rclpy.executors import Executor
from rclpy.node import Node
from simulation_interfaces.msg import Resource, Result, SimulatorFeatures, WorldResource
from simulation_interfaces.srv import (
    GetAvailableWorlds,
    GetCurrentWorld,
    GetSimulationState,
    GetSimulatorFeatures,
    LoadWorld,
    ResetSimulation,
    SetSimulationState,
    StepSimulation,
    UnloadWorld,
)

from arm_control.errors import LoopStoppedError
from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.ros_executor_bridge import call_on_loop, wait_for_future
from arm_gazebo.camera.feed import CameraFeed
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.ros.world_convert import ServiceRow, create_services, world_message
from arm_gazebo.state.run_reset import ResetScope, RunReset
from arm_gazebo.state.snapshots import RunSnapshot, SnapshotStore
from arm_gazebo.world.editor import WorldEditor
from arm_gazebo.world.loading import NamedWorld, WorldLoader, available_worlds
from arm_gazebo.world.run_control import RunControl, RunState
from arm_gazebo.world.spawn_model import FORMATS
from arm_node.qos import SERVICE_QOS

STATE_CODES = {
    Refusal.ALREADY_THERE: SetSimulationState.Response.ALREADY_IN_TARGET_STATE,
    Refusal.INCORRECT_TRANSITION: SetSimulationState.Response.INCORRECT_TRANSITION,
}
LOAD_CODES = {
    Refusal.UNSUPPORTED_FORMAT: LoadWorld.Response.UNSUPPORTED_FORMAT,
    Refusal.NO_RESOURCE: LoadWorld.Response.NO_RESOURCE,
    Refusal.UNREADABLE: LoadWorld.Response.RESOURCE_PARSE_ERROR,
    Refusal.MISSING_ASSETS: LoadWorld.Response.MISSING_ASSETS,
    Refusal.UNSUPPORTED_ELEMENTS: LoadWorld.Response.UNSUPPORTED_ELEMENTS,
}
CURRENT_CODES = {Refusal.NO_WORLD: GetCurrentWorld.Response.NO_WORLD_LOADED}
UNLOAD_CODES = {Refusal.NO_WORLD: UnloadWorld.Response.NO_WORLD_LOADED}
F = SimulatorFeatures
FEATURES = (
    *(F.SPAWNING, F.DELETING, F.SPAWNING_RESOURCE_STRING, F.ENTITY_TAGS, F.ENTITY_CATEGORIES),
    *(F.ENTITY_BOUNDS, F.ENTITY_BOUNDS_BOX, F.ENTITY_STATE_GETTING, F.ENTITY_STATE_SETTING),
    *(F.ENTITY_INFO_GETTING, F.ENTITY_INFO_SETTING, F.SIMULATION_RESET, F.SIMULATION_RESET_STATE),
    *(F.SIMULATION_RESET_TIME, F.SIMULATION_RESET_SPAWNED),
    *(F.SIMULATION_STATE_GETTING, F.SIMULATION_STATE_SETTING),
    *(F.SIMULATION_STATE_PAUSE, F.STEP_SIMULATION_SINGLE, F.STEP_SIMULATION_MULTIPLE),
    *(F.WORLD_LOADING, F.WORLD_RESOURCE_STRING, F.WORLD_UNLOADING, F.WORLD_INFO_GETTING),
    F.AVAILABLE_WORLDS,
)


class RunServices:
    """Creates the services on a node and answers requests, which may block its executor."""

    def __init__(
        self,
        node: Node,
        editor: WorldEditor,
        run: RunControl,
        reset: RunReset,
        loader: WorldLoader,
        about: str,
    ) -> None:
        self._editor = editor
        self._run = run
        self._reset_run = reset
        self._loader = loader
        self._about = about
        services: tuple[ServiceRow, ...] = (
            (GetSimulationState, "get_simulation_state", self._state, {}),
            (SetSimulationState, "set_simulation_state", self._set_state, STATE_CODES),
            (ResetSimulation, "reset_simulation", self._reset, {}),
            (LoadWorld, "load_world", self._load, LOAD_CODES),
            (UnloadWorld, "unload_world", self._unload, UNLOAD_CODES),
            (GetCurrentWorld, "get_current_world", self._current, CURRENT_CODES),
            (GetAvailableWorlds, "get_available_worlds", self._available, {}),
        )
        create_services(node, services)
        # Apart from the others, because its response has no result.
        node.create_service(
            GetSimulatorFeatures,
            "get_simulator_features",
            self._features,
            qos_profile=SERVICE_QOS,
        )

    def _features(self, _request: Any, response: GetSimulatorFeatures.Response) -> Any:
        response.features = SimulatorFeatures(
            features=[int(feature) for feature in FEATURES],
            spawn_formats=list(FORMATS),
            custom_info=self._about,
        )
        return response

    def _state(self, _request: Any, response: GetSimulationState.Response) -> None:
        response.state.state = self._run.state.value

    def _set_state(self, request: SetSimulationState.Request, response: Any) -> None:
        try:
            target = RunState(request.state.state)
        except ValueError as error:
            raise RequestError(
                Refusal.INCORRECT_TRANSITION,
                f"no state {request.state.state}; there are "
                + ", ".join(f"{state.value} {state.name}" for state in RunState),
            ) from error
        self._run.go_to(target)

    def _reset(self, request: ResetSimulation.Request, _response: Any) -> None:
        scope = request.scope or ResetSimulation.Request.SCOPE_ALL
        self._reset_run.reset(
            ResetScope(
                time=bool(scope & ResetSimulation.Request.SCOPE_TIME),
                state=bool(scope & ResetSimulation.Request.SCOPE_STATE),
                spawned=bool(scope & ResetSimulation.Request.SCOPE_SPAWNED),
            )
        )

    def _load(self, request: LoadWorld.Request, response: LoadWorld.Response) -> None:
        resource = request.world_resource
        base, world = self._loader.load(
            resource.uri, resource.resource_string, request.fail_on_unsupported_element
        )
        with self._run.paused_as(RunState.STOPPED):
            self._editor.replace_world(base)
        self._loader.world = world
        response.world = world_message(world)

    def _unload(self, _request: Any, _response: UnloadWorld.Response) -> None:
        self._loaded()
        with self._run.paused_as(RunState.NO_WORLD):
            self._editor.replace_world(self._loader.load_empty())
        self._loader.world = None

    def _current(self, _request: Any, response: GetCurrentWorld.Response) -> None:
        response.world = world_message(self._loaded())

    def _available(self, request: GetAvailableWorlds.Request, response: Any) -> None:
        worlds = available_worlds(list(request.additional_sources), request.continue_on_error)
        wanted = bool(request.filter.tags)
        # No world has tags.
        response.worlds = [] if wanted else [world_message(world) for world in worlds]

    def _loaded(self) -> NamedWorld:
        if self._loader.world is None:
            raise RequestError(Refusal.NO_WORLD, "no world is loaded")
        return self._loader.world


SNAPSHOT_CODES = {
    Refusal.NO_RESOURCE: LoadWorld.Response.NO_RESOURCE,
    Refusal.UNREADABLE: LoadWorld.Response.RESOURCE_PARSE_ERROR,
    Refusal.MISSING_ASSETS: LoadWorld.Response.MISSING_ASSETS,
}


class SnapshotServices:
    """Creates the services on a node. A request's `world_resource.uri` is a name or a file."""

    def __init__(self, node: Node, snapshots: SnapshotStore) -> None:
        self._snapshots = snapshots
        services: tuple[ServiceRow, ...] = (
            (LoadWorld, "save_snapshot", self._save, SNAPSHOT_CODES),
            (LoadWorld, "restore_snapshot", self._restore, SNAPSHOT_CODES),
            (LoadWorld, "remove_snapshot", self._remove, SNAPSHOT_CODES),
            (GetAvailableWorlds, "list_snapshots", self._list, {}),
        )
        create_services(node, services)

    def _save(self, request: LoadWorld.Request, response: LoadWorld.Response) -> None:
        where = request.world_resource.uri
        response.world = _message(where, self._snapshots.save(where))

    def _restore(self, request: LoadWorld.Request, response: LoadWorld.Response) -> None:
        where = request.world_resource.uri
        snapshot, remark = self._snapshots.restore(where)
        response.world = _message(where, snapshot, remark)

    def _remove(self, request: LoadWorld.Request, _response: LoadWorld.Response) -> None:
        self._snapshots.remove(request.world_resource.uri)

    def _list(self, _request: Any, response: GetAvailableWorlds.Response) -> None:
        named = self._snapshots.named()
        response.worlds = [_message(name, snapshot) for name, snapshot in named.items()]


def _message(where: str, snapshot: RunSnapshot, remark: str = "") -> WorldResource:
    return WorldResource(
        name=snapshot.world,
        world_resource=Resource(uri=where),
        description="; ".join(filter(None, (snapshot.description, remark))),
    )


SLICE_S = 0.1
"""Longest time for which a wait for a picture delays the other services."""
PICTURE_TIMEOUT_S = 30.0
"""The first picture takes seconds, because the camera process then loads its renderer."""


class StepServices:
    """Creates the services on a node and answers them.

    /step_simulation answers when the messages of the last step have been sent.
    /step_simulation_with_sensors does not take a step before the pictures of the previous one have
    been published, so that every picture that is due is taken.
    """

    def __init__(
        self,
        node: Node,
        executor: Executor,
        loop: ControlLoop,
        run: RunControl,
        cameras: Sequence[CameraFeed],
    ) -> None:
        self._executor = executor
        self._loop = loop
        self._run = run
        self._cameras = tuple(cameras)
        create_services(
            node,
            (
                (StepSimulation, "step_simulation", self._step, {}),
                (StepSimulation, "step_simulation_with_sensors", self._step_with_sensors, {}),
            ),
        )

    # Coroutines, so that a request to end a long run of steps is answered in the meantime.

    async def _step(self, request: StepSimulation.Request, response: Any) -> None:
        with _stopped_loop_refused():
            done = await wait_for_future(self._run.step(request.steps), self._executor)
        self._report(response, done, request.steps)

    async def _step_with_sensors(self, request: StepSimulation.Request, response: Any) -> None:
        done = 0
        with _stopped_loop_refused(), self._run.run_of_steps(request.steps) as goes_on:
            await self._pictures_are_out()
            before = [camera.missed() for camera in self._cameras]
            while done < request.steps and goes_on():
                done += await wait_for_future(self._run.step(1), self._executor)
                await self._pictures_are_out()
                self._check_sent(before)
        self._report(response, done, request.steps)

    async def _pictures_are_out(self) -> None:
        """Wait until every picture that was taken has been published.

        Raises:
            RequestError: that takes too long.
        """
        for camera in self._cameras:
            deadline_s = time.monotonic() + PICTURE_TIMEOUT_S
            while late := camera.unpublished(SLICE_S):
                # It also lets the executor answer other requests.
                await call_on_loop(self._loop, camera.forget_pace, self._executor)
                if time.monotonic() > deadline_s:
                    raise RequestError(
                        Refusal.FAILED,
                        f"no picture of {', '.join(late)} within {PICTURE_TIMEOUT_S:g} s",
                    )
            await call_on_loop(self._loop, camera.forget_pace, self._executor)

    def _check_sent(self, before: Sequence[dict[str, int]]) -> None:
        """Check that every picture that was due has been taken.

        Raises:
            RequestError: one was not.
        """
        for camera, missed in zip(self._cameras, before, strict=True):
            names = [name for name, count in camera.missed().items() if count > missed[name]]
            if names:
                raise RequestError(
                    Refusal.FAILED,
                    f"no picture of {', '.join(names)}: the camera process is not running",
                )

    def _report(self, response: Any, done: int, asked: int) -> None:
        if done < asked:
            failure = self._loop.lock_step and self._loop.lock_step.failure
            response.result.result = Result.RESULT_OPERATION_FAILED
            response.result.error_message = (
                f"{done} of {asked} steps: {failure or 'the state was changed'}"
            )


@contextmanager
def _stopped_loop_refused() -> Iterator[None]:
    """Refuse a request if the loop has stopped, or cannot take that many steps."""
    try:
        yield
    except (LoopStoppedError, ValueError) as error:
        raise RequestError(Refusal.FAILED, str(error)) from error
