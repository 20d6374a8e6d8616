"""Sensor readings compared with mechanics."""

import math
from collections.abc import Callable, Sequence

import numpy as np
import pytest

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.hardware.simulated_sensors import SimulatedSensor
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.sensors.reader import parse_link_sensors

RATE_HZ = 100.0
G = 9.81

World = Callable[..., "Lab"]


def gazebo(reference: str, kind: str, inside: str = "", name: str = "s") -> str:
    return (
        f'<gazebo reference="{reference}"><sensor name="{name}" type="{kind}">{inside}'
        "</sensor></gazebo>"
    )


def with_tags(urdf: str, *tags: str) -> str:
    return urdf.replace("</robot>", "".join((*tags, "</robot>")))


class Lab:
    """A robot with sensors in a simulation, without controllers."""

    def __init__(
        self, urdf: str, hold_joints: bool = True, seed: int = 0, world="empty", **options
    ) -> None:
        robot, hardware = parse_urdf(urdf), parse_hardware_info(urdf)
        sensors = parse_link_sensors(urdf, robot)
        timing = physics_timing(RATE_HZ)
        built = build_model(
            robot,
            hardware,
            world=world,
            options=BuildOptions(step_s=timing.step_s, **options),
            sensors=sensors,
        )
        self.simulation = Physics(built, timing, hold_joints)
        self.sensors = {s.name: SimulatedSensor(self.simulation, s, seed) for s in sensors}
        self.hardware = [
            SimulatedHardware(self.simulation, info, list(self.sensors.values()))
            for info in hardware
        ]

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds * RATE_HZ)):
            self.simulation.advance()

    def read(self, name: str = "s") -> dict[str, np.ndarray]:
        """Return a reading by the part of its channels' names before the dot."""
        sensor = self.sensors[name]
        values: dict[str, list[float]] = {}
        for channel, value in zip(sensor.description.channels, sensor.read(), strict=True):
            values.setdefault(channel.partition(".")[0], []).append(value)
        return {vector: np.array(numbers) for vector, numbers in values.items()}

    def joint(self, name: str = "j") -> tuple[float, float]:
        """Return position and velocity of a joint."""
        joint, data = self.simulation.built.joints[name], self.simulation.data
        return data.qpos[joint.qpos_address], data.qvel[joint.dof_address]


@pytest.fixture
def still(parts) -> Callable[[Sequence[str]], str]:
    """Return a URDF: 2 kg, 0.3 m below a base, on a fixed joint turned about x by 90 degrees."""

    def urdf(*more: str) -> str:
        return parts.robot(
            parts.link("base"),
            parts.link("load", 2.0, 0.05, "0.1 -0.3 0"),
            '<joint name="mount" type="fixed"><parent link="base"/><child link="load"/>'
            f'<origin xyz="0 0 2" rpy="{math.pi / 2} 0 0"/></joint>',
            *more,
        )

    return urdf


def test_a_still_imu_reads_gravity_upwards_in_its_own_axes(still):
    lab = Lab(still(gazebo("load", "imu")))
    lab.run(0.05)
    reading = lab.read()
    # The load's y axis points up.
    assert reading["linear_acceleration"] == pytest.approx([0, G, 0], abs=1e-9)
    assert reading["angular_velocity"] == pytest.approx([0, 0, 0], abs=1e-12)
    half = math.sqrt(0.5)
    assert reading["orientation"] == pytest.approx([half, 0, 0, half])


def test_a_tilted_imu_turns_with_its_pose(still):
    lab = Lab(still(gazebo("load", "imu", f"<pose>0 0 0 {-math.pi / 2} 0 0</pose>")))
    lab.run(0.05)
    assert lab.read()["linear_acceleration"] == pytest.approx([0, 0, G], abs=1e-9)
    assert lab.read()["orientation"] == pytest.approx([0, 0, 0, 1])


def test_an_imu_on_a_pendulum_reads_its_swing(parts):
    imu = gazebo("bob", "imu", "<pose>0.5 0 0 0 0 0</pose>")
    lab = Lab(with_tags(parts.pendulum(), imu), hold_joints=False)
    lab.run(0.3)
    angle, omega = lab.joint()
    assert omega > 1.0
    reading = lab.read()
    assert reading["angular_velocity"] == pytest.approx([0, omega, 0], abs=1e-9)
    # On the circle, inwards: the specific force less what gravity has along the rod.
    inwards = -(omega**2) * 0.5 - G * math.sin(angle)
    assert reading["linear_acceleration"][0] == pytest.approx(inwards, rel=1e-3)
    turned = math.sin(angle / 2), math.cos(angle / 2)
    assert reading["orientation"][[1, 3]] == pytest.approx(turned)


def test_a_falling_imu_feels_nothing(parts):
    ball = parts.robot(parts.link("ball", 1.0), gazebo("ball", "imu"), parts.ros2_control([]))
    lab = Lab(ball, base="free")
    lab.simulation.data.qpos[2] = 5.0
    lab.run(0.2)
    assert lab.read()["linear_acceleration"] == pytest.approx([0, 0, 0], abs=1e-9)


@pytest.mark.parametrize(
    ("tags", "force", "torque"),
    [
        # The load pulls the base down, which is -y of the load; it hangs 0.1 m along x.
        ("", [0, -2 * G, 0], [0, 0, -0.1 * 2 * G]),
        ("<measure_direction>parent_to_child</measure_direction>", [0, 2 * G, 0], [0, 0, 0.2 * G]),
        ("<frame>parent</frame>", [0, 0, -2 * G], [0, 0.2 * G, 0]),
        ("<frame>sensor</frame>", [2 * G, 0, 0], [0, 0, -0.2 * G]),
    ],
)
def test_a_force_torque_sensor_feels_the_weight_of_the_load(still, tags, force, torque):
    turned = "<pose>0 0 0 0 0 -1.5707963267948966</pose>"
    inside = f"<force_torque>{tags}</force_torque>{turned}"
    lab = Lab(still(gazebo("mount", "force_torque", inside)))
    lab.run(0.05)
    assert lab.read()["force"] == pytest.approx(force, abs=1e-9)
    assert lab.read()["torque"] == pytest.approx(torque, abs=1e-9)


def test_the_torque_is_about_the_sensors_place(still):
    lab = Lab(still(gazebo("mount", "force_torque", "<pose>0.1 0 0 0 0 0</pose>")))
    lab.run(0.05)
    assert lab.read()["torque"] == pytest.approx([0, 0, 0], abs=1e-9)


def test_a_held_joint_bears_the_moment_that_its_drive_gives(parts):
    lab = Lab(with_tags(parts.pendulum(), gazebo("j", "force_torque")))
    lab.run(1.0)
    # About y, downwards is positive: the bob would turn the base that way.
    assert lab.read()["torque"][1] == pytest.approx(0.5 * G, rel=1e-3)


BOX = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'


@pytest.fixture
def box(parts) -> str:
    """Return a URDF: a cube of 3 kg that nothing holds, with a contact sensor."""
    inside = "<contact><collision>c</collision><topic>bumper</topic></contact>"
    cube = parts.link("cube", 3.0, 0.1).replace("</link>", f"{BOX}</link>")
    return parts.robot(cube, gazebo("cube", "contact", inside), parts.ros2_control([]))


def test_a_box_in_the_air_touches_nothing_and_on_the_floor_bears_its_weight(box):
    lab = Lab(box, base="free")
    lab.simulation.data.qpos[2] = 0.3
    lab.run(0.05)
    assert not any(value.any() for value in lab.read().values())
    lab.run(2.0)
    reading = lab.read()
    assert reading["contacts"] >= 1
    # It sleeps a little before all is still.
    assert reading["force"] == pytest.approx([0, 0, 3 * G], abs=0.3)
    assert reading["torque"] == pytest.approx([0, 0, 0], abs=0.02)
    assert lab.sensors["s"].description.topic == "bumper"


def test_what_is_only_near_is_no_contact(box, tmp_path):
    """MuJoCo lists the shapes in the gap of a geom among its contacts, and counts them."""
    world = tmp_path / "near.xml"
    world.write_text(
        '<mujoco><option gravity="0 0 0"/><worldbody>'
        '<geom type="plane" size="0 0 1" gap="0.05"/></worldbody></mujoco>'
    )
    lab = Lab(box, base="free", world=world)
    data = lab.simulation.data
    data.qpos[2] = 0.07
    lab.run(0.05)
    assert data.ncon == 4
    assert not any(value.any() for value in lab.read().values())
    data.qpos[2] = 0.049
    lab.run(0.01)
    assert lab.read()["contacts"] == 4


def test_contact_forces_are_in_the_links_axes(box):
    lab = Lab(box, base="free")
    half = math.sqrt(0.5)
    lab.simulation.data.qpos[2:7] = [0.051, half, half, 0, 0]
    lab.run(2.0)
    assert lab.read()["force"] == pytest.approx([0, 3 * G, 0], abs=0.3)


def test_subscribers_do_not_change_the_run(parts):
    urdf = with_tags(parts.pendulum(), gazebo("bob", "imu"))
    heard, unheard = Lab(urdf, False), Lab(urdf, False)
    for _ in range(50):
        heard.run(0.01)
        heard.read()
        unheard.run(0.01)
    assert heard.joint() == unheard.joint()


def test_readings_are_of_the_state_after_the_step(parts):
    lab = Lab(with_tags(parts.pendulum(), gazebo("bob", "imu")), False)
    for _ in range(20):
        lab.run(0.01)
        assert lab.read()["angular_velocity"][1] == pytest.approx(lab.joint()[1], rel=1e-12)


def test_the_upper_of_two_touching_links_is_pushed_up_and_the_lower_down(parts):
    cube = parts.link("{}", 1.0, 0.1).replace("</link>", f"{BOX}</link>")
    slide = parts.joint("{}", "base", "{}", "prismatic", "0 0 {}", "0 0 1")
    urdf = parts.robot(
        parts.link("base"),
        *(cube.replace("{}", name) for name in ("lower", "upper")),
        slide.format("a", "lower", 1.0),
        slide.format("b", "upper", 1.15),
        *(gazebo(name, "contact", name=name) for name in ("lower", "upper")),
        parts.ros2_control(["a"]),
    )
    lab = Lab(urdf, self_collide=True)
    lab.run(2.0)
    assert lab.read("upper")["force"] == pytest.approx([0, 0, G], abs=0.5)
    assert lab.read("lower")["force"] == pytest.approx([0, 0, -G], abs=0.5)


SLEEPER = """
<mujoco>
  <option><flag sleep="enable"/></option>
  <worldbody>
    <geom type="plane" size="0 0 1"/>
    <body name="thing" pos="2 0 0.05" sleep="init">
      <freejoint name="thing"/><geom type="box" size="0.04 0.04 0.05" mass="1"/>
    </body>
  </worldbody>
</mujoco>
"""


def test_what_is_put_into_the_air_at_rest_falls(box, tmp_path):
    world = tmp_path / "sleeper.xml"
    world.write_text(SLEEPER)
    simulation = Lab(box, base="free", world=world).simulation
    for _ in range(100):
        simulation.advance()
    simulation.place("thing", np.array([2, 0, 0.5, 1, 0, 0, 0]), np.zeros(6))
    for _ in range(10):
        simulation.advance()
    # Half of g times t squared, less what the steps leave out.
    fallen = 0.5 - simulation.data.body("thing").xpos[2]
    assert fallen == pytest.approx(G * 0.1**2 / 2, abs=2e-3)


def test_contact_with_a_sleeping_body_that_was_moved_is_measured(box, tmp_path):
    world = tmp_path / "sleeper.xml"
    world.write_text(SLEEPER)
    lab = Lab(box, base="free", world=world)
    lab.run(1.0)
    alone = lab.read()["contacts"][0]
    assert alone >= 3
    lab.simulation.place("thing", np.array([0, 0, 0.16, 1, 0, 0, 0]), np.zeros(6))
    lab.run(1.0)
    reading = lab.read()
    assert reading["contacts"][0] > alone
    # The floor bears both, and the thing pushes down.
    assert reading["force"][2] == pytest.approx(3 * G, abs=0.5)


def test_a_sensor_finds_itself_again_in_another_model(parts):
    urdf = with_tags(parts.pendulum(), gazebo("bob", "imu"))
    lab, other = Lab(urdf, hold_joints=False), Lab(urdf, hold_joints=False, world="objects")
    lab.run(0.2)
    before = lab.read()
    simulation = lab.simulation
    simulation.swap(simulation.prepare(other.simulation.built, simulation.built.robot_roots))
    for vector, numbers in lab.read().items():
        assert numbers == pytest.approx(before[vector], abs=1e-9)
    lab.run(0.1)
    assert lab.read()["angular_velocity"][1] == pytest.approx(lab.joint()[1])


NOISY = (
    "<imu><angular_velocity><y><noise type='gaussian'><mean>0</mean><stddev>0.2</stddev>"
    "<bias_mean>3</bias_mean></noise></y></angular_velocity></imu>"
)


def test_noise_has_the_requested_spread_and_bias_and_is_reproducible(still):
    runs = []
    for seed in (1, 1, 2):
        lab = Lab(still(gazebo("load", "imu", NOISY)), seed=seed)
        rows = []
        for _ in range(400):
            lab.run(0.01)
            rows.append(lab.read()["angular_velocity"])
        runs.append(np.array(rows))
    first, again, other = runs
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()
    assert np.std(first[:, 1]) == pytest.approx(0.2, rel=0.15)
    assert abs(np.mean(first[:, 1])) == pytest.approx(3.0, abs=0.05)
    assert not first[:, [0, 2]].any()


def test_one_state_gives_one_reading(still):
    lab = Lab(still(gazebo("load", "imu", NOISY)))
    lab.run(0.01)
    np.testing.assert_array_equal(lab.sensors["s"].read(), lab.sensors["s"].read())


BLOCK = (
    '<ros2_control name="sim" type="system"><hardware><plugin>p</plugin></hardware>'
    '<joint name="j"><state_interface name="position"/></joint>'
    '<sensor name="s"><state_interface name="angular_velocity.y"/>'
    '<state_interface name="orientation.w"/><state_interface name="smell"/></sensor>'
    '<sensor name="unknown"><state_interface name="force.x"/></sensor></ros2_control>'
)


def test_sensors_of_the_hardware_are_state_interfaces(parts, caplog):
    urdf = with_tags(parts.pendulum(), gazebo("bob", "imu"))
    lab = Lab(urdf.replace(parts.ros2_control(["j"]), BLOCK), False)
    (hardware,) = lab.hardware
    names = ("j/position", "s/angular_velocity.y", "s/orientation.w")
    assert hardware.state_interfaces == names
    assert "left out: s/smell, unknown/force.x" in caplog.text
    states = np.full(3, math.nan)
    hardware.bind(states, np.empty(0))
    lab.run(0.3)
    hardware.read(lab.simulation.time_s, 0.01)
    angle, omega = lab.joint()
    assert states == pytest.approx([angle, omega, math.cos(angle / 2)])


def test_imus_of_one_name_on_two_links_read_each_its_own(parts, still):
    names = ("base/s", "load/s")
    states = "".join(
        f'<sensor name="{name}"><state_interface name="linear_acceleration.y"/></sensor>'
        for name in names
    )
    lab = Lab(
        still(
            gazebo("base", "imu", "<topic>b</topic>"),
            gazebo("load", "imu", "<topic>l</topic>"),
            parts.ros2_control([]).replace("</ros2_control>", f"{states}</ros2_control>"),
        )
    )
    lab.run(0.05)
    up = [lab.read(name)["linear_acceleration"] for name in names]
    assert up[0] == pytest.approx([0, 0, G], abs=1e-9)
    assert up[1] == pytest.approx([0, G, 0], abs=1e-9)
    assert lab.hardware[0].state_interfaces == tuple(f"{n}/linear_acceleration.y" for n in names)
