"""What is missing between the numbers of messages."""

from random import Random

from hypothesis import given
from hypothesis import strategies as st

from arm_cli.bag.writer_numbers import WriterNumbers


def missing(numbers: list[int], publishers: int = 1) -> int:
    counted = WriterNumbers(lambda: publishers)
    return sum(counted.missing_before(number) for number in numbers)


def test_what_came_before_the_first_is_not_missing():
    assert missing([41, 42, 43]) == 0


def test_gaps_are_counted():
    assert missing([1, 2, 5, 6, 10]) == 2 + 3


def test_a_publisher_that_starts_anew_loses_nothing():
    assert missing([98, 99, 1, 2, 3]) == 0
    assert missing([98, 99, 1, 2, 5]) == 2


def test_publishers_that_join_lose_nothing():
    publishers = 1
    counted = WriterNumbers(lambda: publishers)
    assert counted.missing_before(10) == 0
    publishers = 2
    assert [counted.missing_before(n) for n in (700, 11, 701, 12)] == [0, 0, 0, 0]


STREAMS = st.lists(
    st.lists(st.booleans(), max_size=40).map(lambda came: [True, *came, True]),
    min_size=1,
    max_size=4,
)


def found_in(streams: list[list[bool]], firsts: list[int], random: Random) -> int:
    """Return how many are found to be missing, of messages that came or not, by publisher."""
    waiting = [
        [first + i for i, came in enumerate(flags) if came]
        for first, flags in zip(firsts, streams, strict=True)
    ]
    counted = WriterNumbers(lambda: len(streams))
    # The first message of each is there before the second of any: all are known by then.
    found = sum(counted.missing_before(numbers.pop(0)) for numbers in waiting)
    while any(waiting):
        numbers = random.choice([numbers for numbers in waiting if numbers])
        found += counted.missing_before(numbers.pop(0))
    return found


@given(STREAMS, st.randoms(use_true_random=False))
def test_the_gaps_of_publishers_far_apart_add_up(streams: list[list[bool]], random: Random):
    firsts = [1000 * (i + 1) for i in range(len(streams))]
    assert found_in(streams, firsts, random) == sum(flags.count(False) for flags in streams)
