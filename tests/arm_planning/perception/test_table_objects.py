"""What is seen on a table as objects, and which of them is the target."""

import numpy as np
import pytest

from arm_description.urdf.robot import Box, Cylinder
from arm_planning.errors import PerceptionError
from arm_planning.perception.table_objects import Crop, TableTarget, objects_in_view
from arm_planning.perception.testing import TableThing, look, noisy, tutorial_camera

CAMERA = tutorial_camera()
BOX = TableThing("box", (0.6, -0.1), 0.4, (0.05, 0.07, 0.06))
LOW = TableThing("cylinder", (0.55, 0.1), 0.0, (0.03, 0.08))
HIGH = TableThing("cylinder", (0.7, 0.0), 0.0, (0.02, 0.16))
EVERYWHERE = Crop()


def seen(*things, crop=EVERYWHERE):
    points = noisy(look(CAMERA, things).points, np.random.default_rng(0), 0.001)
    return objects_in_view(points, CAMERA.pose, crop, "table", 0.01)


def test_things_are_objects_and_stand_on_the_surface():
    found = seen(BOX, LOW, HIGH)
    by_name = {each.id: each for each in found.objects}
    assert set(by_name) == {"table", "box_0", "cylinder_0", "cylinder_1"}
    (placed,) = by_name["box_0"].shapes
    assert isinstance(placed.shape, Box)
    assert sorted(placed.shape.size) == pytest.approx(sorted(BOX.size), rel=0.1)
    high = by_name[found.target(TableTarget("cylinder", (0.16, 0.02)))]
    (placed,) = high.shapes
    assert isinstance(placed.shape, Cylinder)
    assert (placed.shape.radius, placed.shape.length) == pytest.approx((0.02, 0.16), rel=0.1)
    assert high.pose.position == pytest.approx((0.7, 0.0, 0.08), abs=5e-3)
    (placed,) = found.support.shapes
    x, y, thickness = placed.shape.size
    assert x > 0.5
    assert y > 0.5
    assert found.support.pose.position[2] + thickness / 2 == pytest.approx(0.0, abs=2e-3)


def test_the_most_similar_thing_is_the_target_whichever_way_a_box_is_turned():
    found = seen(BOX, LOW, HIGH)
    low, high = (found.target(TableTarget("cylinder", size)) for size in ((0.1, 0.04), (0.2, 0.02)))
    assert {low, high} == {"cylinder_0", "cylinder_1"}
    assert found.target(TableTarget("box", (0.05, 0.07, 0.06))) == "box_0"
    assert found.target(TableTarget("box", (0.07, 0.05, 0.06))) == "box_0"


def test_without_such_a_thing_the_others_are_named():
    with pytest.raises(PerceptionError, match=r"no box of about .* is seen .* cylinder_0 of 0\.08"):
        seen(LOW).target(TableTarget("box", (0.05, 0.05, 0.05)))
    with pytest.raises(PerceptionError, match=r"no cylinder of about 0\.500 x 0\.020 m"):
        seen(LOW).target(TableTarget("cylinder", (0.5, 0.02)))
    with pytest.raises(PerceptionError, match="there is nothing"):
        seen().target(TableTarget("cylinder", (0.5, 0.02)))


def test_what_is_hidden_in_part_is_an_object_but_not_the_target():
    behind = TableThing("box", (0.75, 0.0), 0.0, (0.08, 0.08, 0.06))
    found = seen(TableThing("box", (0.6, 0.05), 0.0, (0.05, 0.06, 0.12)), behind)
    assert len(found.things) == 2
    with pytest.raises(PerceptionError, match=r"seen in part"):
        found.target(TableTarget("box", behind.size))


def test_what_is_outside_of_the_crop_is_not_seen():
    found = seen(BOX, LOW, crop=Crop((0.0, 0.0, -1.0), (1.0, 1.0, 1.0)))
    assert [each.id for each, _ in found.things] == ["cylinder_0"]
    with pytest.raises(PerceptionError, match="sees no points"):
        seen(BOX, crop=Crop((0.0, 0.0, 5.0), (1.0, 1.0, 6.0)))


@pytest.mark.parametrize(
    ("shape", "dimensions", "says"),
    [
        ("", (0.1, 0.1), "target_shape or target_dimensions is empty"),
        ("box", (), "target_shape or target_dimensions is empty"),
        ("sphere", (0.1,), "there are box and cylinder"),
        ("cylinder", (0.1, 0.1, 0.1), r"\[height, radius\]"),
        ("box", (0.1, 0.1, -0.1), "all above 0"),
        ("cylinder", (float("nan"), 0.1), "all above 0"),
        ("cylinder", (float("inf"), 0.1), "all above 0"),
    ],
)
def test_a_target_that_cannot_be_is_told_why(shape, dimensions, says):
    with pytest.raises(PerceptionError, match=says):
        TableTarget(shape, dimensions)
