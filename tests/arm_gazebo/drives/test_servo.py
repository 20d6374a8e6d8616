"""The servos' response to commands, in simulation time and so equal on every machine."""

import math

import numpy as np
import pytest

STEP = 0.3
ARMS = [
    (6, 0.3, 0.28),
    (6, 1.0, 0.3),
    (6, 5.0, 0.6),
    (6, 18.0, 0.9),
    (7, 18.0, 0.85),
    (7, 30.0, 1.2),
]
DIRECTIONS = [(1, 1, 1, 1, 1, 1, 1), (1, -1, 1, -1, 1, -1, 1)]
LIGHT = 'lower="-1" upper="1" effort="10" velocity="1"'
POSE = (0.0, 0.6, 0.8, 0.3, 0.5, 0.2, 0.1)


def overshoot(positions, start, target):
    """Return by how much a joint went past its target at most, as a share of the way."""
    way = target - start
    return ((positions - target) * np.sign(way) / np.abs(way)).max()


def step_all_joints(bench, signs, seconds=3.0):
    dof = len(bench.state("position"))
    start = np.array(POSE[:dof])
    bench.claim("position")
    bench.command(*start)
    bench.run(3.0)
    target = start + STEP * np.array(signs[:dof])
    bench.command(*target)
    return bench.run(seconds), start, target


@pytest.mark.parametrize("rate_hz", [30, 100, 500])
@pytest.mark.parametrize(("dof", "mass_kg", "reach_m"), ARMS)
@pytest.mark.parametrize("signs", DIRECTIONS)
def test_arm_of_any_size_steps_without_overshoot_or_sag(
    bench, parts, dof, mass_kg, reach_m, signs, rate_hz
):
    run = step_all_joints(bench(parts.serial_arm(dof, mass_kg, reach_m), rate_hz), signs)
    positions, start, target = run
    assert overshoot(positions, start, target) < 0.03
    assert np.abs(positions[-1] - target).max() < 3e-3


@pytest.mark.parametrize(("dof", "mass_kg", "reach_m"), ARMS)
def test_dry_friction_does_not_spoil_the_step(bench, parts, dof, mass_kg, reach_m):
    urdf = parts.serial_arm(dof, mass_kg, reach_m, friction=0.05)
    positions, start, target = step_all_joints(bench(urdf), DIRECTIONS[0])
    assert overshoot(positions, start, target) < 0.03
    assert np.abs(positions[-1] - target).max() < 3e-3


@pytest.mark.parametrize(("rate_hz", "ticks"), [(30, 1), (100, 1), (225, 1), (500, 1), (1000, 2)])
def test_first_motion_shows_at_once(bench, parts, rate_hz, ticks):
    arm = bench(parts.arm(), rate_hz)
    arm.claim()
    arm.run(0.1)
    arm.command(0.3, 0, 0, 0)
    for _ in range(ticks):
        arm.tick()
    assert arm.state("position")[0] > 1e-3


def quintic(times_s, waypoints, duration_s):
    """Return a path through points at equal times, smooth to the second derivative."""
    count = len(waypoints) - 1
    span = duration_s / count
    slopes = np.zeros_like(waypoints)
    slopes[1:-1] = (waypoints[2:] - waypoints[:-2]) / (2 * span)
    index = np.minimum((times_s / span).astype(int), count - 1)
    u = np.clip((times_s - index * span) / span, 0, 1)[:, None]
    p, q, v, w = (
        waypoints[index],
        waypoints[index + 1],
        slopes[index] * span,
        slopes[index + 1] * span,
    )
    d = q - p
    return (
        p
        + v * u
        + (10 * d - 6 * v - 4 * w) * u**3
        + (-15 * d + 8 * v + 7 * w) * u**4
        + (6 * d - 3 * v - 3 * w) * u**5
    )


WAYPOINTS = 0.65 * np.array(
    [
        [0, 0, 0, 0],
        [0.6, 0.4, -0.5, 0.5],
        [1.2, -0.3, 0.4, -0.6],
        [0.3, 0.5, 0.6, 0.4],
        [-0.5, 0.2, -0.3, 0.8],
    ]
)


def follow(bench, period_s, every=1):
    """Stream a 5 s path, one command in `every` ticks; return commands, positions and times."""
    times = np.arange(0, 5.0, period_s)
    path = quintic(times, WAYPOINTS, 5.0)
    bench.claim()
    rows = []
    for index, command in enumerate(path):
        if index % every == 0:
            bench.command(*command)
        bench.tick()
        rows.append(bench.state("position"))
    return path, np.array(rows), times


def rms(errors):
    return float(np.sqrt(np.mean(errors**2)))


def test_path_streamed_at_100_hz_is_followed_with_its_lag(bench, parts):
    arm = bench(parts.arm(), 100)
    _, positions, times = follow(arm, 0.01)
    now = quintic(times + 0.01, WAYPOINTS, 5.0)
    assert rms(positions - now) < 5e-3


@pytest.mark.parametrize("rate_hz", [30, 100, 500])
def test_sample_of_a_path_is_reached_within_its_period(bench, parts, rate_hz):
    path, positions, _ = follow(bench(parts.arm(), rate_hz), 1 / rate_hz)
    assert rms(positions - path) < 1e-3


def test_slower_stream_is_not_followed_in_jerks(bench, parts):
    arm = bench(parts.arm(), 500)
    arm.claim()
    speeds = []
    for tick in range(1000):
        if tick % 10 == 0:
            arm.command(0.5 * tick / 500, 0, 0, 0)
        arm.tick()
        speeds.append(arm.state("velocity")[0])
    assert np.ptp(speeds[500:]) < 0.05


def test_speed_limit_is_felt(bench, parts):
    arm = bench(parts.arm(velocity_limit="0.1"))
    arm.claim()
    arm.command(1.0, 0, 0, 0)
    speeds = []
    while arm.state("position")[0] < 0.999:
        arm.tick()
        speeds.append(arm.state("velocity")[0])
    assert arm.simulation.time_s == pytest.approx(10.0, abs=0.1)
    assert max(speeds) < 0.101


WALL = """<mujoco><worldbody><geom type="plane" size="0 0 1"/>
<geom name="wall" type="box" size="0.3 0.02 0.5" pos="0 -0.2 0.3"/></worldbody></mujoco>"""


@pytest.fixture
def at_wall(bench, parts, tmp_path):
    world = tmp_path / "wall.xml"
    world.write_text(WALL)
    arm = bench(parts.arm(), world=world)
    arm.claim()
    arm.command(0, 1.5, 0, 0)
    arm.run(3.0)
    return arm


def test_pushing_takes_the_effort_limit_and_no_more(at_wall):
    efforts = []
    for _ in range(100):
        at_wall.tick()
        efforts.append(at_wall.state("effort"))
    assert np.abs(efforts).max() == pytest.approx(5.0, abs=1e-9)


def test_pushing_is_quiet(at_wall):
    assert np.ptp(at_wall.run(1.0), axis=0).max() < 1e-5


def test_arm_freed_from_a_wall_is_not_flung(at_wall):
    model = at_wall.simulation.model
    wall = model.geom("wall").id
    model.geom_contype[wall] = model.geom_conaffinity[wall] = 0
    positions = at_wall.run(2.0)
    assert positions[:, 1].max() < 1.5 + 0.01
    assert positions[-1] == pytest.approx([0, 1.5, 0, 0], abs=1e-3)


@pytest.mark.parametrize("rate_hz", [100, 500])
def test_drive_at_its_effort_limit_does_not_chatter(bench, parts, rate_hz):
    arm = bench(parts.arm(), rate_hz)
    arm.run(0.1)
    arm.simulation.data.qvel[:] = (8, 3, -6, 10)
    arm.run(0.3)
    assert np.abs(arm.run(0.2)).max() < 1e-4


@pytest.mark.parametrize(
    ("rate_hz", "inertia", "effort", "seconds"),
    [(10, 30.0, 30.0, 3.0), (10, 1.0, 10.0, 1.3), (10, 3.0, 10.0, 1.7), (100, 1.0, 10.0, 1.3)],
)
def test_slow_control_moves_a_heavy_joint_as_fast_as_its_effort(
    bench, parts, rate_hz, inertia, effort, seconds
):
    moments = " ".join(f'{name}="{inertia}"' for name in ("ixx", "iyy", "izz"))
    urdf = parts.robot(
        parts.link("base"),
        f'<link name="wheel"><inertial><mass value="10"/><inertia {moments}/></inertial></link>',
        parts.joint(
            "j",
            "base",
            "wheel",
            "continuous",
            axis="0 0 1",
            limit=f'effort="{effort}" velocity="1"',
        ),
        parts.ros2_control(["j"]),
    )
    wheel = bench(urdf, rate_hz)
    wheel.claim()
    wheel.command(1.0)
    positions = wheel.run(2 * seconds)
    assert positions[round(seconds * rate_hz)] == pytest.approx([1.0], abs=1e-3)
    assert overshoot(positions, 0.0, 1.0) < 1e-3


@pytest.mark.parametrize("rate_hz", [10, 100, 500])
@pytest.mark.parametrize("stroke", ["3", "1000"], ids=["long", "placeholder"])
def test_joint_above_a_slide_is_not_slowed_by_how_far_that_may_go(bench, parts, stroke, rate_hz):
    urdf = parts.robot(
        parts.link("base"),
        parts.link("boom", 1.0, centre="0.1 0 0"),
        parts.link("trolley", 1.0),
        parts.joint("yaw", "base", "boom", axis="0 0 1", limit=LIGHT),
        parts.joint(
            "slide",
            "boom",
            "trolley",
            "prismatic",
            axis="1 0 0",
            limit=f'lower="-{stroke}" upper="{stroke}" effort="100" velocity="1"',
        ),
        parts.ros2_control(["yaw", "slide"]),
    )
    boom = bench(urdf, rate_hz)
    boom.claim()
    boom.command(0.5, 0.0)
    positions = boom.run(2.0)[:, 0]
    assert positions[-1] == pytest.approx(0.5, abs=1e-3)
    assert overshoot(positions, 0.0, 0.5) < 1e-3


def test_unknown_payload_is_carried(bench, parts):
    arm = bench(parts.arm())
    arm.claim()
    arm.command(0, 0.5, 0.5, 0.5)
    arm.simulation.data.xfrc_applied[arm.built.bodies["wrist"], 2] = -9.81 * 0.2
    positions = arm.run(3.0)
    target = np.array([0, 0.5, 0.5, 0.5])
    assert np.abs(positions[-1] - target).max() < 5e-3
    assert overshoot(positions[:, 1:], np.zeros(3), target[1:]) < 0.03


def test_resting_joint_that_is_pushed_comes_back(bench, parts):
    arm = bench(parts.arm())
    arm.run(1.0)
    arm.simulation.data.qpos[1] = 0.05
    assert np.abs(arm.run(1.0)[-1]).max() < 1e-4


def test_gripper_follows_its_leader(bench, parts):
    finger = 'lower="0" upper="0.04" effort="20" velocity="0.2"'
    urdf = parts.robot(
        parts.link("base"),
        parts.link("left", 0.05, 0.02),
        parts.link("right", 0.05, 0.02),
        parts.joint("j", "base", "left", "prismatic", "0 0 1", "0 1 0", finger),
        parts.joint(
            "follower",
            "base",
            "right",
            "prismatic",
            "0 0 1",
            "0 -1 0",
            finger,
            '<mimic joint="j" multiplier="0.5" offset="0.01"/>',
        ),
        parts.ros2_control(["j"]),
    )
    gripper = bench(urdf)
    gripper.claim()
    gripper.command(0.03)
    gripper.run(1.0)
    joint = gripper.built.joints["follower"]
    assert gripper.state("position")[0] == pytest.approx(0.03, abs=1e-4)
    assert gripper.simulation.data.qpos[joint.qpos_address] == pytest.approx(0.025, abs=1e-4)


def test_joint_without_an_effort_limit_is_driven(bench, parts):
    urdf = parts.robot(
        parts.link("base"),
        parts.link("bob", 1.0, 0.05, "0.5 0 0"),
        parts.joint("j", "base", "bob", "continuous", "0 0 2", limit=""),
        parts.ros2_control(["j"]),
    )
    pendulum = bench(urdf)
    pendulum.claim()
    pendulum.command(7.0)
    assert pendulum.run(3.0)[-1] == pytest.approx([7.0], abs=1e-3)


def test_joint_too_weak_for_its_load_sinks_and_stays_finite(bench, parts, caplog):
    weak = bench(parts.pendulum(limit='lower="-3" upper="3" effort="2" velocity="3"'))
    weak.run(2.0)
    assert weak.state("position")[0] > 0.5
    assert math.isfinite(weak.state("velocity")[0])
    assert "joint 'j': its effort limit of 2 is below the 4.905" in caplog.text


def test_an_undriven_arm_falls_as_its_links_do_however_strong_its_drives(bench, parts):
    falls = []
    for effort in ("5", "300"):
        arm = bench(parts.arm(effort_limit=effort, j1_pos="0.5"), hold_joints=False)
        falls.append(arm.run(0.4)[-1])
    assert falls[0] == pytest.approx(falls[1], abs=1e-9)
    assert falls[0][1] > 1.0


def rubbing(parts, friction):
    """Return the URDF of a light link, 0.2 kg at 0.1 m, on a strong joint with friction."""
    return parts.robot(
        parts.link("base"),
        parts.link("bob", 0.2, 0.05, "0.1 0 0"),
        parts.joint(
            "j",
            "base",
            "bob",
            xyz="0 0 2",
            limit='lower="-3" upper="3" effort="50" velocity="3"',
            more=f'<dynamics friction="{friction}"/>',
        ),
        parts.ros2_control(["j"]),
    )


def test_a_drive_hardly_moves_a_joint_whose_friction_is_above_its_effort(bench, parts, caplog):
    run = bench(rubbing(parts, 60))
    assert "its effort limit of 50 is not above its friction of 60" in caplog.text
    run.claim()
    run.command(-1.0)
    assert abs(run.run(1.0)[-1, 0]) < 0.1


def test_friction_that_takes_most_of_the_effort_costs_no_accuracy(bench, parts):
    run = bench(parts.pendulum('<dynamics friction="12"/>'))
    run.claim()
    run.command(-1.0)
    assert run.run(2.0)[-1, 0] == pytest.approx(-1.0, abs=3e-4)
