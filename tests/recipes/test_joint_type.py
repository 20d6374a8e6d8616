"""The recipe for a joint type: `rail`, a prismatic joint without ends."""

import math

from checkout import Checkout

URDF = """\
<robot name="cart">
  <link name="ground"/>
  <joint name="track" type="rail">
    <parent link="ground"/>
    <child link="cart"/>
    <axis xyz="1 0 0"/>
    <origin xyz="0 0 0.5"/>
  </joint>
  <link name="cart">
    <inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial>
    <collision><geometry><box size="0.2 0.1 0.1"/></geometry></collision>
  </link>
</robot>
"""

CHANGES = (
    ('    PLANAR = "planar"\n', '    PLANAR = "planar"\n    RAIL = "rail"\n'),
    (
        "return self is JointType.PRISMATIC\n",
        "return self in (JointType.PRISMATIC, JointType.RAIL)\n",
    ),
    (
        "return self.is_scalar and not self.wraps\n",
        "return self in (JointType.REVOLUTE, JointType.PRISMATIC)\n",
    ),
)

SCRIPT = """\
import numpy as np
from arm_control.hardware.info import parse_hardware_info
from arm_description import forward_kinematics, parse_urdf
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.launching.default_control import with_hardware
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.physics_timing import physics_timing
from arm_planning.kinematics.inverse import InverseKinematics

text = open(sys.argv[1]).read()
robot = parse_urdf(text)
pose = forward_kinematics(robot, {"track": 7.0})["cart"]
print(*pose[:3, 3])
print(*InverseKinematics.for_link(robot, "cart", ["track"]).solve(pose, [0.0]))

text = with_hardware(text, robot)
hardware_info = parse_hardware_info(text)
timing = physics_timing(100.0)
built = build_model(
    parse_urdf(text), hardware_info, (), "empty", BuildOptions(step_s=timing.step_s)
)
simulation = Physics(built, timing, True)
hardware = SimulatedHardware(simulation, hardware_info[0])
states = np.zeros(len(hardware.state_interfaces))
commands = np.zeros(len(hardware.command_interfaces))
hardware.bind(states, commands)
assert hardware.on_configure() and hardware.on_activate()
assert hardware.perform_command_mode_switch(["track/position"], [])
commands[hardware.command_interfaces.index("track/position")] = 7.0
for _ in range(1800):
    hardware.write(simulation.time_s, 0.01)
    simulation.advance()
    hardware.read(simulation.time_s, 0.01)
print(states[hardware.state_interfaces.index("track/position")])
"""


def test_a_joint_type_is_added_through_the_files_of_its_recipe(tmp_path):
    checkout = Checkout(tmp_path, "A joint type")
    checkout.insert("arm_description/arm_description/urdf/joint_type.py", *CHANGES)
    checkout.insert(
        "arm_gazebo/arm_gazebo/robot/body_tree.py",
        ("case JointType.PRISMATIC:", "case JointType.PRISMATIC | JointType.RAIL:"),
    )
    file = tmp_path / "cart.urdf"
    file.write_text(URDF)

    forward, inverse, simulated = checkout.run(SCRIPT, str(file)).splitlines()
    assert forward == "7.0 0.0 0.5"
    assert math.isclose(float(inverse), 7.0, abs_tol=1e-4)
    # 14 s at the 0.5 m/s of what slides, where the URDF gives no limit.
    assert math.isclose(float(simulated), 7.0, abs_tol=1e-3)
    assert "track" in checkout.run_module("arm_cli", "check", str(file))
