import mujoco

from arm_gazebo.physics.state_probe import WorldState
from arm_gazebo.physics.stepped_shapes import SteppedShapes
from arm_gazebo.world.entity_motion import EntityMotions

WORLD = """<mujoco><option><flag sleep="enable"/></option><worldbody>
  <geom type="plane" size="0 0 1"/>
  <body name="box" pos="0.6 0.5 0.15" sleep="init"><freejoint/>
    <geom name="hull" type="box" size="0.25 0.2 0.15"/>
    <geom name="label" type="box" size="0.1 0.1 0.151" contype="0" conaffinity="0"/></body>
</worldbody></mujoco>"""
PLACE = (0.6, 0.5, 0.15)


def present(model: mujoco.MjModel) -> WorldState:
    data = mujoco.MjData(model)
    return WorldState(0.0, data.qpos, data.qvel, data.mocap_pos, data.mocap_quat)


def test_drawn_shapes_of_a_sleeping_thing_are_in_place_whenever_they_are_first_asked_for():
    model = mujoco.MjModel.from_xml_string(WORLD)
    state = present(model)
    shapes = SteppedShapes(model)

    # A client of the running simulation makes its own arrays at any moment of a control period.
    shapes.hide()
    motions = EntityMotions(model)
    shapes.show()
    motions.take(state)

    positions, _ = motions.geom_poses
    assert tuple(positions[model.geom("label").id]) == PLACE
