"""Chained controllers: which may be activated and deactivated, and which stop together."""

from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from arm_control.hardware.driver import HardwareReturn
from arm_control.lifecycle import LifecycleState
from arm_control.manager.switch_planner import Strictness

STRICTNESSES = pytest.mark.parametrize("strictness", [Strictness.STRICT, Strictness.BEST_EFFORT])


# Switch rules


@STRICTNESSES
def test_a_leader_does_not_start_without_those_that_it_commands(pair, strictness):
    result = pair.switch("high", strictness=strictness)
    assert pair.states() == {"high": "inactive", "low": "inactive"}
    assert result.ok is (strictness is Strictness.BEST_EFFORT)
    if strictness is Strictness.STRICT:
        assert result.message == (
            "Controller with name 'high' can not be activated since the following controller with "
            "name 'low' is not active and will not be activated."
        )


@pytest.mark.parametrize("steps", [("low", "high"), ("low high",), ("high low",)])
def test_a_chain_starts_one_by_one_from_below_or_at_once(pair, steps):
    for step in steps:
        assert pair.switch(step).ok
    assert pair.states() == {"high": "active", "low": "active"}


@STRICTNESSES
def test_a_commanded_controller_does_not_stop_alone(pair, strictness):
    pair.switch("low high")
    result = pair.switch("", "low", strictness)
    assert pair.states() == {"high": "active", "low": "active"}
    assert result.ok is (strictness is Strictness.BEST_EFFORT)
    if strictness is Strictness.STRICT:
        assert result.message == (
            "Controller with name 'low' can not be deactivated since the preceding controller with "
            "name 'high' is active and will not be deactivated."
        )


def test_a_chain_stops_from_above_or_at_once(pair):
    pair.switch("low high")
    assert pair.switch("", "low high").ok
    assert pair.states() == {"high": "inactive", "low": "inactive"}
    pair.switch("low high")
    assert pair.switch("", "high").ok
    assert pair.switch("", "low").ok


def test_a_leader_does_not_start_while_whom_it_commands_stops(pair):
    pair.switch("low")
    result = pair.switch("high", "low")
    assert "the following controller with name 'low' will be deactivated." in result.message
    assert pair.states() == {"high": "inactive", "low": "active"}


def test_best_effort_leaves_out_the_whole_of_a_broken_chain(pair):
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


def test_a_reference_has_one_commander(pair):
    pair.forwarder("rival", ("low/x",))
    pair.switch("low high")
    result = pair.switch("rival")
    assert result.message == (
        "Unable to activate controller 'rival' since the command interface 'low/x/position' "
        "is currently claimed by another controller."
    )
    assert pair.switch("rival", "high").ok
    assert pair.status("low").is_chained


def test_a_reference_without_an_owner_is_not_available(chain):
    chain.forwarder("top", ("nobody/x",))
    assert chain.switch("top").message == (
        "Unable to activate controller 'top' since the command interface 'nobody/x/position' "
        "is not available."
    )


def test_a_whole_chain_can_be_restarted(pair):
    pair.switch("low high")
    assert pair.switch("low high", "low high").ok
    assert pair.states() == {"high": "active", "low": "active"}
    assert pair.status("low").is_chained


def test_a_chain_one_of_which_cannot_stop_is_not_restarted(pair):
    pair.switch("low high")
    low = pair.links["low"]
    parameters, low.refuses_to_stop = low.parameters, True
    result = pair.switch("low high", "low high")
    assert result.message.endswith(
        "\nUnable to activate controllers: [ low high ]\nUnable to deactivate controllers: [ low ]"
    )
    assert pair.states() == {"high": "inactive", "low": "unconfigured"}
    assert pair.bench.hardware.mode_switches[-1] == ((), ("j0/position",))
    # Nothing is left claimed: configured again, the chain starts as ever.
    pair.manager.configure_controller("low", parameters)
    assert pair.switch("low high").ok


def test_a_commanded_controller_is_not_restarted_alone(pair):
    pair.switch("low high")
    pair.links["low"].references[:] = 7.0
    result = pair.switch("low", "low", Strictness.BEST_EFFORT)
    assert "no controllers need to be activated or deactivated" in result.message
    # It was left alone altogether.
    assert pair.links["low"].references.tolist() == [7.0]


@STRICTNESSES
def test_a_controller_that_is_read_by_name_does_not_stop_alone(chain, strictness):
    chain.link("filter", states=("j0/position",), exported=("sum/position",))
    chain.bench.configure("reader", states=("filter/sum/position",))
    chain.switch("filter reader")
    chain.switch("", "filter", strictness)
    assert chain.states() == {"filter": "active", "reader": "active"}


@STRICTNESSES
def test_a_controller_that_reads_all_states_keeps_no_other_from_stopping(chain, strictness):
    chain.link("filter", states=("j0/position",), exported=("sum/position",))
    every = chain.broadcaster("every")
    chain.switch("filter")
    chain.switch("every")
    assert "filter/sum/position" in every.states.names
    assert chain.switch("", "filter", strictness).ok
    assert chain.states() == {"filter": "inactive", "every": "active"}
    chain.bench.tick()
    assert chain.states()["every"] == "active"


def test_a_reader_of_all_states_starts_after_the_only_exporter_failed_to_stop(chain):
    exporter = chain.link("filter", states=("j0/position",), exported=("sum/position",))
    every = chain.broadcaster("every")
    chain.switch("filter")
    exporter.refuses_to_stop = True
    chain.switch("", "filter")
    assert chain.states() == {"filter": "unconfigured", "every": "inactive"}
    assert chain.switch("every").ok
    assert not any(name.startswith("filter/") for name in every.states.names)


@pytest.mark.parametrize("strictness", [Strictness.STRICT, Strictness.BEST_EFFORT])
def test_without_whom_it_commands_a_leader_does_not_start(chain, strictness):
    chain.link("low", commands=("j0/position",), references=("x/position",)).refuses_to_start = True
    chain.link("high", commands=("low/x/position",), references=("x/position",))
    chain.link("other", commands=("j1/position",), references=("x/position",))
    result = chain.switch("low high other", strictness=strictness)
    assert "Unable to activate controllers: [ low high ]" in result.message
    assert chain.states() == {
        "other": "inactive" if strictness is Strictness.STRICT else "active",
        "high": "inactive",
        "low": "inactive",
    }


def test_hardware_gets_only_its_own_interfaces(pair):
    pair.switch("low high")
    assert pair.bench.hardware.mode_switches == [(("j0/position",), ())]


# Failures


def test_an_update_that_fails_stops_the_whole_chain(pair):
    pair.link("aside", commands=("j3/position",), references=("z/position",))
    pair.switch("low high aside")
    pair.links["low"].fails = True
    pair.bench.tick()
    assert pair.states() == {"high": "inactive", "low": "inactive", "aside": "active"}
    assert not pair.status("low").is_chained


def test_a_failed_update_does_not_stop_a_controller_that_reads_all_states(chain):
    chain.link("filter", states=("j0/position",), exported=("sum/position",)).fails = True
    chain.broadcaster("every")
    chain.switch("filter")
    chain.switch("every")
    chain.bench.tick()
    assert chain.states() == {"filter": "inactive", "every": "active"}


def test_only_the_fallbacks_of_whom_fails_take_over(chain):
    for name in ("spare_low", "spare_high"):
        chain.link(name, commands=("j0/position",), references=("x/position",))
    low = chain.link(
        "low", commands=("j0/position",), references=("x/position",), fallback_names=("spare_low",)
    )
    chain.link(
        "high",
        commands=("low/x/position",),
        references=("x/position",),
        fallback_names=("spare_high",),
    )
    assert chain.switch("low high").ok
    low.fails = True
    chain.bench.tick()
    assert chain.states() == {
        "high": "inactive",
        "low": "inactive",
        "spare_high": "inactive",
        "spare_low": "active",
    }


def test_a_fallback_stops_the_whole_chain_that_claims_its_interfaces(pair):
    pair.forwarder("spare", ("j0", "j1"))
    work = pair.link(
        "work", commands=("j1/position",), references=("x/position",), fallback_names=("spare",)
    )
    assert pair.switch("low high work").ok
    work.fails = True
    pair.bench.tick()
    assert pair.states() == {
        "high": "inactive",
        "low": "inactive",
        "work": "inactive",
        "spare": "active",
    }


def test_hardware_that_fails_takes_the_leaders_of_its_users_along(pair):
    pair.switch("low high")
    pair.bench.hardware.read_result = HardwareReturn.ERROR
    pair.bench.tick()
    assert pair.states() == {"high": "inactive", "low": "inactive"}


def test_shutdown_stops_leaders_first(pair):
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


def test_a_start_that_fails_leaves_chained_mode(chain):
    low = chain.link("low", commands=("j0/position",), references=("x/position",))
    chain.switch("low")
    probe = chain.bench.configure("bad", commands=("low/x/position",))
    probe.refuses.add("activate")
    assert not chain.switch("bad").ok
    assert not low.is_chained
    assert chain.states() == {"bad": "inactive", "low": "active"}


COUNT = 5
NAMES = tuple(f"c{i}" for i in range(COUNT))

# For each controller those before it whose reference it commands; whoever commands none commands
# one of four joints, so that some of them are rivals.
SHAPES = st.tuples(*(st.sets(st.integers(0, COUNT - 1), max_size=2) for _ in NAMES))
NAME_LISTS = st.lists(st.sampled_from((*NAMES, "nobody")), max_size=COUNT)
REQUESTS = st.lists(st.tuples(NAME_LISTS, NAME_LISTS, st.sampled_from(Strictness)), max_size=6)


def followers(shape: tuple[set[int], ...], i: int) -> list[int]:
    return sorted(j for j in shape[i] if j < i)


@pytest.fixture
def build(new_chain):
    """Return a function that makes the controllers of a shape, in an order that is not theirs."""

    def make(shape: tuple[set[int], ...]) -> Any:
        chain = new_chain()
        for i in sorted(range(COUNT), key=lambda i: (i % 2, i)):
            commands = tuple(f"c{j}/x/position" for j in followers(shape, i))
            chain.link(
                f"c{i}", commands=commands or (f"j{i % 4}/position",), references=("x/position",)
            )
        return chain

    return make


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(shape=SHAPES, requests=REQUESTS)
def test_links_hold(build, shape, requests):
    chain = build(shape)
    for activate, deactivate, strictness in requests:
        before = chain.states()
        result = chain.switch(" ".join(activate), " ".join(deactivate), strictness)
        after = chain.states()
        if not result.ok:
            assert after == before
        active = {name for name, state in after.items() if state == "active"}
        commanded: set[str] = set()
        for i, name in enumerate(NAMES):
            if name in active:
                lower = {f"c{j}" for j in followers(shape, i)}
                assert lower <= active
                commanded |= lower
        statuses = chain.manager.list_controllers()
        assert {s.name for s in statuses if s.is_chained} == commanded
        claims = [claim for s in statuses for claim in s.claimed_interfaces]
        assert len(claims) == len(set(claims))
        chain.bench.tick()
        assert chain.states() == after


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(shape=SHAPES)
def test_a_commanding_controller_runs_first(build, shape):
    order = [status.name for status in build(shape).manager.list_controllers()]
    for i in range(COUNT):
        assert all(order.index(f"c{i}") < order.index(f"c{j}") for j in followers(shape, i))
