"""Which controllers of a file start together."""

import pytest

from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.controllers_file import startable_controllers, substitute_arguments

TYPES = frozenset({"a/Broadcaster", "a/Position", "a/Trajectory"})
CONTENT = """
controller_manager:
  ros__parameters:
    update_rate: 100
    states: {type: a/Broadcaster}
    arm: {type: a/Trajectory}
    position: {type: a/Position}
    hand: {type: a/Position}
    force: {type: b/Unheard}
arm: {ros__parameters: {joints: [j0, j1]}}
position: {ros__parameters: {joints: [j1]}}
hand: {ros__parameters: {joint: finger}}
"""


@pytest.fixture
def file(tmp_path):
    return tmp_path / "controllers.yaml"


def test_controllers_with_unclaimed_joints_start_in_order(file):
    file.write_text(CONTENT)
    assert startable_controllers(file, TYPES).names == ("states", "arm", "hand")


def test_each_that_waits_is_named_with_the_reason(file):
    file.write_text(CONTENT)
    found = startable_controllers(file, TYPES)
    assert found.remarks == ("position does not start: arm claims 'j1'",)
    assert found.missing == {"force": "b/Unheard"}


@pytest.mark.parametrize("key", ["/left/controller_manager", "/**/controller_manager"])
def test_a_namespace_before_the_managers_name_is_passed_over(file, key):
    file.write_text(f"{key}:\n  ros__parameters:\n    states.type: a/Broadcaster\n")
    assert startable_controllers(file, TYPES).names == ("states",)


@pytest.mark.parametrize("key", ["arm", "/arm", "/left/arm", "/**/arm"])
def test_a_type_may_stand_in_the_controller_s_own_section(file, key):
    file.write_text(
        f"{key}: {{ros__parameters: {{type: a/Trajectory, joints: [j0]}}}}\n"
        "driver: {ros__parameters: {type: stepper}}\n"
        "states: {ros__parameters: {type: b/Unheard}}\n"
        "controller_manager: {ros__parameters: {states: {type: a/Broadcaster}}}\n"
    )
    found = startable_controllers(file, TYPES)
    assert found.names == ("states", "arm")
    assert not found.remarks


NESTED = """
%s:
  controller_manager:
    ros__parameters: {states: {type: a/Broadcaster}, arm: {type: a/Trajectory}}
  arm: {ros__parameters: {joints: [j0]}}
  hand: {ros__parameters: {joint: j0}}
/left/controller_manager:
  ros__parameters: {hand: {type: a/Position}}
"""


@pytest.mark.parametrize("namespace", ["left", "/left", "/**"])
def test_namespaces_may_be_keys_above_the_nodes(file, namespace):
    file.write_text(NESTED % namespace)
    startable = startable_controllers(file, TYPES)
    assert startable.names == ("states", "arm")
    assert startable.remarks == ("hand does not start: arm claims 'j0'",)


REPEATED = """
/**:
  controller_manager: {ros__parameters: {update_rate: 100, states: {type: a/Broadcaster}}}
/**:
  arm: {ros__parameters: {joints: [j0]}}
/**:
  controller_manager: {ros__parameters: {arm: {type: a/Trajectory}, arm: {fallback: x}}}
  hand: {ros__parameters: {type: a/Position}}
/**/hand: {ros__parameters: {joint: j0}}
"""


def test_keys_that_are_repeated_are_merged_as_by_rcl(file):
    file.write_text(REPEATED)
    startable = startable_controllers(file, TYPES)
    assert startable.names == ("states", "arm")
    assert startable.remarks == ("hand does not start: arm claims 'j0'",)


def test_a_controller_that_two_managers_have_starts_once(file):
    file.write_text(f"left: {CONTENT}right: {CONTENT}".replace("\n", "\n  "))
    assert startable_controllers(file, TYPES).names == ("states", "arm", "hand")


def test_places_in_a_file_with_nested_namespaces_are_filled_node_by_node(file):
    file.write_text(NESTED.replace("j0", "${prefix}j0") % "left")
    content = substitute_arguments(file, {"prefix": "p_"})
    assert not isinstance(content, type(file))
    assert content["/left/arm"] == {"ros__parameters": {"joints": ["p_j0"]}}
    assert list(content["/left/controller_manager"]["ros__parameters"]) == ["states", "arm", "hand"]


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ("", "names no controllers"),
        ("- 1", "names no controllers"),
        ("controller_manager: {ros__parameters: {update_rate: 100}}", "names no controllers"),
        ("left: {controller_manager: {arm: {type: a/Position}}}", "names no controllers"),
        ("a: [", "is not YAML"),
    ],
)
def test_a_file_without_controllers_is_refused(file, content, reason):
    file.write_text(content)
    with pytest.raises(SimSettingsError, match=reason):
        startable_controllers(file, TYPES)


def test_a_missing_file_is_named(file):
    sentence = f"cannot read the controllers' file {file}: No such file or directory$"
    with pytest.raises(SimSettingsError, match=sentence):
        startable_controllers(file, TYPES)


def test_a_single_joint_is_held_too(file):
    file.write_text(CONTENT + "force: {ros__parameters: {joint: finger}}\n")
    types = TYPES | {"b/Unheard"}
    assert startable_controllers(file, types).remarks[-1] == (
        "force does not start: hand claims 'finger'"
    )


def test_arguments_of_the_robot_take_their_places(file):
    file.write_text(CONTENT.replace("[j0, j1]", "['${prefix}j0', '${ prefix }${tool}']"))
    content = substitute_arguments(file, {"prefix": "left_", "tool": "gun", "other": ""})
    assert not isinstance(content, type(file))
    assert content["arm"] == {"ros__parameters": {"joints": ["left_j0", "left_gun"]}}
    assert startable_controllers(content, TYPES).names == ("states", "arm", "position", "hand")


def test_var_is_replaced_by_an_argument_of_the_robot_as_well(file):
    """As in the files of real robots' drivers, which ROS 2's launch fills in."""
    file.write_text(CONTENT.replace("[j0, j1]", "[$(var prefix)j0, '$( var prefix )${tool}']"))
    content = substitute_arguments(file, {"prefix": "left_", "tool": "gun"})
    assert not isinstance(content, type(file))
    assert content["arm"] == {"ros__parameters": {"joints": ["left_j0", "left_gun"]}}


def test_a_file_without_places_stays_a_file(file):
    file.write_text(CONTENT)
    assert substitute_arguments(file, {"prefix": "left_"}) == file


def test_a_placeholder_for_an_unknown_argument_is_refused_with_the_known_ones(file):
    file.write_text(CONTENT.replace("j0", "${side}j0"))
    with pytest.raises(
        SimSettingsError, match=r"\$\{side\}, which is not an argument .*; it has base, p"
    ):
        substitute_arguments(file, {"p": "", "base": "fixed"})
    file.write_text(CONTENT.replace("j0", "$(var side)j0"))
    with pytest.raises(
        SimSettingsError, match=r"has \$\(var side\), which is not an argument .*; it has"
    ):
        substitute_arguments(file, {"p": "", "base": "fixed"})
