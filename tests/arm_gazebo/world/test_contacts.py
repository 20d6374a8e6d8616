"""Which bodies touch, where, and how hard."""

import mujoco
import numpy as np
import pytest

from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import RequestError
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.world.changes import NOTHING
from arm_gazebo.world.contacts import contacts_of
from arm_gazebo.world.entity import Entities

TOWER = """
<mujoco><worldbody>
  <geom type="plane" size="1 1 1"/>
  <body name="low" pos="0 0 0.1"><freejoint/><geom type="sphere" size="0.1" mass="2"/></body>
  <body name="high" pos="0 0 0.3"><freejoint/><geom type="sphere" size="0.1" mass="1"/>
    <body name="hat" pos="0 0 1"><geom type="sphere" size="0.01" mass="0.001"/></body></body>
</worldbody></mujoco>"""
GRAVITY = 9.81


@pytest.fixture
def tower() -> tuple[mujoco.MjModel, mujoco.MjData, Entities]:
    """Two balls on top of each other, at rest on the floor."""
    spec = mujoco.MjSpec.from_string(TOWER)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 2000)
    built = BuiltModel(model, spec, {}, {}, data.qpos.copy(), BuildReport(), {})
    return model, data, Entities(built, NOTHING, {})


def test_forces_carry_what_stands_above(tower):
    (on_low,) = [c for c in contacts_of("low", *tower) if c.other == "world"]
    assert on_low.force == pytest.approx([0, 0, 3.001 * GRAVITY], abs=0.05)
    assert on_low.normal == pytest.approx([0, 0, 1], abs=1e-3)
    assert on_low.position == pytest.approx([0, 0, 0], abs=0.01)
    (on_high,) = contacts_of("high", *tower)
    assert (on_high.body, on_high.other) == ("high", "low")
    assert on_high.force == pytest.approx([0, 0, 1.001 * GRAVITY], abs=0.05)


def test_a_contact_is_seen_from_both_sides(tower):
    (below,) = [c for c in contacts_of("low", *tower) if c.other == "high"]
    (above,) = contacts_of("high", *tower)
    assert np.array_equal(below.force, -above.force)
    assert np.array_equal(below.normal, -above.normal)
    assert below.depth == above.depth > 0.0


def test_a_gap_is_no_contact_and_a_margin_is_one():
    spec = mujoco.MjSpec.from_string(TOWER)
    spec.body("low").geoms[0].gap = 0.05
    spec.body("high").geoms[0].margin = 0.03
    model = spec.compile()
    data = mujoco.MjData(model)
    built = BuiltModel(model, spec, {}, {}, data.qpos.copy(), BuildReport(), {})
    entities = Entities(built, NOTHING, {})
    data.qpos[[2, 9]] = 0.12, 0.3
    mujoco.mj_forward(model, data)
    assert data.ncon == 2
    (between,) = contacts_of(None, model, data, entities)
    assert {between.body, between.other} == {"low", "high"}
    assert between.depth == pytest.approx(0.02)
    data.qpos[[2, 9]] = 0.5, 0.72
    mujoco.mj_forward(model, data)
    (between,) = contacts_of(None, model, data, entities)
    assert between.depth == pytest.approx(-0.02)
    assert np.linalg.norm(between.force) > 1.0


def test_all_contacts_and_those_of_a_link(tower):
    assert {frozenset((c.body, c.other)) for c in contacts_of(None, *tower)} == {
        frozenset(("world", "low")),
        frozenset(("low", "high")),
    }
    assert contacts_of("hat", *tower) == ()
    with pytest.raises(
        RequestError, match="no entity or link 'moon'; there are high, low and links"
    ):
        contacts_of("moon", *tower)
