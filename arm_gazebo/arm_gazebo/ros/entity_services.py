"""The entity services of simulation_interfaces: spawn, delete, find, describe, move."""

from typing import Any

from rclpy.node import Node
from simulation_interfaces.srv import (
    DeleteEntity,
    GetEntities,
    GetEntitiesStates,
    GetEntityBounds,
    GetEntityInfo,
    GetEntityState,
    SetEntityInfo,
    SetEntityState,
    SpawnEntity,
)

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.ros.world_convert import (
    ServiceRow,
    bounds_message,
    create_services,
    filter_of,
    info_message,
    matrix_of,
    note_of,
    state_message,
    twist_of,
)
from arm_gazebo.world.editor import SpawnRequest, WorldEditor

SPAWN_CODES = {
    Refusal.NAME_NOT_UNIQUE: SpawnEntity.Response.NAME_NOT_UNIQUE,
    Refusal.NAME_INVALID: SpawnEntity.Response.NAME_INVALID,
    Refusal.UNSUPPORTED_FORMAT: SpawnEntity.Response.UNSUPPORTED_FORMAT,
    Refusal.NO_RESOURCE: SpawnEntity.Response.NO_RESOURCE,
    Refusal.NAMESPACE_INVALID: SpawnEntity.Response.NAMESPACE_INVALID,
    Refusal.UNREADABLE: SpawnEntity.Response.RESOURCE_PARSE_ERROR,
    Refusal.MISSING_ASSETS: SpawnEntity.Response.MISSING_ASSETS,
    Refusal.INVALID_POSE: SpawnEntity.Response.INVALID_POSE,
}
MOVE_CODES = {Refusal.INVALID_POSE: SetEntityState.Response.INVALID_POSE}


class EntityServices:
    """Creates the services on a node and answers requests, which may block its executor."""

    def __init__(self, node: Node, editor: WorldEditor) -> None:
        self._editor = editor
        services: tuple[ServiceRow, ...] = (
            (SpawnEntity, "spawn_entity", self._spawn, SPAWN_CODES),
            (DeleteEntity, "delete_entity", self._delete, {}),
            (GetEntities, "get_entities", self._names, {}),
            (GetEntitiesStates, "get_entities_states", self._states, {}),
            (GetEntityState, "get_entity_state", self._state, {}),
            (SetEntityState, "set_entity_state", self._move, MOVE_CODES),
            (GetEntityInfo, "get_entity_info", self._info, {}),
            (SetEntityInfo, "set_entity_info", self._describe, {}),
            (GetEntityBounds, "get_entity_bounds", self._bounds, {}),
        )
        create_services(node, services)

    def _spawn(self, request: SpawnEntity.Request, response: SpawnEntity.Response) -> None:
        response.entity_name = self._editor.spawn(
            SpawnRequest(
                name=request.name,
                uri=request.entity_resource.uri,
                text=request.entity_resource.resource_string,
                pose=matrix_of(request.initial_pose.pose),
                frame=request.initial_pose.header.frame_id,
                namespace=request.entity_namespace,
                allow_renaming=request.allow_renaming,
            )
        )

    def _delete(self, request: Any, _response: Any) -> None:
        self._editor.delete(request.entity)

    def _names(self, request: GetEntities.Request, response: GetEntities.Response) -> None:
        chosen = filter_of(request.filters).choose(self._editor.entities, self._editor.motions())
        response.entities = [entity.name for entity in chosen]

    def _states(
        self, request: GetEntitiesStates.Request, response: GetEntitiesStates.Response
    ) -> None:
        motions = self._editor.motions()
        chosen = filter_of(request.filters).choose(self._editor.entities, motions)
        response.entities = [entity.name for entity in chosen]
        response.states = [state_message(motions.of(e)) for e in chosen]

    def _state(self, request: Any, response: Any) -> None:
        entity = self._editor.entities.find(request.entity)
        response.state = state_message(self._editor.motions().of(entity))

    def _move(self, request: SetEntityState.Request, _response: SetEntityState.Response) -> None:
        state = request.state
        if request.set_acceleration:
            raise RequestError(
                Refusal.UNSUPPORTED, "accelerations follow from forces and cannot be set"
            )
        if not (request.set_pose or request.set_twist):
            raise RequestError(
                Refusal.FAILED, "nothing to set: set_pose and set_twist are both false"
            )
        pose = matrix_of(state.pose) if request.set_pose else None
        twist = twist_of(state.twist) if request.set_twist else None
        self._editor.place(request.entity, pose, state.header.frame_id, twist)

    def _info(self, request: Any, response: Any) -> None:
        response.info = info_message(self._editor.entities.find(request.entity).note)

    def _describe(self, request: Any, _response: Any) -> None:
        self._editor.describe(request.entity, note_of(request.info))

    def _bounds(self, request: Any, response: Any) -> None:
        entity = self._editor.entities.find(request.entity)
        motions = self._editor.motions()
        response.bounds = bounds_message(motions.bounds(entity, motions.of(entity).pose))
