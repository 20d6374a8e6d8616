"""`arm check`: the report, its forms, and the exit code."""

import json
import sys

import pytest

from arm_cli.main import main
from arm_description.resources import find_package

LIMIT = '<limit lower="-1" upper="1" effort="50" velocity="2"/>'
MASS = '<inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial>'
ARM = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '<xacro:arg name="mesh" default="part.stl"/>\n'
    f'<link name="base"/><link name="arm">{MASS}\n'
    '<visual><geometry><mesh filename="$(arg mesh)"/></geometry></visual></link>\n'
    '<joint name="j" type="revolute"><parent link="base"/><child link="arm"/>'
    f'<axis xyz="0 1 0"/>{LIMIT}</joint></robot>'
)
TRIANGLES = "solid s\n" + "".join(
    f"facet normal 0 0 0\nouter loop\n{''.join(f'vertex {v}{chr(10)}' for v in corners)}"
    "endloop\nendfacet\n"
    for corners in (
        ("0 0 0", "0 1 0", "1 0 0"),
        ("0 0 0", "1 0 0", "0 0 1"),
        ("1 0 0", "0 1 0", "0 0 1"),
        ("0 0 0", "0 0 1", "0 1 0"),
    )
)


@pytest.fixture
def arm(tmp_path, monkeypatch):
    """A xacro file with its mesh in the folder beside it."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    package = tmp_path / "my_arm"
    (package / "meshes").mkdir(parents=True)
    (package / "urdf").mkdir()
    (package / "meshes" / "part.stl").write_text(TRIANGLES)
    file = package / "urdf" / "arm.urdf.xacro"
    file.write_text(ARM)
    return file


@pytest.mark.parametrize("uri", ["package://my_arm/meshes/part.stl", "../meshes/part.stl"])
def test_a_good_robot_is_usable(arm, capsys, uri):
    assert main(["check", str(arm), f"mesh:={uri}", "--strict"]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed[0] == (
        "robot 'r', root 'base': 2 links, 1 joint (1 revolute), 1 driven, 1 kg, "
        "1 mesh of 4 triangles"
    )
    folder = arm.parents[1]
    shown = [f"package 'my_arm': {folder} (the file's own)"] if "package:" in uri else []
    assert [line for line in printed if line.startswith("package ")] == shown
    assert printed[-1] == "usable: 1 note"


def test_a_missing_mesh_is_replaced_and_the_searched_folders_are_reported(arm, capsys):
    assert main(["check", str(arm), "mesh:=gone.stl"]) == 0
    printed = capsys.readouterr().out
    assert "repaired  link 'arm'" in printed
    assert str(arm.parent / "gone.stl") in printed
    assert "a box of 5 cm replaces it" in printed


def test_strict_makes_a_missing_mesh_an_error(arm, capsys):
    assert main(["check", str(arm), "mesh:=gone.stl", "--strict"]) == 1
    assert capsys.readouterr().out.splitlines()[-1] == "not usable: 1 note, 1 error"


def test_the_package_path_is_searched(arm, capsys, tmp_path):
    (tmp_path / "elsewhere" / "other").mkdir(parents=True)
    (tmp_path / "elsewhere" / "other" / "a.stl").write_text(TRIANGLES)
    words = ["check", str(arm), "mesh:=package://other/a.stl", "--strict"]
    assert main(words) == 1
    assert main([*words, "--package-path", f"/no/such:{tmp_path / 'elsewhere'}"]) == 0


def test_the_robot_file_may_be_in_the_package_path(arm, capsys):
    folders = ["--package-path", str(arm.parents[2])]
    inside = arm.relative_to(arm.parents[2])
    assert main(["check", f"package://{inside}", *folders]) == 0


@pytest.fixture
def namesake(tmp_path, monkeypatch):
    """A user's package with the name of an installed one, whose prefix comes first."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", sys.prefix)
    package = tmp_path / "source" / "Arm-Description"
    (package / "urdf").mkdir(parents=True)
    (package / "meshes").mkdir()
    (package / "package.xml").write_text("<package><name>arm_description</name></package>")
    installed = find_package("arm_description") / "meshes"
    (mesh,) = sorted(installed.glob("*.stl"))[:1]
    (package / "meshes" / mesh.name).write_text(TRIANGLES)
    (package / "urdf/part.xacro").write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="mine"/></robot>'
    )
    (package / "urdf/arm.xacro").write_text(
        ARM.replace(
            '<link name="base"/>',
            '<xacro:include filename="$(find arm_description)/urdf/part.xacro"/>'
            '<link name="base"/><joint name="m" type="fixed"><parent link="base"/>'
            '<child link="mine"/></joint>',
        ).replace("part.stl", f"package://arm_description/meshes/{mesh.name}")
    )
    return package


def test_an_installed_package_does_not_shadow_the_users_own(namesake, capsys):
    assert main(["check", str(namesake / "urdf/arm.xacro"), "--strict"]) == 0
    summary, package, *_ = capsys.readouterr().out.splitlines()
    assert "3 links" in summary
    assert summary.endswith("1 mesh of 4 triangles")
    assert package == f"package 'arm_description': {namesake} (the file's own)"


def test_the_package_path_takes_precedence_over_installed_packages(namesake, capsys, tmp_path):
    file = tmp_path / "elsewhere" / "urdf" / "arm.xacro"
    file.parent.mkdir(parents=True)
    (namesake / "urdf/arm.xacro").rename(file)
    assert main(["check", str(file), "--strict"]) == 1
    capsys.readouterr()
    words = ["check", str(file), "--strict", "--package-path", str(namesake.parent)]
    assert main([*words, "--json"]) == 0
    packages = json.loads(capsys.readouterr().out)["packages"]
    folder, origin = str(namesake), "from the package path"
    assert packages == [{"name": "arm_description", "folder": folder, "origin": origin}]


def test_json(arm, capsys):
    assert main(["check", str(arm), "mesh:=gone.stl", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["usable"] is True
    assert report["robot"]["joints"] == {"revolute": 1}
    [_, finding] = report["findings"]
    assert (finding["outcome"], finding["element"]) == ("repaired", "link 'arm'")
    assert finding["line"] > 0


def test_the_report_s_line_numbers_are_those_of_the_expanded_urdf(arm, capsys):
    assert main(["check", str(arm), "mesh:=gone.stl", "--json"]) == 0
    line = json.loads(capsys.readouterr().out)["findings"][1]["line"]
    assert main(["check", str(arm), "mesh:=gone.stl", "--urdf"]) == 0
    assert '<link name="arm">' in capsys.readouterr().out.splitlines()[line - 1]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["/no/such.urdf"], "arm check: cannot read /no/such.urdf"),
        (["package://no_such/a.urdf"], "arm check: no file for 'package://no_such/a.urdf'"),
        (["{arm}", "mesh"], "arm check: the xacro argument 'mesh' is not NAME:=VALUE"),
    ],
)
def test_wrong_arguments_are_reported(arm, capsys, words, sentence):
    assert main(["check", *(word.format(arm=arm) for word in words)]) == 1
    assert capsys.readouterr().err.startswith(sentence)


def test_a_file_that_is_not_a_robot_is_an_error_with_its_line(tmp_path, capsys):
    file = tmp_path / "a.urdf"
    file.write_text('<robot name="r">\n<link/></robot>')
    assert main(["check", str(file)]) == 1
    assert f"error  {file} (line 2): <link> needs the attribute 'name'" in capsys.readouterr().out


def test_a_world_is_checked_too(tmp_path, capsys):
    file = tmp_path / "lab.world"
    file.write_text('<sdf version="1.9"><world name="lab"><actor name="walker"/></world></sdf>')
    assert main(["check", str(file)]) == 0
    out = capsys.readouterr().out
    assert out.splitlines()[0].endswith("; 1 thing is left out: actor 'walker' in lab.world")
    assert "\\n" not in out
    assert out.splitlines()[-1] == "usable: 1 left out"
    assert main(["check", "--json", str(file)]) == 0
    assert json.loads(capsys.readouterr().out)["world"]["name"] == "lab"


def xacro(inside):
    return f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{inside}</robot>'


def test_a_xacro_that_never_ends_is_stopped(tmp_path, capsys):
    file = tmp_path / "a.urdf.xacro"
    file.write_text(xacro('<link name="${len([0 for x in range(10**9) if x &lt; 0])}"/>'))
    assert main(["check", str(file), "--timeout", "0.5"]) == 1
    said = capsys.readouterr().err
    assert said == f"arm check: checking {file} takes more than 0.5 s; --timeout allows more\n"


def test_a_xacro_that_takes_all_memory_is_reported(tmp_path, capsys):
    file = tmp_path / "a.urdf.xacro"
    file.write_text(xacro("<link name=\"${len('x' * 10**11)}\"/>"))
    assert main(["check", str(file), "--memory-limit", "500"]) == 1
    said = capsys.readouterr().err
    assert said.startswith("arm check: ")
    assert "there is not enough memory" in said
    assert said.count("\n") == 1


def test_a_check_process_that_ends_early_is_reported(arm, capsys, monkeypatch):
    monkeypatch.setattr("arm_cli.check.MODULE", "arm_cli.no_such_module")
    assert main(["check", str(arm)]) == 1
    assert "the process of the check ended with exit code 1" in capsys.readouterr().err


def test_an_error_after_xacro_refers_to_the_expanded_text(arm, capsys):
    arm.write_text(ARM.replace('<link name="base"/>', "<link/>"))
    assert main(["check", str(arm)]) == 1
    printed = capsys.readouterr().out
    assert f"error  {arm}, expanded (line 7): <link> needs the attribute 'name'" in printed
    assert printed.count(str(arm)) == 1
    assert main(["check", "--urdf", str(arm)]) == 0
    assert capsys.readouterr().out.splitlines()[6].strip() == "<link/>"
