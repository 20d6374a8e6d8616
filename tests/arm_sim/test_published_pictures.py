"""Pictures that a program asks for are those that the camera process would publish."""

import os

import numpy as np
import pytest

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.description import RobotDescription
from arm_description.urdf.parser import parse_urdf
from arm_gazebo.camera.pipeline import CameraPipeline
from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.snapshot import CameraSnapshot
from arm_gazebo.feed.socket_pair import ModelMessage
from arm_gazebo.feed.state_feed import compiled_model
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.rendering.backend_selection import backend_order, open_renderer
from arm_gazebo.sensors.camera_reader import parse_cameras
from arm_sim.cameras import RobotCameras

pytestmark = pytest.mark.gl

SEED = 5
ROBOT = """<robot name='eye'><link name='base'/><link name='head'><inertial><mass value='1'/>
<inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link>
<joint name='pan' type='continuous'><parent link='base'/><child link='head'/>
<origin xyz='0 0 0.3'/><axis xyz='0 0 1'/></joint>
<gazebo reference='head'><sensor name='eye' type='camera'><update_rate>20</update_rate><camera>
<image><width>64</width><height>48</height></image><clip><near>0.1</near><far>10</far></clip>
<noise><type>gaussian</type><mean>0</mean><stddev>0.05</stddev></noise></camera></sensor></gazebo>
<ros2_control name='s' type='system'><hardware><plugin>arm_gazebo/SimulatedHardware</plugin>
</hardware><joint name='pan'><command_interface name='velocity'/></joint></ros2_control></robot>"""


class Published:
    """The sink of the camera process."""

    def __init__(self) -> None:
        self.picture = np.zeros((48, 64, 3), np.uint8)
        self.depth = None
        self.pictures: list[np.ndarray] = []

    def wants_picture(self) -> bool:
        return True

    def wants_depth(self) -> bool:
        return False

    def publish_info(self, time_s: float) -> None:
        pass

    def publish_picture(self, time_s: float) -> None:
        self.pictures.append(self.picture.copy())

    def publish_depth(self, time_s: float) -> None:
        pass


def test_a_picture_is_that_of_the_camera_process_with_its_noise():
    document = RobotDescription(ROBOT)
    cameras = parse_cameras(document)
    hardware = parse_hardware_info(document)
    built = build_model(parse_urdf(document), hardware, cameras, world="objects")
    simulation = Physics(built, physics_timing(100.0))
    for _ in range(10):
        simulation.advance()
    sink = Published()
    pipeline = CameraPipeline(
        cameras, [sink], lambda: open_renderer(backend_order("auto"), 64, 48), SEED
    )
    file, data = compiled_model(simulation.model), simulation.data
    # The second frame of a camera at 20 Hz is due at 0.1 s.
    frame = FrameDue(0, 2, 2)
    pipeline.handle(
        [
            ModelMessage(1, os.dup(file)),
            CameraSnapshot(1, data.time, (frame,), data.qpos, data.mocap_pos, data.mocap_quat),
        ]
    )
    pipeline.close()
    os.close(file)
    asked = RobotCameras(simulation, cameras, "auto", SEED)
    assert np.array_equal(asked.find("eye").image(), sink.pictures[0])
    asked.reseed(SEED + 1)
    assert not np.array_equal(asked.find("eye").image(), sink.pictures[0])
    asked.close()
