"""Lets MuJoCo read a model that another patch release of it has saved.

A saved model begins with the number of the version that saved it, and MuJoCo refuses every other
one, even if the formats are the same: 4.0.1 does not read what 4.0.0 has saved, and the two files
of one model differ in that number alone. This changes the number in a copy. MuJoCo still checks
the numbers of sizes and arrays, the length and all indices. Made for MuJoCo 4.0; no upstream issue
is known.
"""

import struct

from arm_node.workarounds.switch import is_on

_HEAD = struct.Struct("=5i")
"""A constant, bytes of a number, number of sizes, version, number of arrays."""
_PATCHES = 1000
"""The version 4.0.1 is 4000001."""


def saved_version(content: bytes) -> int | None:
    """Return the version of MuJoCo that saved a model; None for what is too short to say."""
    return _HEAD.unpack_from(content)[3] if len(content) >= _HEAD.size else None


def for_version(content: bytes, version: int) -> bytes:
    """Return a saved model as a version of MuJoCo reads it.

    Args:
        content: the model as MuJoCo saved it.
        version: that in use, as `mujoco.mj_version` gives it.
    """
    theirs = saved_version(content)
    if theirs is None or theirs == version or theirs // _PATCHES != version // _PATCHES:
        return content
    if not is_on("patch_releases"):
        return content
    constant, number, sizes, _, arrays = _HEAD.unpack_from(content)
    return _HEAD.pack(constant, number, sizes, version, arrays) + content[_HEAD.size :]


def version_text(version: int) -> str:
    """Return a version of MuJoCo 4 or later as it is written, such as 4.0.1."""
    rest, patch = divmod(version, _PATCHES)
    major, minor = divmod(rest, _PATCHES)
    return f"{major}.{minor}.{patch}"
