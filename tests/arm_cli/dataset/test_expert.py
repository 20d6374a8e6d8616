"""`arm dataset record`: options of experts and of running robots do not mix."""

import pytest

from arm_cli.main import main


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("--expert pick", "record needs one folder: arm dataset record DIR"),
        ("a -o b --expert pick", "record needs one folder: arm dataset record DIR"),
        ("a --expert pick --fps 30", "--fps is for the recording of a running robot"),
        ("a --task Lift. --seed 3", "--seed is for --expert"),
        ("a --task Lift. --ray auto", "--ray is for --expert"),
        ("a --expert pick --ray nowhere", "'nowhere' is not the address of a Ray cluster: HOST"),
        ("a", "record needs --task: what the demonstrations show, in words"),
        (". --expert pick --workers 1", ". exists; a dataset is written into a new folder"),
    ],
)
def test_what_does_not_fit_is_said(words, sentence, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert main(["dataset", "record", *words.split()]) == 1
    assert sentence in capsys.readouterr().err
