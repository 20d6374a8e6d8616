"""Read the cameras of a URDF from Gazebo's sensor tags."""

import logging
import math
from collections import deque
from collections.abc import Callable, Container, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_description.errors import UrdfError
from arm_description.transforms import rotation_from_rpy
from arm_description.urdf.description import Description, RobotDescription, as_description
from arm_description.urdf.element import UrdfElement
from arm_description.urdf.robot import Pose
from arm_gazebo.build_report import Finding
from arm_gazebo.sensors.camera import (
    DEFAULT_CLIP,
    DEFAULT_HFOV,
    DEFAULT_RATE_HZ,
    DEFAULT_SIZE,
    MAX_SIDE,
    SAME_FRAME,
    CameraSensor,
)
from arm_gazebo.sensors.noise import noise_type
from arm_gazebo.sensors.reader import TYPES, sensor_type
from arm_gazebo.sensors.tags import (
    COLOR_FORMATS,
    SensorTags,
    unique_names,
)

logger = logging.getLogger(__name__)

FORMATS = (
    *COLOR_FORMATS,
    *("L8", "L_INT8", "L16", "L_INT16", "B8G8R8", "BGR_INT8", "R_FLOAT16", "R_FLOAT32"),
    *("BAYER_RGGB8", "BAYER_BGGR8", "BAYER_GBRG8", "BAYER_GRBG8"),
)
"""Gazebo's formats. All are accepted, but images are always rgb8; `unread_elements` says so."""
CAMERA_TYPES = ("camera", "depth_camera", "rgbd_camera")


def parse_cameras(
    description: Description, note: Callable[[Finding], None] = lambda _finding: None
) -> tuple[CameraSensor, ...]:
    """Return the cameras of a URDF, in document order.

    A camera is `<gazebo reference="LINK"><sensor name="NAME" type="camera">`, or of type
    `depth_camera` or `rgbd_camera`. Values that a tag leaves out have Gazebo's defaults. `note`
    receives what is doubtful or not read.

    Raises:
        SensorError: a value is invalid; the message names sensor, element and line.
        XmlError: the text is not XML.
    """
    document = as_description(description)
    links = [link.get("name") for link in document.links]
    cameras: list[CameraSensor] = []
    taken: dict[str, CameraSensor] = {}
    for tags in _camera_tags(document):
        tags.check_reference("link", links)
        if any((c.name, c.link) == (tags.name, tags.reference) for c in cameras):
            raise tags.error(
                "sensor",
                f"a second camera of this name on link {tags.reference!r}; each needs a name of "
                "its own",
            )
        camera = _read_camera(tags, document, taken)
        _take_topics(camera, tags, taken)
        cameras.append(camera)
        for finding in tags.findings():
            note(finding)
    names = unique_names(cameras)
    return tuple(replace(c, name=name) for c, name in zip(cameras, names, strict=True))


def _camera_tags(document: RobotDescription) -> Iterator[SensorTags]:
    for link, sensor in document.sensors:
        kind = sensor_type(sensor)
        if kind in CAMERA_TYPES:
            yield SensorTags(sensor, link, kind, "camera")
        elif kind is None:
            logger.warning(
                "sensor %r (line %s) has type %r: it is not simulated, only %s are",
                *(sensor.attributes.get("name"), sensor.line, sensor.attributes.get("type")),
                ", ".join(dict.fromkeys(TYPES.values())),
            )


def _topics(tags: SensorTags, taken: Container[str]) -> dict[str, Any]:
    """Return the topics of a camera by the attribute of `CameraSensor`; its type has certain ones.

    They are below `<topic>` with Gazebo's names. A tag for one topic, such as `<image_topic>`,
    overrides its name; it replaces the remapping in a configuration of Gazebo's bridge.
    """
    topics, infos = tags.own_topics(), tags.topics("camera_info_topic")
    if tags.type == "rgbd_camera":
        return {
            "image_topics": tags.topics("image_topic") or _below(topics, "image"),
            "info_topics": infos or _below(topics, "camera_info"),
            "depth_topics": tags.topics("depth_image_topic") or _below(topics, "depth_image"),
            "points_topics": tags.topics("points_topic") or _below(topics, "points"),
        }
    infos = infos or _default_info_topics(topics, taken)
    if tags.type == "depth_camera":
        points = tags.topics("points_topic") or _below(topics, "points")
        return {"info_topics": infos, "depth_topics": topics, "points_topics": points}
    return {"image_topics": topics, "info_topics": infos}


def _below(topics: tuple[str, ...], name: str) -> tuple[str, ...]:
    return tuple(f"{topic}/{name}" for topic in topics)


def _read_camera(
    tags: SensorTags, document: RobotDescription, taken: Container[str]
) -> CameraSensor:
    near = tags.number("clip/near", DEFAULT_CLIP[0], lambda v: v > 0, "above 0")
    far_default = max(DEFAULT_CLIP[1], 2 * near)
    if tags.type == "camera":
        tags.choice("image/format", FORMATS)
    noisy = noise_type(tags, "noise") != "none"
    topics = _topics(tags, taken)
    numbers = tags.pose()
    pose = Pose((numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5]))
    frames = _CameraFrames(document, tags.reference)
    frame = tags.frame(frames.optical())
    optics = frames.optics_in(frame, pose)
    if optics is not None and np.abs(optics[:3, :3] - np.eye(3)).max() > ROTATION_TOLERANCE:
        tags.doubt(
            ".",
            f"its images and camera_info have the frame '{frame}', whose z axis does not look "
            f"where the camera looks (REP 103); give '{tags.reference}' a child link by a fixed "
            "joint with the rpy -1.5708 0 -1.5708",
        )
    camera = CameraSensor(
        name=tags.name,
        link=tags.reference,
        optical_frame=frame,
        width=_pixels(tags, "image/width", DEFAULT_SIZE[0]),
        height=_pixels(tags, "image/height", DEFAULT_SIZE[1]),
        hfov=tags.number("horizontal_fov", DEFAULT_HFOV, lambda v: 0 < v < math.pi, "in (0, pi)"),
        near=near,
        far=tags.number("clip/far", far_default, lambda v: v > near, f"above near, {near:g}"),
        # Gazebo reads rate 0 as "every step", but nobody wants 500 images a second.
        rate_hz=tags.rate_hz() or DEFAULT_RATE_HZ,
        noise_mean=_noise(tags, "mean", -1, "from -1 to 1") if noisy else 0.0,
        noise_stddev=_noise(tags, "stddev", 0, "from 0 to 1") if noisy else 0.0,
        **topics,
        xyz=pose.xyz,
        rpy=pose.rpy,
        optics_in_frame=SAME_FRAME
        # A frame that is not fixed to the link counts as the optical one.
        if optics is None or "points_topics" not in topics
        else tuple(optics[:3].ravel().tolist()),
    )
    return _with_lens(camera, tags)


def _noise(tags: SensorTags, tag: str, least: float, must_be: str) -> float:
    return tags.number(f"noise/{tag}", 0.0, lambda v: least <= v <= 1, must_be)


def _pixels(tags: SensorTags, tag: str, default: int) -> int:
    must_be = f"a whole number from 1 to {MAX_SIDE}"
    return int(tags.number(tag, default, lambda v: v in range(1, MAX_SIDE + 1), must_be))


def _default_info_topics(images: tuple[str, ...], taken: Container[str]) -> tuple[str, ...]:
    """Return two camera info topics: below the image topic, and beside it as ROS drivers have it.

    The topic beside the image is left out if an earlier camera uses it, because the messages of
    two cameras would mix.
    """
    below = _below(images, "camera_info")
    beside = ["".join(image.rpartition("/")[:2]) + "camera_info" for image in images]
    return tuple(dict.fromkeys([*below, *(topic for topic in beside if topic not in taken)]))


def _take_topics(camera: CameraSensor, tags: SensorTags, taken: dict[str, CameraSensor]) -> None:
    for topic in camera.topics:
        if topic in taken:
            raise tags.topic_error(topic, "camera", taken[topic])
        taken[topic] = camera


Matrix = NDArray[np.float64]

OPTICAL_RPY = (-math.pi / 2, 0.0, -math.pi / 2)
"""From a link that looks along x, z up, to the optical frame: z forward, y down (REP 103)."""
OPTICAL = rotation_from_rpy(OPTICAL_RPY)
ROTATION_TOLERANCE = 0.01


class _CameraFrames:
    """A link of a URDF and every link that fixed joints attach to it."""

    def __init__(self, description: RobotDescription, link: str) -> None:
        self._link = link
        self._poses: dict[str, Matrix] = {link: np.eye(4)}
        fixed = [joint for joint in description.joints if joint.get("type") == "fixed"]
        pending = deque([link])
        while pending:
            parent = pending.popleft()
            for joint in fixed:
                child = _child_of(joint, parent)
                origin = _origin(joint) if child and child not in self._poses else None
                if origin is not None:
                    self._poses[child] = self._poses[parent] @ origin.matrix()
                    pending.append(child)

    def optical(self) -> str:
        """Return the nearest frame with the optical orientation, or the link if there is none."""
        for name, pose in self._poses.items():
            if np.abs(pose[:3, :3] - OPTICAL).max() < ROTATION_TOLERANCE:
                return name
        return self._link

    def optics_in(self, frame: str, camera: Pose) -> Matrix | None:
        """Return the (4, 4) pose of a camera's optical axes in a frame.

        It is None for a frame that is not fixed to the camera's link.
        """
        pose = self._poses.get(frame)
        if pose is None:
            return None
        optics = camera.matrix()
        optics[:3, :3] = optics[:3, :3] @ OPTICAL
        return np.linalg.inv(pose) @ optics


def _child_of(joint: UrdfElement, parent: str) -> str:
    """Return the child link of a joint; empty if the joint has another parent link."""
    above, below = joint.first("parent"), joint.first("child")
    if above is None or below is None or above.get("link") != parent:
        return ""
    return below.get("link")


def _origin(joint: UrdfElement) -> Pose | None:
    """Return the pose of a joint in its parent link; None if the origin is invalid."""
    origin = joint.first("origin")
    try:
        return origin.pose() if origin else Pose()
    except UrdfError:
        return None


INTRINSICS = {"fx": 277.0, "fy": 277.0, "cx": 160.0, "cy": 120.0}
"""SDF's defaults, which hold for a picture of 320x240 and are used for every size."""
COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3")
MIDDLE = (0.5, 0.5)
FOCAL_LENGTHS = (1.0, 1e6)
OFFSETS = (-1e5, 1e5)
"""Limits in pixels of the principal point and the skew."""
LARGEST = 1e6
"""Limit of a coefficient."""
HALF_PIXEL = 0.5


def _with_lens(camera: CameraSensor, tags: SensorTags) -> CameraSensor:
    """Return a camera with the lens that its tags describe.

    `<center>` is the principal point as a fraction of the picture's sides. It counts if there are
    coefficients, as in Gazebo, and if `<intrinsics>` does not say where that point is.

    Raises:
        SensorError: a value is invalid, or the distortion cannot be undone in the whole picture.
    """
    intrinsics = _intrinsics(tags)
    distortion = tuple(
        _number(tags, f"distortion/{name}", 0.0, (-LARGEST, LARGEST)) for name in COEFFICIENTS
    )
    center = tags.numbers("distortion/center", MIDDLE)
    point = center[0] * camera.width, center[1] * camera.height
    if any(distortion) and center != MIDDLE:
        if not all(0 <= share <= 1 for share in center):
            raise tags.error("distortion/center", f"must be from 0 to 1, not {center}")
        if not intrinsics:
            focal_length = camera.lens.fx
            intrinsics = (focal_length, focal_length, *point, 0.0)
        elif np.abs(np.subtract(intrinsics[2:4], point)).max() > HALF_PIXEL:
            used = " ".join(f"{value:g}" for value in intrinsics[2:4])
            tags.doubt(
                "distortion/center",
                f"this is the pixel {point[0]:g} {point[1]:g}, but the principal point of "
                f"<intrinsics>, {used}, is the centre of the distortion",
            )
    camera = replace(camera, intrinsics=intrinsics, distortion=distortion)
    _check_size(camera, tags)
    return camera


def _intrinsics(tags: SensorTags) -> tuple[float, ...]:
    """Return fx, fy, cx, cy and skew; empty without `<intrinsics>`."""
    where = "lens/intrinsics"
    if not tags.has(where):
        return ()
    missing = {name: value for name, value in INTRINSICS.items() if not tags.has(f"{where}/{name}")}
    if missing:
        values = ", ".join(f"<{name}> {value:g}" for name, value in missing.items())
        tags.doubt(where, f"what it leaves out has SDF's value for 320x240: {values}")
    numbers = [
        _number(tags, f"{where}/{name}", value, FOCAL_LENGTHS if name[0] == "f" else OFFSETS)
        for name, value in INTRINSICS.items()
    ]
    return (*numbers, _number(tags, f"{where}/s", 0.0, OFFSETS))


def _number(tags: SensorTags, tag: str, default: float, limits: tuple[float, float]) -> float:
    least, largest = limits
    must_be = f"from {least:g} to {largest:g}"
    return tags.number(tag, default, lambda value: least <= value <= largest, must_be)


def _check_size(camera: CameraSensor, tags: SensorTags) -> None:
    lens, size = camera.lens, (camera.width, camera.height)
    if lens.is_pinhole:
        return
    problem = lens.problem(*size)
    if not problem:
        drawn = np.ptp(lens.outline(*size), axis=0) * (lens.fx, lens.fy)
        if drawn.max() > MAX_SIDE:
            problem = (
                f"a picture without it would have {drawn[0]:.0f}x{drawn[1]:.0f} pixels; at most "
                f"{MAX_SIDE} can be rendered"
            )
    if problem:
        raise tags.error("distortion", problem)
