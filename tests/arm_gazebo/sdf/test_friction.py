"""Friction of SDF shapes: of two shapes in contact Gazebo uses the lower value."""

import mujoco
import numpy as np
import pytest

from arm_gazebo.build_report import BuildReport
from arm_gazebo.sdf.world import read_sdf_world

INERTIAL = (
    "<inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.02</izz></inertia>"
    "</inertial>"
)
PUCK = "<cylinder><radius>0.2</radius><length>0.04</length></cylinder>"
PLANE = "<plane><normal>0 0 1</normal></plane>"
SLAB = "<box><size>9 9 0.02</size></box>"


def collision(geometry, mu=None, name="c", pose="0 0 0 0 0 0"):
    friction = "" if mu is None else f"<friction><ode><mu>{mu}</mu></ode></friction>"
    return (
        f'<collision name="{name}"><pose>{pose}</pose><geometry>{geometry}</geometry>'
        f"<surface>{friction}</surface></collision>"
    )


def model(name, *collisions, head="", z=0.0):
    return (
        f'<model name="{name}"><pose>0 0 {z} 0 0 0</pose>{head}<link name="link">{INERTIAL}'
        f"{''.join(collisions)}</link></model>"
    )


@pytest.fixture
def compiled(tmp_path):
    def made(*models):
        path = tmp_path / "lab.sdf"
        path.write_text(f'<sdf version="1.9"><world name="lab">{"".join(models)}</world></sdf>')
        return read_sdf_world(path, BuildReport()).compile()

    return made


def contact_friction(compiled):
    data = mujoco.MjData(compiled)
    mujoco.mj_forward(compiled, data)
    [friction] = np.unique(data.contact.friction[:, 0])
    return friction


@pytest.mark.parametrize(
    ("ground", "thing", "lower"),
    [
        (0.2, None, 0.2),
        (None, 0.2, 0.2),
        (0.5, 0.2, 0.2),
        (0.2, 0.5, 0.2),
        (0.5, 0.5001, 0.5),
        (100, None, 1),
        (None, 100, 1),
        (None, None, 1),
    ],
)
@pytest.mark.parametrize(("geometry", "top"), [(PLANE, 0.0), (SLAB, 0.01)])
def test_of_two_shapes_the_more_slippery_one_counts(compiled, ground, thing, lower, geometry, top):
    static = model("ground", collision(geometry, ground), head="<static>true</static>")
    puck = model("puck", collision(PUCK, thing), z=top + 0.0199)
    assert contact_friction(compiled(static, puck)) == pytest.approx(lower)


@pytest.mark.parametrize(("mu", "slid_m"), [(0.2, 1.02), (1.0, 0.204), (100.0, 0.204)])
def test_a_pushed_thing_slides_as_far_as_the_ground_lets_it(compiled, mu, slid_m):
    ground = model("ground", collision(PLANE, mu), head="<static>true</static>")
    world = compiled(ground, model("puck", collision(PUCK), z=0.02))
    data = mujoco.MjData(world)
    data.qvel[0] = 2.0  # m/s, which mu g would stop after v**2 / (2 mu g); it gets 2 s
    mujoco.mj_step(world, data, nstep=1000)
    assert data.qpos[0] == pytest.approx(slid_m, rel=0.05)


def test_each_collision_of_a_link_has_its_own(compiled):
    ball = "<sphere><radius>0.1</radius></sphere>"
    cart = compiled(
        model("cart", collision(ball, name="rubber"), collision(ball, 0, "caster", "1 0 0 0 0 0"))
    )
    assert dict(zip(cart.geom_pos[:, 0], cart.geom_friction[:, 0], strict=True)) == {0: 1, 1: 0}


def test_all_parts_of_a_mesh_have_its_friction(compiled, tmp_path):
    triangles = "f {0} {2} {1}\nf {0} {1} {3}\nf {0} {3} {2}\nf {1} {2} {3}\n"
    corners = "v {0} 0 0\nv {0} 1 0\nv {0} 0 1\nv {1} 0 0\n"
    (tmp_path / "two.obj").write_text(
        f"o a\n{corners.format(0, 1)}{triangles.format(1, 2, 3, 4)}"
        f"o b\n{corners.format(3, 4)}{triangles.format(5, 6, 7, 8)}"
    )
    world = compiled(model("thing", collision("<mesh><uri>two.obj</uri></mesh>", 0.3)))
    assert set(world.geom_friction[:, 0]) == {0.3}
