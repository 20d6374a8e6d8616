"""What a simulation is made from: named robots, keywords, controllers of unknown types."""

import inspect
import warnings
from pathlib import Path
from types import ModuleType

import pytest

from arm_gazebo.errors import SimSettingsError
from arm_gazebo.run.settings import PhysicsSettings
from arm_node.setting import settings_of
from arm_sim import NAMED_ROBOTS, CallError, Simulation


def test_each_setting_of_the_physics_is_a_keyword_with_its_default_and_its_help():
    keywords = inspect.signature(Simulation).parameters
    for each in settings_of(PhysicsSettings):
        keyword = keywords[each.attribute]
        assert keyword.kind is inspect.Parameter.KEYWORD_ONLY
        assert keyword.default == each.adapt(each.read(each.default))
        assert f"{each.attribute}: {each.about}." in inspect.getdoc(Simulation)


def test_the_keywords_are_those_of_earlier_versions():
    assert set(inspect.signature(Simulation).parameters) == {
        "description", "world", "controllers", "arguments", "spawn", "seed", "base", "pose",
        "package_path", "hold_joints", "position_proportional_gain", "physics_step_s",
        "self_collide", "strict", "render_backend", "record",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("arguments", "keywords", "sentence"),
    [
        (
            (),
            {"hold_joint": False},
            "Simulation() got an unexpected keyword argument 'hold_joint'; "
            "did you mean 'hold_joints'?",
        ),
        (
            ("arm", "empty"),
            {},
            "Simulation() takes from 1 to 2 positional arguments but 3 were given",
        ),
    ],
)
def test_arguments_that_do_not_fit_are_refused(arguments, keywords, sentence):
    with pytest.raises(TypeError) as raised:
        Simulation(*arguments, **keywords)
    assert isinstance(raised.value, CallError)
    assert str(raised.value) == sentence


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


CONTROLLERS = {
    "controller_manager": {
        "ros__parameters": {
            "position_controller": {"type": "position_controllers/JointGroupPositionController"},
            "scaled": {"type": "ur_controllers/ScaledJointTrajectoryController"},
            "admittance": {"type": "admittance_controller/AdmittanceController"},
        }
    },
    "position_controller": {"ros__parameters": {"joints": ["j0"]}},
}


def test_those_that_the_suite_lacks_are_a_warning_at_the_users_line():
    with (
        pytest.warns(UserWarning, match="2 controllers are left out") as caught,
        Simulation(controllers=CONTROLLERS) as sim,
    ):
        assert set(sim.controllers) == {"position_controller"}
    (warning,) = caught
    assert str(warning.message) == (
        "2 controllers are left out, because the suite has no controller of the type: "
        "scaled (ur_controllers/ScaledJointTrajectoryController), "
        "admittance (admittance_controller/AdmittanceController)"
    )
    assert Path(warning.filename) == Path(__file__)


def test_a_misspelt_type_is_an_error():
    content = {
        "controller_manager": {
            "ros__parameters": {"arm": {"type": "position_controllers/JointGroupPositionControler"}}
        }
    }
    sentence = (
        r"arm: no controller type '.*Controler'; "
        r"did you mean 'position_controllers/JointGroupPositionController'"
    )
    with pytest.raises(SimSettingsError, match=sentence):
        Simulation(controllers=content)


def test_what_the_user_leaves_out_himself_is_not_mentioned():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with Simulation(controllers=CONTROLLERS, spawn=["position_controller"]) as sim:
            assert list(sim.controllers) == ["position_controller"]
