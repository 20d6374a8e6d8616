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
        (["--pose", "x", "y", "z"], "argument --pose: 'x' is not a number"),
        (["--pose", "nan", "0", "0"], "argument --pose: 'nan' is not a number"),
        (["--joints", "j1=a"], "argument --joints: j1=a: write it as j1=0.5"),
        (["--joints", "inf"], "argument --joints: inf: write it as inf=0.5"),
        (
            ["--pose", "0.1", "0.1", "0.2", "0", "180", "0"],
            "arm move: --pose takes angles in rad, and 180 is 28.6 turns; 180 degrees are 3.142\n",
        ),
        (
            ["--state", "home", "--speed", "2"],
            "arm move: --speed is a fraction of the limits, up to 1, not 2\n",
        ),
        (["--state", "home", "--acceleration", "50"], "arm move: --acceleration is a fraction"),
    ],
)
def test_a_mistake_in_the_arguments_is_named(words, sentence, capfd):
    try:
        code = main(["move", *words])
    except SystemExit as exit_:
        code = exit_.code
    assert code == 2
    assert sentence in capfd.readouterr().err
