"""A camera of the robot as its URDF describes it, in Gazebo's own tags."""

import logging
import math
import re
from collections.abc import Callable, Container, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from arm_gazebo.errors import CameraError

logger = logging.getLogger(__name__)

DEFAULT_HFOV = 1.047
DEFAULT_SIZE = (320, 240)
DEFAULT_RATE_HZ = 30.0
DEFAULT_CLIP = (0.1, 100.0)
MAX_SIDE = 8192
"""Widest picture, in pixels: what common GL drivers can render into."""
FORMATS = ("R8G8B8", "RGB_INT8", "rgb8")
NOISE_TYPES = ("none", "gaussian", "gaussian_quantized")
FRAME_TAGS = ("optical_frame_id", "gz_frame_id", "ignition_frame_id")
TOPIC = re.compile(r"~?/?[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*")
OPTICAL_RPY = (-math.pi / 2, 0.0, -math.pi / 2)


@dataclass(frozen=True, slots=True)
class CameraSensor:
    """What one camera sees with, how often, and where its pictures go.

    Attributes:
        name: name of the sensor, unique in the robot; the MuJoCo camera has the same.
        link: link that carries the camera; it looks along the link's x axis, z up.
        optical_frame: frame of the messages' headers: z forward, x right, y down.
        width: picture's width in pixels.
        height: picture's height in pixels.
        hfov: horizontal field of view in rad, in (0, pi).
        near: nearest visible distance in m.
        far: farthest visible distance in m.
        rate_hz: frames per second of simulation time.
        noise_mean: mean of the Gaussian noise, as a fraction of the full range.
        noise_stddev: its standard deviation, as a fraction of the full range; 0 for none.
        image_topics: topics of the picture; relative ones are in the node's namespace.
        info_topics: topics of the intrinsics.
        xyz: position of the camera in its link, in m.
        rpy: orientation of the camera in its link, in rad.
    """

    name: str
    link: str
    optical_frame: str
    width: int = DEFAULT_SIZE[0]
    height: int = DEFAULT_SIZE[1]
    hfov: float = DEFAULT_HFOV
    near: float = DEFAULT_CLIP[0]
    far: float = DEFAULT_CLIP[1]
    rate_hz: float = DEFAULT_RATE_HZ
    noise_mean: float = 0.0
    noise_stddev: float = 0.0
    image_topics: tuple[str, ...] = ()
    info_topics: tuple[str, ...] = ()
    xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def focal_length(self) -> float:
        """Focal length in pixels, the same along both axes: pixels are square."""
        return self.width / 2 / math.tan(self.hfov / 2)

    @property
    def vfov(self) -> float:
        """Vertical field of view in rad; MuJoCo's `fovy` is this in degrees."""
        return 2 * math.atan(self.height / 2 / self.focal_length)


def parse_cameras(urdf_xml: str, source: str = "robot_description") -> tuple[CameraSensor, ...]:
    """Return the cameras of a URDF, in document order.

    A camera is `<gazebo reference="LINK"><sensor name="NAME" type="camera">`. What a tag leaves
    out has Gazebo's default.

    Raises:
        CameraError: a value is nonsense; the message names sensor, element and line.
        XmlError: the text is not XML.
    """
    # The camera process knows sensors too, but parses nothing and shall start quickly.
    from arm_description.xml_document import parse_xml

    root = parse_xml(urdf_xml, source)
    links = [str(link.get("name")) for link in root.findall("link")]
    cameras: list[CameraSensor] = []
    taken: dict[str, str] = {}
    for link, element in _camera_elements(root):
        tags = _SensorTags(element, link)
        if link not in links:
            raise tags.error("gazebo", f"no link {link!r}; the robot has {', '.join(links)}")
        if any(camera.name == tags.name for camera in cameras):
            raise tags.error("sensor", "a second camera of this name; each needs a name of its own")
        camera = _read_camera(tags, root, taken)
        _take_topics(camera, tags, taken)
        cameras.append(camera)
    return tuple(cameras)


def _camera_elements(root: Any) -> Iterator[tuple[str, Any]]:
    for gazebo in root.findall("gazebo"):
        for sensor in gazebo.findall("sensor"):
            if sensor.get("type") == "camera":
                yield str(gazebo.get("reference", "")), sensor
            else:
                logger.warning(
                    "sensor %r (line %s) has type %r: it is not simulated, only 'camera' is",
                    sensor.get("name"),
                    sensor.sourceline,
                    sensor.get("type"),
                )


class _SensorTags:
    """The tags of one `<sensor>`: typed look-ups whose errors say where they failed."""

    def __init__(self, element: Any, link: str) -> None:
        self._element = element
        self.link = link
        self.name = str(element.get("name") or "").strip()
        if not self.name:
            raise self.error("sensor", "a sensor needs a name")

    def error(self, tag: str, problem: str, element: Any = None) -> CameraError:
        """Return an error about one tag, or attribute, of this sensor."""
        line = (self._element if element is None else element).sourceline
        return CameraError(f"camera sensor {self.name!r}, <{tag}> (line {line}): {problem}")

    def texts(self, *tags: str) -> list[tuple[Any, str]]:
        """Return element and text of every filled tag of these names, also below `<camera>`."""
        found = (e for tag in tags for e in self._element.xpath(f"./{tag} | ./camera/{tag}"))
        return [(e, str(e.text or "").strip()) for e in found if str(e.text or "").strip()]

    def number(
        self, tag: str, default: float, fits: Callable[[float], bool], must_be: str
    ) -> float:
        """Return a finite number that fits; `must_be` says in words what fits."""
        for element, text in self.texts(tag):
            try:
                value = float(text)
            except ValueError:
                value = math.nan
            if not math.isfinite(value) or not fits(value):
                raise self.error(tag, f"must be {must_be}, not {text!r}", element)
            return value
        return default

    def pixels(self, tag: str, default: int) -> int:
        """Return a whole number of pixels, at least 1."""
        must_be = f"a whole number from 1 to {MAX_SIDE}"
        return int(self.number(tag, default, lambda v: v in range(1, MAX_SIDE + 1), must_be))

    def choice(self, tag: str, choices: tuple[str, ...]) -> str:
        """Return a tag's text, the first choice where it is missing."""
        for element, text in self.texts(tag):
            if text not in choices:
                raise self.error(tag, f"{text!r} is not one of {', '.join(choices)}", element)
            return text
        return choices[0]

    def topics(self, tag: str) -> tuple[str, ...]:
        """Return the valid ROS topic names that the tags of this name hold."""
        names: list[str] = []
        for element, text in self.texts(tag):
            if not TOPIC.fullmatch(text):
                raise self.error(tag, f"{text!r} is not a valid ROS topic name", element)
            names.append(text)
        return tuple(dict.fromkeys(names))

    def pose(self) -> tuple[float, ...]:
        """Return x y z roll pitch yaw of the camera in its link."""
        for element, text in self.texts("pose"):
            try:
                values = tuple(float(word) for word in text.split())
            except ValueError:
                values = ()
            if len(values) != 6 or not all(map(math.isfinite, values)):
                raise self.error("pose", f"{text!r} is not six numbers", element)
            return values
        return (0.0,) * 6


def _read_camera(tags: _SensorTags, root: Any, taken: Mapping[str, str]) -> CameraSensor:
    near = tags.number("clip/near", DEFAULT_CLIP[0], lambda v: v > 0, "above 0")
    far_default = max(DEFAULT_CLIP[1], 2 * near)
    tags.choice("image/format", FORMATS)
    noisy = tags.choice("noise/type", NOISE_TYPES) != "none"
    images = tags.topics("topic") or (re.sub(r"[^A-Za-z0-9_/]", "_", tags.name),)
    frames = tags.texts(*FRAME_TAGS)
    pose = tags.pose()
    # Gazebo reads rate 0 as "every step"; nobody wants 500 pictures a second.
    rate_hz = tags.number("update_rate", 0.0, lambda v: v >= 0, "at least 0") or DEFAULT_RATE_HZ
    return CameraSensor(
        name=tags.name,
        link=tags.link,
        optical_frame=frames[0][1] if frames else _optical_child(root, tags.link),
        width=tags.pixels("image/width", DEFAULT_SIZE[0]),
        height=tags.pixels("image/height", DEFAULT_SIZE[1]),
        hfov=tags.number("horizontal_fov", DEFAULT_HFOV, lambda v: 0 < v < math.pi, "in (0, pi)"),
        near=near,
        far=tags.number("clip/far", far_default, lambda v: v > near, f"above near, {near:g}"),
        rate_hz=rate_hz,
        noise_mean=_noise(tags, "mean", -1, "from -1 to 1") if noisy else 0.0,
        noise_stddev=_noise(tags, "stddev", 0, "from 0 to 1") if noisy else 0.0,
        image_topics=images,
        info_topics=tags.topics("camera_info_topic") or _default_info_topics(images, taken),
        xyz=(pose[0], pose[1], pose[2]),
        rpy=(pose[3], pose[4], pose[5]),
    )


def _noise(tags: _SensorTags, tag: str, least: float, must_be: str) -> float:
    return tags.number(f"noise/{tag}", 0.0, lambda v: least <= v <= 1, must_be)


def _default_info_topics(images: tuple[str, ...], taken: Container[str]) -> tuple[str, ...]:
    """Return both customs: below the image topic, and beside it as Gazebo and ROS drivers do.

    The one beside it is left out where an earlier camera has it: two cameras would mix there.
    """
    below = [f"{image}/camera_info" for image in images]
    beside = ["".join(image.rpartition("/")[:2]) + "camera_info" for image in images]
    return tuple(dict.fromkeys([*below, *(topic for topic in beside if topic not in taken)]))


def _take_topics(camera: CameraSensor, tags: _SensorTags, taken: dict[str, str]) -> None:
    for topic in (*camera.image_topics, *camera.info_topics):
        if topic in taken:
            raise tags.error("topic", f"{topic!r} is taken by camera {taken[topic]!r}")
        taken[topic] = camera.name


def _optical_child(root: Any, link: str) -> str:
    """Return the frame fixed to the link with the optical orientation; the link if none is."""
    for joint in root.findall("joint"):
        parent, child, origin = (joint.find(tag) for tag in ("parent", "child", "origin"))
        if joint.get("type") != "fixed" or parent is None or child is None or origin is None:
            continue
        try:
            rpy = [float(word) for word in str(origin.get("rpy", "")).split()]
        except ValueError:
            continue
        near_optical = len(rpy) == 3 and all(
            abs(a - b) < 0.01 for a, b in zip(rpy, OPTICAL_RPY, strict=True)
        )
        if parent.get("link") == link and near_optical:
            return str(child.get("link"))
    return link
