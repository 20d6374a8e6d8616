"""Choose the kind of batch that is fastest for a number of copies."""

from collections.abc import Sequence

from arm_gazebo.batch.copies import CommandBounds, Copies
from arm_gazebo.batch.gpu_device import check_device
from arm_gazebo.batch.host_batches import PhysicsBatch, SerialBatch
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.physics.physics import Physics

HOST = "host"
SERIAL_COPIES = 8
"""Up to this many copies, evaluating the servo law as arrays takes longer than the physics."""


def make_copies(
    simulation: Physics,
    hardware: Sequence[SimulatedHardware],
    copies: int,
    threads: int = 0,
    device: str = HOST,
) -> Copies:
    """Return copies of a simulation; on the host, every kind goes through the same states.

    Args:
        simulation: a simulation; the copies take over its model, its start and the modes of its
            drives.
        hardware: its hardware components, whose claimed interfaces bound the commands.
        copies: number of copies.
        threads: number of threads that step many copies; 0 for one on each core.
        device: "host", or "cuda" for MuJoCo Warp on a GPU; "cuda:1" for a certain one.

    Raises:
        BatchError: there are no copies, no such device or no MuJoCo Warp, or MuJoCo Warp cannot
            simulate them.
    """
    bounds = CommandBounds(simulation, hardware)
    if device != HOST:
        check_device(device)
        # It imports Warp, which only the extra `gpu` installs.
        from arm_gazebo.batch.gpu.warp_batch import WarpBatch

        return WarpBatch(simulation, bounds, copies, device)
    if copies <= SERIAL_COPIES:
        return SerialBatch(simulation, bounds, copies)
    return PhysicsBatch(simulation, bounds, copies, threads)
