"""Heavy joints move as fast as their effort allows, and all stops stay possible."""

from typing import Any

import mujoco
import numpy as np
import pytest

from arm_gazebo.drives.braking_law import FLOOR, BrakingLaw, budget, budgets, slow_joints
from arm_gazebo.drives.servo_tuning import tune

X, Y, Z = "1 0 0", "0 1 0", "0 0 1"
STEP = 0.3
RATE_HZ = 100


class Tree:
    """A robot of rods; each joint lifts what is beyond it with something to spare."""

    def __init__(self, strength: float, speed: float) -> None:
        self._strength, self._speed = strength, speed
        self._rods: list[tuple[int, str, float, float, tuple[float, float, float]]] = []

    def add(
        self, parent: int, axis: str, mass: float, length: float, xyz: tuple[float, float, float]
    ) -> int:
        """Add a rod along z; return its index."""
        self._rods.append((parent, axis, mass, length, xyz))
        return len(self._rods) - 1

    def chain(
        self, parent: int, masses: Any, lengths: Any, xyz: tuple[float, float, float]
    ) -> "Tree":
        """Add rods one after the other."""
        for index, (mass, length) in enumerate(zip(masses, lengths, strict=True)):
            parent = self.add(parent, (Y, X, Z, Y, Z, Y, X)[index % 7], mass, length, xyz)
            xyz = (0.0, 0.0, float(length))
        return self

    def urdf(self, parts: Any) -> str:
        """Return the description."""
        count = len(self._rods)
        mass, first, second = (np.zeros(count) for _ in range(3))
        for each in reversed(range(count)):
            parent, _, own, length, xyz = self._rods[each]
            mass[each] += own
            first[each] += own * length / 2
            second[each] += own * length**2 / 3
            if parent >= 0:
                away = float(np.linalg.norm(xyz))
                mass[parent] += mass[each]
                first[parent] += first[each] + mass[each] * away
                second[parent] += second[each] + 2 * first[each] * away + mass[each] * away**2
        text = [parts.link("base")]
        for each, (parent, axis, own, length, xyz) in enumerate(self._rods):
            radius = 0.12 * length + 0.004
            across = own * (3 * radius**2 + length**2) / 12
            effort = self._strength * max(9.81 * first[each], 4 * second[each])
            text += [
                f'<link name="l{each}"><inertial><origin xyz="0 0 {length / 2}"/>'
                f'<mass value="{own}"/><inertia ixx="{across}" iyy="{across}" '
                f'izz="{own * radius**2 / 2}" ixy="0" ixz="0" iyz="0"/></inertial></link>',
                parts.joint(
                    f"j{each}",
                    "base" if parent < 0 else f"l{parent}",
                    f"l{each}",
                    xyz=" ".join(map(str, xyz)),
                    axis=axis,
                    limit=f'lower="-2.9" upper="2.9" effort="{effort}" velocity="{self._speed}"',
                ),
            ]
        return parts.robot(*text, parts.ros2_control([f"j{each}" for each in range(count)]))


def trunk(joints: int, trunk_kg: float, arm_kg: float, speed: float = 30.0) -> Tree:
    """Return a trunk that turns, with two arms."""
    tree = Tree(3.0, speed)
    tree.add(-1, Z, trunk_kg, 0.5, (0.0, 0.0, 0.8))
    for side in (0.2, -0.2):
        masses = np.geomspace(1.0, 0.1, joints)
        lengths = np.full(joints, 0.6 / joints)
        tree.chain(0, arm_kg * masses / masses.sum(), lengths, (0.0, side, 0.5))
    return tree


def serial(joints: int, ratio: float, mass_kg: float, speed: float) -> Tree:
    """Return an arm whose inner half is heavier than its outer half."""
    masses = np.where(np.arange(joints) < joints // 2, ratio, 1.0)
    lengths = np.resize((0.12, 0.3, 0.2), joints)
    tree = Tree(3.0, speed)
    return tree.chain(-1, mass_kg * masses / masses.sum(), lengths, (0.0, 0.0, 0.5))


ROBOTS = {
    "trunk, arms of 3": trunk(3, 20.0, 3.0),
    "trunk, arms of 7": trunk(7, 20.0, 4.0),
    "heavy trunk, light arms": trunk(2, 100.0, 0.5, 5.0),
    "3 joints, 2:1": serial(3, 2.0, 2.0, 3.0),
    "4 joints, 20:1": serial(4, 20.0, 8.0, 6.0),
    "6 joints, 200:1": serial(6, 200.0, 20.0, 6.0),
    "7 joints, 50:1": serial(7, 50.0, 60.0, 30.0),
    "40 joints, 5:1": serial(40, 5.0, 20.0, 6.0),
}


def bang_bang(acceleration: float, speed: float) -> float:
    """Return the shortest time for a step from rest to rest."""
    if acceleration * STEP < speed**2:
        return 2 * np.sqrt(STEP / acceleration)
    return STEP / speed + speed / acceleration


@pytest.mark.parametrize("name", ROBOTS)
def test_a_joint_alone_takes_at_most_twice_the_shortest_time(bench, parts, name):
    run = bench(ROBOTS[name].urdf(parts), RATE_HZ)
    run.claim()
    simulation = run.simulation
    joints, model = simulation.servo.joints, simulation.model
    pose = np.cos(np.arange(len(joints)) * 2.1)
    full = np.zeros((model.nv, model.nv))
    for each in range(0, len(joints), max(1, len(joints) // 6)):
        simulation.reset()
        simulation.data.qpos[[joint.qpos_address for joint in joints]] = pose
        mujoco.mj_forward(model, simulation.data)
        simulation.servo.reset()
        run.command(*pose)
        run.run(0.3)
        joint = joints[each]
        mujoco.mj_fullM(model, simulation.data, full)
        left = 0.8 * joint.effort - abs(simulation.data.qfrc_bias[joint.dof_address])
        shortest = bang_bang(left / full[joint.dof_address, joint.dof_address], joint.velocity)
        target, way = pose.copy(), STEP if pose[each] < 0 else -STEP
        target[each] += way
        run.command(*target)
        done = (run.run(2 * shortest + 0.2)[:, each] - pose[each]) / way
        assert done.max() < 1.005
        late = np.flatnonzero(np.abs(done - 1) > 0.01)[-1]
        # A motion takes whole control periods, and is seen at the end of one.
        assert (late + 1) / RATE_HZ < 2 * shortest, joint.name


@pytest.fixture
def law(parts):
    """Return model, tuning and law of a trunk with arms, and inertias and gravity in poses."""
    built = parts.build(ROBOTS["trunk, arms of 3"].urdf(parts))
    joints = [joint for joint in built.joints.values() if joint.actuator is not None]
    tuning = tune(built.model, joints, built.qpos, 0.01)
    built.model.dof_armature[:] = tuning.armature
    data, random = mujoco.MjData(built.model), np.random.default_rng(3)
    inertias, gravities = [], []
    for _ in range(50):
        data.qpos[:] = random.uniform(-2.9, 2.9, built.model.nq)
        mujoco.mj_forward(built.model, data)
        inertias.append(data.M.copy())
        gravities.append(data.qfrc_bias.copy())
    dofs = np.array([joint.dof_address for joint in joints], dtype=np.intp)
    return tuning, BrakingLaw(built.model, tuning, dofs), np.array(inertias), np.array(gravities)


def needs_of(random: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    """Return needs of joints at rest, that start, and that move."""
    kinds = random.integers(0, 3, shape)
    return np.where(kinds == 0, -1.0, np.where(kinds == 1, 0.0, random.uniform(0.0, 2.0, shape)))


def test_all_stops_together_leave_a_quarter_of_the_effort(law):
    tuning, rule, inertias, gravities = law
    count = len(tuning.braking)
    floors, needs = FLOOR * tuning.braking, np.zeros((len(inertias), count))
    limits = budgets(tuning.efforts, gravities)
    parts = rule.parts_of_many(inertias, 1.0 / limits, floors, needs)
    felt = rule.felt(inertias)
    own = limits / np.diagonal(felt, axis1=1, axis2=2)
    loads = (felt * (parts * own)[:, None, :]).sum(axis=2)
    assert (loads <= 1.5 * limits * (1 + 1e-9)).all()
    assert (parts * own >= floors * (1 - 1e-9)).all()
    assert (parts * own > 1.5 * tuning.braking).mean() > 0.3


def test_a_joint_that_starts_takes_nothing_from_one_that_moves(law):
    tuning, rule, inertias, gravities = law
    count = len(tuning.braking)
    floors, needs = FLOOR * tuning.braking, np.full((len(inertias), count), -1.0)
    room = 1.0 / budgets(tuning.efforts, gravities)
    own = 1.0 / (room * np.diagonal(rule.felt(inertias), axis1=1, axis2=2))
    needs[:, 0] = 0.0
    alone = (rule.parts_of_many(inertias, room, floors, needs) * own)[:, 0]
    needs[:, 0], needs[:, 1:] = alone, 0.0
    together = (rule.parts_of_many(inertias, room, floors, needs) * own)[:, 0]
    # Their own floors aside, they take what is left.
    assert (together >= alone * (1 - 1e-9)).all()


def test_many_states_have_the_bits_of_one(law):
    tuning, rule, inertias, gravities = law
    needs = needs_of(np.random.default_rng(4), gravities.shape)
    efforts, floors = tuning.efforts.tolist(), (FLOOR * tuning.braking).tolist()
    room = 1.0 / budgets(tuning.efforts, gravities)
    many = rule.parts_of_many(inertias, room, np.array(floors), needs)
    for row, inertia in enumerate(inertias):
        one = [1.0 / budget(*each) for each in zip(efforts, gravities[row].tolist(), strict=True)]
        assert one == room[row].tolist()
        assert rule.parts(inertia, one, floors, needs[row].tolist()) == many[row].tolist()


def test_a_state_of_an_older_version_is_read(bench, parts):
    run = bench(parts.arm())
    run.claim()
    run.command(0.5, 0, 0, 0)
    run.run(0.1)
    servo = run.simulation.servo
    state = servo.save_state()
    state.pop("way_to_renew")
    state["joints"] = [saved[:14] for saved in state["joints"]]
    servo.load_state(state)
    assert run.run(2.0)[-1] == pytest.approx([0.5, 0, 0, 0], abs=1e-3)


def test_a_joint_that_others_slow_is_named_with_the_one_that_does(parts):
    urdf = parts.robot(
        parts.link("base"),
        parts.link("trunk", 20.0, 0.4),
        parts.link("rod", 2.0, 0.1, "0 0 0.5"),
        parts.joint(
            "waist", "base", "trunk", axis=Z, limit='effort="200" velocity="9"', kind=WHEEL
        ),
        parts.joint("wrist", "trunk", "rod", axis=Z, xyz="0 0 1", limit=WEAK, kind=WHEEL),
        parts.ros2_control(["waist", "wrist"]),
    ).replace('xyz="0 0 0.5"/><mass value="2.0"', 'xyz="0.5 0 0"/><mass value="2.0"')
    built = parts.build(urdf)
    joints = [joint for joint in built.joints.values() if joint.actuator is not None]
    [(name, problem)] = slow_joints(
        built.model, joints, tune(built.model, joints, built.qpos, 0.01), built.qpos
    )
    assert name == "waist"
    assert "'wrist' with its effort limit of 1 could not hold" in problem


WHEEL, WEAK = "continuous", 'effort="1" velocity="9"'
