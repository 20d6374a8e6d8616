"""The unlit colours of a model's surfaces and its sky."""

import mujoco
import numpy as np
from numpy.typing import NDArray

Colours = NDArray[np.float32]

UNSET_RGBA = np.array([0.5, 0.5, 0.5, 1.0], dtype=np.float32)
"""MuJoCo's colour of a geom without one; its material's colour counts instead."""
SKY_FACE = 4
"""A sky box is six images stacked vertically; this one is upright, with the zenith at the top."""


class SurfaceColours:
    """Colours of a model's geoms and sky. A texture counts as its mean colour."""

    def __init__(self, model: mujoco.MjModel) -> None:
        geoms = range(model.ngeom)
        self._paint = np.array([_paint(model, i)[:3] for i in geoms], np.float32)
        self._tint = np.array([_tint(model, i) for i in geoms], np.float32)
        self._glow = np.array([_emission(model, i) for i in geoms], np.float32)
        self._sky = _sky_rows(model)

    def lit(self, geoms: NDArray[np.int32], brightness: Colours) -> Colours:
        """Return the colours (n, 3), in 0..1, of geoms (n,) under light of (n, 3)."""
        light = self._paint[geoms]
        light *= brightness + self._glow[geoms, np.newaxis]
        # OpenGL clips before it applies the texture, so a bright white floor keeps its pattern.
        np.minimum(light, 1.0, out=light)
        light *= self._tint[geoms]
        return light

    def sky(self, rays: NDArray[np.float64]) -> Colours:
        """Return the sky's colours (n, 3) along rays (n, 3) of any length."""
        across = np.maximum(np.abs(rays[:, 0]), np.abs(rays[:, 1]))
        height = np.clip(rays[:, 2] / np.maximum(across, 1e-9), -1.0, 1.0)
        rows = (0.5 * (1.0 - height) * (len(self._sky) - 1)).astype(np.intp)
        return self._sky[rows]


def flat_colours(model: mujoco.MjModel) -> Colours:
    """Return one colour and opacity for each geom, shape (ngeom, 4)."""
    colours = np.ones((model.ngeom, 4), np.float32)
    for geom in range(model.ngeom):
        colours[geom] = _paint(model, geom)
        colours[geom, :3] *= _tint(model, geom)
    return np.clip(colours, 0.0, 1.0)


def _paint(model: mujoco.MjModel, geom: int) -> Colours:
    """Return colour and opacity, shape (4,)."""
    material = model.geom_matid[geom]
    own: Colours = model.geom_rgba[geom]
    from_material = material >= 0 and np.array_equal(own, UNSET_RGBA)
    return model.mat_rgba[material] if from_material else own


def _tint(model: mujoco.MjModel, geom: int) -> Colours:
    material = model.geom_matid[geom]
    if material < 0:
        return np.ones(3, np.float32)
    texture = model.mat_texid[material, mujoco.mjtTextureRole.mjTEXROLE_RGB]
    if texture < 0:
        return np.ones(3, np.float32)
    return _texture(model, int(texture)).mean(axis=(0, 1))


def _emission(model: mujoco.MjModel, geom: int) -> float:
    material = model.geom_matid[geom]
    return float(model.mat_emission[material]) if material >= 0 else 0.0


def _sky_rows(model: mujoco.MjModel) -> Colours:
    """Return the sky's colours from zenith to nadir, (rows, 3); black without a sky box."""
    skies = np.flatnonzero(model.tex_type == mujoco.mjtTexture.mjTEXTURE_SKYBOX)
    if not skies.size:
        return np.zeros((1, 3), np.float32)
    texture = _texture(model, int(skies[0]))
    side = texture.shape[1]
    face = texture[SKY_FACE * side :][:side] if len(texture) >= 6 * side else texture
    return face.mean(axis=1, dtype=np.float32)


def _texture(model: mujoco.MjModel, index: int) -> Colours:
    """Return a texture's colours in 0..1, (height, width, 3)."""
    height, width = int(model.tex_height[index]), int(model.tex_width[index])
    channels, start = int(model.tex_nchannel[index]), int(model.tex_adr[index])
    raw = model.tex_data[start : start + height * width * channels]
    picture = raw.reshape(height, width, channels).astype(np.float32) / 255.0
    return picture[..., :3] if channels >= 3 else np.repeat(picture[..., :1], 3, axis=2)
