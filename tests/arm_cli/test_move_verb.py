"""`arm move`: what it refuses before it looks for a robot."""

import pytest

from arm_cli.main import main


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "arm move: say where to: --pose X Y Z, --state NAME or --joints JOINT=POSITION\n"),
        (["--pose", "1", "2"], "arm move: --pose takes X Y Z or X Y Z ROLL PITCH YAW, not 2"),
        (["--state", "home", "--joints", "j=1"], "not allowed with argument --state"),
        (["--state", "home", "--speed", "0"], "--speed"),
        (["--pose", "x", "y", "z"], "--pose"),
    ],
)
def test_a_mistake_in_the_arguments_is_named(words, sentence, capfd):
    try:
        code = main(["move", *words])
    except SystemExit as exit_:
        code = exit_.code
    assert code == 2
    assert sentence in capfd.readouterr().err
