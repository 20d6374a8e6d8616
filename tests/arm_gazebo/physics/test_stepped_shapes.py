import mujoco
import numpy as np
import pytest

from arm_gazebo.physics.stepped_shapes import SteppedShapes

SLEEP = '<option><flag sleep="enable"/></option>'
DRAWN = '<geom type="box" size="0.2 0.2 0.2" pos="0.1 0 0" contype="0" conaffinity="0"/>'
STEPS = 400

TOUCHING = f"""<worldbody>
  <geom type="plane" size="0 0 1"/>{DRAWN}
  <body name="far" pos="3 0 0.1"><freejoint/>{DRAWN}<geom type="box" size="0.1 0.1 0.1"/></body>
  <body name="low" pos="0 0 0.1"><freejoint/>
    {DRAWN}<geom type="box" size="0.1 0.1 0.1"/>{DRAWN}</body>
  <body name="high" pos="0.05 0 0.4" euler="10 20 0"><freejoint/>
    <geom type="cylinder" size="0.03 0.1"/>{DRAWN}</body>
</worldbody>"""
PAIRED = f"""<worldbody>
  <geom name="floor" type="box" size="1 1 0.1" contype="0" conaffinity="0"/>
  <body pos="0 0 0.3"><freejoint/>
    <geom name="ball" size="0.05" contype="0" conaffinity="0"/>{DRAWN}</body>
</worldbody><contact><pair geom1="floor" geom2="ball"/></contact>"""
BLOWN = """<option density="1000" viscosity="1" wind="2 0 0"/><worldbody>
  <body pos="0 0 1"><freejoint/>
    <geom type="ellipsoid" size="0.1 0.05 0.02" fluidshape="ellipsoid" contype="0"
      conaffinity="0"/></body>
</worldbody>"""
WRAPPED = f"""<worldbody>
  <site name="above" pos="0 0 1"/>
  <body pos="0.3 0 0.6"><joint axis="0 1 0"/>
    <geom type="capsule" size="0.02" fromto="0 0 0 0.3 0 0" contype="0" conaffinity="0"/>
    <geom name="pulley" type="cylinder" size="0.05 0.02" pos="0.15 0 0.06" euler="90 0 0"
      contype="0" conaffinity="0"/>
    <body pos="0.3 0 0"><joint axis="0 1 0"/>{DRAWN}<site name="end" pos="0 0 -0.1"/></body>
  </body>
</worldbody>
<tendon><spatial springlength="0.2" stiffness="400">
  <site site="above"/><geom geom="pulley"/><site site="end"/></spatial></tendon>"""


def stepped(model, hidden):
    data = mujoco.MjData(model)
    shapes = SteppedShapes(model)
    states = []
    for _ in range(STEPS):
        if hidden:
            shapes.hide()
        mujoco.mj_step(model, data)
        shapes.show()
        states.append((data.qpos.tobytes(), data.qvel.tobytes(), data.ncon))
    return states


@pytest.mark.parametrize("world", [TOUCHING, PAIRED, BLOWN, WRAPPED])
def test_steps_give_the_same_bits_without_shapes_that_are_only_drawn(world):
    model = mujoco.MjModel.from_xml_string(f"<mujoco>{SLEEP}{world}</mujoco>")

    assert stepped(model, hidden=True) == stepped(model, hidden=False)


def test_shapes_that_are_only_drawn_are_hidden_and_shown_again():
    model = mujoco.MjModel.from_xml_string(f"<mujoco>{TOUCHING}</mujoco>")
    shapes = SteppedShapes(model)
    whole = model.body_geomadr.tolist(), model.body_geomnum.tolist()

    shapes.hide()

    assert model.body_geomnum.tolist() == [1, 1, 1, 1]
    assert [int(model.geom_contype[first]) for first in model.body_geomadr] == [1, 1, 1, 1]
    shapes.show()
    assert (model.body_geomadr.tolist(), model.body_geomnum.tolist()) == whole


def test_drawn_shapes_of_a_robot_are_where_its_links_are(bench, parts):
    run = bench(parts.arm(), world="pick_and_place_demo")
    model = run.simulation.model
    drawn = int(
        np.flatnonzero((model.geom_contype == 0) & (model.body_weldid[model.geom_bodyid] > 0))[-1]
    )
    whole = model.body_geomnum.tolist()

    run.tick()

    assert model.body_geomnum.tolist() == whole
    poses = run.simulation.poses()
    body = model.geom_bodyid[drawn]
    turned = poses.xmat[body].reshape(3, 3) @ model.geom_pos[drawn]
    assert poses.geom_xpos[drawn] == pytest.approx(poses.xpos[body] + turned, abs=1e-12)
