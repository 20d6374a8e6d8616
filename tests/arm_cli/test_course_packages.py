"""The packages of the tutorials that `arm pkg list` shows, and the launch file of urdf_tutorial."""

import os

from arm_cli.main import main
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.system.packages import Packages

LISTED = {
    "gz_ros2_control",
    "gz_ros2_control_demos",
    "mycobot_bringup",
    "mycobot_description",
    "mycobot_gazebo",
    "mycobot_moveit_config",
    "mycobot_moveit_demos",
    "mycobot_mtc_demos",
    "mycobot_mtc_pick_place_demo",
    "mycobot_ros2",
    "mycobot_system_tests",
    "ros_gz_sim_demos",
    "urdf_tutorial",
}


def test_they_are_listed(capsys):
    assert main(["pkg", "list"]) == 0
    assert set(capsys.readouterr().out.split()) >= LISTED


def test_the_metapackage_names_those_of_the_mycobot(capsys):
    assert main(["pkg", "xml", "mycobot_ros2", "--tag", "exec_depend"]) == 0
    assert set(capsys.readouterr().out.split()) == {
        name for name in LISTED if name.startswith("mycobot_") and name != "mycobot_ros2"
    }


def test_the_tests_of_the_mycobot_are_executables(capsys):
    assert main(["pkg", "executables", "mycobot_system_tests"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "mycobot_system_tests arm_gripper_loop_controller",
        "mycobot_system_tests arm_gripper_loop_controller.py",
    ]


def test_urdf_tutorial_shows_any_robot(tmp_path):
    model = tmp_path / "one.urdf.xacro"
    model.write_text('<robot name="one"><link name="the_only_link"/></robot>')
    file = Packages(os.environ).launch_file("urdf_tutorial", "display.launch.py")
    arguments = {"model": str(model), "use_rviz": "false"}
    plan = expand_description(read_launch_file(file), arguments, dict(os.environ), file)
    assert {step.name for step in plan.processes} == {"robot_state_publisher", "arm_viewer_node"}
    assert any("the_only_link" in str(step.command) for step in plan.processes)
