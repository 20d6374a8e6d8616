import mujoco
import numpy as np
import pytest
from planning_models import model_of, neighbours
from robots import joint, link, robot

from arm_planning.collision.model import CollisionModel
from arm_planning.collision.reach import reach
from arm_planning.scene.scene import PlanningScene

ROD = (
    "<collision><origin xyz='{offset} 0.02 0.1'/><geometry>"
    "<box size='0.04 0.04 0.2'/></geometry></collision>"
)
AXES = ("0 0 1", "0 1 0", "0.6 0 0.8", "0 1 0", "1 0 0")
JOINTS = tuple(f"j{number}" for number in range(len(AXES)))


def arm(slider: int | None, offset: float) -> CollisionModel:
    """An arm of five links, of which one may slide, with each axis beside the one before it."""
    links, joints = [link("base")], []
    for number, axis in enumerate(AXES):
        links.append(link(f"l{number}", ROD.format(offset=offset)))
        kind, span = ("prismatic", (-0.1, 0.3)) if number == slider else ("revolute", (-3.0, 3.0))
        names = (JOINTS[number], links_before(number), f"l{number}")
        place = f"{offset} {-offset} 0.2"
        joints.append(joint(*names, kind=kind, axis=axis, limits=span, xyz=place))
    model = model_of(robot(*links, *joints), arm=(JOINTS, f"l{len(AXES) - 1}"))
    scene = PlanningScene(dict.fromkeys(JOINTS, 0.0), allowed=neighbours(model))
    return CollisionModel(model, scene, "arm")


def links_before(number: int) -> str:
    return f"l{number - 1}" if number else "base"


def farthest(checker: CollisionModel, count: int) -> np.ndarray:
    """Return the largest distances of geoms' balls from each axis that were seen, (geoms, n)."""
    model, data, rng = checker.posed.model, checker.posed.data, np.random.default_rng(0)
    lower, upper = np.array([checker.limits(name) for name in checker.joints]).T
    seen = np.zeros((model.ngeom, model.nq))
    for q in rng.uniform(lower, upper, (count, len(lower))):
        checker.posed.place(q)
        arms = data.geom_xpos[:, None] - data.xanchor
        across = np.linalg.norm(np.cross(arms, data.xaxis), axis=2)
        np.maximum(seen, across + model.geom_rbound[:, None], out=seen)
    return seen


def bounds_and_seen(slider: int | None, offset: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the bounds of turning joints that move a geom, and what was seen, as two rows."""
    checker = arm(slider, offset)
    model = checker.posed.model
    limits = np.array([checker.limits(name) for name in checker.joints]).T
    bounds = reach(model, checker.posed.data, *limits)
    found = bounds.pairs[0, bounds.part]
    turns = (found > 0.0) & (model.jnt_type != int(mujoco.mjtJoint.mjJNT_SLIDE))
    return found[turns], farthest(checker, 2000)[turns]


@pytest.mark.parametrize("offset", [0.0, 0.03, 0.15])
@pytest.mark.parametrize("slider", [None, 0, 1, 2, 4])
def test_nothing_is_farther_from_an_axis_than_its_bound(slider, offset):
    bounds, seen = bounds_and_seen(slider, offset)
    assert len(bounds) > 5
    assert (seen <= bounds + 1e-9).all()


def test_bounds_are_short_where_axes_are_beside_each_other():
    bounds, seen = bounds_and_seen(None, 0.15)
    assert (bounds < 1.08 * seen).all()
