"""Serve ListControllers with two chained controllers."""

import peer
from controller_manager_msgs.msg import ChainConnection, ControllerState
from controller_manager_msgs.srv import ListControllers
from rclpy.node import Node


def list_controllers(
    _: ListControllers.Request, response: ListControllers.Response
) -> ListControllers.Response:
    """Answer with one controller that writes the references of another."""
    inner = ControllerState(
        name="inner",
        state="active",
        type="position_controllers/JointGroupPositionController",
        update_rate=100,
        claimed_interfaces=["j0/position", "j1/position"],
        is_chainable=True,
        is_chained=True,
        reference_interfaces=["inner/j0", "inner/j1"],
    )
    outer = ControllerState(
        name="outer",
        state="inactive",
        is_async=True,
        chain_connections=[
            ChainConnection(name="inner", reference_interfaces=["inner/j0", "inner/j1"])
        ],
    )
    response.controller = [inner, outer]
    return response


def create(node: Node) -> None:
    """Serve under the name that every client of a controller manager knows."""
    node.create_service(ListControllers, "/controller_manager/list_controllers", list_controllers)


if __name__ == "__main__":
    peer.run("controller_manager", create)
