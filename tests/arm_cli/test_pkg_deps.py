"""`arm pkg deps`: what package.xml files need, and where it comes from."""

import json
import subprocess

import pytest

from arm_cli.main import main


@pytest.fixture
def workspace(tmp_path):
    """Return a function that writes a package with dependencies into a folder src."""

    def write(name: str, *dependencies: str, below: str = "src"):
        folder = tmp_path / below / name
        folder.mkdir(parents=True)
        lines = "".join(f"<exec_depend>{each}</exec_depend>" for each in dependencies)
        (folder / "package.xml").write_text(
            f"<package><name>{name}</name><buildtool_depend>ament_cmake</buildtool_depend>{lines}"
            "</package>"
        )
        return tmp_path / "src"

    return write


def test_each_is_named_with_where_it_comes_from(workspace, capsys):
    workspace("arm_a", "rclpy", "python3-numpy", "controller_manager", "ament_lint_auto")
    src = workspace("arm_b", "arm_a", "rclpy", "moveit_core", "python3-no-such")
    assert main(["pkg", "deps", str(src)]) == 1
    lines = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    said = {name: " ".join(rest.split()) for name, rest in lines}
    assert said == {
        "controller_manager": "this suite installed for arm_a",
        "moveit_core": "only apt: ros-jazzy-moveit-core missing for arm_b",
        "python3-no-such": "only apt: python3-no-such missing for arm_b",
        "python3-numpy": "pip: numpy installed for arm_a",
        "rclpy": "ROS installed for arm_a, arm_b",
    }


def test_nothing_missing_is_success(workspace, capsys):
    src = workspace("arm_a", "rclpy")
    assert main(["pkg", "deps", str(src), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == [
        {"name": "rclpy", "needed_by": ["arm_a"], "source": "ROS", "installed": True}
    ]


def test_only_what_pip_has_is_installed(workspace, monkeypatch, capsys):
    src = workspace("arm_a", "python3-transforms3d", "moveit_core", "rclpy", "xacro")
    ran: list[list[str]] = []

    def take(command, **_):
        ran.append(command)
        return subprocess.CompletedProcess(command, 0)

    monkeypatch.setattr(subprocess, "run", take)
    assert main(["pkg", "deps", str(src), "--install"]) == 1
    assert [command[1:] for command in ran] == [["-m", "pip", "install", "transforms3d"]]
    assert "moveit_core" in capsys.readouterr().out


def test_built_and_ignored_folders_are_not_searched(workspace, tmp_path, capsys):
    src = workspace("arm_a", "rclpy")
    workspace("copy", "moveit_core", below="src/build")
    workspace("old", "moveit_core", below="src")
    (src / "old" / "COLCON_IGNORE").touch()
    assert main(["pkg", "deps", str(src)]) == 0
    assert "moveit_core" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "said", "code"),
    [(None, "no package.xml in", 1), ("<package>", "package.xml cannot be read", 2)],
)
def test_a_folder_without_a_package_is_said(tmp_path, capsys, content, said, code):
    if content is not None:
        (tmp_path / "package.xml").write_text(content)
    assert main(["pkg", "deps", str(tmp_path)]) == code
    assert said in capsys.readouterr().err
    assert main(["pkg", "deps", str(tmp_path / "no")]) == 1
    assert "no folder" in capsys.readouterr().err
