"""The named robots are those of the launch files."""

from pathlib import Path
from types import ModuleType

import pytest

from arm_sim import NAMED_ROBOTS, Simulation

ROOT = Path(__file__).parents[2]


def launch_file(path: str) -> ModuleType:
    """Return a launch file as a module."""
    from importlib.machinery import SourceFileLoader
    from importlib.util import module_from_spec, spec_from_loader

    loader = SourceFileLoader("launch_file", str(ROOT / path))
    spec = spec_from_loader("launch_file", loader)
    assert spec is not None
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


def test_the_mycobot_is_that_of_its_launch_file():
    launched = launch_file("robots/mycobot_gazebo/launch/mycobot.gazebo.launch.py")
    default = {name: value for name, (value, *_) in launched.ARGUMENTS.items()}
    robot, name = NAMED_ROBOTS["mycobot"], default["robot_name"]
    assert robot.model.endswith(f"/{name}.urdf.xacro")
    assert f"/{name}/" in robot.controllers
    assert robot.world == default["world_file"]
    assert robot.arguments.items() <= default.items()
    assert robot.pose == tuple(float(default[axis]) for axis in launched.POSE)
    started = (*launched.ARM_CONTROLLERS.split(","), launched.GRIPPER_CONTROLLER)
    assert robot.spawn == started


@pytest.mark.parametrize("name", sorted(NAMED_ROBOTS))
def test_a_named_robot_has_its_controllers_active(name):
    with Simulation(name) as sim:
        assert tuple(sim.controllers) == NAMED_ROBOTS[name].spawn
        assert all(controller.is_active for controller in sim.controllers.values())
        sim.run(0.1)
