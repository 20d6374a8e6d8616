"""Runs of all kinds of controllers go on bit for bit: wheels, efforts, integrals, grippers."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from arm_control.controllers.diff_drive.odometry import PlanarTwist
from arm_control.controllers.gripper.goals import GripperRequest
from arm_control.controllers.mecanum_drive.kinematics import MecanumTwist
from arm_sim import Simulation

DEMOS = "package://gz_ros2_control_demos"
ROSMASTER = "package://yahboom_rosmaster"
TICKS = 60


@pytest.fixture
def assembled() -> Iterator[Callable[..., Simulation]]:
    """Return a maker of robots with the controllers of their files, active."""
    made: list[Simulation] = []

    def make(model: str, controllers: Any, **arguments: str) -> Simulation:
        base = {"base": arguments.pop("base", "fixed")}
        sim = Simulation(model, controllers=controllers, arguments=arguments, **base)
        made.append(sim)
        return sim

    yield make
    for sim in made:
        sim.close()


def run(sim: Simulation, ticks: int = TICKS) -> list[bytes]:
    digests = []
    for _ in range(ticks):
        sim.step()
        digests.append(sim.parts.state.digest())
    return digests


def core(sim: Simulation, name: str) -> Any:
    return sim.controllers[name].core


def assert_goes_on(sim: Simulation, disturb: Callable[[], object]) -> None:
    """Check that the run goes on from here as it did, whatever happened in between."""
    saved = sim.parts.state.save()
    first = run(sim), sim.parts.state.save()
    disturb()
    run(sim, 17)
    sim.parts.state.restore(saved)
    assert (run(sim), sim.parts.state.save()) == first
    sim.parts.state.reset(True)
    once = run(sim)
    disturb()
    run(sim, 17)
    sim.parts.state.reset(True)
    assert run(sim) == once


def test_two_driven_wheels_with_their_odometry_and_limits(assembled):
    sim = assembled(
        f"{DEMOS}/urdf/diff_drive.urdf.xacro",
        f"{DEMOS}/config/diff_drive_controller.yaml",
        base="free",
    )
    name = next(name for name in sim.controllers if "diff_drive" in name)
    drive = core(sim, name)
    run(sim, 5)
    assert not drive.offer(PlanarTwist(0.4, 0.3), None)
    run(sim, 20)
    assert_goes_on(sim, lambda: drive.offer(PlanarTwist(-0.2, 0.0), None))


def test_four_mecanum_wheels(assembled):
    sim = assembled(
        f"{ROSMASTER}_description/urdf/robots/rosmaster_x3.urdf.xacro",
        f"{ROSMASTER}_gazebo/config/ros2_controllers.yaml",
        base="free",
        use_gazebo="true",
    )
    name = next(name for name in sim.controllers if "mecanum" in name)
    drive = core(sim, name)
    run(sim, 5)
    assert not drive.offer(MecanumTwist(x=0.2, y=0.1, yaw=0.3), None)
    run(sim, 20)
    assert_goes_on(sim, lambda: drive.offer(MecanumTwist(x=-0.2), None))


def test_a_gripper_that_is_driven_by_effort(assembled):
    sim = assembled(
        f"{DEMOS}/urdf/gripper_mimic_joint.urdf.xacro",
        f"{DEMOS}/config/gripper_controller.yaml",
        interface="effort",
    )
    name = next(name for name in sim.controllers if "gripper" in name)
    gripper = core(sim, name)
    run(sim, 5)
    assert gripper.offer([1.0])
    run(sim, 20)
    assert_goes_on(sim, lambda: gripper.offer([-1.0]))


def test_a_gripper_controller_with_a_goal_and_an_integral(parts, robot):
    gains = {"joint": "j", "gains.j.p": 20.0, "gains.j.i": 10.0, "gains.j.d": 2.0}
    held = robot(parts.pendulum(), {"grip": ("effort_controllers/GripperActionController", gains)})
    goal = GripperRequest(b"close", [0.3], [10.0])
    assert held.controllers["grip"].submit_goal(goal) is None
    held.run(3)
    saved = held.state.save()
    first = held.run(100)
    ended = held.results.by_goal.pop(b"close")
    held.restore(saved)
    assert held.run(100) == first
    assert held.results.by_goal.pop(b"close") == ended


def test_a_pid_controller_with_its_integral(parts, robot):
    gains = {"p": 20.0, "i": 10.0, "d": 2.0}
    pid = {
        "dof_names": ["j"],
        "command_interface": "effort",
        "reference_and_state_interfaces": ["position"],
        **{f"gains.j.{name}": value for name, value in gains.items()},
    }
    held = robot(parts.pendulum(), {"pid": ("pid_controller/PidController", pid)})
    assert not held.controllers["pid"].offer([], [0.3])
    held.run(50)
    saved = held.state.save()
    first = held.run(60)
    held.controllers["pid"].offer([], [-0.3])
    held.run(30)
    held.restore(saved)
    assert held.run(60) == first
