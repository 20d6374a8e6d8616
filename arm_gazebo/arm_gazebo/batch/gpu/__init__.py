"""Copies on a GPU; the extra `gpu` installs what it imports: `pip install 'arm-suite[gpu]'`.

Raises:
    MissingWarpError: MuJoCo Warp is not installed.
"""

from arm_gazebo.batch.gpu_device import check_installed

check_installed()
