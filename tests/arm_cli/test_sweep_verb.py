"""`arm sweep`: what it prints, and its exit code."""

import pytest

from arm_cli.main import main

TASK = """
def double(run):
    if run.values["x"] == 3:
        raise ValueError("three")
    return {"double": 2 * run.values["x"]}
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "task.py").write_text(TASK)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_study_prints_its_tables_and_goes_on_later(folder, capsys):
    (folder / "s.yaml").write_text("task: task.py:double\nvariations: {x: [1, 2]}\n")
    assert main(["sweep", "s.yaml", "--processes", "1"]) == 0
    assert "s-results/runs.csv\ns-results/runs.parquet\n" in capsys.readouterr().out
    assert "0,1,2,," in (folder / "s-results" / "runs.csv").read_text()
    assert main(["sweep", "s.yaml"]) == 0
    assert "2 of 2 runs were made before" in capsys.readouterr().out


def test_a_failed_run_is_told_and_the_exit_code_is_1(folder, capsys):
    (folder / "s.yaml").write_text("task: task.py:double\nvariations: {x: [2, 3]}\n")
    assert main(["sweep", "s.yaml", "--output", "out", "--processes", "1"]) == 1
    printed = capsys.readouterr()
    assert "run 1 failed: ValueError: three (task.py:4)" in " ".join(printed.out.split())
    assert "1 of 2 runs failed; the tables say why" in printed.err


def test_what_is_not_a_study_is_a_sentence(folder, capsys):
    assert main(["sweep", "none.yaml"]) == 1
    assert capsys.readouterr().err == "arm sweep: none.yaml does not exist\n"
