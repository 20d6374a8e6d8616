"""Executable gz_sim_server: a world that waits for `create` to spawn its robot, as in Gazebo.

Launch files for ROS start Gazebo first and spawn the robot later. This simulation is built together
with its robot, so this process answers `spawn_entity` until a robot arrives, and then becomes
arm_gazebo_node.
"""

import json
import os
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_description.errors import DescriptionError
from arm_gazebo.errors import GazeboError
from arm_node.task import run_task

if TYPE_CHECKING:
    from rclpy.node import Node

    from arm_description.urdf.robot import Pose
    from arm_node.process import NodeProcess

NODE = "gz_sim"
SIMULATION = "arm_gazebo"
ANSWERED_S = 0.5
"""Time between the response and the end of this node, so that the response is sent."""


def main(argv: Sequence[str] | None = None) -> int:
    """Wait for a robot, then become its simulation; return the exit code if none arrives."""
    arguments = list(sys.argv if argv is None else argv)
    parameters: list[Path] = []

    def task(node: "Node", process: "NodeProcess") -> int:
        found = wait_for_robot(node, process)
        if found is not None:
            parameters.extend(found)
        return 0

    code = run_task(NODE, task, arguments, (GazeboError, DescriptionError))
    if code or not parameters:
        return code
    files = [word for path in parameters for word in ("--params-file", str(path))]
    module = "arm_gazebo.arm_gazebo_node"
    words = [sys.executable, "-P", "-m", module, *arguments[1:], "--ros-args", *files]
    os.execv(sys.executable, words)


def wait_for_robot(node: "Node", process: "NodeProcess") -> Sequence[Path] | None:
    """Answer `spawn_entity` until a URDF arrives; return its parameter files, None at the end."""
    from simulation_interfaces.srv import SpawnEntity

    from arm_description.urdf.robot import Pose
    from arm_gazebo.ros.world_convert import matrix_of

    robots: list[Sequence[Path]] = []

    def spawn(request: Any, response: Any) -> Any:
        text = request.entity_resource.resource_string
        try:
            if "<robot" not in text:
                raise GazeboError("the world waits for its robot; spawn other entities after it")
            robots.append(robot_parameters(text, Pose.of(matrix_of(request.initial_pose.pose))))
        except (GazeboError, DescriptionError) as error:
            response.result.result = SpawnEntity.Response.RESOURCE_PARSE_ERROR
            response.result.error_message = str(error)
            return response
        response.result.result = 1  # RESULT_OK of simulation_interfaces/Result
        response.entity_name = request.name
        return response

    service = node.create_service(SpawnEntity, "spawn_entity", spawn)
    node.get_logger().info("the world waits for its robot: ros_gz_sim create")
    while not robots:
        if process.wait(0.05):
            return None
    process.wait(ANSWERED_S)
    node.destroy_service(service)
    return robots[0]


def robot_parameters(description: str, pose: "Pose") -> list[Path]:
    """Write the parameter files of the simulation of one robot; return their paths.

    The controllers' file is the one that the description names for gz_ros2_control. No controller
    is started, because the launch file spawns them. As in Gazebo, nothing holds the joints without
    hardware, and a robot without a root link `world` stands free.

    Raises:
        DescriptionError: the text is not a valid robot.
        GazeboError: the controllers' file cannot be used.
    """
    from arm_description.urdf.description import RobotDescription
    from arm_gazebo.launching.default_control import has_hardware
    from arm_gazebo.launching.robot_setup import gz_parameter_files, set_up_robot

    folder = Path(tempfile.mkdtemp(prefix="gz_sim_"))
    model = folder / "robot.urdf"
    model.write_text(description, encoding="utf-8")
    controllers = next(iter(gz_parameter_files(RobotDescription(description))), "")
    setup = set_up_robot(str(model), controllers=controllers, spawn="")
    settings = {
        **setup.parameters(),
        "base": "free",
        "pose": str([*pose.xyz, *pose.rpy]),
        "hold_joints": has_hardware(description),
    }
    content: dict[str, Any] = {SIMULATION: {"ros__parameters": settings}}
    files: list[Path] = []
    if isinstance(setup.controllers, Mapping):
        content.update(setup.controllers)
    else:
        files.append(setup.controllers)
    own = folder / "parameters.yaml"
    own.write_text(json.dumps(content), encoding="utf-8")
    return [*files, own]


if __name__ == "__main__":
    sys.exit(main())
