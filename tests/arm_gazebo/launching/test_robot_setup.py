"""A robot's description, controllers and folders, completed with defaults."""

from pathlib import Path

import pytest

from arm_description.errors import ResourceNotFoundError, XacroError
from arm_description.urdf.description_source import DescriptionSource, source_of
from arm_gazebo.launching.default_control import TRAJECTORY, has_hardware
from arm_gazebo.launching.robot_setup import folders, set_up_robot


@pytest.fixture
def bare(tmp_path, parts):
    """The file of a robot without <ros2_control>."""
    file = tmp_path / "bare.urdf"
    file.write_text(
        parts.robot(
            parts.link("base"),
            parts.link("a", 1.0),
            parts.link("b", 1.0),
            parts.joint("j0", "base", "a"),
            parts.joint("j1", "a", "b"),
        )
    )
    return file


def test_default_hardware_and_controllers_are_added_and_reported(bare):
    setup = set_up_robot(str(bare))
    assert has_hardware(setup.description)
    assert setup.spawn == ("joint_state_broadcaster", "position_controller")
    assert not isinstance(setup.controllers, Path)
    assert setup.controllers["position_controller"]["ros__parameters"]["joints"] == ["j0", "j1"]
    assert "no <ros2_control> block: a default one commands j0, j1" in setup.remarks[0]
    assert "position_controller drives j0, j1" in setup.remarks[1]


def test_a_robot_to_plan_for_gets_a_trajectory_controller(bare):
    setup = set_up_robot(str(bare), commander=TRAJECTORY)
    assert setup.spawn == ("joint_state_broadcaster", TRAJECTORY)
    assert not isinstance(setup.controllers, Path)
    parameters = setup.controllers[TRAJECTORY]["ros__parameters"]
    assert parameters["joints"] == ["j0", "j1"]
    assert parameters["allow_partial_joints_goal"]
    assert f"{TRAJECTORY} drives j0, j1" in setup.remarks[1]


def test_a_file_that_the_description_hands_to_gazebos_plugin_is_named(bare, tmp_path):
    (tmp_path / "own.yaml").touch()
    plugins = "".join(
        f"<gazebo><plugin filename='x' name='y'><parameters>{tmp_path}/{name}</parameters>"
        "</plugin></gazebo>"
        for name in ("own.yaml", "none.yaml")
    )
    bare.write_text(bare.read_text().replace("</robot>", f"{plugins}</robot>"))
    *_, remark = set_up_robot(str(bare)).remarks
    assert remark.endswith(f"to use it: controllers:={tmp_path}/own.yaml")
    assert "the default is" in set_up_robot(str(bare)).remarks[-2]


def test_made_up_controllers_leave_out_joints_that_cannot_be_commanded(tmp_path, parts):
    """As in the blocks of grippers, which often list all of their joints."""
    file = tmp_path / "gripper.urdf"
    names = ["left", "right", "tip", "missing"]
    file.write_text(
        parts.robot(
            *(parts.link(name, 1.0) for name in ("base", "a", "b", "c")),
            parts.joint("left", "base", "a"),
            parts.joint("right", "base", "b", more='<mimic joint="left" multiplier="-1"/>'),
            parts.joint("tip", "a", "c", kind="fixed", limit=""),
            parts.ros2_control(names),
        )
    )
    setup = set_up_robot(str(file))
    assert not isinstance(setup.controllers, Path)
    assert setup.controllers["position_controller"]["ros__parameters"]["joints"] == ["left"]


def test_made_up_controllers_take_the_joints_that_the_hardware_commands_by_position(
    tmp_path, parts
):
    file = tmp_path / "arm.urdf"
    velocity_only = parts.ros2_control(["j1"], commands=["velocity"]).replace("sim", "other")
    file.write_text(
        parts.robot(
            parts.link("base"),
            parts.link("a", 1.0),
            parts.link("b", 1.0),
            parts.joint("j0", "base", "a"),
            parts.joint("j1", "a", "b"),
            parts.ros2_control(["j0"]),
            velocity_only,
        )
    )
    setup = set_up_robot(str(file))
    assert not isinstance(setup.controllers, Path)
    assert setup.controllers["position_controller"]["ros__parameters"]["joints"] == ["j0"]
    assert len(setup.remarks) == 1
    assert "position_controller drives j0; nothing drives j1, which the" in setup.remarks[0]


def test_given_controllers_stand(bare, tmp_path):
    file = tmp_path / "controllers.yaml"
    file.write_text(
        "controller_manager: {ros__parameters: {"
        "states: {type: joint_state_broadcaster/JointStateBroadcaster}}}"
    )
    setup = set_up_robot(str(bare), controllers=str(file))
    assert setup.controllers == file
    assert setup.spawn == ("states",)


def test_controllers_may_be_named_by_a_uri_or_below_the_home(bare, tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    file = tmp_path / "controllers.yaml"
    file.write_text(
        "controller_manager: {ros__parameters: {"
        "states: {type: joint_state_broadcaster/JointStateBroadcaster}}}"
    )
    for name in (file.as_uri(), "~/controllers.yaml"):
        assert set_up_robot(str(bare), controllers=name).controllers == file


def test_places_in_the_controllers_are_filled_with_the_models_arguments(tmp_path, parts):
    text = parts.robot(parts.link("$(arg side)base")).replace(
        ">",
        ' xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="side" default="left_"/>',
        1,
    )
    (tmp_path / "arm.urdf.xacro").write_text(text)
    file = tmp_path / "controllers.yaml"
    file.write_text(
        "controller_manager: {ros__parameters: {"
        "${side}states: {type: joint_state_broadcaster/JointStateBroadcaster}}}"
    )

    def spawned(model_args: str) -> tuple[str, ...]:
        return set_up_robot(str(tmp_path / "arm.urdf.xacro"), model_args, str(file)).spawn

    assert spawned("") == ("left_states",)
    assert spawned("side:=right_") == ("right_states",)


def test_spawn_names_controllers(bare):
    assert set_up_robot(str(bare), spawn="a, b c").spawn == ("a", "b", "c")
    assert set_up_robot(str(bare), spawn="").spawn == ()


def test_only_controllers_that_are_named_have_to_start(bare):
    assert set_up_robot(str(bare), spawn="a").parameters()["spawn_required"] is True
    assert set_up_robot(str(bare)).parameters()["spawn_required"] is False


def test_joints_without_a_position_interface_are_reported(tmp_path, parts):
    file = tmp_path / "wheel.urdf"
    file.write_text(
        parts.robot(
            parts.link("base"),
            parts.link("a", 1.0),
            parts.joint("j0", "base", "a"),
            parts.ros2_control(["j0"], commands=["velocity"]),
        )
    )
    setup = set_up_robot(str(file))
    assert setup.spawn == ("joint_state_broadcaster",)
    assert "nothing drives j0, which the hardware does not command by pos" in setup.remarks[0]
    assert setup.remarks[0].endswith("controllers:=FILE")


def test_a_statue_needs_no_controllers(tmp_path, parts):
    file = tmp_path / "statue.urdf"
    file.write_text(parts.robot(parts.link("base", 1.0)))
    setup = set_up_robot(str(file))
    assert setup.spawn == ()
    assert "no joint can be commanded" in setup.remarks[0]
    assert setup.remarks[1] == "no controllers are given: there is no default for this robot"


def test_files_beside_the_model_and_in_its_package_are_found(bare, tmp_path):
    setup = set_up_robot(str(bare), package_path=f"{tmp_path / 'x'}:{tmp_path / 'y'}")
    given = (tmp_path / "x", tmp_path / "y")
    assert setup.package_path == given
    assert source_of(setup.description) == DescriptionSource(bare, given)


def test_the_robot_and_its_controllers_may_lie_in_a_package_of_the_folders_given(bare, tmp_path):
    package = tmp_path / "source" / "my_arm"
    package.mkdir(parents=True)
    bare.rename(package / "a.urdf")
    (package / "c.yaml").write_text(
        "controller_manager:\n  ros__parameters:\n    states: {type: x/JointStateBroadcaster}\n"
    )
    setup = set_up_robot(
        "package://my_arm/a.urdf", "", "package://my_arm/c.yaml", "", str(tmp_path / "source")
    )
    assert setup.controllers == package / "c.yaml"
    with pytest.raises(ResourceNotFoundError, match=r"no file for 'package://my_arm/a\.urdf'"):
        set_up_robot("package://my_arm/a.urdf")


def test_xacro_arguments_are_passed_on(tmp_path):
    file = tmp_path / "a.urdf.xacro"
    file.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="side" '
        'default="left"/><link name="$(arg side)_hand"/></robot>'
    )
    assert "a hand" in set_up_robot(str(file), "side:='a hand'").description.replace("_", " ")


def test_a_missing_model_is_named():
    with pytest.raises(XacroError, match=r"cannot read /no/such\.urdf"):
        set_up_robot("/no/such.urdf")


def test_folders_are_parted_by_colons():
    assert folders("/a:/b c::~") == (Path("/a"), Path("/b c"), Path.home())
