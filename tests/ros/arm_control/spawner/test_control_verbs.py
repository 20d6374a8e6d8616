"""`arm control` says what ros2 control says, on both ways: done, and refused."""

from collections.abc import Callable

import pytest

from arm_cli.main import main

POSITION = "position_controller"


@pytest.fixture
def arm_control(control, capfd) -> Callable[..., str]:
    """Return a function that carries out one verb and returns what it prints."""
    control.start("joint_state_broadcaster")

    def run(*words: str, code: int = 0) -> str:
        capfd.readouterr()
        assert main(["control", *words]) == code
        said = capfd.readouterr()
        # Fast DDS says it if a port of another domain's process is just ending, and takes the next.
        lines = (said.err if code else said.out).splitlines(keepends=True)
        return "".join(line for line in lines if "RTPS_TRANSPORT_SHM" not in line)

    return run


def test_load_says_each_step_and_skips_what_is_loaded(arm_control, control):
    assert arm_control("load_controller", POSITION, "--set-state", "inactive") == (
        f"Successfully loaded controller {POSITION}\n"
        f"Successfully loaded controller {POSITION} into state inactive\n"
    )
    skipped = f"Controller : {POSITION} already loaded, skipping load_controller!\n"
    assert arm_control("load_controller", POSITION) == skipped
    assert arm_control("load_controller", POSITION, "--set-state", "active") == (
        f"{skipped}Successfully loaded controller {POSITION} into state active\n"
    )
    # It is active: neither of the steps is possible any more.
    assert arm_control("load_controller", POSITION, "--set-state", "active", code=1) == (
        f"Error configuring controller : {POSITION}\n"
    )
    assert arm_control("cleanup_controller", POSITION, code=1) == (
        f"Error cleaning up controller {POSITION}, check controller_manager logs\n"
    )
    assert control.states()[POSITION] == "active"


def test_load_takes_a_parameter_file(arm_control, control, tmp_path):
    file = tmp_path / "own.yaml"
    file.write_text(
        "own_controller: {ros__parameters: "
        "{type: position_controllers/JointGroupPositionController, joints: [j1, j2]}}"
    )
    said = arm_control("load_controller", "own_controller", str(file), "--set-state", "active")
    assert said == (
        "Successfully loaded controller own_controller\n"
        "Successfully loaded controller own_controller into state active\n"
    )
    assert "j2/position [available] [claimed]" in arm_control("list_hardware_interfaces")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (None, "Controller parameter file : {file} does not exist, Aborting!"),
        ("[", "parameter file '{file}' is not YAML: "),
        ("own_controller: {ros__parameters: {type: 5}}", "the type of controller 'own_controller'"),
    ],
)
def test_an_unusable_parameter_file_is_refused(arm_control, tmp_path, content, sentence):
    file = tmp_path / "own.yaml"
    if content is not None:
        file.write_text(content)
    said = arm_control("load_controller", "own_controller", str(file), code=1)
    assert said.startswith(sentence.format(file=file))


@pytest.mark.parametrize(
    ("words", "sentence", "meant"),
    [
        (
            ("load_controller", "position_controler"),
            "Failed loading controller position_controler check controller_manager logs",
            "position_controller",
        ),
        (
            ("cleanup_controller", "joint_state_broadcastr"),
            "Error cleaning up controller joint_state_broadcastr, check controller_manager logs",
            "joint_state_broadcaster",
        ),
        (
            ("unload_controller", "joint_state_broadcastr"),
            "Error unloading controller joint_state_broadcastr, check controller_manager logs",
            "joint_state_broadcaster",
        ),
        (
            ("set_controller_state", "joint_state_broadcastr", "active"),
            "controller joint_state_broadcastr does not seem to be loaded",
            "joint_state_broadcaster",
        ),
        (
            ("switch_controllers", "--deactivate", "joint_state_broadcastr", "--strict"),
            "arm control switch_controllers",
            "joint_state_broadcaster",
        ),
    ],
)
def test_a_misspelt_controller_gets_a_suggestion(arm_control, words, sentence, meant):
    said = arm_control(*words, code=1)
    assert said.startswith(sentence)
    assert f" did you mean '{meant}'" in said


@pytest.mark.parametrize(
    ("state", "step"),
    [("unconfigured", "cleaning up"), ("inactive", "stopping"), ("active", "activating")],
)
def test_a_refused_hardware_state_is_reported_like_ros2_control(arm_control, state, step):
    assert arm_control("set_hardware_component_state", "nothere", state, code=1) == (
        f"Error {step} hardware component, check controller_manager logs\n"
    )
