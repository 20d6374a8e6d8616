"""Controllers in a chain: who runs when, who may start and stop, what becomes of references."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from arm_control import ControllerContext, InterfaceConfiguration, ReturnType, SwitchRequest
from arm_control.chainable_controller import ChainableController
from arm_control.controller_switch import Strictness, SwitchResult
from arm_control.errors import ControllerManagerError
from arm_control.forward_command_controller import (
    ForwardCommandController,
    ForwardCommandParameters,
)
from arm_control.hardware import HardwareReturn
from arm_control.lifecycle import LifecycleState

JOINTS = ("j0", "j1", "j2", "j3")
STRICTNESSES = pytest.mark.parametrize("strictness", [Strictness.STRICT, Strictness.BEST_EFFORT])


@dataclass(frozen=True, slots=True)
class LinkParameters:
    commands: tuple[str, ...] = ()
    states: tuple[str, ...] = ()
    references: tuple[str, ...] = ()
    exported: tuple[str, ...] = ()


class Link(ChainableController[LinkParameters]):
    """Hands its references through to its commands, adding one; its own topic says `topic`."""

    parameters_type = LinkParameters

    def __init__(self, context: ControllerContext, runs: list[str]) -> None:
        super().__init__(context)
        self.runs = runs
        self.topic: float = np.nan
        self.fails = False
        self._parameters = LinkParameters()

    def command_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(self._parameters.commands)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        return InterfaceConfiguration.individual(self._parameters.states)

    def reference_names(self) -> tuple[str, ...]:
        return self._parameters.references

    def exported_state_names(self) -> tuple[str, ...]:
        return self._parameters.exported

    def on_configure(self, parameters: LinkParameters) -> None:
        self._parameters = parameters

    def update_references(self, time_s: float, period_s: float) -> ReturnType:
        self.references[:] = self.topic
        return ReturnType.OK

    def update_commands(self, time_s: float, period_s: float) -> ReturnType:
        self.runs.append(self.name)
        if self.references.size == len(self.commands):
            self.commands.write(self.references + 1.0)
        self.exported_states[:] = self.states.read().sum()
        return ReturnType.ERROR if self.fails else ReturnType.OK


class ChainBench:
    """A bench whose controllers hang together."""

    def __init__(self, bench: Any) -> None:
        self.bench = bench
        self.manager = bench.manager
        self.runs: list[str] = []
        self.links: dict[str, Link] = {}

    def link(
        self,
        name: str,
        *,
        commands: tuple[str, ...] = (),
        states: tuple[str, ...] = (),
        references: tuple[str, ...] = (),
        exported: tuple[str, ...] = (),
    ) -> Link:
        """Load and configure a link."""
        link = self.links[name] = Link(ControllerContext(name, 100), self.runs)
        self.manager.load_controller(link, "test/Link")
        self.manager.configure_controller(
            name, LinkParameters(commands, states, references, exported)
        )
        return link

    def forwarder(self, name: str, joints: tuple[str, ...]) -> ForwardCommandController:
        """Load and configure a real forward_command_controller."""
        controller = ForwardCommandController(ControllerContext(name, 100))
        self.manager.load_controller(controller, "test/Forward")
        self.manager.configure_controller(name, ForwardCommandParameters(joints, "position"))
        return controller

    def switch(
        self, activate: str = "", deactivate: str = "", strictness: Strictness = Strictness.STRICT
    ) -> SwitchResult:
        """Switch the controllers of these names, parted by blanks."""
        return self.manager.switch_controller(
            SwitchRequest(tuple(activate.split()), tuple(deactivate.split()), strictness)
        )

    def states(self) -> dict[str, str]:
        return self.bench.states()

    def status(self, name: str) -> Any:
        return next(s for s in self.manager.list_controllers() if s.name == name)

    def commands(self) -> list[float]:
        return self.manager.resources.commands.tolist()

    def interface(self, name: str) -> Any:
        commands, states = self.manager.list_hardware_interfaces()
        return next(i for i in (*commands, *states) if i.name == name)


@pytest.fixture
def chain(bench: Any) -> ChainBench:
    return ChainBench(bench)


@pytest.fixture
def pair(chain: ChainBench) -> ChainBench:
    """`low` commands j0; `high` commands the reference of `low`."""
    chain.link("low", commands=("j0/position",), references=("x/position",))
    chain.link("high", commands=("low/x/position",), references=("y/position",))
    return chain


# What is listed


def test_exports_are_listed_while_it_is_configured(pair: ChainBench) -> None:
    pair.link("reader", states=("j0/position",), exported=("sum/position",))
    low, high, reader = map(pair.status, ("low", "high", "reader"))
    assert (low.is_chainable, low.is_chained) == (True, False)
    assert low.reference_interfaces == ("x/position",)
    assert reader.exported_state_interfaces == ("sum/position",)
    assert [(c.name, c.reference_interfaces) for c in high.chain_connections] == [
        ("low", ("x/position",))
    ]
    pair.manager.cleanup_controller("low")
    assert pair.status("low").reference_interfaces == ()
    assert pair.status("high").chain_connections == ()


def test_chained_mode_is_listed_while_somebody_commands(pair: ChainBench) -> None:
    pair.switch("low")
    assert not pair.status("low").is_chained
    pair.switch("high")
    assert pair.status("low").is_chained
    assert not pair.status("high").is_chained
    pair.switch("", "high")
    assert not pair.status("low").is_chained


def test_references_are_command_interfaces_available_in_chained_mode(pair: ChainBench) -> None:
    reference = "low/x/position"
    assert not pair.interface(reference).is_available
    pair.switch("low")
    assert not pair.interface(reference).is_available
    pair.switch("high")
    assert (pair.interface(reference).is_available, pair.interface(reference).is_claimed) == (
        True,
        True,
    )
    pair.switch("", "high")
    assert not pair.interface(reference).is_claimed
    pair.switch("", "low")
    pair.manager.unload_controller("low")
    commands, _ = pair.manager.list_hardware_interfaces()
    assert reference not in [i.name for i in commands]


def test_exported_states_are_state_interfaces_while_it_is_active(chain: ChainBench) -> None:
    chain.link("filter", states=("j0/position",), exported=("sum/position",))
    assert not chain.interface("filter/sum/position").is_available
    chain.switch("filter")
    assert chain.interface("filter/sum/position").is_available


def test_an_ordinary_controller_is_not_chainable(chain: ChainBench) -> None:
    chain.forwarder("plain", ("j0",))
    status = chain.status("plain")
    assert (status.is_chainable, status.is_chained, status.reference_interfaces) == (
        False,
        False,
        (),
    )


def test_a_chainable_controller_must_export_something(chain: ChainBench) -> None:
    with pytest.raises(ControllerManagerError, match="exports no reference and no state"):
        chain.link("useless", commands=("j0/position",))
    assert chain.states() == {"useless": "unconfigured"}


@pytest.mark.parametrize("kind", ["references", "exported"])
def test_an_export_given_twice_is_refused(chain: ChainBench, kind: str) -> None:
    with pytest.raises(ControllerManagerError, match=r"exports .* interface a/b more than once"):
        chain.link("double", **{kind: ("a/b", "a/b")})


# Values


def test_commands_go_down_the_chain_within_one_cycle(pair: ChainBench) -> None:
    top = pair.forwarder("top", ("high/y",))
    assert pair.switch("top high low").ok
    top.offer([1.0])
    pair.bench.tick()
    assert pair.commands()[0] == 3.0
    assert pair.runs == ["high", "low"]


def test_without_a_leader_it_follows_its_topic(pair: ChainBench) -> None:
    pair.links["low"].topic = 5.0
    pair.switch("low")
    pair.bench.tick()
    assert pair.commands()[0] == 6.0


def test_in_chained_mode_its_topic_does_not_count(chain: ChainBench) -> None:
    low = chain.link("low", commands=("j0/position",), references=("x/position",))
    top = chain.forwarder("top", ("low/x",))
    chain.switch("low top")
    low.topic = 5.0
    top.offer([1.0])
    chain.bench.tick()
    assert chain.commands()[0] == 2.0
    assert chain.switch("", "top").ok
    # What was commanded last holds until its own topic says otherwise.
    assert low.references.tolist() == [1.0]
    chain.bench.tick()
    assert chain.commands()[0] == 6.0


def test_it_begins_with_nothing_to_follow(chain: ChainBench) -> None:
    low = chain.link("low", commands=("j0/position",), references=("x/position",))
    top = chain.forwarder("top", ("low/x",))
    chain.switch("low top")
    top.offer([1.0])
    chain.bench.tick()
    chain.switch("", "low top")
    chain.switch("low top")
    assert np.isnan(low.references).all()


def test_one_controller_may_command_hardware_and_references(chain: ChainBench) -> None:
    low = chain.link("low", commands=("j1/position",), references=("x/position",))
    top = chain.forwarder("top", ("j0", "low/x", "j2"))
    chain.switch("low top")
    top.offer([1.0, 2.0, 3.0])
    chain.bench.tick()
    assert low.references.tolist() == [2.0]
    assert chain.commands()[:3] == [1.0, 3.0, 3.0]


def test_exported_states_are_read_in_the_same_cycle(chain: ChainBench) -> None:
    reader = chain.bench.configure("reader", states=("filter/sum/position", "j1/position"))
    chain.link("filter", states=("j0/position", "j1/position"), exported=("sum/position",))
    chain.manager.configure_controller(
        "reader", type(reader).parameters_type((), ("filter/sum/position", "j1/position"))
    )
    chain.bench.hardware.states[:] = 0.0
    assert chain.switch("filter reader").ok
    where = {n: i for i, n in enumerate(chain.bench.hardware.state_interfaces)}
    chain.bench.hardware.states[where["j0/position"]] = 2.0
    chain.bench.hardware.states[where["j1/position"]] = 3.0
    chain.bench.tick()
    assert reader.states.read().tolist() == [5.0, 3.0]
    with pytest.raises(ValueError, match="read-only"):
        reader.states.write(0.0)


# Order


def expected_order(chain: ChainBench) -> list[str]:
    return [s.name for s in chain.manager.list_controllers()]


@pytest.mark.parametrize("order", [(1, 2, 3, 4), (4, 3, 2, 1), (2, 4, 1, 3), (3, 1, 4, 2)])
def test_the_list_is_sorted_along_the_chain(chain: ChainBench, order: tuple[int, ...]) -> None:
    for n in order:
        commands = (f"c{n - 1}/x/position",) if n > 1 else ("j0/position",)
        chain.link(f"c{n}", commands=commands, references=("x/position",))
    assert expected_order(chain) == ["c4", "c3", "c2", "c1"]
    assert chain.switch("c1 c2 c3 c4").ok
    chain.bench.tick()
    assert chain.runs == ["c4", "c3", "c2", "c1"]


def test_branches_run_before_what_they_share(chain: ChainBench) -> None:
    chain.link("left", commands=("base/x/position",), references=("x/position",))
    chain.link("base", commands=("j0/position",), references=("x/position", "y/position"))
    chain.link("right", commands=("base/y/position",), references=("x/position",))
    assert expected_order(chain) == ["right", "left", "base"]


def test_a_reader_runs_after_the_exporter_but_before_whom_it_commands(chain: ChainBench) -> None:
    chain.link(
        "low", commands=("j0/position",), references=("x/position",), exported=("state/position",)
    )
    chain.link(
        "high",
        commands=("low/x/position",),
        states=("low/state/position",),
        references=("y/position",),
    )
    chain.link(
        "watch",
        commands=("j1/position",),
        states=("low/state/position",),
        references=("z/position",),
    )
    order = expected_order(chain)
    assert order.index("high") < order.index("low") < order.index("watch")


# Switch rules


@STRICTNESSES
def test_a_leader_does_not_start_without_those_that_it_commands(
    pair: ChainBench, strictness: Strictness
) -> None:
    result = pair.switch("high", strictness=strictness)
    assert pair.states() == {"high": "inactive", "low": "inactive"}
    assert result.ok is (strictness is Strictness.BEST_EFFORT)
    if strictness is Strictness.STRICT:
        assert result.message == (
            "Controller with name 'high' can not be activated since the following controller with "
            "name 'low' is not active and will not be activated."
        )


@pytest.mark.parametrize("steps", [("low", "high"), ("low high",), ("high low",)])
def test_a_chain_starts_one_by_one_from_below_or_at_once(
    pair: ChainBench, steps: tuple[str, ...]
) -> None:
    for step in steps:
        assert pair.switch(step).ok
    assert pair.states() == {"high": "active", "low": "active"}


@STRICTNESSES
def test_whoever_is_commanded_does_not_stop_alone(pair: ChainBench, strictness: Strictness) -> None:
    pair.switch("low high")
    result = pair.switch("", "low", strictness)
    assert pair.states() == {"high": "active", "low": "active"}
    assert result.ok is (strictness is Strictness.BEST_EFFORT)
    if strictness is Strictness.STRICT:
        assert result.message == (
            "Controller with name 'low' can not be deactivated since the preceding controller with "
            "name 'high' is active and will not be deactivated."
        )


def test_a_chain_stops_from_above_or_at_once(pair: ChainBench) -> None:
    pair.switch("low high")
    assert pair.switch("", "low high").ok
    assert pair.states() == {"high": "inactive", "low": "inactive"}
    pair.switch("low high")
    assert pair.switch("", "high").ok
    assert pair.switch("", "low").ok


def test_a_leader_does_not_start_while_whom_it_commands_stops(pair: ChainBench) -> None:
    pair.switch("low")
    result = pair.switch("high", "low")
    assert "the following controller with name 'low' will be deactivated." in result.message
    assert pair.states() == {"high": "inactive", "low": "active"}


def test_best_effort_leaves_out_the_whole_of_a_broken_chain(pair: ChainBench) -> None:
    pair.link("top", commands=("high/y/position",), references=("z/position",))
    pair.link("other", commands=("j3/position",), references=("z/position",))
    result = pair.switch("top high other", strictness=Strictness.BEST_EFFORT)
    assert result.ok
    assert pair.states() == {
        "top": "inactive",
        "high": "inactive",
        "low": "inactive",
        "other": "active",
    }


def test_a_reference_has_one_commander(pair: ChainBench) -> None:
    pair.forwarder("rival", ("low/x",))
    pair.switch("low high")
    result = pair.switch("rival")
    assert result.message == (
        "Unable to activate controller 'rival' since the command interface 'low/x/position' "
        "is currently claimed by another controller."
    )
    assert pair.switch("rival", "high").ok
    assert pair.status("low").is_chained


def test_a_reference_of_nobody_is_not_available(chain: ChainBench) -> None:
    chain.forwarder("top", ("nobody/x",))
    assert chain.switch("top").message == (
        "Unable to activate controller 'top' since the command interface 'nobody/x/position' "
        "is not available."
    )


def test_a_whole_chain_can_be_restarted(pair: ChainBench) -> None:
    pair.switch("low high")
    assert pair.switch("low high", "low high").ok
    assert pair.states() == {"high": "active", "low": "active"}
    assert pair.status("low").is_chained


def test_hardware_hears_of_its_own_interfaces_only(pair: ChainBench) -> None:
    pair.switch("low high")
    assert pair.bench.hardware.mode_switches == [(("j0/position",), ())]


# Failures


def test_an_update_that_fails_stops_the_whole_chain(pair: ChainBench) -> None:
    pair.link("aside", commands=("j3/position",), references=("z/position",))
    pair.switch("low high aside")
    pair.links["low"].fails = True
    pair.bench.tick()
    assert pair.states() == {"high": "inactive", "low": "inactive", "aside": "active"}
    assert not pair.status("low").is_chained


def test_hardware_that_fails_takes_the_leaders_of_its_users_along(pair: ChainBench) -> None:
    pair.switch("low high")
    pair.bench.hardware.read_result = HardwareReturn.ERROR
    pair.bench.tick()
    assert pair.states() == {"high": "inactive", "low": "inactive"}


def test_shutdown_stops_leaders_first(pair: ChainBench) -> None:
    seen: list[tuple[str, str]] = []

    class Observer:
        def controller_transitioned(
            self, name: str, transition: Any, start: LifecycleState, end: LifecycleState
        ) -> None:
            seen.append((name, transition.label))

        def activity_changed(self) -> None:
            pass

    pair.switch("low high")
    pair.manager.add_observer(Observer())
    pair.manager.shutdown()
    assert seen[:2] == [("high", "deactivate"), ("low", "deactivate")]


def test_a_start_that_fails_leaves_chained_mode(chain: ChainBench) -> None:
    low = chain.link("low", commands=("j0/position",), references=("x/position",))
    chain.switch("low")
    probe = chain.bench.configure("bad", commands=("low/x/position",))
    probe.refuses.add("activate")
    assert not chain.switch("bad").ok
    assert not low.is_chained
    assert chain.states() == {"bad": "inactive", "low": "active"}
