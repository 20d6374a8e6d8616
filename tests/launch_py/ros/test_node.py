"""The command line of a Node: program, names, namespaces, remappings, parameters."""

import os

import pytest
import yaml

from launch_py import GroupAction, SetLaunchConfiguration, TopicPublished
from launch_py.errors import LaunchFileError, NodeParameterError, NotFoundError
from launch_py.plan.steps import GeneratedFile
from launch_py.ros import (
    FindPackagePrefix,
    FindPackageShare,
    Node,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetUseSimTime,
)
from launch_py.substitution import perform_text
from launch_py.substitutions import LaunchConfiguration


@pytest.fixture(autouse=True)
def demo_package(package_prefix):
    return package_prefix("demo", "talker", "listener")


def node(**options):
    return Node(package="demo", executable="talker", **options)


def words(plan, index=0):
    return plan.processes[index].command


def parameters(plan, index=0):
    files = [word for word in words(plan, index) if isinstance(word, GeneratedFile)]
    return [yaml.safe_load(file.text) for file in files]


def test_a_bare_node_is_its_program(expand, demo_package):
    plan = expand([node()])
    assert words(plan) == (str(demo_package.parents[1] / "lib" / "demo" / "talker"),)
    assert plan.processes[0].name == "talker"


def test_a_program_without_package_is_a_path_or_on_the_path(expand):
    plan = expand(
        [
            Node(executable="/bin/true", arguments=["x"], ros_arguments=["-y"]),
            Node(executable="true", namespace="left"),
        ]
    )
    assert words(plan) == ("/bin/true", "x", "--ros-args", "-y")
    assert os.path.basename(str(words(plan, 1)[0])) == "true"
    assert [step.name for step in plan.processes] == ["true", "true-2"]
    with pytest.raises(NotFoundError, match="program /no/such does not exist"):
        expand([Node(executable="/no/such")])


def test_a_group_without_forwarding_has_no_outer_namespace(expand):
    around = [PushRosNamespace("left"), SetRemap("a", "b"), SetParameter("c", 1)]
    plan = expand([*around, GroupAction([node()], forwarding=False)])
    assert len(words(plan)) == 1


def test_arguments_come_before_the_ros_arguments(expand):
    plan = expand([node(arguments=["-v"], ros_arguments=["--log-level", "debug"])])
    assert words(plan)[1:] == ("-v", "--ros-args", "--log-level", "debug")


def test_name_namespace_and_remappings(expand):
    plan = expand(
        [
            PushRosNamespace("left"),
            SetRemap("/clock", "/sim/clock"),
            node(name="chatter", namespace="arm", remappings=[("chat", "talk")]),
        ]
    )
    assert words(plan)[1:] == (
        "--ros-args",
        *("-r", "__node:=chatter"),
        *("-r", "__ns:=/left/arm"),
        *("-r", "/clock:=/sim/clock"),
        *("-r", "chat:=talk"),
    )
    assert plan.processes[0].name == "chatter"


def test_remappings_may_be_a_dict(expand):
    assert words(expand([node(remappings={"chat": "talk"})]))[1:] == (
        "--ros-args",
        *("-r", "chat:=talk"),
    )


@pytest.mark.parametrize("pair", [("a", "b", "c"), ("a",), "ab", 3, {"a": "b"}])
def test_a_remapping_that_is_not_a_pair_is_reported(expand, pair):
    with pytest.raises(LaunchFileError, match=r"remappings= takes pairs of two texts, not .*a|3"):
        expand([node(remappings=[pair])])


def test_optional_arguments_may_be_none(expand):
    bare = node(parameters=None, remappings=None, arguments=None, ros_arguments=None)
    assert len(words(expand([bare]))) == 1


def test_an_absolute_namespace_stands_alone(expand):
    plan = expand([PushRosNamespace("left"), node(namespace="/right")])
    assert "__ns:=/right" in words(plan)


def test_a_node_s_namespace_is_inside_the_group_s(expand):
    plan = expand([GroupAction([PushRosNamespace("left"), node()]), node()])
    assert "__ns:=/left" in words(plan, 0)
    assert len(words(plan, 1)) == 1


def test_parameters_go_to_every_node_of_the_process(expand):
    plan = expand([node(parameters=[{"rate": 100}])])
    assert parameters(plan) == [{"/**": {"ros__parameters": {"rate": 100}}}]


def test_parameters_of_a_named_node_go_to_that_node_only(expand):
    plan = expand([node(name="n", namespace="a", parameters=[{"rate": 100}])])
    assert list(parameters(plan)[0]) == ["/a/n"]


def test_parameters_may_name_one_node_of_several(expand):
    each = {
        "arm_gazebo": {"ros__parameters": {"rate": 100}},
        "controller": {"ros__parameters": {"joints": ["j0"]}},
        "/right/controller": {"ros__parameters": {"joints": ["j1"]}},
    }
    plan = expand([node(namespace="left", parameters=[each])])
    assert parameters(plan) == [
        {
            "/left/arm_gazebo": {"ros__parameters": {"rate": 100}},
            "/left/controller": {"ros__parameters": {"joints": ["j0"]}},
            "/right/controller": {"ros__parameters": {"joints": ["j1"]}},
        }
    ]
    assert not any("__node" in str(word) for word in words(plan))


def test_set_parameter_comes_first_so_that_own_values_win(expand):
    plan = expand([SetParameter("use_sim_time", True), node(parameters=[{"rate": 1}])])
    values = [next(iter(file.values()))["ros__parameters"] for file in parameters(plan)]
    assert values == [{"use_sim_time": True}, {"rate": 1}]


@pytest.mark.parametrize("value", [True, "true", LaunchConfiguration("s", default="yes")])
def test_sim_time_is_set_for_the_scope(expand, value):
    plan = expand([GroupAction([SetUseSimTime(value), node()]), node()])
    assert parameters(plan, 0) == [{"/**": {"ros__parameters": {"use_sim_time": True}}}]
    assert parameters(plan, 1) == []


def test_a_parameter_file_for_the_scope_comes_first(expand, tmp_path):
    path = tmp_path / "params.yaml"
    path.touch()
    plan = expand([SetParametersFromFile(path), node(parameters=[{"rate": 1}])])
    assert words(plan)[1:4] == ("--ros-args", "--params-file", str(path))
    assert parameters(plan) == [{"/**": {"ros__parameters": {"rate": 1}}}]


def test_a_parameter_file_is_passed_as_it_is(expand, tmp_path):
    path = tmp_path / "params.yaml"
    path.touch()
    plan = expand(
        [SetLaunchConfiguration("f", str(path)), node(parameters=[LaunchConfiguration("f")])]
    )
    assert words(plan)[1:] == ("--ros-args", "--params-file", str(path))


@pytest.mark.parametrize("folder", ["", "{tmp_path}/"])
def test_a_missing_parameter_file_names_its_neighbours(expand, tmp_path, monkeypatch, folder):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "params.yaml").touch()
    with pytest.raises(NodeParameterError, match=r"talker: no parameter file .*mean 'params.yaml'"):
        expand([node(parameters=[folder.format(tmp_path=tmp_path) + "parms.yaml"])])


def test_a_bad_parameter_names_node_and_parameter(expand):
    with pytest.raises(NodeParameterError, match=r"talker: parameter 'a': .*cannot be a parameter"):
        expand([node(parameters=[{"a": object()}])])


def test_an_unknown_executable_suggests_a_similar_one(expand):
    with pytest.raises(NotFoundError, match=r"'demo' has no executable 'takler'.*mean 'talker'"):
        expand([Node(package="demo", executable="takler")])


def test_relative_topics_of_a_condition_are_in_the_namespace_of_the_node(expand):
    plan = expand([node(namespace="left", ready=[TopicPublished("chat"), TopicPublished("/abs")])])
    assert [condition.topic for condition in plan.processes[0].ready] == ["/left/chat", "/abs"]


def test_exec_name_names_the_process_only(expand):
    plan = expand([node(exec_name="sim", parameters=[{"a": 1}])])
    assert plan.processes[0].name == "sim"
    assert not any("__node" in str(word) for word in words(plan))


def test_find_package(demo_package):
    from launch_py import LaunchContext

    assert perform_text(LaunchContext(), FindPackageShare("demo")) == str(demo_package)
    prefix = demo_package.parents[1]
    assert perform_text(LaunchContext(), FindPackagePrefix("demo")) == str(prefix)


def test_given_node_names_are_known(expand):
    plan = expand(
        [
            node(name="a"),
            node(name="b", namespace="left"),
            PushRosNamespace("arm"),
            node(name="c", namespace="right"),
            node(),
            Node(executable="/bin/true"),
        ]
    )
    names = [list(step.node_names()) for step in plan.processes]
    assert names == [["/a"], ["/left/b"], ["/arm/right/c"], [], []]


def test_a_distribution_may_declare_the_nodes_of_its_scripts(expand, tmp_path, monkeypatch):
    entry_points = tmp_path / "site" / "own-1.0.dist-info" / "entry_points.txt"
    entry_points.parent.mkdir(parents=True)
    entry_points.write_text(
        "[console_scripts]\nscript = own.main:main\n[launch_py.nodes]\nscript = the_node\n"
    )
    monkeypatch.syspath_prepend(tmp_path / "site")
    plan = expand([Node(package="own", executable="script", namespace="left")])
    assert list(plan.processes[0].node_names()) == ["/left/the_node"]
