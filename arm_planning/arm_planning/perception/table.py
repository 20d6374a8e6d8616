"""The things that stand on a support plane, found in one view of a depth camera."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, hypot, sin
from typing import Literal

import cv2
import numpy as np

from arm_description.transforms import quaternion_from_rpy
from arm_node.rigid_transform import RigidTransform, rpy_from_rows
from arm_planning.perception.footprints import (
    Circle,
    Fit,
    Rectangle,
    fit_circle,
    fit_rectangle,
)
from arm_planning.perception.outline import FLATTEST, evidence_of, goes_on
from arm_planning.perception.support_plane import Picture, SupportPlane, find_support_plane
from arm_planning.perception.view import Array, Mask, PlaneView, Window, view_of

LEAST_HEIGHT_M = 0.005
"""Height above the plane from which on a point belongs to a thing."""
LEAST_PIXELS, LEAST_TOP_PIXELS, LEAST_EVIDENCE = 20, 4, 8
"""What is seen with less is noise."""
LEAST_MARGIN_M = 0.001
"""How far beside a footprint a thing's points may be, beside noise and pixels."""
REFINEMENTS = 2
TOP_RANK = 5
"""The search of a top starts at the height of the fifth highest pixel or below."""
LEVEL_FLOOR_M = 0.0005
"""Least half width of the band of heights that makes a top."""
MISFIT = 2.0
"""Error of a fit from which on a thing is neither a box nor a cylinder."""
MOST_PASSES = 100
"""How often the tallest thing is taken away, so that clutter costs a bounded time."""


@dataclass(frozen=True, slots=True)
class SeenThing:
    """An upright box or cylinder.

    Attributes:
        kind: "box" or "cylinder".
        pose: of its centre; z is the support's normal, x is along a box's first side.
        size: sides of a box; radius and height of a cylinder, in m.
        partial: it is not known as a whole: a nearer thing or the picture's edge hides a part, or
            it is neither a box nor a cylinder. The size is that of what is seen.
        pixels: of the picture that show it.
        error: misfit of the shape: about 1 if all of it is the noise of the depths.
    """

    kind: Literal["box", "cylinder"]
    pose: RigidTransform
    size: tuple[float, ...]
    partial: bool
    pixels: int
    error: float


@dataclass(frozen=True, slots=True)
class SeenTable:
    """A support plane in the camera's frame, and the things on it in the frame of its pose."""

    plane: SupportPlane
    things: tuple[SeenThing, ...]


def find_things(points: Picture, camera: RigidTransform, apart: Mask | None = None) -> SeenTable:
    """Return what stands on the largest level plane, from the largest to the smallest picture.

    Args:
        points: (height, width, 3) in the optical frame (x right, y down, z ahead), in m; nan
            where nothing is seen.
        camera: pose of the optical frame in one whose z axis is up.
        apart: (height, width), pixels of what is neither a thing nor the plane, such as the robot;
            what it may hide is returned as partial.

    Raises:
        PerceptionError: there is no level plane below the camera.
    """
    rotation = np.array(camera.matrix())[:3, :3]
    apart = np.zeros(points.shape[:2], bool) if apart is None else apart
    plane = find_support_plane(points, rotation[2], apart)
    normal = np.array(plane.normal)
    sideways = np.cross(normal, (0, 0, 1) if abs(normal[2]) < 0.9 else (0, 1, 0))
    sideways /= np.linalg.norm(sideways)
    axes = np.stack([sideways, np.cross(normal, sideways), normal])
    heights = plane.heights(points)
    noise = 5 * plane.noise * plane.distance * points[..., 2]
    raised = _without_specks(heights > LEAST_HEIGHT_M + noise) & (heights > LEAST_HEIGHT_M)
    if not (raised & ~apart).any():
        return SeenTable(plane, ())
    view, raised = view_of(points, plane, axes, raised & ~apart, raised & apart)
    found = sorted(_peeled(view, raised), key=lambda one: -one.pixels)
    return SeenTable(plane, tuple(_placed(one, plane, axes, camera) for one in found))


@dataclass(frozen=True, slots=True)
class _Found:
    """A thing in the frame of its view: `partial` and `pixels` as those of `SeenThing`."""

    fit: Fit
    level: float
    partial: bool
    pixels: int


def _peeled(view: PlaneView, raised: Mask) -> Iterator[_Found]:
    """Yield the things; of those that meet in the picture, the tallest first.

    Nothing lower hides a part of the tallest thing's top, and nothing else is as high: so its top
    alone tells where it ends, whatever it touches.
    """
    waiting = deque(_pieces(raised, (0, 0)))
    shapeless = np.zeros_like(raised)
    for _ in range(MOST_PASSES):
        if not waiting:
            return
        window, piece = waiting.popleft()
        found, claimed = _tallest(view, window, piece, raised[window], shapeless[window])
        if found is not None:
            yield found
            shapeless[window] |= claimed & (found.fit.error > MISFIT)
        corner = (window[0].start, window[1].start)
        rest = piece & ~claimed
        # The filter fills holes, too: what is accounted for stays so.
        waiting.extend(_pieces(rest & _without_specks(rest), corner))


def _pieces(mask: Mask, corner: tuple[int, int]) -> Iterator[tuple[Window, Mask]]:
    """Yield the connected parts of a mask, each with its window and one pixel around."""
    count, labels, boxes, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8))
    for label in range(1, count):
        left, top, width, height, area = boxes[label].tolist()
        if area >= LEAST_PIXELS:
            inner = (slice(top - 1, top + height + 1), slice(left - 1, left + width + 1))
            rows, columns = (
                slice(part.start + start, part.stop + start)
                for part, start in zip(inner, corner, strict=True)
            )
            yield (rows, columns), labels[inner] == label


def _without_specks(mask: Mask) -> Mask:
    return cv2.medianBlur(mask.astype(np.uint8), 3).astype(bool)


def _tallest(
    view: PlaneView, window: Window, piece: Mask, raised: Mask, shapeless: Mask
) -> tuple[_Found | None, Mask]:
    """Return the tallest thing of a piece, if it is one, and the pixels that are accounted for."""
    level, top = _top(view, window, piece)
    if top.sum() < LEAST_TOP_PIXELS:
        return None, top if top.any() else piece
    distance = float(np.median(view.depths[window][top]))
    rim = view.spots(window, top)
    steepness = view.steepness(rim.mean(axis=0), level)
    top_is_seen = steepness > FLATTEST
    if top_is_seen:
        rim = view.on_level(view.rays[window][top].astype(np.float64), level)
    steepness = max(steepness, FLATTEST)
    noise = view.noise(distance) / hypot(1, steepness)
    # One pixel of the top along the line of sight: so far its front edge may be from its pixels.
    reach = view.pixel * distance * hypot(1, 1 / steepness)
    spots = view.spots(window, piece)
    pixels = np.nonzero(piece)
    around = np.maximum(*(shape.distances(spots) for shape in _around(rim.astype(np.float32))))
    near = around < reach + 2.5 * noise + LEAST_MARGIN_M
    fit: Fit | None = None
    partial, claimed = False, top
    for _ in range(REFINEMENTS):
        claimed = top.copy()
        claimed[pixels[0][near], pixels[1][near]] = True
        others = _without_specks(raised & ~claimed)
        lid = top if top_is_seen else np.zeros_like(top)
        evidence, partial = evidence_of(view, window, claimed, lid, level, others)
        if len(evidence.points()) < LEAST_EVIDENCE:
            return None, claimed
        fit = min(fit_circle(evidence), fit_rectangle(evidence), key=lambda one: one.error)
        near = fit.shape.distances(spots) < 0.5 * reach + 4 * noise + LEAST_MARGIN_M
    assert fit is not None
    partial = partial or goes_on(view, window, claimed, shapeless)
    claimed[pixels[0][near], pixels[1][near]] = True
    partial = partial or not top_is_seen or fit.error > MISFIT
    return _Found(fit, level, partial, int(claimed.sum())), claimed


def _top(view: PlaneView, window: Window, piece: Mask) -> tuple[float, Mask]:
    """Return the height of the highest level part of a piece, and its pixels."""
    heights = view.heights[window]
    values = heights[piece]
    noise = view.level_noise(float(np.median(view.depths[window][piece])), float(np.median(values)))
    part = piece.astype(np.float32)
    smooth = cv2.blur(np.where(piece, heights, 0), (3, 3))[piece] / cv2.blur(part, (3, 3))[piece]
    rank = max(TOP_RANK, len(values) // 200)
    level = float(np.partition(smooth, -rank)[-rank])
    for _ in range(5):
        near = values[np.abs(values - level) < 2.5 * noise + LEVEL_FLOOR_M]
        level = float(np.median(near)) if len(near) else level
    top = piece & (np.abs(heights - level) < 3.5 * noise + LEVEL_FLOOR_M)
    count, labels, boxes, _ = cv2.connectedComponentsWithStats(top.astype(np.uint8))
    largest = 1 + int(boxes[1:, cv2.CC_STAT_AREA].argmax()) if count > 1 else 1
    return level, labels == largest


def _around(points: Picture) -> tuple[Circle, Rectangle]:
    """Return the smallest circle and rectangle around points (n, 2)."""
    (x, y), radius = cv2.minEnclosingCircle(points)
    (u, v), (along, across), degrees = cv2.minAreaRect(points)
    return Circle(x, y, radius), Rectangle(u, v, np.radians(degrees), along / 2, across / 2)


def _placed(found: _Found, plane: SupportPlane, axes: Array, camera: RigidTransform) -> SeenThing:
    """Return a thing in the frame of the camera's pose."""
    shape, level = found.fit.shape, found.level
    rotation = np.array(camera.matrix())[:3, :3]
    centre = (shape.x, shape.y, level / 2 - plane.distance)
    position = rotation @ (centre @ axes) + camera.position
    if isinstance(shape, Circle):
        kind, yaw, size = "cylinder", 0.0, (float(shape.radius), level)
    else:
        kind, yaw, size = "box", shape.yaw, (2 * float(shape.along), 2 * float(shape.across), level)
    columns = rotation @ (_turned(yaw) @ axes).T
    turn = quaternion_from_rpy(rpy_from_rows(columns.tolist()))
    pose = RigidTransform(tuple(position.tolist()), tuple(turn.tolist()))
    return SeenThing(kind, pose, size, found.partial, found.pixels, found.fit.error)


def _turned(yaw: float) -> Array:
    """Return the axes of a frame turned about z, as rows."""
    return np.array([(cos(yaw), sin(yaw), 0), (-sin(yaw), cos(yaw), 0), (0, 0, 1)])
