import os
import socket

import pytest

from arm_node.user_file import check_file, open_file, read_bytes, read_text


def refusal(read, *arguments) -> str:
    with pytest.raises(OSError) as caught:  # noqa: PT011
        read(*arguments)
    return caught.value.strerror


def test_a_text_is_read_with_plain_line_ends(tmp_path):
    file = tmp_path / "a.txt"
    file.write_bytes("ä\r\nb\rc\n".encode())
    assert read_text(file) == "ä\nb\nc\n"


def test_a_link_to_a_file_is_that_file(tmp_path):
    (tmp_path / "a").write_text("here")
    (tmp_path / "b").symlink_to("a")
    assert read_text(tmp_path / "b") == "here"


@pytest.mark.parametrize("read", [check_file, open_file, read_text, lambda f: read_bytes(f, 10)])
def test_what_could_block_or_never_end_is_refused(tmp_path, read):
    os.mkfifo(tmp_path / "fifo")
    (tmp_path / "link").symlink_to("/dev/zero")
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(str(tmp_path / "socket"))
        assert refusal(read, tmp_path / "socket") == "it is a socket, not a regular file"
    assert refusal(read, tmp_path / "fifo") == "it is a FIFO, not a regular file"
    assert refusal(read, tmp_path / "link") == "it is a device, not a regular file"
    assert refusal(read, "/dev/zero") == "it is a device, not a regular file"
    assert refusal(read, tmp_path) == "it is a folder, not a regular file"


def test_a_file_over_the_limit_is_refused_unread(tmp_path):
    with (tmp_path / "sparse").open("wb") as file:
        file.truncate(10**12)
    problem = refusal(read_text, tmp_path / "sparse")
    assert problem == "it has 1000000000000 bytes; at most 20000000 are read"


def test_a_file_that_hides_its_size_is_read_up_to_the_limit():
    assert os.stat("/proc/self/maps").st_size == 0
    problem = refusal(read_bytes, "/proc/self/maps", 100)
    assert problem == "it has more than 100 bytes; at most 100 are read"


def test_the_error_names_the_file(tmp_path):
    with pytest.raises(OSError, match="not a regular file") as caught:
        read_text(tmp_path)
    assert caught.value.filename == str(tmp_path)
