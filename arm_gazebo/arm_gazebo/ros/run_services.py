"""The services of simulation_interfaces for the simulation's state and its world."""

from typing import Any

from rclpy.node import Node
from simulation_interfaces.msg import SimulatorFeatures
from simulation_interfaces.srv import (
    GetAvailableWorlds,
    GetCurrentWorld,
    GetSimulationState,
    GetSimulatorFeatures,
    LoadWorld,
    ResetSimulation,
    SetSimulationState,
    UnloadWorld,
)

from arm_gazebo.ros.world_convert import ServiceRow, answer, create_services, world_message
from arm_gazebo.state.run_reset import ResetScope, RunReset
from arm_gazebo.world.editor import WorldEditor
from arm_gazebo.world.loading import NamedWorld, WorldLoader, available_worlds
from arm_gazebo.world.refusal import Refusal, RequestError
from arm_gazebo.world.run_control import RunControl, RunState
from arm_gazebo.world.spawn_model import FORMATS

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
            (GetSimulatorFeatures, "get_simulator_features", self._features),
            (GetSimulationState, "get_simulation_state", self._state),
            (SetSimulationState, "set_simulation_state", self._set_state),
            (ResetSimulation, "reset_simulation", self._reset),
            (LoadWorld, "load_world", self._load),
            (UnloadWorld, "unload_world", self._unload),
            (GetCurrentWorld, "get_current_world", self._current),
            (GetAvailableWorlds, "get_available_worlds", self._available),
        )
        create_services(node, services)

    def _features(self, _request: Any, response: GetSimulatorFeatures.Response) -> Any:
        response.features = SimulatorFeatures(
            features=[int(feature) for feature in FEATURES],
            spawn_formats=list(FORMATS),
            custom_info=self._about,
        )
        return response

    def _state(self, _request: Any, response: GetSimulationState.Response) -> Any:
        def look() -> None:
            response.state.state = self._run.state.value

        return answer(response, {}, look)

    def _set_state(self, request: SetSimulationState.Request, response: Any) -> Any:
        def change() -> None:
            try:
                target = RunState(request.state.state)
            except ValueError as error:
                raise RequestError(
                    Refusal.INCORRECT_TRANSITION,
                    f"no state {request.state.state}; there are "
                    + ", ".join(f"{state.value} {state.name}" for state in RunState),
                ) from error
            self._run.go_to(target)

        return answer(response, STATE_CODES, change)

    def _reset(self, request: ResetSimulation.Request, response: Any) -> Any:
        def reset() -> None:
            scope = request.scope or ResetSimulation.Request.SCOPE_ALL
            self._reset_run.reset(
                ResetScope(
                    time=bool(scope & ResetSimulation.Request.SCOPE_TIME),
                    state=bool(scope & ResetSimulation.Request.SCOPE_STATE),
                    spawned=bool(scope & ResetSimulation.Request.SCOPE_SPAWNED),
                )
            )

        return answer(response, {}, reset)

    def _load(self, request: LoadWorld.Request, response: LoadWorld.Response) -> Any:
        def load() -> None:
            resource = request.world_resource
            base, world = self._loader.load(
                resource.uri, resource.resource_string, request.fail_on_unsupported_element
            )
            with self._run.paused_as(RunState.STOPPED):
                self._editor.replace_world(base)
            self._loader.world = world
            response.world = world_message(world)

        return answer(response, LOAD_CODES, load)

    def _unload(self, _request: Any, response: UnloadWorld.Response) -> Any:
        def unload() -> None:
            self._loaded()
            with self._run.paused_as(RunState.NO_WORLD):
                self._editor.replace_world(self._loader.load_empty())
            self._loader.world = None

        return answer(response, UNLOAD_CODES, unload)

    def _current(self, _request: Any, response: GetCurrentWorld.Response) -> Any:
        def look() -> None:
            response.world = world_message(self._loaded())

        return answer(response, CURRENT_CODES, look)

    def _available(self, request: GetAvailableWorlds.Request, response: Any) -> Any:
        def look() -> None:
            worlds = available_worlds(list(request.additional_sources), request.continue_on_error)
            wanted = bool(request.filter.tags)
            # No world has tags.
            response.worlds = [] if wanted else [world_message(world) for world in worlds]

        return answer(response, {}, look)

    def _loaded(self) -> NamedWorld:
        if self._loader.world is None:
            raise RequestError(Refusal.NO_WORLD, "no world is loaded")
        return self._loader.world
