"""A compiled model in the renderer's process, put into the states that the simulation sends."""

import mujoco

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.snapshot import CameraSnapshot


class Scene:
    """A model with the one state that is being drawn. One thread."""

    def __init__(self, file: int) -> None:
        """Load the model from a file with a compiled model (MJB).

        Args:
            file: descriptor of the file; stays open.

        Raises:
            CameraError: the file holds no model that this MuJoCo can read.
        """
        # MuJoCo opens files by name only; this is the name of an open one.
        path = f"/proc/self/fd/{file}"
        try:
            self.model = mujoco.MjModel.from_binary_path(path)
        except ValueError as error:
            raise CameraError(f"cannot load the compiled model: {error}") from error
        self.data = mujoco.MjData(self.model)

    def pose(self, snapshot: CameraSnapshot) -> None:
        """Put everything where a snapshot of the same model says.

        Raises:
            CameraError: the snapshot is of another model.
        """
        data = self.data
        if snapshot.qpos.shape != data.qpos.shape:
            raise CameraError(
                f"a snapshot of {snapshot.qpos.size} positions is not of this model, "
                f"which has {data.qpos.size}"
            )
        data.time = snapshot.time_s
        data.qpos[:] = snapshot.qpos
        data.mocap_pos[:] = snapshot.mocap_positions
        data.mocap_quat[:] = snapshot.mocap_quaternions
        mujoco.mj_kinematics(self.model, data)
        # Cameras and lights may track a centre of mass.
        mujoco.mj_comPos(self.model, data)
        mujoco.mj_camlight(self.model, data)
