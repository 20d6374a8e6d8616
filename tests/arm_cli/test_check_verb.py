"""`arm check`: the report, its forms, and the exit code."""

import json

import pytest

from arm_cli.main import main

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
    assert printed[-1] == "usable: 1 note"


def test_a_missing_mesh_is_repaired_and_where_it_was_sought_is_said(arm, capsys):
    assert main(["check", str(arm), "mesh:=gone.stl"]) == 0
    printed = capsys.readouterr().out
    assert "repaired  link 'arm'" in printed
    assert str(arm.parent / "gone.stl") in printed
    assert "a box of 5 cm takes its place" in printed


def test_strict_makes_it_an_error(arm, capsys):
    assert main(["check", str(arm), "mesh:=gone.stl", "--strict"]) == 1
    assert capsys.readouterr().out.splitlines()[-1] == "not usable: 1 note, 1 error"


def test_the_package_path_is_searched(arm, capsys, tmp_path):
    (tmp_path / "elsewhere" / "other").mkdir(parents=True)
    (tmp_path / "elsewhere" / "other" / "a.stl").write_text(TRIANGLES)
    words = ["check", str(arm), "mesh:=package://other/a.stl", "--strict"]
    assert main(words) == 1
    assert main([*words, "--package-path", f"/no/such:{tmp_path / 'elsewhere'}"]) == 0


def test_the_robot_itself_may_lie_in_the_package_path(arm, capsys):
    folders = ["--package-path", str(arm.parents[2])]
    inside = arm.relative_to(arm.parents[2])
    assert main(["check", f"package://{inside}", *folders]) == 0


def test_json(arm, capsys):
    assert main(["check", str(arm), "mesh:=gone.stl", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["usable"] is True
    assert report["robot"]["joints"] == {"revolute": 1}
    [_, finding] = report["findings"]
    assert (finding["outcome"], finding["element"]) == ("repaired", "link 'arm'")
    assert finding["line"] > 0


def test_the_expanded_urdf_has_the_reports_lines(arm, capsys):
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
def test_words_that_make_no_sense_are_a_sentence(arm, capsys, words, sentence):
    assert main(["check", *(word.format(arm=arm) for word in words)]) == 1
    assert capsys.readouterr().err.startswith(sentence)


def test_a_file_that_is_no_robot_is_an_error_with_its_line(tmp_path, capsys):
    file = tmp_path / "a.urdf"
    file.write_text('<robot name="r">\n<link/></robot>')
    assert main(["check", str(file)]) == 1
    assert f"error  {file} (line 2): <link> needs the attribute 'name'" in capsys.readouterr().out
