"""OctoMap's serialised trees, as octomap_msgs/Octomap has them.

A tree is 16 levels deep; its smallest cubes are numbered from -32768 to 32767 along each axis.
Nodes come before their children, and those in the order x + 2 y + 4 z of their halves. In the
binary form an inner node is 16 bits, two for each child: 0 unknown, 1 free, 2 occupied, 3 an inner
node, which follows. In the full form each node is the logarithm of the odds of being occupied, a
32-bit number, and a byte with a bit for each child. All numbers are little-endian.
"""

import struct
from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import InvalidObjectError, PlanningError

Cells = NDArray[np.int64]

DEPTH = 16
HALF = 1 << (DEPTH - 1)
OCCUPIED, INNER = 2, 3
NODE = struct.Struct("<fB")
MOST_BYTES = 8_000_000
"""Larger trees take seconds to read."""
Node = tuple[int, int]
"""The halves on the way to a node, three bits each, and the level it is on; 0 is the deepest."""


@dataclass(frozen=True, slots=True, eq=False)
class Cubes:
    """Cubes of occupied space, in edges of the smallest cube.

    Attributes:
        corners: lowest corner of each, (n, 3), from -32768 to 32767.
        edges: edge of each, a power of 2, (n,).
    """

    corners: Cells
    edges: Cells


def encoded(cubes: Cubes) -> bytes:
    """Return the binary form of a tree; eight cubes that fill the one above become that one."""
    codes = _codes(cubes.corners + HALF)
    levels = np.round(np.log2(cubes.edges)).astype(np.int64)
    places: list[Cells] = []
    sizes: list[Cells] = []
    words: list[Cells] = []
    merged = inner = np.empty(0, np.int64)
    for level in range(DEPTH):
        leaves = np.union1d(codes[levels == level] >> 3 * level, merged)
        parents, counts = np.unique(leaves >> 3, return_counts=True)
        # The root is an inner node whatever is in it.
        merged = parents[counts == 8] if level < DEPTH - 1 else parents[:0]
        leaves = leaves[~np.isin(leaves >> 3, merged)]
        nodes = np.union1d(leaves >> 3, inner >> 3)
        bits = np.zeros(len(nodes), np.int64)
        for found, state in ((leaves, OCCUPIED), (inner, INNER)):
            np.add.at(bits, np.searchsorted(nodes, found >> 3), state << 2 * (found & 7))
        places.append(nodes << 3 * (level + 1))
        sizes.append(np.full(len(nodes), level))
        words.append(bits)
        inner = nodes
    order = np.lexsort((-np.concatenate(sizes), np.concatenate(places)))
    return np.concatenate(words)[order].astype("<u2").tobytes()


def decoded(data: bytes, *, binary: bool) -> Cubes:
    """Return the occupied cubes of a serialised tree.

    Raises:
        PlanningError: the data are not such a tree.
    """
    if len(data) > MOST_BYTES:
        raise refused(f"its data have {len(data)} bytes; at most {MOST_BYTES} are read")
    found, end = _of_words(data) if binary else _of_nodes(data)
    if end < len(data):
        raise refused(f"its data, {len(data)} bytes, go on after the end of the tree")
    codes, levels = np.array(found, np.int64).reshape(-1, 2).T
    return Cubes(_places(codes << 3 * levels) - HALF, 1 << levels)


def refused(reason: str) -> PlanningError:
    """Return the error of an octomap that cannot be used."""
    sentence = f"the octomap cannot be used: {reason}"
    return InvalidObjectError(sentence)


def _of_words(data: bytes) -> tuple[list[Node], int]:
    """Return the occupied leaves of the binary form, and where its tree ends."""
    words = np.frombuffer(data[: len(data) // 2 * 2], "<u2").tolist()
    found: list[Node] = []
    waiting, read = [(0, DEPTH)], 0
    while waiting:
        code, level = waiting.pop()
        if read == len(words):
            raise _cut_off(data)
        states = [(8 * code + half, words[read] >> 2 * half & 3) for half in range(8)]
        read += 1
        found += [(child, level - 1) for child, state in states if state == OCCUPIED]
        inner = [(child, level - 1) for child, state in reversed(states) if state == INNER]
        if inner and level == 1:
            raise _too_deep()
        waiting += inner
    return found, 2 * read


def _of_nodes(data: bytes) -> tuple[list[Node], int]:
    """Return the occupied leaves of the full form, and where its tree ends."""
    found: list[Node] = []
    waiting, read = [(0, DEPTH)], 0
    while waiting:
        code, level = waiting.pop()
        if read + NODE.size > len(data):
            raise _cut_off(data)
        odds, halves = NODE.unpack_from(data, read)
        read += NODE.size
        if not isfinite(odds):
            raise refused("the odds of a node are not finite")
        if halves and level == 0:
            raise _too_deep()
        if not halves and odds >= 0.0:
            found.append((code, level))
        waiting += [
            (8 * code + half, level - 1) for half in reversed(range(8)) if halves >> half & 1
        ]
    return found, read


def _cut_off(data: bytes) -> PlanningError:
    return refused(f"its data, {len(data)} bytes, end in the middle of the tree")


def _too_deep() -> PlanningError:
    return refused(f"its tree has more than {DEPTH} levels")


def _codes(places: Cells) -> Cells:
    """Return places (n, 3) from 0 to 65535 with the bits of x, y and z in turn, (n,)."""
    codes = np.zeros(len(places), np.int64)
    for bit in range(DEPTH):
        for axis in range(3):
            codes |= (places[:, axis] >> bit & 1) << 3 * bit + axis
    return codes


def _places(codes: Cells) -> Cells:
    """Return the places (n, 3) of codes (n,)."""
    places = np.zeros((len(codes), 3), np.int64)
    for bit in range(DEPTH):
        for axis in range(3):
            places[:, axis] |= (codes >> 3 * bit + axis & 1) << bit
    return places
