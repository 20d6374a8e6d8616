"""Chained controllers: order of execution, references and states."""

from typing import Any

import numpy as np
import pytest

from arm_control.errors import ControllerManagerError

JOINTS = ("j0", "j1", "j2", "j3")


# What is listed


def test_exports_are_listed_while_it_is_configured(pair):
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


def test_chained_mode_is_listed_while_a_controller_commands(pair):
    pair.switch("low")
    assert not pair.status("low").is_chained
    pair.switch("high")
    assert pair.status("low").is_chained
    assert not pair.status("high").is_chained
    pair.switch("", "high")
    assert not pair.status("low").is_chained


def test_references_are_command_interfaces_available_in_chained_mode(pair):
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


def test_exported_states_are_state_interfaces_while_it_is_active(chain):
    chain.link("filter", states=("j0/position",), exported=("sum/position",))
    assert not chain.interface("filter/sum/position").is_available
    chain.switch("filter")
    assert chain.interface("filter/sum/position").is_available


def test_an_ordinary_controller_is_not_chainable(chain):
    chain.forwarder("plain", ("j0",))
    status = chain.status("plain")
    assert (status.is_chainable, status.is_chained, status.reference_interfaces) == (
        False,
        False,
        (),
    )


def test_a_chainable_controller_must_export_something(chain):
    with pytest.raises(ControllerManagerError, match="exports no reference and no state"):
        chain.link("useless", commands=("j0/position",))
    assert chain.states() == {"useless": "unconfigured"}


@pytest.mark.parametrize("kind", ["references", "exported"])
def test_an_export_given_twice_is_refused(chain, kind):
    with pytest.raises(ControllerManagerError, match=r"exports .* interface a/b more than once"):
        chain.link("double", **{kind: ("a/b", "a/b")})


# Values


def test_commands_go_down_the_chain_within_one_cycle(pair):
    top = pair.forwarder("top", ("high/y",))
    assert pair.switch("top high low").ok
    top.offer([1.0])
    pair.bench.tick()
    assert pair.commands()[0] == 3.0
    assert pair.runs == ["high", "low"]


def test_without_a_leader_it_follows_its_topic(pair):
    pair.links["low"].topic = 5.0
    pair.switch("low")
    pair.bench.tick()
    assert pair.commands()[0] == 6.0


def test_in_chained_mode_its_topic_does_not_count(chain):
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


def test_it_begins_with_nothing_to_follow(chain):
    low = chain.link("low", commands=("j0/position",), references=("x/position",))
    top = chain.forwarder("top", ("low/x",))
    chain.switch("low top")
    top.offer([1.0])
    chain.bench.tick()
    chain.switch("", "low top")
    chain.switch("low top")
    assert np.isnan(low.references).all()


def test_one_controller_may_command_hardware_and_references(chain):
    low = chain.link("low", commands=("j1/position",), references=("x/position",))
    top = chain.forwarder("top", ("j0", "low/x", "j2"))
    chain.switch("low top")
    top.offer([1.0, 2.0, 3.0])
    chain.bench.tick()
    assert low.references.tolist() == [2.0]
    assert chain.commands()[:3] == [1.0, 3.0, 3.0]


def test_exported_states_are_read_in_the_same_cycle(chain):
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


@pytest.mark.parametrize("names", ["estimator user", "user estimator"])
def test_a_commanding_controller_reads_a_state_exported_in_the_same_cycle(chain, names):
    """Before the commands, not when the broadcasters' turn comes."""
    states = {
        "raw": ("j0/position",),
        "estimator": ("raw/x/position",),
        "user": ("estimator/x/position",),
    }
    for name in ("raw", *names.split()):
        commands = ("j1/position",) if name == "user" else ()
        chain.link(name, commands=commands, states=states[name], exported=("x/position",))
    chain.link("aside", states=("raw/x/position",), exported=("x/position",))
    chain.manager.resources.states[:] = 3.0
    assert chain.switch("raw estimator user aside").ok
    chain.manager.update(1.0, 0.01)
    assert chain.runs == ["raw", "estimator", "user"]
    assert chain.links["user"].exported_states.tolist() == [3.0]
    chain.manager.publish(1.0, 0.01)
    assert chain.runs == ["raw", "estimator", "user", "aside"]


# Order


def expected_order(chain: Any) -> list[str]:
    return [s.name for s in chain.manager.list_controllers()]


@pytest.mark.parametrize("order", [(1, 2, 3, 4), (4, 3, 2, 1), (2, 4, 1, 3), (3, 1, 4, 2)])
def test_the_list_is_sorted_along_the_chain(chain, order):
    for n in order:
        commands = (f"c{n - 1}/x/position",) if n > 1 else ("j0/position",)
        chain.link(f"c{n}", commands=commands, references=("x/position",))
    assert expected_order(chain) == ["c4", "c3", "c2", "c1"]
    assert chain.switch("c1 c2 c3 c4").ok
    chain.bench.tick()
    assert chain.runs == ["c4", "c3", "c2", "c1"]


def test_a_reader_of_all_states_runs_after_the_exporters(chain):
    chain.link("filter", states=("j0/position",), exported=("sum/position",))
    chain.broadcaster("every")
    assert expected_order(chain) == ["every", "filter"]
    chain.switch("filter")
    assert expected_order(chain) == ["filter", "every"]


def test_branches_run_before_what_they_share(chain):
    chain.link("left", commands=("base/x/position",), references=("x/position",))
    chain.link("base", commands=("j0/position",), references=("x/position", "y/position"))
    chain.link("right", commands=("base/y/position",), references=("x/position",))
    assert expected_order(chain) == ["right", "left", "base"]


def test_a_reader_runs_after_the_exporter_but_before_whom_it_commands(chain):
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
