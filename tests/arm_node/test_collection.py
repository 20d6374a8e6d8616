"""The pause of Python's garbage collector."""

import gc

import pytest

from arm_node.collection import collection_paused, imports_kept


@pytest.fixture(autouse=True)
def collecting():
    """The collector is on, and as it was afterwards."""
    was_on = gc.isenabled()
    gc.enable()
    yield
    (gc.enable if was_on else gc.disable)()


def test_nothing_is_collected_inside():
    with collection_paused():
        assert not gc.isenabled()
    assert gc.isenabled()


def test_an_error_ends_the_pause():
    with pytest.raises(KeyError), collection_paused():
        raise KeyError
    assert gc.isenabled()


def test_a_collector_that_was_off_stays_off():
    gc.disable()
    with collection_paused():
        pass
    assert not gc.isenabled()


def test_imported_objects_are_not_searched_at_once():
    gc.unfreeze()  # What pytest or a plugin may have frozen.
    with imports_kept():
        kept = [[] for _ in range(10_000)]
    assert len(gc.get_objects(generation=2)) > 10_000
    assert gc.get_freeze_count() == 0
    assert len(kept) == 10_000


def test_what_a_program_has_frozen_stays_frozen():
    gc.freeze()
    try:
        with imports_kept():
            pass
        assert gc.get_freeze_count() > 0
    finally:
        gc.unfreeze()
