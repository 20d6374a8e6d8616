"""Put a robot's description on real hardware: another plugin in its `<ros2_control>` block."""

from collections.abc import Mapping

import lxml.etree as etree

from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.edited_description import edited_text

SIMULATION = "simulation"
PLUGINS = {
    "feetech": "arm_drivers/Feetech",
    "mycobot_280": "arm_drivers/MyCobot280",
    "mock": "mock_components/GenericSystem",
}
"""The plugins that the launch argument `hardware` has a short name for."""
RATES_HZ = {"arm_drivers/MyCobot280": 50}
"""How often hardware can be read and written, where that is less often than controllers run."""
UNMEASURED = {"arm_drivers/MyCobot280": ("effort",)}
"""Kinds of states that hardware does not measure; the description loses them."""


def plugin_of(hardware: str) -> str:
    """Return the plugin of a short name, or the plugin that is given itself.

    Raises:
        SimSettingsError: there is no such short name, and a plugin's name has a slash.
    """
    if "/" not in hardware and hardware not in PLUGINS:
        raise SimSettingsError(
            f"no hardware '{hardware}'; there are {SIMULATION}, {', '.join(PLUGINS)}, "
            "or any plugin, such as my_package/MyServos"
        )
    return PLUGINS.get(hardware, hardware)


def on_hardware(urdf: str, hardware: str, parameters: Mapping[str, str]) -> str:
    """Return a description whose `<ros2_control>` block names other hardware.

    `hardware` is a short name of PLUGINS, or a plugin. The parameters replace all `<param>`s.

    Raises:
        SimSettingsError: the hardware is unknown, or there are several blocks: one port serves one.
        XmlError: the text is not XML.
    """
    plugin = plugin_of(hardware)
    document = parse_xml(urdf)
    blocks = document.findall("ros2_control")
    if len(blocks) != 1:
        raise SimSettingsError(
            f"hardware:={hardware} drives one <ros2_control> block; "
            f"the description has {len(blocks)}"
        )
    for old in blocks[0].findall("hardware"):
        blocks[0].remove(old)
    new = etree.Element("hardware")
    blocks[0].insert(0, new)
    etree.SubElement(new, "plugin").text = plugin
    for name, value in parameters.items():
        etree.SubElement(new, "param", name=name).text = value
    if plugin in RATES_HZ:
        blocks[0].set("rw_rate", str(RATES_HZ[plugin]))
    for state in blocks[0].findall("joint/state_interface"):
        if state.get("name") in UNMEASURED.get(plugin, ()):
            state.getparent().remove(state)
    return edited_text(document, urdf)
