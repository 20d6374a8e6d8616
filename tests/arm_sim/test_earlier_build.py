"""A recording and a snapshot of an earlier build are read, and go on as they did there.

The build of November 2026 (commit 98e7c66) made both with MuJoCo 4.0.0: a recording of 0.8 s, and a
snapshot at 0.4 s, in the middle of a trajectory, a grip and the fall of a box.
"""

import re
from pathlib import Path

import mujoco
import pytest

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RunFile
from arm_sim import Simulation

pytestmark = pytest.mark.skipif(
    not mujoco.__version__.startswith("4.0."), reason="made with MuJoCo 4.0, and refused by others"
)
FILES = Path(__file__).with_name("earlier_build")
AT_END = (-0.00152515, 0.21778761, 0.19834749, 0.38504419, 0.23503576)
"""The joints' positions after 0.8 s (rad)."""
TOLERANCE = 1e-6
LINK = """<link name='l{n}'><inertial><origin xyz='0 0 0.1'/><mass value='0.5'/>
<inertia ixx='0.002' ixy='0' ixz='0' iyy='0.002' iyz='0' izz='0.001'/></inertial>
<collision><origin xyz='0 0 0.1'/><geometry><box size='0.04 0.04 0.16'/></geometry></collision>
</link>"""
JOINT = """<joint name='j{i}' type='revolute'><parent link='l{i}'/><child link='l{n}'/>
<origin xyz='0 0 {z}'/><axis xyz='0 1 0'/>
<limit lower='-2' upper='2' effort='40' velocity='3'/></joint>"""
IMU = """<gazebo reference='l1'><sensor name='imu' type='imu'><always_on>1</always_on>
<update_rate>50</update_rate><imu><linear_acceleration><x><noise type='gaussian'><mean>0</mean>
<stddev>0.1</stddev></noise></x></linear_acceleration></imu></sensor></gazebo>"""
CONTROLLERS = {
    "controller_manager": {
        "update_rate": 100,
        "joint_state_broadcaster": "joint_state_broadcaster/JointStateBroadcaster",
        "follower": "joint_trajectory_controller/JointTrajectoryController",
        "gripper": "position_controllers/GripperActionController",
        "pid": "pid_controller/PidController",
        "gpio": "gpio_controllers/GpioCommandController",
        "forward": "forward_command_controller/ForwardCommandController",
        "imu_broadcaster": "imu_sensor_broadcaster/IMUSensorBroadcaster",
    },
    "follower": {
        "joints": ["j0", "j1"],
        "command_interfaces": ["position"],
        "state_interfaces": ["position", "velocity"],
    },
    "gripper": {"joint": "j2"},
    "pid": {
        "dof_names": ["j3"],
        "command_interface": "effort",
        "reference_and_state_interfaces": ["position"],
        "gains": {
            "j3": {
                "p": 20.0,
                "i": 2.0,
                "d": 1.0,
                "i_clamp_max": 1.0,
                "i_clamp_min": -1.0,
                "antiwindup": True,
            }
        },
    },
    "gpio": {
        "gpios": ["io"],
        "command_interfaces": {"io": {"interfaces": ["out"]}},
        "state_interfaces": {"io": {"interfaces": ["out"]}},
    },
    "forward": {"joints": ["j4"], "interface_name": "velocity"},
    "imu_broadcaster": {"sensor_name": "imu", "frame_id": "l1"},
}


def description() -> str:
    links, joints, interfaces = "", "", ""
    for i in range(5):
        links += LINK.format(n=i + 1)
        joints += JOINT.format(i=i, n=i + 1, z=0.2 if i else 0.5)
        kinds = ("position", "velocity", "effort")
        commands = "".join(f"<command_interface name='{kind}'/>" for kind in kinds)
        states = "".join(f"<state_interface name='{kind}'/>" for kind in kinds)
        interfaces += f"<joint name='j{i}'>{commands}{states}</joint>"
    readings = [f"orientation.{axis}" for axis in "xyzw"]
    readings += [
        f"{kind}.{x}" for kind in ("angular_velocity", "linear_acceleration") for x in "xyz"
    ]
    sensor = "".join(f"<state_interface name='{name}'/>" for name in readings)
    return f"""<robot name='earlier'><link name='world'/><link name='l0'><inertial><mass value='1'/>
<inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link>
<joint name='foot' type='fixed'><parent link='world'/><child link='l0'/></joint>
{links}{joints}{IMU}<ros2_control name='sim' type='system'>
<hardware><plugin>arm_gazebo/SimulatedHardware</plugin></hardware>{interfaces}
<gpio name='io'><command_interface name='out'/><state_interface name='out'/></gpio>
<sensor name='imu'>{sensor}</sensor></ros2_control></robot>"""


def parameters() -> dict[str, object]:
    manager = {
        name: {"type": value} if isinstance(value, str) else value
        for name, value in CONTROLLERS["controller_manager"].items()
    }
    nodes = {**CONTROLLERS, "controller_manager": manager}
    return {node: {"ros__parameters": values} for node, values in nodes.items()}


def test_a_snapshot_is_restored_and_goes_on_with_its_goals():
    with Simulation(description(), controllers=parameters(), seed=3) as sim:
        sim.restore(FILES / "earlier.snapshot")
        assert sim.time_s == pytest.approx(0.4)
        sim.run(0.4)
        assert list(sim.joints.position) == pytest.approx(AT_END, abs=TOLERANCE)


def test_a_recording_replays():
    # A patch release of MuJoCo reads the model of another one as its own.
    difference = Replay(RunFile(FILES / "earlier.run")).run().difference
    # On a processor of another kind the last bits may differ.
    for line in difference.lines if difference else ():
        by = re.search(r"by (\S+)$", line)
        assert by, line
        assert abs(float(by[1])) < TOLERANCE


def test_every_input_of_a_recording_is_read():
    records = list(RunFile(FILES / "earlier.run").records())
    assert len(records) > 10
