"""A robot in its world, ready to be simulated, and its form as data for a file."""

from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError
from arm_gazebo.robot.actuation import RobotJoint
from arm_node.frozen import frozen
from arm_node.workarounds.patch_releases import for_version, saved_version, version_text


@frozen
class BuiltModel:
    """The result of `build_world`.

    Attributes:
        model: the compiled model.
        spec: the specification that it was compiled from; None for a model from a file.
        joints: the robot's joints with one degree of freedom, by name, in the URDF's order.
        bodies: ids of the robot's links, by name.
        qpos: starting positions, shape (nq,), read-only.
        report: what was changed, repaired or left out.
        robots: names of each robot's top-level bodies, by robot name.
    """

    model: mujoco.MjModel
    spec: mujoco.MjSpec | None
    joints: Mapping[str, RobotJoint]
    bodies: Mapping[str, int]
    qpos: NDArray[np.float64]
    report: BuildReport
    robots: Mapping[str, tuple[str, ...]]

    @property
    def robot_roots(self) -> frozenset[str]:
        """The top-level bodies of all robots."""
        return frozenset(root for roots in self.robots.values() for root in roots)


@frozen
class SavedModel:
    """A model that can be written to a file; all attributes except `content` are `BuiltModel`'s.

    Attributes:
        content: the model as MuJoCo saves it; other versions of MuJoCo than its own patch
            releases may not read it.
    """

    content: bytes
    joints: Mapping[str, RobotJoint]
    bodies: Mapping[str, int]
    qpos: NDArray[np.float64]
    robots: Mapping[str, tuple[str, ...]]

    @classmethod
    def of(cls, built: BuiltModel) -> "SavedModel":
        """Save a model that no simulation uses yet: a simulation changes its model."""
        content = np.empty(mujoco.mj_sizeModel(built.model), np.uint8)
        mujoco.mj_saveModel(built.model, None, content)
        return cls(
            content.tobytes(),
            dict(built.joints),
            dict(built.bodies),
            built.qpos,
            dict(built.robots),
        )

    def load(self) -> BuiltModel:
        """Return the model; it has no specification, so the world cannot be changed further.

        Raises:
            ModelError: this version of MuJoCo cannot read it.
        """
        name = "saved.mjb"
        try:
            content = for_version(self.content, mujoco.mj_version())
            model = mujoco.MjModel.from_binary_path(name, {name: content})
        except (ValueError, mujoco.FatalError) as error:
            theirs, reason = saved_version(self.content), " ".join(str(error).split())
            by = "" if theirs is None else f" that MuJoCo {version_text(theirs)} saved"
            raise ModelError(
                f"MuJoCo {mujoco.__version__} cannot read the model{by}: {reason}"
            ) from error
        qpos = self.qpos.copy()
        qpos.setflags(write=False)
        return BuiltModel(model, None, self.joints, self.bodies, qpos, BuildReport(), self.robots)
