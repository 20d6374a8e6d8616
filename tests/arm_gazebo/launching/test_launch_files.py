"""Launch files: their arguments reach the description, the world and every node."""

import json
import os
import runpy
import shlex

import pytest
from lxml import etree
from robots import collision, joint, link, robot

from arm_cli.main import main
from arm_description import parse_urdf
from arm_description.resources import resolve_uri
from arm_description.urdf.description_source import DescriptionSource, source_of
from arm_description.xacro.expansion import arguments_of_text, expand_xacro_file
from arm_gazebo.sensors.camera_reader import parse_cameras
from launch_py.errors import UsageError
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import GeneratedFile

SWITCHED = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="camera" default="false"/>
  <link name="base"/>
  <xacro:if value="$(arg camera)"><link name="lens"/></xacro:if>
</robot>
"""


@pytest.fixture
def launch_file():
    return runpy.run_path(str(resolve_uri("package://arm_gazebo/launch/arm_world.launch.py")))


@pytest.fixture
def defaults(launch_file):
    return {name: default for name, (default, *_) in launch_file["DESCRIPTION_ARGUMENTS"].items()}


def test_a_model_that_has_an_argument_of_the_arms_in_another_sense_keeps_its_default(
    capsys, tmp_path
):
    model = tmp_path / "other.urdf.xacro"
    model.write_text(SWITCHED)
    line = ["launch", "arm_gazebo", "arm_world.launch.py", "--print", f"model:={model}"]
    assert main([*line, "controllers:="]) == 0
    assert "arm_gazebo_node" in capsys.readouterr().out


def test_what_is_given_is_passed_on(launch_file, defaults):
    given = defaults | {"prefix": "x y", "j1_limit": "0.25"}
    passed = launch_file["assignments"](**given)
    assert arguments_of_text(passed) == {"prefix": "x y", "j1_limit": "0.25"}
    assert len(shlex.split(passed)) == 2


def test_what_is_left_out_is_the_same_in_the_description(launch_file, defaults):
    assert launch_file["assignments"](**defaults) == ""
    model = resolve_uri("package://arm_description/urdf/arm.urdf.xacro")
    assert defaults.items() <= expand_xacro_file(model).arguments.items()


LINE = ["launch", "arm_gazebo", "sim.launch.py", "--print"]


def test_every_node_gets_the_source_of_the_description(capsys, tmp_path, parts):
    model = tmp_path / "arm_x" / "urdf" / "arm.urdf"
    model.parent.mkdir(parents=True)
    model.write_text(parts.pendulum())
    elsewhere = tmp_path / "elsewhere"
    assert main([*LINE, "viewer:=true", f"model:={model}", f"package_path:={elsewhere}"]) == 0
    printed = capsys.readouterr().out
    told = [line for line in printed.splitlines() if "<?description_source" in line]
    sources = [source_of(line[line.index("<?description_source") :]) for line in told]
    assert sources == [DescriptionSource(model, (elsewhere,))] * 2


def test_a_missing_world_is_refused_before_anything_starts(capsys):
    assert main([*LINE, "model:=any.urdf", "world:=object"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "no world 'object': there is no file" in captured.err
    assert "the shipped worlds are empty, house, objects" in captured.err


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (["gz_args:=-r -v 1 kitchen.sdf"], "no world 'kitchen'"),
        (["gz_args:=-r objects.sdf", "world:=/no/such/lab.xml"], "/no/such/lab.xml"),
    ],
)
def test_a_missing_world_of_gazebo_s_arguments_is_refused_as_well(capsys, given, sentence):
    assert main(["launch", "arm_gazebo", "arm_world.launch.py", "camera:=none", *given]) == 2
    said = capsys.readouterr().err
    assert sentence in said
    assert "the shipped worlds are empty" in said


def test_a_world_without_a_name_is_no_folder(capsys):
    assert main([*LINE, "model:=any.urdf", "world:="]) == 2
    assert "no world '': the name is empty, and the shipped worlds are" in capsys.readouterr().err


def plan_of(name: str, *, search: str = "/bin", **arguments: str):
    file = resolve_uri("package://arm_gazebo/launch") / name
    environ = {**os.environ, "PATH": search}
    return expand_description(read_launch_file(file), arguments, environ, file)


def command_of(plan, name: str) -> tuple:
    (step,) = (step for step in plan.processes if step.name == name)
    return step.command


def parameters_of(plan, name: str) -> str:
    words = command_of(plan, name)
    return "".join(word.text for word in words if isinstance(word, GeneratedFile))


@pytest.mark.parametrize(
    ("planning", "configuration", "moved"),
    [("true", "", True), ("false", "", False), ("true", ".", False)],
)
def test_only_a_robot_that_plans_unconfigured_starts_where_it_is_free(
    tmp_path, monkeypatch, planning, configuration, moved
):
    monkeypatch.chdir(tmp_path)
    ball = collision("sphere", radius=0.1)
    model = tmp_path / "folded.urdf"
    model.write_text(
        robot(
            *(link(name, ball) for name in ("base", "arm", "hand")),
            joint("shoulder", "base", "arm", xyz="0.25 0 0"),
            joint("wrist", "arm", "hand", xyz="-0.15 0 0"),
        )
    )
    (tmp_path / "kinematics.yaml").write_text("arm: {kinematics_solver_timeout: 0.1}")
    given = {"planning": planning, "moveit_config": configuration}
    plan = plan_of("sim.launch.py", model=str(model), **given)
    assert ("initial_value" in parameters_of(plan, "arm_gazebo_node")) is moved


def test_rviz_opens_if_it_is_installed(tmp_path):
    program = tmp_path / "rviz2"
    program.touch(mode=0o755)
    given = {"use_rviz": "true", "rviz_config_file": "/my/lab.rviz"}
    plan = plan_of("arm_world.launch.py", search=f"{tmp_path}:/bin", **given)
    words = (str(program), "-d", "/my/lab.rviz", "--ros-args", "-p", "use_sim_time:=true")
    assert command_of(plan, "rviz2") == words
    assert plan.warnings == ()


def test_rviz_that_is_not_installed_is_a_warning_and_the_page():
    plan = plan_of("arm_world.launch.py", use_rviz="true")
    assert "arm_viewer_node" in [step.name for step in plan.processes]
    assert [w for w in plan.warnings if w.startswith("RViz (rviz2)") and "not installed" in w]
    opened = plan_of("arm_world.launch.py", use_rviz="true", viewer="true")
    assert [step.name for step in opened.processes].count("arm_viewer_node") == 1


@pytest.mark.parametrize(
    ("given", "shown"), [({}, ""), ({"rviz_config_file": "/my/lab.rviz"}, "/my/lab.rviz")]
)
def test_the_page_in_rviz_s_place_shows_the_configuration_that_is_given(given, shown):
    plan = plan_of("arm_world.launch.py", use_rviz="true", **given)
    parameters = parameters_of(plan, "arm_viewer_node")
    assert f'"display_config": "{shown}"' in parameters


def test_without_controllers_the_arm_falls_unless_it_is_held():
    for given, held in (
        ({}, "false"),
        ({"spawn": "joint_state_broadcaster"}, "true"),
        ({"hold_joints": "true"}, "true"),
    ):
        plan = plan_of("arm_world.launch.py", **given)
        assert f'"hold_joints": {held}' in parameters_of(plan, "arm_gazebo_node")


def test_the_arguments_of_ros_1_are_taken():
    plan = plan_of(
        "arm_gazebo.launch.py",
        interface="ros1",
        robot_name="left",
        paused="true",
        gui="false",
        debug="true",
        hardware_interface="hardware_interface/PositionJointInterface",
        use_sim_time="true",
    )
    assert '"paused": true' in parameters_of(plan, "arm_gazebo_node")
    for step in plan.processes:
        assert "__ns:=/left" in step.command, step.name
    with pytest.raises(UsageError, match="'hardware_interface' cannot be 'EffortJointInterface'"):
        plan_of("arm_world.launch.py", hardware_interface="EffortJointInterface")


def description_of(**arguments):
    """Return the text of the robot that arm_world.launch.py simulates."""
    plan = plan_of("arm_world.launch.py", **arguments)
    _, _, rest = parameters_of(plan, "arm_gazebo_node").partition('"robot_description": ')
    description, _ = json.JSONDecoder().raw_decode(rest)
    return description


def camera_of(**arguments):
    (camera,) = parse_cameras(description_of(**arguments))
    return camera


def test_ros_1_has_the_side_camera_on_its_own_topics():
    ros1 = camera_of(interface="ros1")
    assert (ros1.width, ros1.height, ros1.hfov) == (800, 800, 1.3962634)
    assert ros1.noise_stddev == 0.007
    assert "/camera/image_raw" in ros1.image_topics
    assert "/camera/camera_info" in ros1.info_topics
    chosen = camera_of(interface="ros1", camera="front", camera_profile="standard")
    assert chosen == camera_of()
    assert chosen.image_topics == ("videocamera",)


def test_the_camera_has_any_size_and_field_of_view():
    camera = camera_of(camera_width="1280", camera_height="720", camera_hfov="1.2")
    assert (camera.width, camera.height, camera.hfov) == (1280, 720, 1.2)


# Where the camera is in base_link, and the colour of the box around it, by course.
COURSE_CAMERAS = {
    "S0": ((0.0, -0.05, 0.0), (0.0, -0.2, -1.57), None),
    "S1": ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.8, 0.0, 1.0)),
    "S2": ((0.0, 0.0, 0.0), (0.0, 0.0, -1.57), (0.208, 0.024, 0.243, 1.0)),
    "S3": ((0.75, 0.0, 0.5), (0.0, 0.3, -3.14), (0.8, 0.8, 0.8, 1.0)),
}


@pytest.mark.parametrize("course", COURSE_CAMERAS)
def test_a_course_has_the_original_s_camera(course):
    xyz, rpy, colour = COURSE_CAMERAS[course]
    robot = parse_urdf(description_of(course=course))
    joint = robot.joint("camera_joint")
    assert (joint.origin.xyz, joint.origin.rpy) == (xyz, rpy)
    materials = (visual.material for visual in robot.link("camera_link").visuals)
    boxes = [m.rgba for m in materials if m and m.name == "camera_box"]
    assert boxes == ([colour] if colour else [])


@pytest.mark.parametrize("course", COURSE_CAMERAS)
def test_joints_of_a_course_are_commanded_by_position_as_in_the_original(course):
    description = etree.fromstring(description_of(course=course).encode())
    commands = description.findall("ros2_control/joint/command_interface")
    assert [command.get("name") for command in commands] == ["position"] * 4


def test_course_s2_has_grey_servos_a_shorter_way_of_j1_and_touches_itself():
    robot = parse_urdf(description_of(course="S2"))
    limit = robot.joint("j1").limit
    assert limit is not None
    assert (limit.lower, limit.upper) == (-2.0, 2.0)
    materials = {v.material for v in robot.link("dyn2").visuals if v.material}
    assert {m.rgba for m in materials if m.name == "servo"} == {(0.5, 0.5, 0.5, 1.0)}
    plan = plan_of("arm_world.launch.py", course="S2")
    assert '"self_collide": true' in parameters_of(plan, "arm_gazebo_node")


def test_gazebos_words_without_r_start_paused():
    paused = plan_of("arm_world.launch.py", gz_args="empty.sdf")
    assert '"paused": true' in parameters_of(paused, "arm_gazebo_node")
    running = plan_of("arm_world.launch.py", gz_args="-r empty.sdf")
    assert '"paused": false' in parameters_of(running, "arm_gazebo_node")


def test_gazebos_verbosity_is_the_log_level():
    plan = plan_of("arm_gazebo.launch.py", gz_args="-r -v 1 empty.sdf")
    assert command_of(plan, "arm_gazebo_node")[-2:] == ("--log-level", "error")


def test_gui_is_the_window(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(UsageError, match="headless:=false opens a window, and there is no display"):
        plan_of("arm_world.launch.py", gui="true")
    assert plan_of("arm_world.launch.py", gui="true", headless="true").processes


def test_the_description_is_uploaded_if_requested():
    plan = plan_of("arm_upload.launch.py", robot_name="arm", origin_xyz="0 0 0.4567")
    (publisher,) = plan.processes
    assert "__ns:=/arm" in publisher.command
    # Its foot stands 0.0313 m above the world's link.
    assert "0.0 0.0 0.488" in parameters_of(plan, "robot_state_publisher")
    assert plan_of("arm_upload.launch.py").processes
    with pytest.raises(UsageError, match="origin_rpy:='a b' is not three numbers"):
        plan_of("arm_upload.launch.py", origin_rpy="a b")


def test_the_ros_1_names_of_launch_files_are_found(capsys):
    assert main(["launch", "arm_gazebo", "arm_upload.launch", "--show-args"]) == 0
    assert "origin_xyz  (default '0 0 0')" in capsys.readouterr().out


def test_copies_have_a_simulation_and_a_process_of_state_publishers():
    plan = plan_of("arm_gazebo.launch.py", copies="3", copy_spacing="0.5", pose="[1,0,0,0,0,0]")
    assert [step.name for step in plan.processes] == ["arm_gazebo_node", "robot_state_publisher"]
    simulation = parameters_of(plan, "arm_gazebo_node")
    assert '"robots": ["arm_0", "arm_1", "arm_2"]' in simulation
    assert '"/arm_2/position_controller": {"ros__parameters": {"joints": ["arm_2_j0"' in simulation
    (publishers,) = (step for step in plan.processes if step.name == "robot_state_publisher")
    assert publishers.command[-7:-3] == ("--namespaces", "arm_0", "arm_1", "arm_2")
    assert "/arm_2/robot_state_publisher" in parameters_of(plan, "robot_state_publisher")
    titles = [panel.title for panel in plan.panels]
    assert titles == ["3 robots are up, from /arm_0 to /arm_2"]


def test_one_copy_is_what_there_is_without_the_argument():
    def processes(**arguments: str):
        plan = plan_of("arm_gazebo.launch.py", **arguments)
        return [(step.name, step.command) for step in plan.processes], plan.panels

    assert processes(copies="1") == processes()


def test_ros_1_s_copies_are_below_the_robot_s_name():
    plan = plan_of("arm_gazebo.launch.py", interface="ros1", copies="2")
    simulation = parameters_of(plan, "arm_gazebo_node")
    assert '"/arm_1/j0p_controller": {"ros__parameters": {"joint": "arm_1_j0"' in simulation


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"copies": "0"}, "copies:=0 is not a number of robots that one world can have"),
        ({"copies": "1000"}, "copies:=1000 is not a number of robots .* from 1 to 30"),
        ({"copies": "2", "copy_spacing": "0"}, "copy_spacing:=0 is not a distance above 0"),
        ({"copies": "2", "robots": "r.yaml"}, "copies:= repeats one model, and robots:=FILE lists"),
        ({"copies": "2", "controller_node": "true"}, "controller_node:=true is for one arm"),
    ],
)
def test_copies_that_cannot_be_are_refused(given, sentence):
    with pytest.raises(UsageError, match=sentence):
        plan_of("arm_gazebo.launch.py", **given)


def test_a_jog_without_planning_is_refused():
    with pytest.raises(UsageError, match="servo:=true needs planning:=true"):
        plan_of("arm_gazebo.launch.py", servo="true")


CONTROLLERS = """
controller_manager:
  ros__parameters:
    states: {{type: joint_state_broadcaster/JointStateBroadcaster}}
    scaled: {{type: {}/ScaledJointTrajectoryController}}
"""


@pytest.mark.parametrize("interface", ["ros2", "ros1"])
@pytest.mark.parametrize("camera", ["front", "none"])
def test_an_arm_without_a_camera_shows_no_topic_of_pictures(interface, camera):
    plan = plan_of("arm_gazebo.launch.py", interface=interface, camera=camera)
    shown = [topic for panel in plan.panels for topic, _ in panel.topics]
    assert ("/videocamera" in shown or "/camera/image_raw" in shown) == (camera != "none")


def test_a_file_of_controllers_starts_what_it_has(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text(CONTROLLERS.format("ur_controllers"))
    plan = plan_of("arm_gazebo.launch.py", controllers=str(file))
    assert '"spawn": "states"' in parameters_of(plan, "arm_gazebo_node")
    shown = [topic for panel in plan.panels for topic, _ in panel.topics]
    assert shown == ["/joint_states", "/videocamera"]
    plan = plan_of("arm_gazebo.launch.py", controllers=str(file), spawn="states,scaled")
    assert '"spawn": "states,scaled"' in parameters_of(plan, "arm_gazebo_node")
    plan = plan_of("arm_gazebo.launch.py", course="S1")
    assert '"spawn": "joint_state_broadcaster,position_controller"' in parameters_of(
        plan, "arm_gazebo_node"
    )


@pytest.fixture
def files(tmp_path):
    """Return a function that writes a robot, and controllers with one of a package."""

    def write(package: str) -> dict[str, str]:
        file, model = tmp_path / "controllers.yaml", tmp_path / "robot.urdf"
        file.write_text(CONTROLLERS.format(package))
        model.write_text("<robot name='r'><link name='base'/></robot>")
        return {"model": str(model), "controllers": str(file)}

    return write


def test_a_misspelt_type_of_a_controller_ends_the_launch_with_1(files, capsys):
    words = [f"{name}:={value}" for name, value in files("joint_trajectory_controller").items()]
    assert main(["launch", "arm_gazebo", "sim.launch.py", *words, "--print"]) == 1
    assert capsys.readouterr().err.startswith(
        "arm launch: scaled: no controller type 'joint_trajectory_controller/Scaled"
        "JointTrajectoryController'; did you mean 'joint_trajectory_controller/JointTrajectory"
    )


def test_a_type_that_the_suite_lacks_is_a_warning_when_all_is_ready(files):
    plan = plan_of("sim.launch.py", **files("ur_controllers"))
    (note,) = [note for panel in plan.panels for note in panel.notes]
    assert note == (
        "warning",
        "1 controller is left out, because the suite has no controller of the type: scaled "
        "(ur_controllers/ScaledJointTrajectoryController)",
    )
    assert '"spawn": "states"' in parameters_of(plan, "arm_gazebo_node")
