"""The errors of this package.

GazeboError
├── SensorError     invalid sensor description
├── CameraError     the camera process cannot work
│   └── BackendError  an OpenGL library starts but does not draw
├── OrphanError     the simulation ended before its child process started
├── WindowError     a window is requested but there is no display
├── WorldError      a world file is missing, or is neither MJCF nor SDF
├── ModelError      a robot cannot be converted to a model
│   └── MeshError   a mesh file cannot be used
├── TimingError     invalid control rate or physics step
├── BatchError      copies of a simulation cannot be made, or not commanded this way
│   └── MissingWarpError  copies on a GPU need MuJoCo Warp, which is not installed
├── RecordingError  a recording cannot be written, read or run again
├── FaultError      a requested fault is not possible here
├── SimSettingsError   invalid parameter of the simulation node
│   └── ControllerTypeError  a file names a controller's type that does not exist
└── RequestError    a request to the running world is refused; see `Refusal`
"""

from enum import Enum, auto


class GazeboError(Exception):
    """Base class of this package's errors; the message is a sentence for the user."""


class SensorError(GazeboError):
    """A sensor description is invalid; the message names the sensor, the element and the line."""


class CameraError(GazeboError):
    """The camera process cannot do its work."""


class BackendError(CameraError):
    """An OpenGL library started in this process but does not draw."""


class OrphanError(GazeboError):
    """The simulation that started this child process has ended."""


class WindowError(GazeboError):
    """A window is requested but there is no display; the message names the fix."""


class WorldError(GazeboError):
    """A world file does not exist or does not compile; the message names the shipped worlds."""


class ModelError(GazeboError):
    """The robot cannot be simulated as described; the message names the element and its line."""


class MeshError(ModelError):
    """A mesh file cannot be found or read."""


class TimingError(GazeboError):
    """The control rate is not positive, or a fixed physics step does not divide its period."""


class SimSettingsError(GazeboError):
    """A parameter of the simulation node is invalid; the message names it and the valid values."""


class ControllerTypeError(SimSettingsError):
    """A file misspells the type of a controller; the message has the near names."""


class BatchError(GazeboError):
    """Copies of a simulation cannot be made, or not commanded this way; the message says why."""


class MissingWarpError(BatchError, ImportError):
    """MuJoCo Warp is not installed; the message tells how to install it."""


class RecordingError(GazeboError):
    """A recording of a run cannot be written, read or run again; the message says why."""


class FaultError(GazeboError):
    """A requested fault is not possible here; the message says which ones are."""


class Refusal(Enum):
    """The kinds of refusal that result codes distinguish."""

    UNSUPPORTED = auto()
    NOT_FOUND = auto()
    INCORRECT_STATE = auto()
    FAILED = auto()
    NAME_NOT_UNIQUE = auto()
    NAME_INVALID = auto()
    NAMESPACE_INVALID = auto()
    UNSUPPORTED_FORMAT = auto()
    NO_RESOURCE = auto()
    UNREADABLE = auto()
    MISSING_ASSETS = auto()
    UNSUPPORTED_ELEMENTS = auto()
    INVALID_POSE = auto()
    NO_WORLD = auto()
    ALREADY_THERE = auto()
    INCORRECT_TRANSITION = auto()


class RequestError(GazeboError):
    """A request to the running world is refused; nothing was changed.

    Attributes:
        refusal: the kind; the message is for the user.
    """

    def __init__(self, refusal: Refusal, message: str) -> None:
        super().__init__(message)
        self.refusal = refusal
