"""`arm sweep`: what it prints, and its exit code."""

import socket
import sys

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
    assert "2 of 2 runs are already done" in capsys.readouterr().out


def test_a_failed_run_is_told_and_the_exit_code_is_1(folder, capsys):
    (folder / "s.yaml").write_text("task: task.py:double\nvariations: {x: [2, 3]}\n")
    assert main(["sweep", "s.yaml", "--output", "out", "--processes", "1"]) == 1
    printed = capsys.readouterr()
    assert "run 1 failed: ValueError: three (task.py:4)" in " ".join(printed.out.split())
    assert "1 of 2 runs failed; the tables say why" in printed.err


def test_what_is_not_a_study_is_a_sentence(folder, capsys):
    assert main(["sweep", "none.yaml"]) == 1
    assert capsys.readouterr().err == "arm sweep: none.yaml does not exist\n"


def test_an_address_without_a_cluster_is_a_sentence(folder, capsys):
    (folder / "s.yaml").write_text("task: task.py:double\nvariations: {x: [1, 2]}\n")
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = f"127.0.0.1:{server.getsockname()[1]}"
    assert main(["sweep", "s.yaml", "--ray", address]) == 1
    refused = f"arm sweep: no Ray cluster listens at {address}: Connection refused\n"
    assert capsys.readouterr().err == refused
    assert main(["sweep", "s.yaml", "--ray", "here"]) == 1
    assert "'here' is not the address of a Ray cluster: HOST:PORT" in capsys.readouterr().err


def test_without_ray_its_extra_is_named(folder, capsys, monkeypatch):
    (folder / "s.yaml").write_text("task: task.py:double\nvariations: {x: [1, 2]}\n")
    monkeypatch.setitem(sys.modules, "ray", None)
    monkeypatch.delitem(sys.modules, "arm_sim.sweep.ray_pool", raising=False)
    assert main(["sweep", "s.yaml", "--ray", "auto"]) == 1
    sentence = "arm sweep: Ray is not installed; pip install 'arm-suite[ray]'\n"
    assert capsys.readouterr().err == sentence
