"""XML and YAML launch files: the action of each element, and the errors."""

import os

import pytest
import yaml

from launch_py.errors import LaunchError, LaunchFileError
from launch_py.launch_description import expand_description, survey_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import GeneratedFile, MessageStep

XML = """<?xml version="1.0"?>
<launch>
  <!-- What can be said on the command line. -->
  <arg name="rate" default="10" description="in Hz"/>
  <arg name="who" default="arm"><choice value="arm"/><choice value="leg"/></arg>
  <let name="greeting" value="hello $(var who)"/>
  <set_env name="COLOUR" value="red"/>
  <group if="$(eval &quot;'$(var who)' == 'arm'&quot;)">
    <push-ros-namespace namespace="left"/>
    <node pkg="demo" exec="talker" name="speaker" output="screen"
          args="--say 'two words' $(var who)" respawn="true" respawn_delay="2.5">
      <param name="rate" value="$(var rate)"/>
      <param name="label" value="10" type="str"/>
      <param name="limits"><param name="upper" value="1.5"/></param>
      <param from="$(find-pkg-share demo)/config/demo.yaml"/>
      <remap from="chatter" to="talk"/>
      <env name="SHAPE" value="round"/>
    </node>
  </group>
  <node pkg="demo" exec="listener" unless="true"/>
  <include file="$(dirname)/child.launch.yaml"><arg name="word" value="$(var greeting)"/></include>
  <executable cmd="true $(env COLOUR)" name="tool"/>
</launch>
"""

YAML = """
launch:
- arg: {name: rate, default: "10", description: in Hz}
- arg:
    name: who
    default: arm
    choice:
    - value: arm
    - value: leg
- let: {name: greeting, value: "hello $(var who)"}
- set_env: {name: COLOUR, value: red}
- group:
    if: $(eval "'$(var who)' == 'arm'")
    children:
    - push_ros_namespace: {namespace: left}
    - node:
        pkg: demo
        exec: talker
        name: speaker
        output: screen
        args: "--say 'two words' $(var who)"
        respawn: true
        respawn_delay: 2.5
        param:
        - {name: rate, value: $(var rate)}
        - {name: label, value: "10", type: str}
        - name: limits
          param:
          - {name: upper, value: 1.5}
        - from: $(find-pkg-share demo)/config/demo.yaml
        remap:
        - {from: chatter, to: talk}
        env:
        - {name: SHAPE, value: round}
- node: {pkg: demo, exec: listener, unless: true}
- include:
    file: $(dirname)/child.launch.yaml
    arg:
    - {name: word, value: $(var greeting)}
- executable: {cmd: "true $(env COLOUR)", name: tool}
"""

CHILD = "launch:\n- arg: {name: word}\n- log: {message: child says $(var word)}\n"


@pytest.fixture
def demo(package_prefix):
    share = package_prefix("demo", "talker", "listener")
    (share / "config").mkdir()
    (share / "config" / "demo.yaml").write_text("speaker: {ros__parameters: {x: 1}}\n")
    return share


@pytest.fixture
def ros_file(tmp_path):
    def write(text: str, name: str = "test.launch.xml"):
        path = tmp_path / name
        path.write_text(text)
        (tmp_path / "child.launch.yaml").write_text(CHILD)
        return path

    return write


def expand(path, **arguments: str):
    return expand_description(read_launch_file(path), arguments, dict(os.environ), path)


@pytest.mark.parametrize(
    ("name", "text"),
    [("test.launch.xml", XML), ("test.launch", XML), ("a.launch.yaml", YAML), ("a.yml", YAML)],
)
def test_xml_and_yaml_files_mean_the_same(ros_file, demo, name, text):
    plan = expand(ros_file(text, name), rate="30")
    talker, tool = plan.processes
    assert (talker.name, tool.name) == ("speaker", "tool")
    words = [word for word in talker.command if isinstance(word, str)]
    assert words[1:4] == ["--say", "two words", "arm"]
    assert "__ns:=/left" in words
    assert "chatter:=talk" in words
    assert str(demo / "config" / "demo.yaml") in words
    values = {}
    for word in talker.command:
        if isinstance(word, GeneratedFile):
            values |= yaml.safe_load(word.text)["/left/speaker"]["ros__parameters"]
    assert values == {"rate": 30, "label": "10", "limits": {"upper": 1.5}}
    assert talker.environment == {"COLOUR": "red", "SHAPE": "round"}
    assert talker.restart.when == "always"
    assert talker.restart.first_delay_s == 2.5
    assert tool.command[1:] == ("red",)
    texts = [step.text for step in plan.steps if isinstance(step, MessageStep)]
    assert texts == ["child says hello arm"]


def test_conditions_and_choices_are_applied(ros_file, demo):
    assert [step.name for step in expand(ros_file(XML), who="leg").processes] == ["tool"]
    with pytest.raises(LaunchError, match="'who' cannot be 'foot'"):
        expand(ros_file(XML), who="foot")


def test_its_arguments_are_listed(ros_file, demo):
    path = ros_file(XML)
    arguments = survey_description(read_launch_file(path), dict(os.environ), path).arguments
    assert {a.name: (a.default, a.description, a.choices) for a in arguments.values()} == {
        "rate": ("10", "in Hz", ()),
        "who": ("arm", None, ("arm", "leg")),
    }


def test_settings_of_a_group_stay_in_the_group(ros_file):
    plan = expand(
        ros_file(
            '<launch><group><let name="a" value="in"/></group>'
            '<group scoped="false"><let name="b" value="out"/></group>'
            '<log message="$(var a clean) $(var b clean)"/></launch>'
        )
    )
    assert [step.text for step in plan.steps if isinstance(step, MessageStep)] == ["clean out"]


def test_environment_timer_and_shutdown(ros_file, monkeypatch):
    monkeypatch.setenv("GONE", "1")
    plan = expand(
        ros_file(
            """<launch>
              <append_env name="LIST" value="b"/><append_env name="LIST" value="a" prepend="true"/>
              <unset_env name="GONE"/>
              <executable cmd="echo $LIST; true" shell="true" name="tool"/>
              <timer period="2.0"><shutdown reason="enough"/></timer>
            </launch>"""
        )
    )
    [tool] = plan.processes
    assert tool.environment == {"LIST": "a:b", "GONE": None}
    assert tool.command == ("/bin/sh", "-c", "echo $LIST; true")
    assert plan.steps[-1].delay_s == 2.0


def test_parameters_for_all_nodes(ros_file, demo):
    plan = expand(
        ros_file(
            """<launch>
              <set_use_sim_time value="true"/><set_parameter name="gain" value="2.5"/>
              <set_remap from="a" to="b"/>
              <node pkg="demo" exec="talker"/>
            </launch>"""
        )
    )
    command = plan.processes[0].command
    text = "".join(word.text for word in command if isinstance(word, GeneratedFile))
    assert '"use_sim_time": true' in text
    assert '"gain": 2.5' in text
    assert "a:=b" in command


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ('<nod pkg="a"/>', "line 2: no action 'nod' here; did you mean 'node'"),
        ('<node pkg="demo"/>', "line 2: node lacks 'exec'"),
        (
            '<node pkg="demo" exec="t" nam="x"/>',
            "line 2: node does not take 'nam'; did you mean 'name'",
        ),
        (
            '<node pkg="demo" exec="t"><parm name="a"/></node>',
            "line 2: node does not take 'parm'; did you mean 'param'",
        ),
        ('<node pkg="demo" exec="t"><param name="a"/></node>', "line 2: param 'a' has no 'value'"),
        (
            '<node pkg="demo" exec="t"><param name="a" value="1" type="byte"/></node>',
            "line 2: no type 'byte' of a parameter; the types are bool, float",
        ),
        ('<node pkg="demo" exec="t" args="\'x"/>', 'line 2: "\'x" has an open quotation'),
        (
            '<node pkg="demo" exec="t" respawn_delay="soon"/>',
            "line 2: respawn_delay='soon' is not a number",
        ),
        ('<let name="a" value="$(vra b)"/>', r"line 2: no substitution $(vra); "),
        ('<log message="a" if="1" unless="1"/>', "line 2: log has both 'if' and 'unless'"),
        ('<group scoped="maybe"/>', "line 2: scoped='maybe' is neither true nor false"),
        ("<node_container/>", "line 2: node_container lacks 'pkg'"),
        ("words", "line 2: 'words' is outside an attribute"),
        ("<node", "line 3: not XML: not well-formed (invalid token)"),
    ],
)
def test_errors_are_reported_with_their_line(ros_file, body, said):
    path = ros_file(f"<launch>\n{body}\n</launch>")
    with pytest.raises(LaunchFileError) as caught:
        read_launch_file(path)
    assert str(caught.value).startswith(f"{path}, {said}")


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.launch.xml", "<robot/>", "the root must be 'launch', not 'robot'"),
        ("a.launch.xml", "", "line 1: not XML: no element found"),
        ("a.launch.xml", "<a>" * 100, "nested more than 64 deep"),
        ("a.launch.yaml", "", "is a list of actions below 'launch:'"),
        ("a.launch.yaml", "launch: [node]", "line 1: an action must be one name with a colon"),
        ("a.launch.yaml", "launch:\n- node: demo", "line 2: node takes names and values"),
        ("a.launch.yaml", "launch: [", "is not YAML: while parsing"),
        ("a.launch.yaml", f"launch: {'[' * 5000}{']' * 5000}", "its values are nested too deep"),
    ],
)
def test_a_file_of_another_form_is_refused(ros_file, name, text, said):
    with pytest.raises(LaunchFileError) as caught:
        read_launch_file(ros_file(text, name))
    assert said in str(caught.value)


def test_xml_and_yaml_files_are_found_by_package_and_name(demo, run_launch_py):
    (demo / "launch" / "demo.launch.xml").write_text(
        '<launch><arg name="rate" default="10"/></launch>'
    )
    done = run_launch_py("demo", "demo.launch.xml", "--show-args")
    assert "rate  (default '10')" in done.stdout
    done = run_launch_py("demo")
    assert "It has demo.launch.xml" in done.stderr
    done = run_launch_py("demo", "demo.launch.yaml")
    assert "did you mean 'demo.launch.xml'" in done.stderr


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ('<log message="$(not maybe)"/>', "line 2: maybe is 'maybe', neither true nor false"),
        ('<log message="$(equals $(var a) 1)"/>', "line 2: no launch argument 'a'"),
        ("<group><log message=\"$(eval '1 / 0')\"/></group>", "line 2: expression '1 / 0'"),
        ('<log message="a" if="$(eval 2)"/>', "line 2: a condition on"),
    ],
)
def test_errors_of_substitutions_are_reported_with_their_line(ros_file, body, said):
    path = ros_file(f"<launch>\n{body}\n</launch>")
    with pytest.raises(LaunchError) as caught:
        expand(path)
    assert str(caught.value).startswith(f"{path}, {said}")


def test_containers_managed_nodes_and_settings(ros_file):
    path = ros_file(
        """<launch>
          <let name="a" value="1"/>
          <node_container pkg="rclcpp_components" exec="component_container" name="box"
              namespace="">
            <composable_node pkg="robot_state_publisher" name="rsp" namespace="left"
                plugin="robot_state_publisher::RobotStatePublisher">
              <param name="robot_description" value="x"/>
              <extra_arg name="use_intra_process_comms" value="true"/>
            </composable_node>
          </node_container>
          <load_composable_node target="box">
            <composable_node pkg="image_proc" plugin="image_proc::RectifyNode"/>
          </load_composable_node>
          <lifecycle_node pkg="robot_state_publisher" exec="robot_state_publisher" name="managed"
              namespace="" autostart="true"/>
          <push_env/>
          <rep_env><env name="B" value="2"/></rep_env>
          <set_ros_log_dir new_log_dir="/tmp/x"/>
          <ros_timer period="1"><log message="$(env B) $(string-join - a $(var a))"/></ros_timer>
          <pop_env/>
          <reset><keep name="b" value="$(var a)"/></reset>
          <log message="$(var a unset) $(var b)"/>
          <reset_env/>
        </launch>"""
    )
    plan = expand_description(read_launch_file(path), {}, dict(os.environ), path)
    assert [step.name for step in plan.processes] == [
        "rsp",
        "managed",
        "configure activate /managed",
    ]
    texts = [step.text for step in plan.steps if isinstance(step, MessageStep)]
    assert texts == ["2 a-1", "unset 1"]
    assert plan.warnings[0].startswith("the composable node image_proc::RectifyNode of image_proc")
