"""Whatever is asked of chains of whatever shape, no link of them is left hanging."""

from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from arm_control.manager.switch_planner import Strictness

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
