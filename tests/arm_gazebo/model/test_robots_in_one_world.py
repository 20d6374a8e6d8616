"""Several robots in one world are independent but collide with each other."""

import mujoco
import numpy as np
import pytest

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Pose
from arm_gazebo.errors import ModelError
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.launching.edited_description import placed
from arm_gazebo.model.builder import build_world
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.part import BuildOptions, RobotInWorld

BALL = '<collision><origin xyz="0.5 0 0"/><geometry><sphere radius="0.1"/></geometry></collision>'


def pendulum(parts, prefix):
    """Return a robot with one joint that swings a ball at 0.5 m about the y axis."""
    bob = parts.link(f"{prefix}bob", 1.0, 0.05, "0.5 0 0")
    bob = bob.replace("</link>", f"{BALL}</link>")
    return parts.robot(
        parts.link(f"{prefix}base"),
        bob,
        parts.joint(f"{prefix}j", f"{prefix}base", f"{prefix}bob", xyz="0 0 2"),
        parts.ros2_control([f"{prefix}j"]),
    )


def entry(urdf, **options):
    return RobotInWorld(
        parse_urdf(urdf), parse_hardware_info(urdf), options=BuildOptions(**options)
    )


@pytest.fixture
def pair(parts):
    """Two pendulums, 0.3 m apart."""
    return [
        entry(pendulum(parts, "left_")),
        entry(pendulum(parts, "right_"), spawn=Pose((0.0, 0.3, 0.0))),
    ]


def test_each_robot_has_its_joints_and_its_own_pose(pair):
    built = build_world(pair)
    assert list(built.joints) == ["left_j", "right_j"]
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    mujoco.mj_forward(built.model, data)
    assert data.xpos[built.bodies["left_bob"]] == pytest.approx([0, 0, 2])
    assert data.xpos[built.bodies["right_bob"]] == pytest.approx([0, 0.3, 2])


def test_robots_that_hold_a_link_called_world_are_put_in_places_too(parts):
    pair = []
    for prefix, y in (("left_", 1.0), ("right_", -1.0)):
        urdf = pendulum(parts, prefix).replace(
            "</robot>",
            f"<link name='world'/><joint name='{prefix}w' type='fixed'>"
            f"<parent link='{prefix}base'/><child link='world'/></joint></robot>",
        )
        pair.append(entry(placed(urdf, (0.0, y, 0.0, 0.0, 0.0, 0.0))))
    built = build_world(pair)
    data = mujoco.MjData(built.model)
    mujoco.mj_forward(built.model, data)
    assert data.body("left_bob").xpos == pytest.approx([0, 1, 2])
    assert data.body("right_bob").xpos == pytest.approx([0, -1, 2])


def test_each_follows_its_own_commands(pair):
    timing = physics_timing(100)
    simulation = Physics(build_world(pair), timing)
    components = [SimulatedHardware(simulation, info) for e in pair for info in e.hardware]
    values = []
    for component in components:
        states = np.zeros(len(component.state_interfaces))
        commands = np.zeros(len(component.command_interfaces))
        component.bind(states, commands)
        assert component.on_configure()
        assert component.on_activate()
        claimed = [n for n in component.command_interfaces if n.endswith("/position")]
        assert component.perform_command_mode_switch(claimed, [])
        values.append((states, commands))
    left, right = values
    left[1][components[0].command_interfaces.index("left_j/position")] = 0.7
    for _ in range(200):
        for component in components:
            component.write(simulation.time_s, timing.period_s)
        simulation.advance()
        for component in components:
            component.read(simulation.time_s, timing.period_s)
    assert left[0][components[0].state_interfaces.index("left_j/position")] == pytest.approx(0.7)
    position = right[0][components[1].state_interfaces.index("right_j/position")]
    assert position == pytest.approx(0.0, abs=1e-3)


def touching(built):
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    mujoco.mj_forward(built.model, data)
    return {tuple(sorted(built.model.geom_bodyid[list(c.geom)])) for c in data.contact}


def test_they_touch_each_other(parts):
    near = [
        entry(pendulum(parts, "left_")),
        entry(pendulum(parts, "right_"), spawn=Pose((0.0, 0.15, 0.0))),
    ]
    built = build_world(near)
    assert touching(built) == {(built.bodies["left_bob"], built.bodies["right_bob"])}


def test_robots_with_the_same_names_are_refused_with_advice(parts):
    same = entry(pendulum(parts, ""))
    with pytest.raises(ModelError, match=r"already has a body 'base'.*with a prefix"):
        build_world([same, same])


def test_too_many_robots_are_refused(pair):
    with pytest.raises(ModelError, match="40 robots are too many"):
        build_world(pair * 20)
