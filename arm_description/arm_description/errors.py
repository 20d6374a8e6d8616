"""The errors of this package; each message says what is wrong, where, and what exists.

DescriptionError
├── XmlError                 text that is not XML or is refused (a DOCTYPE, too large)
├── UrdfError                XML that does not describe a robot
│   └── MimicCycleError      joints that mimic each other in a circle
├── XacroError               a xacro file that cannot be expanded
├── ResourceNotFoundError    a mesh or another file that a URI names but that does not exist
├── MeshFileError            a mesh file that cannot be read
├── KinematicsError          joint positions that do not fit the robot
├── JointStateError          a joint state message that cannot be used
└── SettingsError            a parameter or an argument of a node that cannot be used
"""


class DescriptionError(Exception):
    """Root of this package's errors; the message is a sentence for the user."""


class XmlError(DescriptionError):
    """The text is not well-formed XML, or contains something that is refused for safety."""


class UrdfError(DescriptionError):
    """The XML does not describe a robot; the message names the element and its line."""


class MimicCycleError(UrdfError):
    """Joints mimic each other in a circle, so none of them has a position."""


class XacroError(DescriptionError):
    """A xacro file could not be expanded; the message names the file."""


class ResourceNotFoundError(DescriptionError):
    """A URI names no existing file; the message names every folder tried."""


class MeshFileError(DescriptionError):
    """A mesh file that cannot be read or drawn."""


class KinematicsError(DescriptionError):
    """Joint positions that do not fit the robot: an unknown joint, or a value not finite."""


class JointStateError(DescriptionError):
    """A joint state that cannot be used; the message says which joint and why."""


class SettingsError(DescriptionError):
    """A parameter or command-line argument of a node that cannot be used."""
