"""The errors of this package.

GazeboError
├── SensorError     a sensor's description
├── CameraError     a camera's process
│   └── BackendError  an OpenGL library that starts but does not draw
├── OrphanError     the simulation ended before its child process was there
├── WindowError     a window cannot be opened where the simulation runs
├── WorldError      a world file that is missing, or neither MJCF nor SDF
├── ModelError      a robot that cannot be made into a model
│   └── MeshError   a mesh file that cannot be used
├── TimingError     a control rate or a physics step that cannot be
├── SettingsError   a parameter of the simulation node that makes no sense
└── RefusedError    a request about the running world that cannot be met; see `refusal`
"""


class GazeboError(Exception):
    """Root of what this package raises; the message is a sentence for the user."""


class SensorError(GazeboError):
    """A sensor is described wrongly; the message names the sensor, the element and the line."""


class CameraError(GazeboError):
    """A camera's process cannot do its work."""


class BackendError(CameraError):
    """An OpenGL library started in this process, but no picture comes out of it."""


class OrphanError(GazeboError):
    """The simulation that started this child process has ended."""


class WindowError(GazeboError):
    """A window is asked for and there is no display; the message names the fix."""


class WorldError(GazeboError):
    """A world file does not exist or does not compile; the message names the shipped worlds."""


class ModelError(GazeboError):
    """The robot cannot be simulated as described; the message names the element and its line."""


class MeshError(ModelError):
    """A mesh file cannot be found or read."""


class TimingError(GazeboError):
    """The control rate is not positive, or a fixed physics step does not divide its period."""


class SettingsError(GazeboError):
    """A parameter of the simulation node makes no sense; the message names it and what would."""
