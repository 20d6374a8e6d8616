"""Devices of MuJoCo Warp and what its errors mean: sentences, with or without a GPU."""

import sys
from types import SimpleNamespace

import pytest

from arm_gazebo.batch.choice import make_copies
from arm_gazebo.batch.gpu_device import check_device, explained
from arm_gazebo.errors import BatchError
from arm_sim import Simulation

TOTAL = 3_000_000_000


@pytest.fixture
def one_gpu(monkeypatch) -> None:
    """Let Warp find one GPU."""
    device = SimpleNamespace(total_memory=TOTAL)
    found = SimpleNamespace(get_cuda_device_count=lambda: 1, get_device=lambda name: device)
    for module in ("warp", "mujoco_warp"):
        monkeypatch.setitem(sys.modules, module, found)


@pytest.mark.parametrize("name", ["gpu", "cuda:x", "cuda:", "cuda:-1", "CUDA", ""])
def test_a_name_that_is_no_device_is_a_sentence(name):
    with pytest.raises(BatchError, match=f"no device '{name}'; there are host, cuda, cuda:0"):
        check_device(name)


@pytest.mark.usefixtures("one_gpu")
def test_a_gpu_that_is_not_there_is_named_with_those_that_are():
    check_device("cuda")
    check_device("cuda:0")
    with pytest.raises(BatchError, match=r"no GPU 'cuda:7'; there are cuda:0$"):
        check_device("cuda:7")


def test_a_batch_says_what_is_missing(monkeypatch):
    sim = Simulation("arm", arguments={"camera": "none"})
    physics, hardware = sim.parts.physics, sim.parts.robot.hardware
    for module in ("warp", "mujoco_warp"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(BatchError, match=r"MuJoCo Warp; pip install 'arm-suite\[gpu\]'"):
        make_copies(physics, hardware, 2, device="cuda")
    without = SimpleNamespace(get_cuda_device_count=lambda: 0)
    for module in ("warp", "mujoco_warp"):
        monkeypatch.setitem(sys.modules, module, without)
    with pytest.raises(BatchError, match="a GPU that CUDA finds, and there is none"):
        make_copies(physics, hardware, 2, device="cuda")
    sim.close()


@pytest.mark.usefixtures("one_gpu")
@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (
            RuntimeError("Failed to allocate 15360000000 bytes on device 'cuda:0'"),
            r"'cuda' has too little memory for 400 copies; it has 3\.0 GB in all",
        ),
        (MemoryError("of 8 GiB"), "too little memory for 400 copies: of 8 GiB"),
        (RuntimeError("illegal address"), "failed on the device 'cuda': illegal address"),
        (NotImplementedError("NOSLIP is unsupported."), "cannot simulate this model: NOSLIP is"),
        (ValueError("Dense is unsupported"), "cannot simulate this model: Dense is unsupported"),
    ],
)
def test_errors_of_the_device_are_sentences(error, sentence):
    with pytest.raises(BatchError, match=sentence), explained(400, "cuda"):
        raise error
