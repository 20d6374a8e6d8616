"""The myCobot picks cylinders that it knows from its camera alone."""

import contextlib
from functools import partial

import numpy as np
import pytest

from arm_controller.pick_plan import CLOSED, WIDE_OPEN, JointPath, PickTask, PlanError, plan_pick
from arm_description import expand_xacro, resolve_uri
from arm_description.transforms import quaternion_from_rpy
from arm_node.rigid_transform import RigidTransform, rpy_from_rows
from arm_planning.collision.body_filter import SeenRobot
from arm_planning.perception.table import SeenThing, find_things
from arm_planning.perception.testing import noisy
from arm_sim import GoalError, JointTrajectory, Simulation

PICKS = 20
NOISE_AT_1M = 0.002
LIFT_M = 0.05
OPTICAL = "camera_head_depth_optical_frame"
POSITIONS = ([0.0] * 6, [0.5, -0.6, -0.5, 0.2, 0.0, 0.5], [1.2, 0.4, -1.2, 0.6, 0.8, -1.0])
XACRO = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"
CYLINDER = """
<mujoco><worldbody><body name="thing">
  <freejoint/>
  <inertial pos="0 0 0" mass="0.05" diaginertia="1e-4 1e-4 1e-5"/>
  <geom type="cylinder" size="{radius} {half}" condim="4" friction="0.8 0.005 0.0001"
        solref="0.004 1" solimp="0.95 0.99 0.001" priority="1"/>
</body></worldbody></mujoco>
"""


def put_somewhere(sim: Simulation, random: np.random.Generator) -> None:
    """Spawn an upright cylinder of random size within reach and in the camera's picture."""
    distance, direction = random.uniform(0.18, 0.28), random.uniform(0.6, 1.0)
    place = (distance * np.cos(direction), distance * np.sin(direction))
    radius, half = random.uniform(0.012, 0.016), random.uniform(0.10, 0.16)
    model = CYLINDER.format(radius=radius, half=half)
    sim.spawn(model, name="thing", pose=(*place, half))
    sim.run(0.2)


def pose_in(sim: Simulation, frame: str, link: str) -> RigidTransform:
    matrix = sim.pose(link, frame)
    turn = quaternion_from_rpy(rpy_from_rows(matrix.tolist()))
    return RigidTransform(tuple(matrix[:3, 3].tolist()), tuple(turn.tolist()))


def seen(
    sim: Simulation, random: np.random.Generator, robot: SeenRobot | None = None
) -> tuple[SeenThing, ...]:
    camera = sim.camera("camera_head")
    depth = camera.depth()
    depth[~np.isfinite(depth)] = np.nan
    points = noisy(depth[..., None] * camera.rays(), random, NOISE_AT_1M)
    apart = robot.pixels(points, partial(pose_in, sim, OPTICAL)) if robot else None
    return find_things(points, pose_in(sim, "base_link", OPTICAL), apart).things


def follow(sim: Simulation, path: JointPath) -> None:
    times_s = [point.time_s for point in path]
    positions = [point.positions for point in path]
    velocities = [point.velocities for point in path]
    sim.follow("arm_controller", JointTrajectory(times_s, positions, velocities=velocities))


def pick(sim: Simulation, urdf: str, thing: SeenThing) -> None:
    """Grip a cylinder below its top and lift it."""
    x, y, _ = thing.pose.position
    plan = plan_pick(urdf, PickTask(x, y, min(thing.size[1] - 0.05, 0.2), LIFT_M))
    sim.grip("gripper_action_controller", WIDE_OPEN)
    follow(sim, plan.to_object)
    follow(sim, plan.approach)
    # The fingers stop at the thing, on their way to where they would be closed.
    with contextlib.suppress(GoalError):
        sim.grip("gripper_action_controller", CLOSED, max_effort=1.0)
    follow(sim, plan.up)
    sim.run(0.5)


def test_the_robot_itself_and_what_is_no_cylinder_are_never_whole_things():
    arguments = {"use_camera": "true"}
    with Simulation("mycobot", arguments=arguments, render_backend="raycast") as sim:
        things = seen(sim, np.random.default_rng(0))
        cylinders = np.array([sim.pose(name)[:2, 3] for name in ("red_cylinder", "coke_can")])
    whole = np.array([thing.pose.position[:2] for thing in things if not thing.partial])
    assert whole == pytest.approx(cylinders, abs=5e-3)


def test_the_robot_is_cut_out_wherever_it_is():
    arguments = {"use_camera": "true"}
    robot = SeenRobot(expand_xacro(resolve_uri(XACRO), arguments))
    random = np.random.default_rng(0)
    with Simulation("mycobot", arguments=arguments, world="empty", render_backend="raycast") as sim:
        for positions in POSITIONS:
            sim.follow("arm_controller", JointTrajectory([2.0], [positions]))
            assert any(thing.pixels > 100 for thing in seen(sim, random))
            assert seen(sim, random, robot) == ()


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_it_lifts_18_of_20_cylinders_that_it_sees():
    urdf = expand_xacro(resolve_uri(XACRO))
    random = np.random.default_rng(0)
    lifted = 0
    arguments = {"use_camera": "true"}
    with Simulation("mycobot", arguments=arguments, world="empty", render_backend="raycast") as sim:
        for _ in range(PICKS):
            sim.reset()
            put_somewhere(sim, random)
            before = sim.pose("thing")[2, 3]
            whole = [thing for thing in seen(sim, random) if not thing.partial]
            with contextlib.suppress(PlanError, GoalError):
                if len(whole) == 1:
                    pick(sim, urdf, whole[0])
            lifted += sim.pose("thing")[2, 3] - before > 0.8 * LIFT_M
            sim.delete("thing")
    assert lifted >= 18
