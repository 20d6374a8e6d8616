"""The broadcaster's core, with a sink that remembers."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from arm_control import (
    ControllerContext,
    ControllerManager,
    HardwareInfo,
    InterfaceInfo,
    JointInfo,
    SwitchRequest,
)
from arm_control.controllers.joint_state_broadcaster.controller import (
    InterfaceMap,
    JointStateBroadcaster,
    JointStateBroadcasterParameters,
    JointStateLayout,
)
from arm_control.testing import FakeHardware, fake_hardware

Parameters = JointStateBroadcasterParameters

URDF = """
<robot name="r"><link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/>
  <joint name="zeta" type="continuous"><parent link="base"/><child link="l1"/></joint>
  <joint name="alpha" type="continuous"><parent link="l1"/><child link="l2"/></joint>
  <joint name="welded" type="fixed"><parent link="l2"/><child link="l3"/></joint>
</robot>
"""


class Sink:
    """Records what was published."""

    def __init__(self) -> None:
        self.layouts: list[JointStateLayout] = []
        self.published: list[tuple[float, list[float]]] = []

    def open(self, layout: JointStateLayout) -> None:
        self.layouts.append(layout)

    def publish(
        self, time_s: float, joints: NDArray[np.float64], components: NDArray[np.float64]
    ) -> None:
        self.published.append((time_s, joints.tolist()))


Start = Callable[..., tuple[ControllerManager, Sink]]


@pytest.fixture
def start() -> Start:
    """Return a function that makes an active broadcaster over hardware."""

    def start_broadcaster(
        parameters: Parameters | None = None,
        hardware: FakeHardware | None = None,
        robot_description: str = "",
        expect: bool = True,
    ) -> tuple[ControllerManager, Sink]:
        manager = ControllerManager([hardware or fake_hardware()], 100)
        manager.bring_up()
        sink = Sink()
        broadcaster = JointStateBroadcaster(ControllerContext("jsb", 100, robot_description))
        manager.load_controller(broadcaster, "joint_state_broadcaster/JointStateBroadcaster")
        manager.configure_controller("jsb", parameters or Parameters())
        broadcaster.sink = sink
        assert manager.switch_controller(SwitchRequest(("jsb",))).ok is expect
        return manager, sink

    return start_broadcaster


def test_it_claims_nothing_and_reads_everything(start):
    manager, _ = start()
    (status,) = manager.list_controllers()
    assert status.claimed_interfaces == status.required_command_interfaces == ()
    assert len(status.required_state_interfaces) == 12


def test_it_publishes_at_every_tick_with_the_time_of_the_state(start):
    manager, sink = start(hardware=fake_hardware(("j0",), initial_positions={"j0": 0.5}))
    manager.publish(1.25, 0.01)
    manager.publish(1.26, 0.01)
    assert sink.published == [(1.25, [0.5, 0.0, 0.0]), (1.26, [0.5, 0.0, 0.0])]


def test_the_order_is_alphabetical_for_movable_joints_of_the_description(start):
    hardware = fake_hardware(("zeta", "alpha", "welded", "stranger"))
    _, sink = start(hardware=hardware, robot_description=URDF)
    assert sink.layouts[0].joints == ("alpha", "zeta")
    assert [name for name, _ in sink.layouts[0].components] == [
        "zeta",
        "alpha",
        "welded",
        "stranger",
    ]


@pytest.mark.parametrize("description", ["", "<robot", URDF])
def test_without_a_usable_description_or_filter_all_joints_stand_as_they_come(start, description):
    parameters = Parameters(use_urdf_to_filter=description != URDF)
    hardware = fake_hardware(("zeta", "stranger", "alpha"))
    _, sink = start(parameters, hardware, description)
    assert sink.layouts[0].joints == ("zeta", "stranger", "alpha")


def test_a_description_that_cannot_be_used_is_logged(start, caplog):
    start(robot_description="<robot")
    assert "robot description cannot be used, so all joints are published" in caplog.text


def test_joints_and_interfaces_choose_and_order(start):
    parameters = Parameters(joints=("j2", "j0"), interfaces=("position", "velocity"))
    manager, sink = start(parameters)
    assert manager.list_controllers()[0].required_state_interfaces == (
        "j2/position",
        "j2/velocity",
        "j0/position",
        "j0/velocity",
    )
    assert sink.layouts[0].joints == ("j2", "j0")
    manager.publish(0.0, 0.01)
    np.testing.assert_array_equal(sink.published[0][1], [0, 0, 0, 0, np.nan, np.nan])


@pytest.mark.parametrize(
    ("parameters", "empty"),
    [
        (Parameters(joints=("j3", "j1")), "interfaces"),
        (Parameters(interfaces=("position",)), "joints"),
    ],
)
def test_joints_or_interfaces_alone_choose_nothing(start, caplog, parameters, empty):
    manager, sink = start(parameters)
    assert f"'{empty}' parameter is empty" in caplog.text
    assert sink.layouts[0].joints == ("j0", "j1", "j2", "j3")
    assert len(manager.list_controllers()[0].required_state_interfaces) == 12


@pytest.mark.parametrize(
    ("joints", "interfaces", "missing"),
    [
        (("j0", "j9"), ("position",), "j9/position"),
        (("j0",), ("position", "torque"), "j0/torque"),
        (("j8", "j9"), ("torque",), "j8/torque"),
    ],
)
def test_a_missing_interface_fails_the_activation(start, joints, interfaces, missing):
    manager, _ = start(Parameters(joints=joints, interfaces=interfaces), expect=False)
    result = manager.switch_controller(SwitchRequest(("jsb",)))
    assert result.message == (
        f"Unable to activate controller 'jsb' since the state interface '{missing}' "
        "is not available."
    )


def test_no_state_interface_at_all_fails_the_activation(start, caplog):
    start(hardware=fake_hardware(state_interfaces=()), expect=False)
    assert "None of requested interfaces exist. Controller will not run." in caplog.text


def test_extra_joints_are_published_at_zero(start):
    manager, sink = start(Parameters(extra_joints=("wheel",)), fake_hardware(("j0",)))
    manager.publish(0.0, 0.01)
    assert sink.layouts[0].joints == ("j0", "wheel")
    assert sink.published[0][1] == [0.0] * 6


def test_another_interface_can_be_shown_as_position(start):
    joint = JointInfo("j0", state_interfaces=(InterfaceInfo("measured", initial_value=3.0),))
    hardware = FakeHardware(HardwareInfo("H", "system", "x/Y", joints=(joint,)))
    parameters = Parameters(map_interface_to_joint_state=InterfaceMap(position="measured"))
    manager, sink = start(parameters, hardware)
    manager.publish(0.0, 0.01)
    assert sink.published[0][1][0] == 3.0
    assert sink.layouts[0].components == (("j0", ("position",)),)


def test_an_interface_that_is_not_a_number_is_left_out(start, caplog):
    switched = InterfaceInfo("switched", data_type="bool")
    joint = JointInfo("j0", state_interfaces=(switched, InterfaceInfo("position", 0.5)))
    tool = JointInfo("tool", state_interfaces=(switched,))
    hardware = FakeHardware(HardwareInfo("H", "system", "x/Y", joints=(joint, tool)))
    manager, sink = start(hardware=hardware)
    manager.publish(0.0, 0.01)
    assert sink.published[0][1][0] == 0.5
    assert sink.layouts[0].components == (("j0", ("position",)),)
    said = [r.message for r in caplog.records if "is not published" in r.message]
    assert said == [
        f"state interface '{name}/switched' is not published: its type is bool, not double"
        for name in ("j0", "tool")
    ]


def test_a_read_that_fails_does_not_mix_up_the_joints(start):
    positions = {f"j{i}": i / 10 for i in range(4)}
    hardware = fake_hardware(initial_positions=positions)
    manager, sink = start(hardware=hardware)
    manager.read(0.0, 0.01)
    manager.publish(0.0, 0.01)
    hardware.states[hardware.state_interfaces.index("j2/position")] = np.nan
    manager.publish(0.01, 0.01)
    np.testing.assert_array_equal(sink.published[0][1][:4], [0.0, 0.1, 0.2, 0.3])
    np.testing.assert_array_equal(sink.published[1][1][:4], [0.0, 0.1, np.nan, 0.3])


@pytest.mark.parametrize("other", ["velocity", "measured"])
def test_a_listed_standard_interface_is_not_mapped(start, caplog, other):
    parameters = Parameters(
        joints=("j0",),
        interfaces=("position", "velocity"),
        map_interface_to_joint_state=InterfaceMap(position=other),
    )
    _, sink = start(parameters)
    assert sink.layouts[0].components == (("j0", ("position", "velocity")),)
    assert f"interface '{other}' is not shown as 'position'" in caplog.text


def test_interfaces_without_joints_do_not_keep_another_one_from_being_shown(start):
    states = (InterfaceInfo("measured", initial_value=3.0),)
    joint = JointInfo("j0", state_interfaces=states)
    hardware = FakeHardware(HardwareInfo("H", "system", "x/Y", joints=(joint,)))
    parameters = Parameters(
        interfaces=("position",), map_interface_to_joint_state=InterfaceMap(position="measured")
    )
    _, sink = start(parameters, hardware)
    assert sink.layouts[0].components == (("j0", ("position",)),)


def test_a_new_activation_rebuilds_the_messages(start):
    manager, sink = start()
    manager.switch_controller(SwitchRequest(("jsb",), ("jsb",)))
    assert len(sink.layouts) == 2


def test_it_works_without_a_sink(bench, make):
    make(JointStateBroadcaster, Parameters())
    bench.manager.switch_controller(SwitchRequest(("it",)))
    bench.tick()
    assert bench.states() == {"it": "active"}
