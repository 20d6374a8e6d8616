"""The watched folder of shared memory, and the segments that are hidden from other users."""

import fcntl
import os
import select

from launch_py.fast_dds.shared_memory import hide, lock_owners, segments_of, watch_folder


def test_a_folder_that_does_not_exist_cannot_be_watched():
    assert watch_folder("/nowhere") is None


def test_a_new_file_wakes_the_watcher(tmp_path):
    fd = watch_folder(str(tmp_path))
    assert fd is not None
    assert select.select([fd], [], [], 0)[0] == []
    (tmp_path / "fastrtps_1").touch()
    assert select.select([fd], [], [], 10)[0] == [fd]
    os.close(fd)


def test_an_owner_that_a_long_list_leaves_out_once_is_found(tmp_path, monkeypatch):
    """The list comes in pages, between which it may lose a line."""
    device = tmp_path.stat().st_dev
    place = f"{os.major(device):02x}:{os.minor(device):02x}"
    first, second = (f"1: FLOCK  ADVISORY  WRITE {pid} {place}:{pid} 0 EOF\n" for pid in (11, 12))
    pages = iter([first, first, "", first, second, "", *([first, first, ""] * 9)])
    monkeypatch.setattr(os, "read", lambda _fd, _size: next(pages).encode())
    assert lock_owners(str(tmp_path)) == {11: {11}, 12: {12}}


def test_only_the_segments_of_this_process_are_hidden(tmp_path):
    for name in ("fastrtps_1", "fastrtps_1_el", "fastrtps_2", "fastrtps_2_el"):
        (tmp_path / name).touch(0o644)
        (tmp_path / name).chmod(0o644)
    with (tmp_path / "fastrtps_1_el").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        own = segments_of(lambda pid: pid == os.getpid(), str(tmp_path))
        hidden = hide(own, str(tmp_path))
    assert sorted(hidden) == ["fastrtps_1", "fastrtps_1_el"]
    modes = {path.name: path.stat().st_mode & 0o777 for path in tmp_path.iterdir()}
    assert modes["fastrtps_1"] == modes["fastrtps_1_el"] == 0o600
    assert modes["fastrtps_2"] == modes["fastrtps_2_el"] == 0o644
