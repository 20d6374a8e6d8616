"""`arm launch`: its default file, its errors, and its imports."""

import os
import subprocess

import pytest
from run_python import run_python

from arm_cli import launch
from arm_cli.launch import launch_domain, name_launch_file
from arm_cli.main import main
from arm_node import environment

LAUNCH_FILE = """
import sys
from launch_py import ExecuteProcess, LaunchDescription


def generate_launch_description():
    heavy = {"rclpy", "rich", "yaml", "numpy", "asyncio", "importlib.metadata", "mujoco"}
    print("imported:", *sorted(heavy & sys.modules.keys()))
    return LaunchDescription([ExecuteProcess(cmd=["true"])])
"""


@pytest.fixture
def launch_file(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
    path = tmp_path / "test.launch.py"
    path.write_text(LAUNCH_FILE)
    return path


def test_without_arguments_it_launches_the_default_file(monkeypatch):
    taken = {}

    def run(argv, **options):
        taken.update(options, argv=argv)
        return 0

    monkeypatch.setattr(launch, "run_launch", run)
    assert main(["launch", "world:=objects"]) == 0
    assert taken["short_names"][""] == ("arm_gazebo", "arm_gazebo.launch.py")
    assert taken["argv"] == ["world:=objects"]
    assert taken["program"] == "arm launch"


def test_every_short_name_leads_to_a_launch_file(capsys):
    for word in launch.SHORT_NAMES:
        assert main(["launch", *word.split(), "--show-args"]) == 0
        assert capsys.readouterr().out.startswith("Arguments of ")


def test_without_the_interfaces_it_names_the_fix_and_starts_nothing(
    launch_file, monkeypatch, capsys
):
    monkeypatch.setattr(environment, "INTERFACE_PACKAGES", ("no_such_interfaces",))
    assert main(["launch", str(launch_file)]) == 2
    (sentence,) = capsys.readouterr().err.splitlines()
    assert "no_such_interfaces is not installed" in sentence
    assert "pip install ./arm_interfaces" in sentence


@pytest.mark.parametrize("option", ["-n", "--noninteractive"])
def test_the_noninteractive_option_of_ros2_is_accepted(launch_file, capsys, option):
    assert main(["launch", option, str(launch_file), "--show-args"]) == 0
    assert "test.launch.py has no arguments." in capsys.readouterr().out


def test_without_the_interfaces_it_still_lists_arguments(launch_file, monkeypatch, capsys):
    monkeypatch.setattr(environment, "INTERFACE_PACKAGES", ("no_such_interfaces",))
    assert main(["launch", str(launch_file), "--show-args"]) == 0
    assert "test.launch.py has no arguments." in capsys.readouterr().out


def test_the_launcher_imports_nothing_heavy(launch_file):
    done = run_python("-m", "arm_cli", "launch", str(launch_file))
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[0].strip() == "imported:"


def test_its_help_explains_the_arguments(capsys):
    with pytest.raises(SystemExit, match="0"):
        main(["launch", "--help"])
    text = capsys.readouterr().out
    assert "usage: arm launch" in text
    assert "arm_gazebo arm_gazebo.launch.py" in text


def test_another_user_in_the_domain_is_named(monkeypatch, capsys):
    def run(argv, before_start, **options):
        before_start()
        return 0

    monkeypatch.setattr(launch, "run_launch", run)
    monkeypatch.setattr(launch, "other_users", lambda domain: ["anna"] if domain == 7 else [])
    monkeypatch.setenv("ROS_DOMAIN_ID", "8")
    assert main(["launch"]) == 0
    assert capsys.readouterr().err == ""
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert main(["launch"]) == 0
    said = capsys.readouterr().err
    assert said.startswith("[launch] warning: user anna runs ROS programs in this ROS domain, too")
    assert "domain:=auto takes another domain" in said


def test_the_emergency_stop_starts_beside_modules_of_the_user(tmp_path):
    for name in ("argparse", "random", "types", "yaml"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit('the user's own')")
    done = subprocess.run(
        [*launch.STOP, "--help"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("usage: arm stop")


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.urdf", "", ["arm_gazebo", "sim.launch.py", "model:=FILE"]),
        ("a.urdf.xacro", "", ["arm_gazebo", "sim.launch.py", "model:=FILE"]),
        ("a.xml", "<?xml version='1.0'?><robot/>", ["arm_gazebo", "sim.launch.py", "model:=FILE"]),
        ("a.xml", "<!-- <robot/> --><mujoco/>", ["world:=FILE"]),
        ("a.sdf", "", ["world:=FILE"]),
        ("a.launch.xml", "<launch/>", ["FILE"]),
        ("a.launch.py", "", ["FILE"]),
        ("a.xml", "no markup", ["FILE"]),
    ],
)
def test_a_robot_or_a_world_is_launched_by_its_file(tmp_path, name, content, words):
    path = tmp_path / name
    path.write_text(content)
    expected = [word.replace("FILE", str(path)) for word in words]
    assert name_launch_file([str(path), "pose:=[0]", "-p"]) == [*expected, "pose:=[0]", "-p"]


def test_the_plan_of_a_urdf_has_its_robot(tmp_path, capsys):
    path = tmp_path / "my_robot.urdf"
    path.write_text('<robot name="my_robot"><link name="base"/></robot>')
    assert main(["launch", str(path), "--print"]) == 0
    assert "robot_state_publisher" in capsys.readouterr().out


def test_a_near_short_name_is_offered(capsys):
    assert main(["launch", "mycobt"]) == 2
    assert capsys.readouterr().err.rstrip().endswith("did you mean 'mycobot'?")


def test_the_launcher_reads_a_robot_without_numpy_lxml_and_rclpy():
    code = (
        "import sys\nsys.argv = ['arm', 'launch', '--print']\nfrom arm_cli.main import run\n"
        "try:\n    run()\nexcept SystemExit:\n    pass\n"
        "print(sorted({'lxml', 'numpy', 'rclpy', 'mujoco'} & sys.modules.keys()), file=sys.stderr)"
    )
    done = run_python("-c", code)
    assert "robot_state_publisher" in done.stdout
    assert done.stderr.strip() == "[]"


@pytest.fixture(autouse=True)
def _domain_of_the_tests(monkeypatch):
    # The variable is restored after the test.
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")


def test_without_the_word_nothing_changes():
    with launch_domain(["mycobot", "viewer:=true"]) as words:
        assert words == ["mycobot", "viewer:=true"]
        assert os.environ["ROS_DOMAIN_ID"] == "7"


def test_a_number_is_the_domain():
    with launch_domain(["domain:=42", "viewer:=true"]) as words:
        assert words == ["viewer:=true"]
        assert os.environ["ROS_DOMAIN_ID"] == "42"


def test_auto_finds_a_domain_of_its_own_for_each_launch(capsys):
    with launch_domain(["domain:=auto"]) as words:
        assert words == []
        first = os.environ["ROS_DOMAIN_ID"]
        with launch_domain(["domain:=auto"]):
            second = os.environ["ROS_DOMAIN_ID"]
    assert first != second
    assert f"[launch] ROS_DOMAIN_ID={first}; export it" in capsys.readouterr().out


@pytest.mark.parametrize("value", ["233", "mine", "-1", ""])
def test_another_value_is_left_to_the_launch_file(value):
    with launch_domain([f"domain:={value}"]) as words:
        assert words == [f"domain:={value}"]
        assert os.environ["ROS_DOMAIN_ID"] == "7"
