"""The recipe for a setting: `gravity_m_s2`, how strongly things fall."""

import json

from checkout import ROOT, Checkout

FIRST = "    hold_joints: bool = setting("
FIELD = """\
    gravity_m_s2: float = setting(
        9.81,
        "how strongly things fall; 0 for space",
        read_non_negative,
        unit="m/s^2",
        name="gravity",
    )
"""
BUILT = "        return cls(simulated, physics, "
ACTS = "        physics.model.opt.gravity[2] = -settings.gravity_m_s2\n"

IN_A_PROGRAM = """\
import inspect, json
from arm_sim import Simulation

falling = {}
for keywords in ({}, {"gravity_m_s2": 2.0}):
    with Simulation("arm", **keywords) as sim:
        falling[str(keywords)] = sim.parts.physics.model.opt.gravity[2]
try:
    Simulation("arm", gravity_m_s2=-1.0)
except Exception as error:
    falling["refused"] = str(error)
falling["help"] = [x.strip() for x in inspect.getdoc(Simulation).splitlines() if "gravity" in x]
print(json.dumps(falling))
"""
AS_A_PARAMETER = """\
import json
from functools import partial
import rclpy
from rclpy.node import Node
from arm_gazebo.run.settings import simulation_settings
from arm_node.parameters import declare_setting
from rclpy.signals import SignalHandlerOptions

robot = "<robot name='r'><link name='l'/></robot>"
given = ["--ros-args", "-p", f"robot_description:={robot}", "-p", "gravity:=3"]
rclpy.init(args=given, signal_handler_options=SignalHandlerOptions.NO)
node = Node("arm_gazebo")
settings = simulation_settings(partial(declare_setting, node))
about = node.describe_parameter("gravity")
print(json.dumps({
    "value": settings.gravity_m_s2,
    "about": about.description,
    "least": about.floating_point_range[0].from_value,
    "read_only": about.read_only,
}))
rclpy.shutdown()
"""
IN_THE_MANUAL = """\
import os, sys
os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)
sys.path.insert(0, sys.argv[1])
from node_parameters import node_parameters_page
print(node_parameters_page())
"""


def test_a_setting_is_added_through_the_files_of_its_recipe(tmp_path):
    checkout = Checkout(tmp_path, "A setting")
    checkout.insert("arm_gazebo/arm_gazebo/run/settings.py", (FIRST, FIELD + FIRST))
    checkout.insert("arm_gazebo/arm_gazebo/run/run.py", (BUILT, ACTS + BUILT))
    help_text = "how strongly things fall, in m/s^2; 0 for space"

    arguments = checkout.run_module(
        "arm_cli", "launch", "arm_gazebo", "sim.launch.py", "--show-args"
    )
    assert f"gravity  (default '9.81')\n      {help_text}" in arguments

    program = json.loads(checkout.run(IN_A_PROGRAM))
    assert program["{}"] == -9.81
    assert program["{'gravity_m_s2': 2.0}"] == -2.0
    assert program["refused"] == "gravity must be a finite number of at least 0, not -1.0"
    assert program["help"] == [f"gravity_m_s2: {help_text}."]

    parameter = json.loads(checkout.run(AS_A_PARAMETER))
    assert parameter == {"value": 3.0, "about": help_text, "least": 0.0, "read_only": True}

    row = "| `gravity` | float | `9.81` | a finite number of at least 0 | at the start | "
    assert f"{row}{help_text} |" in checkout.run(IN_THE_MANUAL, str(ROOT / "docs"))
