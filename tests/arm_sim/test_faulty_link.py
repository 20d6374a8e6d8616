"""A connection that loses, delays and repeats messages."""

from math import inf, nan

import pytest

from arm_sim.errors import CallError
from arm_sim.faulty_link import FaultyLink, LinkFault


def delays(fault: LinkFault, messages: int = 2000) -> list[list[float]]:
    link = FaultyLink(fault)
    return [link.delays_s() for _ in range(messages)]


def test_a_fraction_of_the_messages_is_lost():
    lost = sum(not each for each in delays(LinkFault(lost=0.3)))
    assert 500 < lost < 700


def test_all_or_none_are_lost():
    assert not any(delays(LinkFault(lost=1.0)))
    assert all(delays(LinkFault(lost=0.0)))


def test_a_doubled_message_arrives_twice():
    assert set(map(tuple, delays(LinkFault(doubled=1.0, again_s=0.5)))) == {(0.0, 0.5)}


def test_jitter_is_at_most_what_was_asked_for():
    late = [each[0] for each in delays(LinkFault(delay_s=1.0, jitter_s=0.5))]
    assert 1.0 <= min(late) < 1.05
    assert 1.45 < max(late) <= 1.5


def test_the_seed_repeats_and_another_one_does_not():
    assert delays(LinkFault(lost=0.5, seed=1)) == delays(LinkFault(lost=0.5, seed=1))
    assert delays(LinkFault(lost=0.5, seed=1)) != delays(LinkFault(lost=0.5, seed=2))


def test_what_is_lost_does_not_depend_on_the_delay():
    lost = [not each for each in delays(LinkFault(lost=0.5))]
    assert lost == [not each for each in delays(LinkFault(lost=0.5, jitter_s=1.0, doubled=0.5))]


@pytest.mark.parametrize(
    "values", [{"lost": 1.1}, {"doubled": -0.1}, {"lost": nan}, {"delay_s": inf}, {"jitter_s": -1}]
)
def test_impossible_values_are_refused(values):
    with pytest.raises(CallError):
        LinkFault(**values)
