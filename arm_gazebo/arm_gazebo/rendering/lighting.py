"""Brightness of surfaces: Lambert's law with the lights of a MuJoCo scene, without shadows."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray


class Lighting:
    """The head light and the active lights of one state of a model, as seen by one camera."""

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, forward: NDArray[np.float64]
    ) -> None:
        """Collect the lights.

        Args:
            model: the model.
            data: state with up-to-date frames of the lights.
            forward: (3,) unit vector along which the camera looks; the head light's direction.
        """
        self._model = model
        self._data = data
        self._forward = forward
        self._active = [int(index) for index in np.flatnonzero(model.light_active)]

    def brightness(
        self, points: NDArray[np.float64], normals: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        """Return the brightness (n, 3) of white surfaces, 1 for fully lit.

        Args:
            points: (n, 3) points on the surfaces, in m.
            normals: (n, 3) outward unit normals there.
        """
        light = np.zeros(points.shape, np.float32)
        head = self._model.vis.headlight
        if head.active:
            facing = np.maximum(-(normals @ self._forward), 0.0)[:, np.newaxis]
            light += np.asarray(head.ambient) + facing * np.asarray(head.diffuse)
        for index in self._active:
            light += self._model.light_ambient[index]
            light += (
                self._diffuse(index, points, normals)[:, np.newaxis]
                * (self._model.light_diffuse[index])
            )
        return light

    def _diffuse(
        self, index: int, points: NDArray[np.float64], normals: NDArray[np.float64]
    ) -> NDArray[np.float32]:
        direction = self._data.light_xdir[index]
        kind = self._model.light_type[index]
        if kind == mujoco.mjtLightType.mjLIGHT_DIRECTIONAL:
            return np.maximum(-(normals @ direction), 0.0).astype(np.float32)
        beams = points - self._data.light_xpos[index]
        distances = np.maximum(np.linalg.norm(beams, axis=1), 1e-9)
        beams /= distances[:, np.newaxis]
        facing = np.maximum(-np.einsum("ij,ij->i", normals, beams), 0.0)
        constant, linear, square = self._model.light_attenuation[index]
        facing /= constant + distances * (linear + distances * square)
        if kind == mujoco.mjtLightType.mjLIGHT_SPOT:
            inside = beams @ direction
            edge = math.cos(math.radians(float(self._model.light_cutoff[index])))
            facing *= np.where(inside > edge, inside, 0.0) ** self._model.light_exponent[index]
        return facing.astype(np.float32)
