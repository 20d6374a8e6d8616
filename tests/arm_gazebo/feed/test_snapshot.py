"""States as datagrams."""

import contextlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.schedule import FrameDue
from arm_gazebo.feed.snapshot import CameraSnapshot

frames = st.builds(FrameDue, st.integers(0, 9), st.integers(0, 2**63), st.integers(0, 2**63))


def poses(count):
    return np.zeros((count, 3)), np.zeros((count, 4))


@given(
    version=st.integers(0, 2**32 - 1),
    time_s=st.floats(0, 1e9),
    due=st.lists(frames, max_size=4).map(tuple),
    qpos=hnp.arrays(np.float64, st.integers(0, 40)),
    mocaps=st.integers(0, 3),
)
def test_unpacking_restores_what_was_packed(version, time_s, due, qpos, mocaps):
    positions = np.arange(3.0 * mocaps).reshape(mocaps, 3)
    quaternions = np.arange(4.0 * mocaps).reshape(mocaps, 4) + 0.5
    packed = CameraSnapshot(version, time_s, due, qpos, positions, quaternions).pack()
    found = CameraSnapshot.unpack(packed)
    assert (found.model_version, found.time_s, found.frames) == (version, time_s, due)
    np.testing.assert_array_equal(found.qpos, qpos)
    np.testing.assert_array_equal(found.mocap_positions, positions)
    np.testing.assert_array_equal(found.mocap_quaternions, quaternions)


@given(st.binary(max_size=200))
def test_garbage_is_refused_or_is_a_snapshot_after_all(packed):
    found = None
    with contextlib.suppress(CameraError):
        found = CameraSnapshot.unpack(packed)
    assert found is None or found.pack() == packed


def test_a_snapshot_with_too_few_positions_is_refused():
    packed = CameraSnapshot(1, 0.0, (), np.zeros(4), *poses(0)).pack()
    with pytest.raises(CameraError, match="3 numbers, not 4"):
        CameraSnapshot.unpack(packed[:-8])


def test_a_truncated_snapshot_is_refused():
    packed = CameraSnapshot(1, 0.0, (), np.zeros(4), *poses(1)).pack()
    with pytest.raises(CameraError, match=f"{len(packed) - 8} bytes are not"):
        CameraSnapshot.unpack(packed[:-8])
