"""Read the cameras of a URDF from Gazebo's sensor tags."""

import logging
import math
from collections.abc import Callable, Container, Iterator
from dataclasses import dataclass, replace

import numpy as np

from arm_description.urdf.description import Description, RobotDescription, as_description
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
from arm_gazebo.sensors.camera_frames import ROTATION_TOLERANCE, CameraFrames
from arm_gazebo.sensors.lens_reader import with_lens
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
    `depth_camera` or `rgbd_camera`. Values that a tag leaves out have Gazebo's defaults.

    Args:
        description: the robot description.
        note: receives what is doubtful or not read.

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


@dataclass(frozen=True, slots=True)
class _Topics:
    """The topics of a camera, which depend on its type.

    They are below `<topic>` with Gazebo's names. A tag for one topic, such as `<image_topic>`,
    overrides its name; it replaces the remapping in a configuration of Gazebo's bridge.
    """

    image_topics: tuple[str, ...] = ()
    info_topics: tuple[str, ...] = ()
    depth_topics: tuple[str, ...] = ()
    points_topics: tuple[str, ...] = ()

    @classmethod
    def of(cls, tags: SensorTags, taken: Container[str]) -> "_Topics":
        topics, infos = tags.own_topics(), tags.topics("camera_info_topic")
        if tags.type == "rgbd_camera":
            return cls(
                image_topics=tags.topics("image_topic") or _below(topics, "image"),
                info_topics=infos or _below(topics, "camera_info"),
                depth_topics=tags.topics("depth_image_topic") or _below(topics, "depth_image"),
                points_topics=tags.topics("points_topic") or _below(topics, "points"),
            )
        infos = infos or _default_info_topics(topics, taken)
        if tags.type == "depth_camera":
            points = tags.topics("points_topic") or _below(topics, "points")
            return cls(info_topics=infos, depth_topics=topics, points_topics=points)
        return cls(image_topics=topics, info_topics=infos)


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
    topics = _Topics.of(tags, taken)
    numbers = tags.pose()
    pose = Pose((numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5]))
    frames = CameraFrames(document, tags.reference)
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
        image_topics=topics.image_topics,
        info_topics=topics.info_topics,
        depth_topics=topics.depth_topics,
        points_topics=topics.points_topics,
        xyz=pose.xyz,
        rpy=pose.rpy,
        optics_in_frame=SAME_FRAME
        # A frame that is not fixed to the link counts as the optical one.
        if optics is None or not topics.points_topics
        else tuple(optics[:3].ravel().tolist()),
    )
    return with_lens(camera, tags)


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
