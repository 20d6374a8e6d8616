"""Robots of tests, as URDF texts, where it does not matter how each is written."""

MYCOBOT_ARM = (
    "link1_to_link2",
    "link2_to_link3",
    "link3_to_link4",
    "link4_to_link5",
    "link5_to_link6",
    "link6_to_link6_flange",
)
"""The joints of the myCobot's arm, which the package mycobot_description describes."""
CAN = """<sdf version='1.9'><model name='can'><link name='body'>
<inertial><mass>0.1</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial>
<collision name='shape'><geometry><box><size>0.06 0.06 0.1</size></box></geometry></collision>
</link></model></sdf>"""
"""A model that falls; of Gazebo's, not a robot."""
TETRAHEDRON_OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
"""The smallest mesh."""


def link(name: str, *inside: str, mass: float = 1.0) -> str:
    """A link that weighs something, unless `mass` is 0."""
    inertia = "<inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/>"
    inertial = f"<inertial><mass value='{mass:g}'/>{inertia}</inertial>" if mass else ""
    return f"<link name='{name}'>{inertial}{''.join(inside)}</link>"


def box(*kinds: str, size: float = 0.1) -> str:
    """A cube as what a link shows and touches, or as one of both: `visual`, `collision`."""
    shape = f"<geometry><box size='{size} {size} {size}'/></geometry>"
    return "".join(f"<{kind}>{shape}</{kind}>" for kind in kinds or ("visual", "collision"))


def collision(kind: str, xyz: str = "0 0 0", **sizes: str) -> str:
    """A primitive that a link touches; its sizes are those of the URDF."""
    size = " ".join(f"{name}='{value}'" for name, value in sizes.items())
    shape = f"<geometry><{kind} {size}/></geometry>"
    return f"<collision><origin xyz='{xyz}'/>{shape}</collision>"


def joint(
    name: str,
    parent: str,
    child: str,
    *inside: str,
    kind: str = "revolute",
    axis: str = "0 1 0",
    xyz: str = "0 0 0",
    limits: tuple[float, float] | None = (-3.0, 3.0),
    effort: float = 20.0,
    velocity: float = 3.0,
) -> str:
    """A joint between two links; `limits` None leaves its limits out."""
    lines = [f"<parent link='{parent}'/><child link='{child}'/><origin xyz='{xyz}'/>", *inside]
    if kind not in ("fixed", "floating"):
        lines.append(f"<axis xyz='{axis}'/>")
    if limits is not None:
        span = f"lower='{limits[0]:g}' upper='{limits[1]:g}'"
        lines.append(f"<limit {span} effort='{effort:g}' velocity='{velocity:g}'/>")
    return f"<joint name='{name}' type='{kind}'>{''.join(lines)}</joint>"


def sensor(reference: str, name: str, kind: str, *inside: str) -> str:
    """A sensor of Gazebo at a link."""
    tag = f"<sensor name='{name}' type='{kind}'>{''.join(inside)}</sensor>"
    return f"<gazebo reference='{reference}'>{tag}</gazebo>"


def control(*inside: str, plugin: str = "arm_gazebo/SimulatedHardware") -> str:
    """A <ros2_control> block."""
    hardware = f"<hardware><plugin>{plugin}</plugin></hardware>"
    return f"<ros2_control name='sim' type='system'>{hardware}{''.join(inside)}</ros2_control>"


def robot(*parts: str, name: str = "r") -> str:
    """A robot of these parts."""
    return f"<robot name='{name}'>{''.join(parts)}</robot>"


def pendulum(*more: str, name: str = "pendulum", xyz: str = "0 0 1") -> str:
    """A bob of 1 kg on a hinge about y, and more parts."""
    hinge = joint("hinge", "base", "bob", xyz=xyz)
    return robot(link("base", mass=0), link("bob"), hinge, *more, name=name)


def crate(*more: str, size: float = 0.1) -> str:
    """A cube of 1 kg that stands free, and more parts."""
    return robot(link("base", box(size=size)), *more, name="crate")
