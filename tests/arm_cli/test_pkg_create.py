"""`arm pkg create`: the files that it writes, and its errors."""

import ast
import xml.etree.ElementTree as ET

import pytest
import yaml

from arm_cli.main import main


@pytest.fixture
def create(tmp_path, capsys):
    def run(*words: str) -> tuple[int, str, str]:
        code = main(["pkg", "create", "--destination-directory", str(tmp_path), *words])
        said = capsys.readouterr()
        return code, said.out, said.err

    return run


def files_of(folder):
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())


def test_it_writes_node_launch_file_config_test_and_readme(create, tmp_path):
    code, said, _ = create("my_arm")
    assert code == 0
    assert files_of(tmp_path / "my_arm") == [
        "README.md",
        "config/my_arm.yaml",
        "launch/my_arm.launch.py",
        "my_arm/__init__.py",
        "my_arm/my_arm_node.py",
        "package.xml",
        "pyproject.toml",
        "resource/my_arm",
        "setup.cfg",
        "setup.py",
        "test/test_my_arm_node.py",
    ]
    assert said.startswith("going to create a new package\npackage name: my_arm\n")
    assert f"pip install {tmp_path / 'my_arm'}\n  arm launch my_arm my_arm.launch.py\n" in said


def test_every_file_parses_and_every_placeholder_is_filled(create, tmp_path):
    create("my_arm", "--node-name", "mover", "--library-name", "kinematics")
    for path in (tmp_path / "my_arm").rglob("*"):
        if path.is_file():
            assert "@" not in path.read_text().replace("@pytest", "").replace("@todo.todo", "")
        if path.suffix == ".py":
            ast.parse(path.read_text())
    assert yaml.safe_load((tmp_path / "my_arm/config/my_arm.yaml").read_text())["mover"]
    assert (tmp_path / "my_arm/my_arm/mover.py").is_file()
    assert (tmp_path / "my_arm/my_arm/kinematics/__init__.py").is_file()


def test_the_options_of_ros2_reach_the_manifest(create, tmp_path):
    code, said, _ = create(
        *("my_arm", "--build-type", "ament_python", "--license", "Apache-2.0"),
        *("--maintainer-name", "Ada & Co", "--maintainer-email", "ada@example.org"),
        *("--description", "Moves <it>", "--dependencies", "rclpy", "tf2_msgs"),
    )
    assert code == 0
    root = ET.parse(tmp_path / "my_arm" / "package.xml").getroot()
    texts = {element.tag: element.text for element in root}
    assert (texts["license"], texts["description"]) == ("Apache-2.0", "Moves <it>")
    maintainer = root.find("maintainer")
    assert maintainer is not None
    assert (maintainer.text, maintainer.get("email")) == ("Ada & Co", "ada@example.org")
    assert [e.text for e in root.iter("depend")] == ["rclpy", "tf2_msgs"]
    # colcon refuses a package that is listed twice.
    assert "rclpy" not in [e.text for e in root.iter("exec_depend")]
    assert "put the text of Apache-2.0 into" in said


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ["my_arm", "--build-type", "ament_cmake"],
            "--build-type ament_cmake: there is no compiler here: packages of this suite "
            "are Python, for pip and colcon alike. Use --build-type ament_python",
        ),
        (["my_arm", "--build-type", "make"], "no build type 'make'; the only one is ament_python"),
        (["My-Arm"], "'My-Arm' is not a valid package name: use lower-case letters"),
        (["class"], "'class' is not a valid package name"),
        (["json"], "'json' is a module of Python"),
        (["my_arm", "--node-name", "a b"], "'a b' is not a valid node name"),
        (
            ["my_arm", "--library-name", "my_arm"],
            "library 'my_arm' has the name of the package or the node",
        ),
        (["arm_gazebo"], "there is already a package 'arm_gazebo', and one would hide the other"),
        (["my_arm", "--description", 'say "hi"'], "contains a quotation mark"),
    ],
)
def test_invalid_requests_are_reported_and_write_nothing(create, tmp_path, words, said):
    code, _, error = create(*words)
    assert code == 2
    assert error.startswith("arm pkg create: ")
    assert said in error
    assert files_of(tmp_path) == []


def test_an_existing_folder_stays_unchanged(create, tmp_path):
    (tmp_path / "my_arm").mkdir()
    code, _, error = create("my_arm")
    assert code == 2
    assert f"the directory already exists: {tmp_path / 'my_arm'}" in error
    assert files_of(tmp_path) == []
