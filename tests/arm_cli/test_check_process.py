"""What the process of `arm check` answers: the report, its forms, and the exit code."""

import argparse
import json
import sys

import pytest

from arm_cli.check_process import check
from arm_cli.errors import ArmCliError
from arm_description.resources import resolve_uri

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


def answer(file, *arguments, **options):
    """Return the report on a file, and the exit code."""
    defaults = {"package_path": "", "strict": False, "json": False, "urdf": False}
    words = {"file": str(file), "arguments": list(arguments), **defaults, **options}
    return check(argparse.Namespace(**words))


@pytest.mark.parametrize("uri", ["package://my_arm/meshes/part.stl", "../meshes/part.stl"])
def test_a_good_robot_is_usable(arm, uri):
    text, code = answer(arm, f"mesh:={uri}", strict=True)
    assert code == 0
    printed = text.splitlines()
    assert printed[0] == (
        "robot 'r', root 'base': 2 links, 1 joint (1 revolute), 1 driven, 1 kg, "
        "1 mesh of 4 triangles"
    )
    folder = arm.parents[1]
    shown = [f"package 'my_arm': {folder} (the file's own)"] if "package:" in uri else []
    assert [line for line in printed if line.startswith("package ")] == shown
    assert printed[-1] == "usable: 1 note"


def test_a_missing_mesh_is_replaced_and_the_searched_folders_are_reported(arm):
    printed, code = answer(arm, "mesh:=gone.stl")
    assert code == 0
    assert "repaired  link 'arm'" in printed
    assert str(arm.parent / "gone.stl") in printed
    assert "a box of 5 cm replaces it" in printed


def test_strict_makes_a_missing_mesh_an_error(arm):
    text, code = answer(arm, "mesh:=gone.stl", strict=True)
    assert (text.splitlines()[-1], code) == ("not usable: 1 note, 1 error", 1)


def test_the_package_path_is_searched(arm, tmp_path):
    (tmp_path / "elsewhere" / "other").mkdir(parents=True)
    (tmp_path / "elsewhere" / "other" / "a.stl").write_text(TRIANGLES)
    for path, expected in (("", 1), (f"/no/such:{tmp_path / 'elsewhere'}", 0)):
        _, code = answer(arm, "mesh:=package://other/a.stl", strict=True, package_path=path)
        assert code == expected


def test_the_robot_file_may_be_in_the_package_path(arm):
    folder = arm.parents[2]
    _, code = answer(f"package://{arm.relative_to(folder)}", package_path=str(folder))
    assert code == 0


@pytest.fixture
def namesake(tmp_path, monkeypatch):
    """A user's package with the name of an installed one, whose prefix comes first."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", sys.prefix)
    package = tmp_path / "source" / "Arm-Description"
    (package / "urdf").mkdir(parents=True)
    (package / "meshes").mkdir()
    (package / "package.xml").write_text("<package><name>arm_description</name></package>")
    installed = resolve_uri("package://arm_description/meshes")
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


def test_an_installed_package_does_not_shadow_the_users_own(namesake):
    text, code = answer(namesake / "urdf/arm.xacro", strict=True)
    assert code == 0
    summary, package, *_ = text.splitlines()
    assert "3 links" in summary
    assert summary.endswith("1 mesh of 4 triangles")
    assert package == f"package 'arm_description': {namesake} (the file's own)"


def test_the_package_path_takes_precedence_over_installed_packages(namesake, tmp_path):
    file = tmp_path / "elsewhere" / "urdf" / "arm.xacro"
    file.parent.mkdir(parents=True)
    (namesake / "urdf/arm.xacro").rename(file)
    with pytest.raises(ArmCliError, match=r"share/arm_description/urdf/part\.xacro"):
        answer(file, strict=True)
    text, code = answer(file, strict=True, package_path=str(namesake.parent), json=True)
    assert code == 0
    packages = json.loads(text)["packages"]
    folder, origin = str(namesake), "from the package path"
    assert packages == [{"name": "arm_description", "folder": folder, "origin": origin}]


def test_json(arm):
    text, code = answer(arm, "mesh:=gone.stl", json=True)
    assert code == 0
    report = json.loads(text)
    assert report["usable"] is True
    assert report["robot"]["joints"] == {"revolute": 1}
    [_, finding] = report["findings"]
    assert (finding["outcome"], finding["element"]) == ("repaired", "link 'arm'")
    assert finding["line"] > 0


def test_the_report_s_line_numbers_are_those_of_the_expanded_urdf(arm):
    line = json.loads(answer(arm, "mesh:=gone.stl", json=True)[0])["findings"][1]["line"]
    urdf, code = answer(arm, "mesh:=gone.stl", urdf=True)
    assert code == 0
    assert '<link name="arm">' in urdf.splitlines()[line - 1]


@pytest.mark.parametrize(
    ("file", "arguments", "sentence"),
    [
        ("/no/such.urdf", [], "cannot read /no/such.urdf"),
        ("package://no_such/a.urdf", [], "no file for 'package://no_such/a.urdf'"),
        ("{arm}", ["mesh"], "the xacro argument 'mesh' is not NAME:=VALUE"),
    ],
)
def test_wrong_arguments_are_reported(arm, file, arguments, sentence):
    with pytest.raises(ArmCliError, match=f"^{sentence}"):
        answer(file.format(arm=arm), *arguments)


def test_a_file_that_is_not_a_robot_is_an_error_with_its_line(tmp_path):
    file = tmp_path / "a.urdf"
    file.write_text('<robot name="r">\n<link/></robot>')
    text, code = answer(file)
    assert f"error  {file} (line 2): <link> needs the attribute 'name'" in text
    assert code == 1


def test_a_world_is_checked_too(tmp_path):
    file = tmp_path / "lab.world"
    file.write_text('<sdf version="1.9"><world name="lab"><actor name="walker"/></world></sdf>')
    out, code = answer(file)
    assert code == 0
    assert out.splitlines()[0].endswith("; 1 thing is left out: actor 'walker' in lab.world")
    assert "\\n" not in out
    assert out.splitlines()[-1] == "usable: 1 left out"
    assert json.loads(answer(file, json=True)[0])["world"]["name"] == "lab"


def test_an_error_after_xacro_refers_to_the_expanded_text(arm):
    arm.write_text(ARM.replace('<link name="base"/>', "<link/>"))
    printed, code = answer(arm)
    assert code == 1
    assert f"error  {arm}, expanded (line 7): <link> needs the attribute 'name'" in printed
    assert printed.count(str(arm)) == 1
    assert answer(arm, urdf=True)[0].splitlines()[6].strip() == "<link/>"
