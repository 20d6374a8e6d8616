"""`arm check`: its options reach the process of the check, which is held within limits."""

import json

from arm_cli.main import main

MESH = '<visual><geometry><mesh filename="$(arg mesh)"/></geometry></visual>'


def xacro(inside):
    return f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{inside}</robot>'


def test_its_options_reach_the_process_and_its_answer_comes_back(tmp_path, capsys):
    file = tmp_path / "elsewhere" / "a.urdf.xacro"
    file.parent.mkdir()
    file.write_text(xacro(f'<xacro:arg name="mesh" default=""/><link name="a">{MESH}</link>'))
    words = ["check", f"package://elsewhere/{file.name}", "mesh:=gone.stl"]
    folders = ["--package-path", str(tmp_path)]
    assert main([*words, *folders, "--strict", "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["usable"] is False
    assert main([*words, *folders, "--urdf"]) == 0
    assert 'filename="gone.stl"' in capsys.readouterr().out
    assert main(words) == 1
    assert capsys.readouterr().err.startswith(f"arm check: no file for '{words[1]}'")


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


def test_a_check_process_that_ends_early_is_reported(capsys, monkeypatch):
    monkeypatch.setattr("arm_cli.check.MODULE", "arm_cli.no_such_module")
    assert main(["check", "a.urdf"]) == 1
    assert "the process of the check ended with exit code 1" in capsys.readouterr().err
