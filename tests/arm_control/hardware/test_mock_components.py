"""The mock hardware: a command appears in the next read."""

from collections.abc import Mapping
from math import isnan
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control.errors import HardwareInfoError
from arm_control.hardware.driver import HardwareReturn
from arm_control.hardware.info import parse_hardware_info
from arm_control.hardware.mock_components import GenericSystem

PERIOD_S = 0.1


class Mock:
    """A bound and active GenericSystem, with its interfaces by name."""

    def __init__(self, block: str, urdf: str = "", **parameters: str) -> None:
        params = "".join(f"<param name='{k}'>{v}</param>" for k, v in parameters.items())
        (info,) = parse_hardware_info(
            f"<robot name='r'>{urdf}<ros2_control name='H' type='system'><hardware>"
            f"<plugin>mock_components/GenericSystem</plugin>{params}</hardware>{block}"
            "</ros2_control></robot>"
        )
        self.hardware = GenericSystem(info)
        self._states = np.full(len(self.hardware.state_interfaces), np.nan)
        self._commands = np.full(len(self.hardware.command_interfaces), np.nan)
        self.hardware.bind(self._states, self._commands)
        assert self.hardware.on_configure()
        assert self.hardware.on_activate()

    def command(self, values: Mapping[str, float]) -> None:
        for name, value in values.items():
            self._commands[self.hardware.command_interfaces.index(name)] = value

    def cycle(self, count: int = 1) -> dict[str, float]:
        for _ in range(count):
            assert self.hardware.write(0.0, PERIOD_S) is HardwareReturn.OK
            assert self.hardware.read(0.0, PERIOD_S) is HardwareReturn.OK
        return self.states()

    def states(self) -> dict[str, float]:
        return dict(zip(self.hardware.state_interfaces, self._states.tolist(), strict=True))


def joint(name: str, commands: str = "position", states: str = "position velocity") -> str:
    return (
        f"<joint name='{name}'>"
        + "".join(f"<command_interface name='{c}'/>" for c in commands.split())
        + "".join(f"<state_interface name='{s}'/>" for s in states.split())
        + "</joint>"
    )


def test_states_begin_at_their_initial_values_or_at_zero():
    mock = Mock(
        "<joint name='j'><state_interface name='position'>"
        "<param name='initial_value'>3.45</param></state_interface>"
        "<state_interface name='velocity'/><state_interface name='strange'/></joint>"
        "<sensor name='s'><state_interface name='force'/></sensor>"
    )
    states = mock.states()
    assert (states["j/position"], states["j/velocity"]) == (3.45, 0.0)
    # Nothing says what these are.
    assert isnan(states["j/strange"])
    assert isnan(states["s/force"])


def test_a_command_shows_at_the_next_read_and_stays():
    mock = Mock(joint("a") + joint("b"))
    mock.command({"a/position": 1.0})
    assert mock.states()["a/position"] == 0.0
    assert mock.cycle()["a/position"] == 1.0
    assert mock.cycle()["a/position"] == 1.0
    assert mock.states()["b/position"] == 0.0


def test_each_quantity_is_mirrored_separately():
    mock = Mock(joint("a", "position velocity effort strange", "position velocity effort strange"))
    mock.command({"a/velocity": 2.0, "a/effort": 3.0, "a/strange": 4.0})
    assert mock.cycle(3) == {
        "a/position": 0.0,
        "a/velocity": 2.0,
        "a/effort": 3.0,
        "a/strange": 4.0,
    }


def test_a_state_that_is_not_commanded_keeps_its_value():
    mock = Mock(joint("a", "velocity", "position"))
    mock.command({"a/velocity": 2.0})
    assert mock.cycle(3) == {"a/position": 0.0}


def test_disabled_commands_go_nowhere(caplog):
    mock = Mock(joint("a"), disable_commands="True")
    mock.command({"a/position": 1.0})
    assert mock.cycle()["a/position"] == 0.0
    assert ("H", "disable_commands is true: the states will not move") in [
        (record.name, record.message) for record in caplog.records
    ]


def test_the_offset_is_added_to_positions():
    mock = Mock(joint("a"), position_state_following_offset="-0.5")
    assert mock.cycle()["a/position"] == 0.0
    mock.command({"a/position": 1.0})
    assert mock.cycle(2)["a/position"] == 0.5


def test_the_offset_may_go_to_another_interface():
    mock = Mock(
        joint("a", "position", "position actual"),
        position_state_following_offset="-0.5",
        custom_interface_with_following_offset="actual",
    )
    mock.command({"a/position": 1.0})
    assert mock.cycle() == {"a/position": 1.0, "a/actual": 0.5}


@pytest.mark.parametrize("parameter", ["mock_sensor_commands", "fake_sensor_commands"])
def test_sensors_can_be_commanded(parameter):
    sensor = "<sensor name='s'><state_interface name='f.x'/><state_interface name='f.y'/></sensor>"
    assert Mock(joint("a") + sensor).hardware.command_interfaces == ("a/position",)
    mock = Mock(joint("a") + sensor, **{parameter: "true"})
    assert mock.hardware.command_interfaces == ("a/position", "s/f.x", "s/f.y")
    mock.command({"s/f.y": 7.0})
    assert mock.cycle()["s/f.y"] == 7.0


def test_gpios_mirror_their_commands_and_all_states_on_demand():
    gpio = (
        "<gpio name='io'><command_interface name='out'/><state_interface name='out'/>"
        "<state_interface name='in'/></gpio>"
    )
    mock = Mock(gpio)
    mock.command({"io/out": 1.0})
    assert mock.cycle()["io/out"] == 1.0
    mock = Mock(gpio, mock_gpio_commands="true")
    assert mock.hardware.command_interfaces == ("io/out", "io/in")
    mock.command({"io/in": 2.0})
    assert mock.cycle()["io/in"] == 2.0


# Mimic joints

MIMIC = (
    "<joint name='b'><mimic joint='a' multiplier='-2' offset='0.5'/></joint>"
    "<joint name='c'><mimic joint='b'/></joint>"
)


def test_a_mimic_joint_follows_its_leader():
    block = joint("c", "") + joint("b", "") + joint("a", "position velocity")
    mock = Mock(block, MIMIC)
    assert mock.states()["b/position"] == 0.5
    mock.command({"a/position": 1.0, "a/velocity": 3.0})
    states = mock.cycle()
    assert (states["b/position"], states["b/velocity"]) == (-1.5, -6.0)
    assert (states["c/position"], states["c/velocity"]) == (-1.5, -6.0)


def test_mimic_false_makes_a_joint_independent():
    mock = Mock(joint("a") + joint("b").replace("'b'", "'b' mimic='false'"), MIMIC)
    mock.command({"a/position": 1.0, "b/position": 2.0})
    assert mock.cycle()["b/position"] == 2.0


@pytest.mark.parametrize(
    ("block", "says"),
    [
        (joint("b", ""), "joint 'b' mimics 'a', but has no such joint; it has b"),
        (joint("a") + joint("b"), "'b' mimics 'a', so it cannot be commanded"),
    ],
)
def test_a_mimic_joint_that_cannot_follow_is_refused(block, says):
    with pytest.raises(HardwareInfoError, match=says):
        Mock(block, MIMIC)


def test_joints_that_mimic_each_other_are_refused():
    circle = "<joint name='a'><mimic joint='b'/></joint><joint name='b'><mimic joint='a'/></joint>"
    with pytest.raises(HardwareInfoError, match="mimic each other in a circle: a, b"):
        Mock(joint("a", "") + joint("b", ""), circle)


# Dynamics

MOTION = "position velocity acceleration"


@pytest.fixture
def dynamic() -> Mock:
    return Mock(joint("a", f"{MOTION} effort", MOTION), calculate_dynamics="true")


def test_a_position_gives_velocity_and_acceleration(dynamic):
    dynamic.hardware.perform_command_mode_switch(["a/position"], [])
    dynamic.command({"a/position": 1.0})
    assert list(dynamic.cycle().values()) == pytest.approx([1.0, 10.0, 100.0])
    assert list(dynamic.cycle().values()) == pytest.approx([1.0, 0.0, -100.0])


def test_a_velocity_moves_the_position_from_the_next_cycle_on(dynamic):
    dynamic.hardware.perform_command_mode_switch(["a/velocity"], [])
    dynamic.command({"a/velocity": 2.0})
    assert list(dynamic.cycle().values()) == pytest.approx([0.0, 2.0, 20.0])
    assert list(dynamic.cycle(5).values()) == pytest.approx([1.0, 2.0, 0.0])


def test_an_acceleration_moves_velocity_and_position(dynamic):
    dynamic.hardware.perform_command_mode_switch(["a/acceleration"], [])
    dynamic.command({"a/acceleration": 1.0})
    assert list(dynamic.cycle().values()) == pytest.approx([0.0, 0.0, 1.0])
    assert list(dynamic.cycle(10).values()) == pytest.approx([0.45, 1.0, 1.0])


def test_a_read_without_time_between_is_harmless(dynamic):
    dynamic.command({"a/position": 1.0})
    dynamic.hardware.read(0.0, 0.0)
    assert dynamic.states() == {"a/position": 1.0, "a/velocity": 0.0, "a/acceleration": 0.0}


@pytest.mark.parametrize("start", [["a/position", "a/velocity"], ["a/effort"]])
def test_with_dynamics_a_joint_has_one_mode(dynamic, start):
    with pytest.raises(HardwareInfoError, match="joint 'a' has to be commanded by one of"):
        dynamic.hardware.prepare_command_mode_switch(start, [])


@pytest.mark.parametrize("start", [["a/position"], ["s/f.x"], []])
def test_other_modes_are_agreed_to(dynamic, start):
    assert dynamic.hardware.prepare_command_mode_switch(start, [])


@pytest.mark.parametrize(
    ("parameter", "text", "says"),
    [
        ("calculate_dynamics", "perhaps", "'calculate_dynamics' is 'perhaps'; it must be true or"),
        ("position_state_following_offset", "far", "'far'; it must be a finite number"),
    ],
)
def test_parameters_that_make_no_sense_are_refused(parameter, text, says):
    with pytest.raises(HardwareInfoError, match=says):
        Mock(joint("a"), **{parameter: text})


def test_all_of_it_follows_the_hardware_protocol():
    hardware: Any = Mock(joint("a")).hardware
    assert all(
        getattr(hardware, step)()
        for step in ("on_deactivate", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown")
    )


KINDS = ("position", "velocity", "acceleration", "effort", "temperature")
some_kinds = st.lists(st.sampled_from(KINDS), unique=True)


@given(
    declared=st.lists(st.tuples(some_kinds, some_kinds), min_size=1, max_size=5),
    order=st.randoms(use_true_random=False),
)
def test_each_command_shows_in_its_own_state_whatever_each_joint_declares(declared, order):
    named = [(f"j{i}", " ".join(c), " ".join(s)) for i, (c, s) in enumerate(declared)]
    order.shuffle(named)
    mock = Mock("".join(joint(*each) for each in named))
    before = mock.states()
    commands = {name: 0.5 + number for number, name in enumerate(mock.hardware.command_interfaces)}
    mock.command(commands)
    after = mock.cycle()
    for name, value in after.items():
        expected = commands.get(name, before[name])
        assert value == expected or (isnan(value) and isnan(expected)), name
