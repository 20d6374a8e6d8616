"""`arm planning srdf`: what it prints and writes, and what it refuses."""

from pathlib import Path

import pytest
from robots import box, joint, link, robot

from arm_cli.main import main
from arm_description import parse_urdf
from arm_planning.robot.srdf import Srdf, parse_srdf

ARM = robot(
    link("base", box()),
    *(link(name, box(size=0.02)) for name in ("upper", "$(arg tip)")),
    joint("shoulder", "base", "upper", xyz="0 0 0.3"),
    joint("elbow", "upper", "$(arg tip)", xyz="0 0 0.2"),
)
XACRO = ARM.replace("<robot", "<robot xmlns:xacro='http://www.ros.org/wiki/xacro'", 1).replace(
    ">", "><xacro:arg name='tip' default='lower'/>", 1
)


@pytest.fixture(name="file")
def fixture_file(tmp_path) -> Path:
    file = tmp_path / "arm.urdf.xacro"
    file.write_text(XACRO)
    return file


def read(text: str, tip: str) -> Srdf:
    return parse_srdf(text, parse_urdf(ARM.replace("$(arg tip)", tip)), remark=pytest.fail)


def test_the_srdf_is_printed(file, capsys):
    assert main(["planning", "srdf", str(file)]) == 0
    srdf = read(capsys.readouterr().out, "lower")
    assert srdf.groups["arm"].chains == (("base", "lower"),)
    assert srdf.disabled == {
        ("base", "upper"): "Adjacent",
        ("lower", "upper"): "Adjacent",
        ("base", "lower"): "Never",
    }


def test_the_srdf_is_written(file, capsys):
    output = file.parent / "arm.srdf"
    assert main(["planning", "srdf", str(file), "tip:=hand", "-o", str(output)]) == 0
    assert not capsys.readouterr().out
    assert read(output.read_text(), "hand").groups["arm"].chains == (("base", "hand"),)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["nix.urdf"], "cannot read nix.urdf: No such file or directory"),
        (
            ["FILE", "--samples", "9999"],
            "9999 samples are too few to tell which links never touch; the least is 10000",
        ),
        (["FILE", "-o", "FILE"], "FILE already exists; remove it, or choose another"),
        (["FILE", "-o", "FILE/x"], "cannot write FILE/x: Not a directory"),
    ],
)
def test_what_is_not_possible_is_refused(file, capsys, words, sentence):
    given = [word.replace("FILE", str(file)) for word in words]
    assert main(["planning", "srdf", *given]) != 0
    expected = sentence.replace("FILE", str(file))
    assert capsys.readouterr().err.startswith(f"arm planning srdf: {expected}")


def test_a_file_that_is_not_a_robot_is_refused(tmp_path, capsys):
    file = tmp_path / "x.urdf"
    file.write_text("<robot name='r'/>")
    assert main(["planning", "srdf", str(file)]) == 1
    assert capsys.readouterr().err == f"arm planning srdf: {file}, the robot has no links\n"
