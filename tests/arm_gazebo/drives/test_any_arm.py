"""Arms without any tuning: a step of all joints, its overshoot and its sag."""

from dataclasses import dataclass, field

import numpy as np
import pytest
import trimesh

from arm_gazebo.launching.default_control import with_hardware

STEP = 0.3
SETTLED_S = 2.0
WATCHED_S = 2.0
MAX_OVERSHOOT = 0.03
MAX_SAG = 0.003

X, Y, Z = "1 0 0", "0 1 0", "0 0 1"
PARALLEL = (Z, Y, Y, Y, Z, Y)
SPHERICAL = (Z, Y, Y, Z, Y, Z)
SEVEN = (Z, Y, Z, Y, Z, Y, Z)


@dataclass(frozen=True)
class Arm:
    """A serial arm of rods: lengths in m, masses in kg, limits as in the URDF."""

    axes: tuple[str, ...]
    lengths: tuple[float, ...]
    masses: tuple[float, ...]
    efforts: tuple[float, ...]
    speeds: tuple[float, ...]
    dynamics: str = ""
    thickness: float = 0.15
    thinnest: float = 0.005
    bodies: tuple[str, ...] = field(default=())
    kinds: tuple[str, ...] = field(default=())

    def urdf(self) -> str:
        """Return the description, without a <ros2_control> block."""
        parts, parent, height = ['<link name="base"/>'], "base", 0.5
        for index, axis in enumerate(self.axes):
            length, mass = self.lengths[index], self.masses[index]
            radius = self.thickness * length + self.thinnest
            across = mass * (3 * radius**2 + length**2) / 12
            body = self.bodies[index] if self.bodies else ""
            kind = self.kinds[index] if self.kinds else "revolute"
            parts.append(
                f'<link name="l{index}"><inertial><origin xyz="0 0 {length / 2}"/>'
                f'<mass value="{mass}"/><inertia ixx="{across}" iyy="{across}" '
                f'izz="{mass * radius**2 / 2}" ixy="0" ixz="0" iyz="0"/></inertial>{body}</link>'
            )
            parts.append(
                f'<joint name="j{index}" type="{kind}"><parent link="{parent}"/>'
                f'<child link="l{index}"/><origin xyz="0 0 {height}"/><axis xyz="{axis}"/>'
                f'<limit lower="-2.9" upper="2.9" effort="{self.efforts[index]}" '
                f'velocity="{self.speeds[index]}"/>{self.dynamics}</joint>'
            )
            parent, height = f"l{index}", length
        return f'<robot name="arm">{"".join(parts)}</robot>'


UR = {"lengths": (0.09, 0.42, 0.39, 0.1, 0.09, 0.08), "masses": (3.7, 8.4, 2.3, 1.2, 1.2, 0.25)}
UR_EFFORTS = (150, 150, 150, 28, 28, 28)
LIGHT_SEVEN = {
    "lengths": (0.33, 0.02, 0.32, 0.08, 0.38, 0.09, 0.11),
    "masses": (5.0, 0.65, 3.2, 3.6, 1.2, 1.7, 0.75),
}
TINY = {
    "lengths": (0.05, 0.08, 0.08, 0.04, 0.04, 0.03),
    "masses": (0.08, 0.08, 0.06, 0.04, 0.03, 0.01),
}
HEAVY = {"lengths": (0.15, 0.6, 0.6, 0.2, 0.15, 0.1), "masses": (8.0, 9.0, 6.0, 4.0, 2.0, 1.0)}

ARMS = {
    "five kilograms payload": Arm(
        PARALLEL, **UR, efforts=(150, 150, 150, 28, 28, 28), speeds=(3.1,) * 6
    ),
    "ten kilograms payload": Arm(
        PARALLEL,
        (0.13, 0.61, 0.57, 0.17, 0.12, 0.1),
        (7.8, 12.9, 3.9, 2.0, 2.0, 0.2),
        (330, 330, 150, 54, 54, 54),
        (2.1, 2.1, 3.1, 3.2, 3.2, 3.2),
    ),
    "seven joints, weak wrist": Arm(
        SEVEN,
        **LIGHT_SEVEN,
        efforts=(87, 87, 87, 87, 12, 12, 12),
        speeds=(2.17, 2.17, 2.17, 2.17, 2.6, 2.6, 2.6),
    ),
    "seven joints, damped": Arm(
        SEVEN,
        **LIGHT_SEVEN,
        efforts=(87, 87, 87, 87, 12, 12, 12),
        speeds=(2.17, 2.17, 2.17, 2.17, 2.6, 2.6, 2.6),
        dynamics='<dynamics damping="10" friction="0.5"/>',
    ),
    "seven joints, heavy": Arm(
        SEVEN,
        (0.18, 0.2, 0.22, 0.2, 0.2, 0.08, 0.05),
        (5.8, 6.4, 3.5, 3.5, 3.5, 1.8, 1.2),
        (320, 320, 176, 176, 110, 40, 40),
        (1.7, 1.7, 1.7, 2.2, 2.4, 3.1, 3.1),
    ),
    "on a rail": Arm(
        (X, *PARALLEL),
        (0.1, *UR["lengths"]),
        (25.0, *UR["masses"]),
        (2000, 150, 150, 150, 28, 28, 28),
        (1.0, *(3.1,) * 6),
        kinds=("prismatic", *("revolute",) * 6),
    ),
    "seven joints, every other one without end": Arm(
        SEVEN,
        (0.28, 0.21, 0.21, 0.21, 0.21, 0.1, 0.06),
        (1.4, 1.2, 1.2, 0.9, 0.7, 0.7, 0.4),
        (39, 39, 39, 39, 9, 9, 9),
        (1.4, 1.4, 1.4, 1.4, 1.2, 1.2, 1.2),
        kinds=("continuous", "revolute") * 3 + ("continuous",),
    ),
    "a quill at the end": Arm(
        (Z, Z, Z, Z),
        (0.1, 0.1, 0.3, 0.03),
        (9.0, 6.5, 1.2, 0.4),
        (120, 70, 250, 8),
        (6.9, 10.5, 1.1, 26.0),
        kinds=("revolute", "revolute", "prismatic", "revolute"),
    ),
    "tiny": Arm(SPHERICAL, **TINY, efforts=(1.5, 1.5, 1.5, 0.5, 0.5, 0.5), speeds=(3,) * 6),
    "tiny, far too strong": Arm(SPHERICAL, **TINY, efforts=(56,) * 6, speeds=(2.8,) * 6),
    "tiny, no limits": Arm(SPHERICAL, **TINY, efforts=(0,) * 6, speeds=(0,) * 6),
    "seven joints, no limits": Arm(SEVEN, **LIGHT_SEVEN, efforts=(0,) * 7, speeds=(0,) * 7),
    "heavy, fast, no efforts": Arm(
        SPHERICAL, **HEAVY, efforts=(0,) * 6, speeds=(4.4, 4.4, 4.4, 5.6, 5.6, 7.3)
    ),
    "heavy, no limits": Arm(PARALLEL, **HEAVY, efforts=(0,) * 6, speeds=(0,) * 6),
    "heavy, absurd limits": Arm(SPHERICAL, **HEAVY, efforts=(1e6,) * 6, speeds=(100,) * 6),
}


def random_arm(seed: int) -> Arm:
    """Return an arm of 0.3 to 30 kg whose drives lift it with something to spare."""
    random = np.random.default_rng(seed)
    axes = SEVEN if seed % 2 else (PARALLEL, SPHERICAL)[seed % 4 // 2]
    count = len(axes)
    mass = 0.3 * 100 ** random.uniform()
    reach = 0.25 * mass**0.4
    masses = np.sort(random.uniform(0.2, 2.0, count))[::-1]
    lengths = random.uniform(0.3, 1.5, count)
    masses, lengths = mass * masses / masses.sum(), reach * lengths / lengths.sum()
    beyond = np.array([masses[i:] @ np.cumsum(lengths[i:]) for i in range(count)])
    efforts = np.maximum(9.81 * beyond * random.uniform(1.5, 4.0), 0.02 * mass)
    return Arm(
        axes,
        tuple(lengths.round(4)),
        tuple(masses.round(4)),
        tuple(efforts.round(3)),
        tuple(random.uniform(2.0, 3.2, count).round(2)),
        thickness=random.uniform(0.05, 0.3),
    )


def check_step(bench, urdf: str, starts: tuple[float, ...] = (0.0,), **options: object) -> None:
    """Step all joints from poses, and compare what they do with the targets."""
    robot = bench(urdf, **options)
    robot.claim("position")
    joints = len(robot.names("position"))
    for start in starts:
        pose = start * np.cos(np.arange(joints) * 2.1)
        robot.command(*pose)
        robot.run(SETTLED_S)
        way = np.where(pose > 0, -STEP, STEP)
        robot.command(*(pose + way))
        done = (robot.run(WATCHED_S) - pose) / way
        assert done.max() < 1 + MAX_OVERSHOOT
        assert np.abs((done[-1] - 1) * way).max() < MAX_SAG
    assert robot.simulation.take_failures() == []


def complete(urdf: str) -> str:
    from arm_description.urdf.parser import parse_urdf

    return with_hardware(urdf, parse_urdf(urdf))


@pytest.mark.parametrize("name", ARMS)
def test_industrial_arms_settle(bench, name):
    check_step(bench, complete(ARMS[name].urdf()), (0.0, 1.2))


@pytest.mark.parametrize("seed", range(16))
def test_random_arms_settle(bench, seed):
    check_step(bench, complete(random_arm(seed).urdf()), (0.8,))


@pytest.mark.parametrize("rate_hz", [30, 225, 500])
def test_they_settle_at_other_control_rates(bench, rate_hz):
    urdf = complete(ARMS["seven joints, weak wrist"].urdf())
    check_step(bench, urdf, (0.5,), rate_hz=rate_hz)


@pytest.mark.parametrize("rate_hz", [30, 100, 1000])
@pytest.mark.parametrize("efforts", [UR_EFFORTS, (0,) * 6])
def test_arms_of_wires_settle(bench, rate_hz, efforts):
    arm = Arm(SPHERICAL, **UR, efforts=efforts, speeds=(3.1,) * 6, thickness=0, thinnest=1e-4)
    check_step(bench, complete(arm.urdf()), (0.0, 1.2), rate_hz=rate_hz)


def test_an_arm_of_meshes_alone_settles(bench, tmp_path):
    """Its hulls overlap at the joints, as those of published arms do."""
    trimesh.creation.icosphere(4, 0.12).export(tmp_path / "ball.stl")
    shape = f'<geometry><mesh filename="{tmp_path}/ball.stl"/></geometry>'
    body = f"<visual>{shape}</visual><collision>{shape}</collision>"
    arm = Arm(
        PARALLEL, **UR, efforts=(150, 150, 150, 28, 28, 28), speeds=(3.1,) * 6, bodies=(body,) * 6
    )
    check_step(bench, complete(arm.urdf()), (0.4,))
    check_step(bench, complete(arm.urdf()), (0.0,), self_collide=True)


def test_an_arm_without_any_mass_settles(bench, parts):
    """Every link is given a mass by its size, or next to none."""
    box = '<collision><geometry><box size="0.08 0.08 0.2"/></geometry></collision>'
    links = "".join(f'<link name="l{index}">{box}</link>' for index in range(6))
    joints = "".join(
        parts.joint(f"j{i}", f"l{i - 1}" if i else "base", f"l{i}", xyz="0 0 0.2", axis=axis)
        for i, axis in enumerate(SPHERICAL)
    )
    check_step(bench, complete(parts.robot(parts.link("base"), links, joints)), (0.5,))
