"""Launch files start without the programs of ROS that nothing replaces here."""

import os

import pytest

from launch_py import ExecuteProcess, LaunchDescription, LogInfo, RegisterEventHandler
from launch_py.errors import NotFoundError, UnavailableError
from launch_py.event_handlers import OnProcessExit
from launch_py.launch_description import expand_description
from launch_py.ros import Node
from launch_py.system.packages import Packages


@pytest.fixture
def listed(package_prefix):
    """Replacements of a package `demo`, which has the program `talker`."""
    share = package_prefix("demo", "talker")
    folder = share.parent / "ament_index" / "resource_index" / "executable_stand_ins"
    folder.mkdir(parents=True)
    (folder / "demo").write_text(
        "# PACKAGE EXECUTABLE\n"
        "chat chat = demo talker\n"
        "chat chat::Talker = demo talker\n"
        "window window ~ demo talker --shown\n"
        "rtools_* * ! use the page\n"
        "rtools_plot better ! never reached\n"
        "plotter plotter ! `arm topic echo` prints numbers\n"
    )


def expand(*actions):
    return expand_description(LaunchDescription(actions), {}, dict(os.environ))


@pytest.mark.usefixtures("listed")
def test_a_node_without_a_replacement_is_skipped_and_the_others_start():
    plot = Node(package="rtools_plot", executable="plot", name="plot")
    plan = expand(
        plot,
        RegisterEventHandler(OnProcessExit(target_action=plot, on_exit=[LogInfo(msg="never")])),
        Node(package="demo", executable="talker"),
        ExecuteProcess(cmd=["plotter", "--file", "x"], depends_on=plot),
    )
    assert [step.name for step in plan.processes] == ["talker"]
    assert len(plan.steps) == 1
    assert plan.warnings == (
        "plot is skipped: plot of rtools_plot is not available: use the page",
        "plotter is skipped: plotter of plotter is not available: `arm topic echo` prints numbers",
    )


@pytest.mark.usefixtures("listed")
def test_a_program_that_is_run_by_its_name_alone_is_replaced_as_a_node_is():
    plan = expand(ExecuteProcess(cmd=["window", "-d", "x"]))
    assert plan.processes[0].command[1:] == ("--shown", "-d", "x")
    assert plan.warnings == ("window is not installed: talker of demo runs in place of window",)


@pytest.mark.usefixtures("listed")
def test_an_unknown_executable_is_still_an_error():
    with pytest.raises(NotFoundError, match="no package 'rtool_plot'"):
        expand(Node(package="rtool_plot", executable="plot"))
    with pytest.raises(NotFoundError, match="no program 'ploter'"):
        expand(ExecuteProcess(cmd=["ploter"]))


@pytest.mark.usefixtures("listed")
def test_the_first_line_that_fits_counts_and_composable_nodes_are_no_executables():
    packages = Packages(os.environ)
    with pytest.raises(UnavailableError, match="better of rtools_plot is not available: use the"):
        packages.executable("rtools_plot", "better")
    assert packages.executable("chat", "chat::Talker") == packages.executable("demo", "talker")
    assert [name for package, name in packages.executables() if package == "chat"] == ["chat"]


def test_a_command_line_tool_gets_no_ros_arguments():
    plan = expand(
        Node(
            package="tf2_ros",
            executable="tf2_monitor",
            name="monitor",
            namespace="left",
            arguments=["base", "tool"],
            parameters=[{"use_sim_time": True}],
        )
    )
    assert plan.processes[0].command[-4:] == ("tf", "monitor", "base", "tool")
