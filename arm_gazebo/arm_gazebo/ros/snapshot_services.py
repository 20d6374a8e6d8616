"""The services that save, restore, list and remove snapshots of the run."""

from typing import Any

from rclpy.node import Node
from simulation_interfaces.msg import Resource, WorldResource
from simulation_interfaces.srv import GetAvailableWorlds, LoadWorld

from arm_gazebo.ros.world_convert import ServiceRow, answer, create_services
from arm_gazebo.state.snapshot import RunSnapshot
from arm_gazebo.state.snapshots import SnapshotStore
from arm_gazebo.world.refusal import Refusal

CODES = {
    Refusal.NO_RESOURCE: LoadWorld.Response.NO_RESOURCE,
    Refusal.UNREADABLE: LoadWorld.Response.RESOURCE_PARSE_ERROR,
    Refusal.MISSING_ASSETS: LoadWorld.Response.MISSING_ASSETS,
}


class SnapshotServices:
    """Creates the services on a node. A request's `world_resource.uri` is a name or a file."""

    def __init__(self, node: Node, snapshots: SnapshotStore) -> None:
        self._snapshots = snapshots
        services: tuple[ServiceRow, ...] = (
            (LoadWorld, "save_snapshot", self._save),
            (LoadWorld, "restore_snapshot", self._restore),
            (LoadWorld, "remove_snapshot", self._remove),
            (GetAvailableWorlds, "list_snapshots", self._list),
        )
        create_services(node, services)

    def _save(self, request: LoadWorld.Request, response: LoadWorld.Response) -> Any:
        def save() -> None:
            where = request.world_resource.uri
            response.world = _message(where, self._snapshots.save(where))

        return answer(response, CODES, save)

    def _restore(self, request: LoadWorld.Request, response: LoadWorld.Response) -> Any:
        def restore() -> None:
            where = request.world_resource.uri
            snapshot, remark = self._snapshots.restore(where)
            response.world = _message(where, snapshot, remark)

        return answer(response, CODES, restore)

    def _remove(self, request: LoadWorld.Request, response: LoadWorld.Response) -> Any:
        return answer(response, CODES, lambda: self._snapshots.remove(request.world_resource.uri))

    def _list(self, _request: Any, response: GetAvailableWorlds.Response) -> Any:
        def look() -> None:
            named = self._snapshots.named()
            response.worlds = [_message(name, snapshot) for name, snapshot in named.items()]

        return answer(response, {}, look)


def _message(where: str, snapshot: RunSnapshot, remark: str = "") -> WorldResource:
    return WorldResource(
        name=snapshot.world,
        world_resource=Resource(uri=where),
        description="; ".join(filter(None, (snapshot.description, remark))),
    )
