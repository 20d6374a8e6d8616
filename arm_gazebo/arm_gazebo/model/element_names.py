"""Names for what a model's file left unnamed: states are carried from model to model by name."""

import mujoco

from arm_gazebo.free_name import free_name

UNNAMED_BODY = "thing"


def name_elements(spec: mujoco.MjSpec) -> None:
    """Give every body, joint and actuator without a name one that is free."""
    bodies = {body.name for body in spec.bodies}
    for body in spec.bodies:
        if not body.name:
            body.name = free_name(UNNAMED_BODY, bodies)
            bodies.add(body.name)
    joints = {joint.name for joint in spec.joints}
    for joint in spec.joints:
        if not joint.name:
            joint.name = free_name(f"{joint.parent.name}::joint", joints)
            joints.add(joint.name)
    actuators = {actuator.name for actuator in spec.actuators}
    for actuator in spec.actuators:
        if not actuator.name:
            actuator.name = free_name(f"{actuator.target or UNNAMED_BODY}::actuator", actuators)
            actuators.add(actuator.name)
