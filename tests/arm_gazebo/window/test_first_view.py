"""The first view of the window."""

import math

import mujoco
import numpy as np

from arm_gazebo.window.__main__ import first_view

ROBOT = """
  <body name="robot"><geom type="box" size=".05 .05 .3" pos="0 0 .3"/>
    <body name="arm" pos="0 0 .6"><joint name="turn"/><geom type="box" size=".05 .05 .1"/></body>
  </body>"""
ACTUATOR = '<actuator><position joint="turn"/></actuator>'


def view_of(bodies, actuator=ACTUATOR):
    ground = '<geom type="plane" size="0 0 1"/><geom type="box" size="9 9 .01"/>'
    world = f"<mujoco><worldbody>{ground}{bodies}</worldbody>{actuator}</mujoco>"
    model = mujoco.MjModel.from_xml_string(world)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return first_view(model, data)


def distance(view):
    return float(np.linalg.norm(np.subtract(view.position, view.target)))


def test_a_robot_fills_the_window_whatever_the_world_is_like():
    alone = view_of(ROBOT)
    assert 0.7 < distance(alone) < 2.0
    in_a_hall = view_of(ROBOT + '<geom type="box" size=".1 9 2" pos="-9 0 2"/>')
    assert distance(in_a_hall) == distance(alone)


def test_the_camera_is_neither_behind_a_wall_nor_in_furniture():
    usual = view_of(ROBOT)
    x, y, _ = usual.position
    sofa = f'<geom type="box" size=".4 .4 2" pos="{x} {y} 0"/>'
    view = view_of(ROBOT + sofa)
    assert math.hypot(view.position[0] - x, view.position[1] - y) > 0.4
    # What can be seen through is in nobody's way.
    glass = sofa.replace("/>", ' rgba="1 1 1 .2"/>')
    assert view_of(ROBOT + glass).position == usual.position


def test_a_world_without_a_robot_fills_the_view():
    things = "".join(f'<geom type="sphere" size=".2" pos="{x} 0 .2"/>' for x in (-3, 3))
    view = view_of(things, "")
    assert distance(view) > 3.0
    np.testing.assert_allclose(view.target[:2], (0.0, 0.0), atol=1e-6)


def test_bare_ground_has_no_view():
    assert view_of("", "") is None
