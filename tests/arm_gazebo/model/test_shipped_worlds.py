"""The worlds that come with the simulation: what is in them, and that it stays where it is."""

import subprocess
import sys
import time
from pathlib import Path

import mujoco
import numpy as np
import pytest
import yaml

from arm_gazebo.launching.world_path import find_world, shipped_worlds
from arm_gazebo.model.world_file import load_world

HOUSE = Path(__file__).parents[3] / "tools" / "house"

GROCERIES = {
    "red_cylinder": ([0.22, 0.12, 0.175], 0.05, 0.8),
    "cheezit_big_original": ([0.64, 0.23, 0.13], 0.5, 1.0),
    "cardboard_box": ([0.65, 0.6, 0.15], 2.0, 1.0),
    "coke_can": ([0.5, 0.15, 0.0], 0.39, 1.0),
}
"""Where each is, in m, its mass in kg and its friction."""

SIZES = {
    "red_cylinder": [0.03, 0.03, 0.35],
    "mustard": [0.0651, 0.0486, 0.16],
    "cheezit_big_original": [0.154, 0.226, 0.062],
    "cardboard_box": [0.5, 0.4, 0.3],
    "coke_can": [0.067, 0.067, 0.1239],
}
"""Of what can be touched, in the frame of the thing, in m."""


def compiled(world):
    model = load_world(world).compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def geoms_of(model, name):
    body = model.body(name).id
    return range(model.body_geomadr[body], model.body_geomadr[body] + model.body_geomnum[body])


def box_around(model, geoms):
    """Return the lowest and the highest corner of a box around geoms, in their body's frame."""
    corners = []
    for geom in geoms:
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
        centre, half = model.geom_aabb[geom, :3], model.geom_aabb[geom, 3:]
        signs = np.array(np.meshgrid([-1, 1], [-1, 1], [-1, 1])).reshape(3, -1).T
        corners.append((centre + signs * half) @ rotation.reshape(3, 3).T + model.geom_pos[geom])
    every = np.concatenate(corners)
    return every.min(axis=0), every.max(axis=0)


@pytest.mark.parametrize("world", sorted(shipped_worlds()))
def test_nothing_overlaps_and_nothing_moves_once_it_is_awake(world):
    model, data = compiled(world)
    assert all(contact.dist > -1e-4 for contact in data.contact)
    model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
    places, turns = data.xpos.copy(), data.xquat.copy()
    mujoco.mj_step(model, data, nstep=int(2.0 / model.opt.timestep))
    assert data.xpos == pytest.approx(places, abs=5e-4)
    assert data.xquat == pytest.approx(turns, abs=5e-3)


@pytest.mark.parametrize("world", sorted(shipped_worlds()))
def test_robot_has_room_at_the_origin(world):
    """A box of the reach of a small arm's foot, over the floor and what lies flat on it."""
    model, data = compiled(world)
    touched = [
        model.geom(geom).name or model.body(model.geom_bodyid[geom]).name
        for geom in range(model.ngeom)
        if model.geom_contype[geom] and model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_PLANE
        if np.linalg.norm(data.geom_xpos[geom][:2]) - model.geom_rbound[geom] < 0.2
        if np.all(
            np.abs((-data.geom_xpos[geom]) @ data.geom_xmat[geom].reshape(3, 3))
            < model.geom_aabb[geom, 3:] + 0.15
        )
    ]
    assert touched == []


@pytest.mark.parametrize("name", sorted(GROCERIES))
def test_things_to_pick_have_their_places_masses_and_friction(name):
    place, mass, friction = GROCERIES[name]
    model, data = compiled("pick_and_place_demo")
    assert data.body(name).xpos == pytest.approx(place, abs=1e-6)
    assert model.body(name).mass[0] == pytest.approx(mass)
    solid = [geom for geom in geoms_of(model, name) if model.geom_contype[geom]]
    assert [model.geom_friction[geom][0] for geom in solid] == pytest.approx([friction])


@pytest.mark.parametrize("name", sorted(SIZES))
def test_things_to_pick_have_their_sizes(name):
    model, _ = compiled("pick_and_place_demo")
    solid = [geom for geom in geoms_of(model, name) if model.geom_contype[geom]]
    low, high = box_around(model, solid)
    assert high - low == pytest.approx(SIZES[name], abs=1e-4)
    drawn = [geom for geom in geoms_of(model, name) if not model.geom_contype[geom]]
    low, high = box_around(model, drawn)
    # The cylinder's looks are thinner than it is.
    assert high - low == pytest.approx(SIZES[name], abs=6e-3)


def test_mustard_is_part_of_the_world_and_the_rest_can_be_taken():
    model, _ = compiled("pick_and_place_demo")
    free = {name for name in SIZES if model.body(name).dofnum[0] == 6}
    assert free == set(SIZES) - {"mustard"}


def test_shapes_are_one_of_each():
    model, _ = compiled("shapes")
    kinds = {mujoco.mjtGeom(kind).name.removeprefix("mjGEOM_") for kind in model.geom_type}
    assert kinds == {"PLANE", "BOX", "CYLINDER", "SPHERE", "CAPSULE", "ELLIPSOID", "MESH"}
    assert model.body_mass[1:] == pytest.approx(np.ones(6))


def test_the_house_is_what_make_house_writes(tmp_path):
    made = tmp_path / "house.xml"
    subprocess.run([sys.executable, HOUSE.parent / "make_house.py", "--output", made], check=True)
    assert made.read_text(encoding="utf-8") == find_world("house").read_text(encoding="utf-8")


def test_house_has_its_things_in_their_places_and_loads_quickly():
    started = time.process_time()
    model, data = compiled("house")
    assert time.process_time() - started < 5
    things = yaml.safe_load((HOUSE / "things.yaml").read_text(encoding="utf-8"))
    assert len(things) == 86 == model.nbody - 1
    assert model.nv == 0
    for name, _, *pose in things:
        assert data.body(name).xpos == pytest.approx(pose[:3], abs=1e-6)


def test_things_of_the_house_fill_their_boxes():
    model, _ = compiled("house")
    models = {}
    for file in ("building.yaml", "furniture.yaml", "belongings.yaml"):
        models |= yaml.safe_load((HOUSE / file).read_text(encoding="utf-8"))
    for name, kind, *_ in yaml.safe_load((HOUSE / "things.yaml").read_text(encoding="utf-8")):
        if kind == "FloorB_01":
            [floor] = geoms_of(model, name)
            assert 2 * model.geom_size[floor][:2] == pytest.approx(models[kind]["size"][:2])
            continue
        low, high = box_around(model, geoms_of(model, name))
        assert low == pytest.approx(models[kind]["low"], abs=3e-3), name
        assert high - low == pytest.approx(models[kind]["size"], abs=3e-3), name
