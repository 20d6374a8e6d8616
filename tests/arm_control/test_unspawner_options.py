"""The unspawner's command line."""

import pytest

from arm_control.unspawner_options import UnspawnerOptions, parse_unspawner_options


def test_names_and_options_may_be_mixed() -> None:
    assert parse_unspawner_options(["a", "-c", "/m", "b"]) == UnspawnerOptions(
        ("a", "b"), "/m", 5.0
    )
    assert parse_unspawner_options(["a", "--switch-timeout", "0.5"]) == UnspawnerOptions(
        ("a",), "controller_manager", 0.5
    )


@pytest.mark.parametrize("arguments", [[], ["a", "--switch-timeout", "-1"], ["a", "--force"]])
def test_a_wrong_command_line_ends_with_code_2(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        parse_unspawner_options(arguments)
    assert end.value.code == 2
    assert "unspawner: error:" in capsys.readouterr().err
