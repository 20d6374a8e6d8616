"""A running simulation as a client over ROS sees it: its services, and parameters of its nodes."""

import re
from typing import Any

import numpy as np

OK = 1
PLAYING, PAUSED = 1, 2
TIMEOUT_S = 120.0


class Simulated:
    """The services of a simulation, called by the client of a test.

    Args:
        client: see `tests/ros/conftest.py`.
    """

    def __init__(self, client: Any) -> None:
        self.client = client

    def start(self, service: str, name: str = "", /, **fields: Any) -> Any:
        """Call a service by its type, and by a name other than the type's if it has one.

        Returns:
            the future of its answer.
        """
        import simulation_interfaces.srv

        kind = getattr(simulation_interfaces.srv, service)
        name = name or re.sub(r"(?<!^)([A-Z])", r"_\1", service).lower()
        return self.client.ask(kind, f"/{name}", kind.Request(**fields), TIMEOUT_S)

    def ask(self, service: str, name: str = "", /, **fields: Any) -> Any:
        """Do the same; return the answer."""
        return self.client.result_of(self.start(service, name, **fields), service, TIMEOUT_S)

    def do(self, service: str, name: str = "", /, **fields: Any) -> Any:
        """Do the same; it must succeed."""
        answer = self.ask(service, name, **fields)
        assert answer.result.result == OK, answer
        return answer

    def spawn(self, name: str, text: str, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
        """Spawn a thing from its description."""
        from geometry_msgs.msg import Point, Pose, PoseStamped
        from simulation_interfaces.msg import Resource

        answer = self.do(
            "SpawnEntity",
            name=name,
            entity_resource=Resource(resource_string=text),
            initial_pose=PoseStamped(pose=Pose(position=Point(x=x, y=y, z=z))),
        )
        assert answer.entity_name == name

    def move(self, name: str, x: float, y: float, z: float) -> None:
        """Put a thing elsewhere."""
        from geometry_msgs.msg import Point, Pose
        from simulation_interfaces.msg import EntityState

        state = EntityState(pose=Pose(position=Point(x=x, y=y, z=z)))
        self.do("SetEntityState", entity=name, state=state, set_pose=True)

    def state_of(self, name: str) -> Any:
        """Return the state of a thing, as its message."""
        return self.do("GetEntityState", entity=name).state

    def where(self, name: str) -> tuple[float, np.ndarray]:
        """Return the time and the place of a thing."""
        state = self.state_of(name)
        stamp, p = state.header.stamp, state.pose.position
        return stamp.sec + stamp.nanosec * 1e-9, np.array([p.x, p.y, p.z])

    def delete(self, name: str) -> None:
        """Delete a thing."""
        self.do("DeleteEntity", entity=name)

    def state(self) -> int:
        """Return whether it is `PLAYING` or `PAUSED`."""
        return self.do("GetSimulationState").state.state

    def go_to(self, state: int) -> None:
        """Play or pause."""
        from simulation_interfaces.msg import SimulationState

        self.do("SetSimulationState", state=SimulationState(state=state))

    def reset(self, scope: int = 0) -> None:
        """Reset it."""
        self.do("ResetSimulation", scope=scope)

    def snapshot(self, do: str, name: str) -> Any:
        """Save, restore or remove a snapshot; return the result, which may be a refusal."""
        from simulation_interfaces.msg import Resource

        return self.ask("LoadWorld", f"{do}_snapshot", world_resource=Resource(uri=name)).result

    def set(self, node: str = "/arm_gazebo", **values: object) -> str:
        """Set parameters of a node; see `Client.set_parameters`."""
        return self.client.set_parameters(node, **values)
