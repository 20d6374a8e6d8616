"""OctoMap's serialised trees.

The recorded bytes are those of OctoMap itself: octomap-python 1.10.0.0 wrote them.
"""

import struct

import numpy as np
import pytest

from arm_planning.errors import PlanningError
from arm_planning.scene.octree import HALF, Cubes, decoded, encoded

ONE_CUBE = bytes.fromhex("00c0" + "0300" * 14 + "0200")
"""Only the cube (0, 0, 0)."""
OCCUPIED_AND_FREE = bytes.fromhex("00f0" + "0c00" * 14 + "0800" + "0300" * 14 + "0100")
"""The cube (-1, 0, 0), and beside it one that is known to be free."""
ODDS = 3.51


def unit_cubes(cells):
    cells = np.asarray(cells, np.int64).reshape(-1, 3)
    return Cubes(cells, np.ones(len(cells), np.int64))


def set_of(cubes):
    return {
        (*corner, edge) for corner, edge in zip(cubes.corners.tolist(), cubes.edges, strict=True)
    }


def full_tree(*halves, odds=ODDS, depth=16):
    """Return the full form of one branch of a tree."""
    inner = b"".join(struct.pack("<fB", odds, 1 << half) for half in halves)
    return inner + struct.pack("<fB", odds, 0) if len(halves) <= depth else inner


def test_a_cube_has_the_bytes_that_octomap_writes():
    assert encoded(unit_cubes([(0, 0, 0)])) == ONE_CUBE
    assert set_of(decoded(ONE_CUBE, binary=True)) == {(0, 0, 0, 1)}


def test_free_space_is_passed_over():
    assert set_of(decoded(OCCUPIED_AND_FREE, binary=True)) == {(-1, 0, 0, 1)}


@pytest.mark.parametrize("seed", range(3))
def test_many_cubes_survive_and_eight_of_them_become_one(seed):
    random = np.random.default_rng(seed)
    block = np.indices((4, 4, 4)).reshape(3, -1).T + 8
    scattered = random.integers(-HALF, HALF, (200, 3))
    read = decoded(encoded(unit_cubes(np.unique([*block, *scattered], axis=0))), binary=True)
    assert set_of(read) == {(8, 8, 8, 4), *((*cell, 1) for cell in scattered.tolist())}
    assert encoded(read) == encoded(unit_cubes([*block, *scattered]))


def test_all_of_the_space_is_eight_cubes():
    whole = Cubes(
        np.array([[x, y, z] for x in (-HALF, 0) for y in (-HALF, 0) for z in (-HALF, 0)]),
        np.full(8, HALF),
    )
    assert set_of(decoded(encoded(whole), binary=True)) == set_of(whole)


def test_the_full_form_is_read_with_its_odds():
    branch = (7, *[0] * 15)
    assert set_of(decoded(full_tree(*branch), binary=False)) == {(0, 0, 0, 1)}
    assert set_of(decoded(full_tree(7, 0), binary=False)) == {(0, 0, 0, HALF // 2)}
    assert not len(decoded(full_tree(*branch, odds=-1.0), binary=False).edges)


@pytest.mark.parametrize("binary", [True, False])
def test_a_tree_that_is_cut_off_anywhere_is_refused(binary):
    data = ONE_CUBE if binary else full_tree(7, 0, 0)
    for length in range(1, len(data)):
        with pytest.raises(PlanningError, match="end in the middle of the tree"):
            decoded(data[:length], binary=binary)
    with pytest.raises(PlanningError, match="go on after the end"):
        decoded(data + b"\0", binary=binary)


@pytest.mark.parametrize(
    ("data", "binary", "says"),
    [
        (bytes.fromhex("00c0" + "0300" * 16), True, "more than 16 levels"),
        (full_tree(*[0] * 17), False, "more than 16 levels"),
        (full_tree(7, odds=float("nan")), False, "not finite"),
        (bytes(8_000_002), True, "at most 8000000"),
    ],
)
def test_what_is_not_such_a_tree_is_told_why(data, binary, says):
    with pytest.raises(PlanningError, match=says):
        decoded(data, binary=binary)


def test_random_bytes_are_a_tree_or_refused():
    random = np.random.default_rng(0)
    outcomes = set()
    for _ in range(300):
        data = random.bytes(int(random.integers(1, 60)))
        for binary in (True, False):
            try:
                cubes = decoded(data, binary=binary)
            except PlanningError:
                outcomes.add("refused")
            else:
                assert (cubes.edges > 0).all()
                outcomes.add("read")
    assert outcomes >= {"refused"}
