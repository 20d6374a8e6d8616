"""A model that is drawn, set to the states of the simulation."""

import mujoco

from arm_gazebo.errors import CameraError
from arm_gazebo.feed.snapshot import CameraSnapshot


def read_model(file: int) -> mujoco.MjModel:
    """Return the compiled model of a file (MJB), whose descriptor stays open.

    Raises:
        CameraError: the file is not a model that this version of MuJoCo can read.
    """
    # MuJoCo opens files only by name; this path names an open descriptor.
    path = f"/proc/self/fd/{file}"
    try:
        return mujoco.MjModel.from_binary_path(path)
    except ValueError as error:
        raise CameraError(f"cannot load the compiled model: {error}") from error


class RenderScene:
    """A model with the one state that is being drawn. One thread."""

    def __init__(self, model: mujoco.MjModel) -> None:
        """Make a state of a model that nobody else draws."""
        self.model = model
        self.data = mujoco.MjData(model)

    def pose(self, snapshot: CameraSnapshot) -> None:
        """Set the state to a snapshot of the same model.

        Raises:
            CameraError: the snapshot belongs to another model.
        """
        data = self.data
        if snapshot.qpos.shape != data.qpos.shape:
            raise CameraError(
                f"a snapshot of {snapshot.qpos.size} positions does not belong to this model, "
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
