"""The code in the example's README."""

import re
from pathlib import Path

import pytest

from arm_control import ControllerContext, ControllerManager, SwitchRequest
from arm_control.testing import fake_hardware

README = Path(__file__).parents[2] / "examples" / "servo_arm" / "README.md"


def test_the_controller_in_twenty_lines_works():
    (code,) = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    names: dict = {"__name__": "readme"}
    exec(compile(code, str(README), "exec"), names)
    hardware = fake_hardware(("j0", "j1"), command_interfaces=("effort",))
    manager = ControllerManager([hardware], 100)
    manager.bring_up()
    controller = names["SpringController"](ControllerContext("spring", 100))
    manager.load_controller(controller, "spring", ())
    values = {"joints": ("j0", "j1"), "target": 0.5, "p": 2.0}
    manager.configure_controller("spring", controller.build_parameters(values), 100)
    assert manager.switch_controller(SwitchRequest(activate=("spring",))).ok

    manager.update(0.0, 0.01)

    assert hardware.commands == pytest.approx([1.0, 1.0])
    assert len([line for line in code.splitlines() if line.strip()]) <= 20
