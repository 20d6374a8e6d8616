"""What is removed while other processes open the same port, clean up or stand still."""

import ctypes
import fcntl
import os
import signal
import subprocess
import sys

import pytest

from launch_py.fast_dds.removal import remove_unused

PORT = "fastrtps_port7000"
MUTEX = f"sem.{PORT}_mutex"

# Opens and closes a port, step by step as Fast DDS does, and leaves its files as a killed process.
OPEN_PORTS = """
import ctypes, fcntl, mmap, os, sys, time
folder, times = sys.argv[1], int(sys.argv[2])
libc = ctypes.CDLL(None)
path, mutex = os.path.join(folder, "fastrtps_port7000"), sys.argv[3]
other_participant = open(os.path.join(folder, "fastrtps_1_el"), "w")
fcntl.flock(other_participant, fcntl.LOCK_EX)
print("up", flush=True)
nameless = 0
for _ in range(times):
    with open(mutex, "r+b") as file:
        memory = mmap.mmap(file.fileno(), 32)
    semaphore = (ctypes.c_char * 32).from_buffer(memory)
    libc.sem_wait(semaphore)
    with open(path, "a+b") as file:
        file.truncate(4096)
        segment = mmap.mmap(file.fileno(), 4096)
        inode = os.fstat(file.fileno()).st_ino
    time.sleep(0.001)
    lock = open(path + "_el", "a")
    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    libc.sem_post(semaphore)
    del semaphore
    memory.close()
    try:
        nameless += os.stat(path).st_ino != inode
    except FileNotFoundError:
        nameless += 1
    lock.close()
    segment.close()
    time.sleep(0.001)
print(times, "ports,", nameless, "without a name")
"""


@pytest.fixture
def folder(shm_folder):
    for name in (PORT, f"{PORT}_el"):
        (shm_folder / name).write_bytes(bytes(4096))
    return str(shm_folder)


def left(folder):
    return set(os.listdir(folder))


def test_a_port_that_is_opened_meanwhile_keeps_its_name(folder):
    """Else its reader would hear nothing, because the senders open another file."""
    with open(os.path.join(folder, "fastrtps_1_el"), "w") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        remove_unused([PORT], folder)
    assert left(folder) == {MUTEX, "fastrtps_1_el"}
    removed = 0
    with subprocess.Popen(
        [sys.executable, "-S", "-c", OPEN_PORTS, folder, "300", os.path.join(folder, MUTEX)],
        stdout=subprocess.PIPE,
        text=True,
    ) as opener:
        assert opener.stdout is not None
        assert opener.stdout.readline() == "up\n"
        while opener.poll() is None:
            removed += len(remove_unused([PORT], folder))
        assert opener.stdout.read() == "300 ports, 0 without a name\n"
    assert removed > 0


def test_a_mutex_that_a_killed_process_held_is_free_again(folder):
    path = os.path.join(folder, MUTEX)
    with open(path, "wb") as file:
        file.write(bytes(32))
    with open(os.path.join(folder, "fastrtps_1_el"), "w") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        assert set(remove_unused([PORT], folder)) == {PORT, f"{PORT}_el"}
    with open(path, "rb") as file:
        semaphore = ctypes.create_string_buffer(file.read(), 32)
    assert ctypes.CDLL(None).sem_trywait(semaphore) == 0


def test_the_mutex_is_a_semaphore_of_the_c_library(shm_folder):
    """Fast DDS opens it by its name."""
    port = f"fastrtps_port{os.getpid()}0000"  # There is no port of so large a number.
    lock = f"/dev/shm/{port}_el"
    libc = ctypes.CDLL(None)
    libc.sem_open.restype = ctypes.c_void_p
    libc.sem_trywait.argtypes = libc.sem_close.argtypes = (ctypes.c_void_p,)
    with open(lock, "w"), open(f"/dev/shm/fastrtps_{os.getpid()}_el", "w") as other:
        fcntl.flock(other, fcntl.LOCK_EX)
        try:
            assert remove_unused([port], "/dev/shm") == []
            semaphore = libc.sem_open(f"{port}_mutex".encode(), 0)
            assert semaphore
            assert [libc.sem_trywait(semaphore) for _ in range(2)] == [0, -1]
            libc.sem_close(semaphore)
        finally:
            os.unlink(other.name)
            os.unlink(lock)
            os.unlink(f"/dev/shm/sem.{port}_mutex")


def test_several_processes_clean_up_in_turn(folder):
    """None of them leaves a file because another one looks at it."""
    code = "import sys; from launch_py.fast_dds.removal import *\n"
    code += "print('up', flush=True); input(); print(len(remove_unused(sys.argv[2:], sys.argv[1])))"
    stems = [f"fastrtps_{number}" for number in range(50)]
    for stem in stems:
        open(os.path.join(folder, stem), "w").close()
    cleaners = [
        subprocess.Popen(
            [sys.executable, "-c", code, folder, *stems],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        for _ in range(2)
    ]
    for cleaner in cleaners:
        assert cleaner.stdout is not None
        assert cleaner.stdout.readline() == "up\n"
    for cleaner in cleaners:
        assert cleaner.stdin is not None
        cleaner.stdin.write("\n")
        cleaner.stdin.flush()
    assert sum(int(cleaner.communicate()[0]) for cleaner in cleaners) == 50
    assert left(folder) == {PORT, f"{PORT}_el"}


def test_a_stopped_process_that_cleans_up_is_not_waited_for(folder):
    code = (
        "import fcntl, os, sys; fcntl.flock(os.open(sys.argv[1], 0), 2); print('up', flush=True)\n"
    )
    code += "sys.stdin.read()"
    with subprocess.Popen(
        [sys.executable, "-S", "-c", code, folder], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as stopped:
        assert stopped.stdout is not None
        assert stopped.stdout.readline() == b"up\n"
        stopped.send_signal(signal.SIGSTOP)
        assert set(remove_unused([PORT], folder)) == {PORT, f"{PORT}_el", MUTEX}
        stopped.send_signal(signal.SIGCONT)
