"""The hardware spawner's command line."""

import pytest

from arm_control.hardware_spawner_options import (
    HardwareSpawnerOptions,
    parse_hardware_spawner_options,
)
from arm_control.lifecycle import LifecycleState


def test_a_target_must_be_chosen() -> None:
    assert parse_hardware_spawner_options(["a", "b", "--activate"]) == HardwareSpawnerOptions(
        ("a", "b"), LifecycleState.ACTIVE, "controller_manager", 0.0
    )
    arguments = ["a", "--configure", "-c", "m", "--controller-manager-timeout", "2.5"]
    assert parse_hardware_spawner_options(arguments) == HardwareSpawnerOptions(
        ("a",), LifecycleState.INACTIVE, "m", 2.5
    )


@pytest.mark.parametrize(
    "arguments", [[], ["a"], ["--activate"], ["a", "--activate", "--configure"], ["-c", "m"]]
)
def test_a_wrong_command_line_ends_with_code_2(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        parse_hardware_spawner_options(arguments)
    assert end.value.code == 2
    assert "hardware_spawner: error:" in capsys.readouterr().err
