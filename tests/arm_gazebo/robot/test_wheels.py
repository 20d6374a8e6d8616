"""Changes to wheels and casters, and shapes that stay unchanged."""

import mujoco
import numpy as np
import pytest

from arm_gazebo.world.changes import WorldChanges, changed_model

ELLIPSOID, CYLINDER = mujoco.mjtGeom.mjGEOM_ELLIPSOID, mujoco.mjtGeom.mjGEOM_CYLINDER


def cylinder(name, rpy="1.5707963 0 0"):
    return (
        f'<link name="{name}"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"'
        f' ixy="0" ixz="0" iyz="0"/></inertial><collision><origin rpy="{rpy}"/><geometry>'
        '<cylinder radius="0.1" length="0.04"/></geometry></collision></link>'
    )


@pytest.fixture
def cart(parts):
    def make(kind="continuous", axis="0 1 0", rpy="1.5707963 0 0", height="0", base="free", **more):
        caster = '<collision><origin xyz="-0.2 0 -0.07"/><geometry><sphere radius="0.03"/>'
        chassis = parts.link("base", 5.0, 0.1, "-0.05 0 0").replace(
            "</link>", f"{caster}</geometry></collision></link>"
        )
        wheels = [
            part
            for side, y in (("left", 0.2), ("right", -0.2))
            for part in (
                cylinder(side, rpy),
                parts.joint(f"{side}_j", "base", side, kind, f"0 {y} {height}", axis),
            )
        ]
        urdf = parts.robot(chassis, *wheels, parts.ros2_control(["left_j", "right_j"]))
        return parts.build(urdf, base=base, **more)

    return make


def shapes_that_touch(built):
    model = built.model
    return {
        model.body(model.geom_bodyid[geom]).name: model.geom_type[geom]
        for geom in np.flatnonzero(model.geom_contype)
    }


def test_wheels_stand_on_their_middle(cart):
    built = cart()
    shapes = shapes_that_touch(built)
    assert (shapes["left"], shapes["right"]) == (ELLIPSOID, ELLIPSOID)
    assert built.model.geom("floor").id in built.model.pair_geom1
    assert any("they are wheels" in str(finding) for finding in built.report.findings)
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    mujoco.mj_forward(built.model, data)
    assert data.body("left").xpos[2] == pytest.approx(0.1, abs=1e-6)


@pytest.mark.parametrize(
    "how",
    [
        {"base": "fixed"},
        {"kind": "revolute"},
        {"axis": "0 0 1", "rpy": "0 0 0"},
        {"rpy": "0 0 0"},
        {"height": "0.3"},
    ],
    ids=["bolted down", "limited", "upright", "across the axis", "above the floor"],
)
def test_other_cylinders_keep_their_shape(cart, how):
    built = cart(**how)
    assert shapes_that_touch(built)["left"] == CYLINDER
    assert built.model.npair == 0


def test_a_pair_has_the_friction_that_its_shapes_would_have(cart):
    model = cart().model
    [pair] = range(model.npair)
    floor, ball = model.pair_geom1[pair], model.pair_geom2[pair]
    assert (model.geom(floor).name, model.geom_type[ball]) == (
        "floor",
        mujoco.mjtGeom.mjGEOM_SPHERE,
    )
    friction = np.maximum(model.geom_friction[floor], model.geom_friction[ball])
    assert model.pair_friction[pair][[0, 2, 3]] == pytest.approx(friction)
    assert model.pair_solref[pair] == pytest.approx(model.geom_solref[ball])


def test_a_pair_has_the_margin_and_gap_of_both_shapes(cart, tmp_path):
    world = tmp_path / "world.xml"
    world.write_text(
        '<mujoco><worldbody><geom type="plane" size="0 0 1" margin="0.01" gap="0.02"/></worldbody>'
        "</mujoco>"
    )
    model = cart(world=world).model
    assert model.pair_margin.tolist() == pytest.approx([0.01])
    assert model.pair_gap.tolist() == pytest.approx([0.02])


def test_pairs_go_with_what_is_taken_out_of_the_world(cart):
    built = cart(world="pick_and_place_demo")
    spec = built.spec
    standing = next(
        body.name
        for body in spec.worldbody.bodies
        if not body.joints and any(geom.contype for geom in body.geoms)
    )
    changed = changed_model(built, WorldChanges().without(standing))
    assert 0 < changed.model.npair < built.model.npair
    assert changed_model(changed, WorldChanges()).model.npair == changed.model.npair
