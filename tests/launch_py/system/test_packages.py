"""Finding packages, launch files and executables."""

import os
import sys

import pytest

from launch_py.errors import NotFoundError
from launch_py.system.packages import Packages, ament_prefixes


@pytest.fixture
def site(tmp_path):
    """A folder on the Python path with one distribution in it."""
    entry_points = tmp_path / "site" / "demo-1.0.dist-info" / "entry_points.txt"
    entry_points.parent.mkdir(parents=True)
    entry_points.write_text(
        "[console_scripts]\n# a comment\nspin = demo_nodes.spin:main\n"
        "stop = demo_nodes.stop:Application.run [extra]\n\n[other]\nspin = wrong:main\n"
        "\n[launch_py.packages]\ndemo_nodes_cpp = demo_nodes\ndemo = demo_nodes\n"
        "[launch_py.programs]\nexpand = demo_nodes.expand:main\n"
    )
    return str(tmp_path / "site")


@pytest.fixture
def packages(package_prefix, site):
    package_prefix("demo", "talker")
    return Packages(os.environ, [site, "/nowhere"])


def test_a_console_script_runs_with_this_python(packages):
    command = packages.executable("demo_nodes", "spin")
    assert command[:3] == (sys.executable, "-P", "-c")
    assert "sys.argv[0] = 'spin'; " in command[3]
    assert "from demo_nodes.spin import main; " in command[3]
    assert command[3].endswith("sys.exit(main())")


def test_a_console_script_may_be_an_attribute(packages):
    code = packages.executable("demo_nodes", "stop")[3]
    assert "from demo_nodes.stop import Application; " in code
    assert code.endswith("sys.exit(Application.run())")


def test_a_program_of_a_prefix(packages, package_prefix):
    (path,) = packages.executable("demo", "talker")
    assert path.endswith("/lib/demo/talker")


def test_an_unknown_package_suggests_a_similar_one(packages):
    with pytest.raises(NotFoundError, match=r"no package 'dmo'.*did you mean 'demo'"):
        packages.executable("dmo", "talker")


def test_an_unknown_package_of_a_known_executable_says_where_it_is(packages):
    with pytest.raises(NotFoundError, match="'spin' is in package 'demo_nodes'"):
        packages.executable("robot_stuff", "spin")


def test_a_missing_package_may_have_a_stand_in(packages):
    assert packages.executable("demo_nodes_cpp", "spin") == packages.executable(
        "demo_nodes", "spin"
    )
    with pytest.raises(NotFoundError, match="'demo_nodes' has no executable 'zzz'"):
        packages.executable("demo_nodes_cpp", "zzz")


def test_an_installed_package_needs_no_stand_in(packages):
    with pytest.raises(NotFoundError, match="'demo' has no executable 'spin'"):
        packages.executable("demo", "spin")


def test_an_unknown_executable_lists_what_there_is(packages):
    with pytest.raises(
        NotFoundError, match="'demo_nodes' has no executable 'zzz'; it has spin, st"
    ):
        packages.executable("demo_nodes", "zzz")


def test_the_first_prefix_wins(package_prefix, tmp_path, monkeypatch):
    share = package_prefix("demo")
    overlay = tmp_path / "overlay"
    marker = overlay / "share" / "ament_index" / "resource_index" / "packages" / "demo"
    marker.parent.mkdir(parents=True)
    marker.touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{overlay}:{share.parents[1]}")
    assert Packages(os.environ).share_folder("demo") == overlay / "share" / "demo"


def test_this_python_is_always_searched():
    assert ament_prefixes({}) == [sys.prefix]
    assert ament_prefixes({"AMENT_PREFIX_PATH": f"/a::{sys.prefix}"}) == ["/a", sys.prefix]


def test_a_launch_file_is_found_by_its_name(package_prefix):
    share = package_prefix("demo")
    (share / "launch" / "a.launch.py").touch()
    (share / "more").mkdir()
    (share / "more" / "b.launch.py").touch()
    packages = Packages(os.environ)
    assert packages.launch_file("demo", "a.launch.py") == share / "launch" / "a.launch.py"
    assert packages.launch_file("demo", "b.launch.py") == share / "more" / "b.launch.py"
    # As in roslaunch.
    assert packages.launch_file("demo", "a.launch") == share / "launch" / "a.launch.py"
    with pytest.raises(NotFoundError, match=r"no launch file 'a.lanch'; did you mean 'a.launch.py"):
        packages.launch_file("demo", "a.lanch")


def test_a_workspace_always_takes_precedence_over_this_python(tmp_path, monkeypatch):
    marker = tmp_path / "share/ament_index/resource_index/packages/launch_py"
    marker.parent.mkdir(parents=True)
    marker.touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{sys.prefix}:{tmp_path}")
    assert Packages(os.environ).share_folder("launch_py") == tmp_path / "share" / "launch_py"


def test_a_distribution_may_replace_a_program(package_prefix, site):
    packages = Packages(os.environ, [site])
    for program in ("expand", "/usr/bin/expand"):
        assert "from demo_nodes.expand import main; " in packages.stand_in(program)[3]
    assert packages.stand_in("echo") is None


def test_a_distribution_that_is_installed_later_is_found(package_prefix, site, tmp_path):
    packages = Packages(os.environ, [site])
    assert packages.node_names("talk") == []
    later = tmp_path / "site" / "later-1.0.dist-info"
    later.mkdir()
    (later / "entry_points.txt").write_text("[launch_py.nodes]\ntalk = talker\n")
    assert packages.node_names("talk") == ["talker"]
