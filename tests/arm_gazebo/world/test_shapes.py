import numpy as np
import pytest

from arm_gazebo.world.shapes import MAX_TRIANGLES, Solid, WorldShapes


def shapes_of(world) -> WorldShapes:
    return WorldShapes(world.editor.model, world.editor.entities)


@pytest.fixture
def world(kept, parts):
    return kept("shapes", robot=parts.pendulum())


def test_every_kind_of_shape_is_drawn(world):
    solids = {}
    for shape in shapes_of(world).shapes:
        solids.setdefault(shape.owner, []).append(shape.solid)
    assert solids == {
        "world": [Solid.BOX],
        "capsule": [Solid.CYLINDER, Solid.BALL, Solid.BALL],
        "cylinder": [Solid.CYLINDER],
        "box": [Solid.BOX],
        "sphere": [Solid.BALL],
        "ellipsoid": [Solid.BALL],
        "cone": [Solid.TRIANGLES],
    }


def test_sizes_and_places(world):
    shapes = shapes_of(world)
    rows = shapes.poses(*world.editor.motions().geom_poses)
    found = {shape.key: (shape, row) for shape, row in zip(shapes.shapes, rows, strict=True)}
    box, row = found["box", 0]
    assert box.size == (1.0, 1.0, 1.0)
    assert row == pytest.approx([2, 0, 0.5, 0, 0, 0, 1])
    # The capsule lies along x: its ends are 0.3 m off the middle.
    ends = [found["capsule", number][1][:3] for number in (1, 2)]
    assert sorted(end[0] for end in ends) == pytest.approx([1.7, 2.3], abs=1e-6)


def test_triangles_are_at_the_meshs_pose(world):
    shapes = shapes_of(world)
    rows = shapes.poses(*world.editor.motions().geom_poses)
    cone, row = next(
        (shape, row) for shape, row in zip(shapes.shapes, rows, strict=True) if shape.corners.size
    )
    assert 0 < len(cone.corners) <= 3 * MAX_TRIANGLES
    data = world.arm.simulation.data
    rotation = data.geom_xmat[cone.geom].reshape(3, 3)
    corners = cone.corners @ rotation.T + row[:3]
    # Its foot is half a metre below its frame, its tip half a metre above.
    assert corners[:, 2].min() == pytest.approx(0.0, abs=1e-3)
    assert corners[:, 2].max() == pytest.approx(1.0, abs=1e-3)
    assert np.abs(corners[:, :2] - [2, 4.5]).max() <= 0.5 + 1e-6


def test_keys_stay_when_the_world_changes(world, things):
    before = {shape.key: shape.size for shape in shapes_of(world).shapes}
    world.spawn("crate", things.crate, things.at(5, 5, 1))
    world.editor.delete("capsule")
    after = {shape.key: shape.size for shape in shapes_of(world).shapes}
    assert after == {
        **{key: size for key, size in before.items() if key[0] != "capsule"},
        ("crate", 0): (0.1, 0.1, 0.1),
    }


def test_robots_are_left_out(kept):
    assert {shape.owner for shape in shapes_of(kept("empty")).shapes} == {"world"}


def test_colours_are_those_of_the_world_file(world):
    sphere = next(shape for shape in shapes_of(world).shapes if shape.owner == "sphere")
    assert sphere.rgba == pytest.approx((0.18, 0.38, 0.85, 1.0), abs=1e-6)
