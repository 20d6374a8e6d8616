#!/usr/bin/env bash
# xacro 2.1.1: a property or parameter "01" is 1 in every name that is made of it, while an argument stays "01".
#
# A good guess, as XML attributes are text, is that <xacro:finger id="01"/> with name="finger_${id}" makes
# finger_01. What looks like a number or a truth value becomes one: finger_1, and version 1.10 is 1.1,
# 1e3 is 1000.0, true is True. $(arg id) pastes the text as it is, so that a link named with $(arg id)
# and a joint's <child> named with ${id} from the same "01" are two names; 01 and 1 become the same
# one; and ${sim == 'true'} is false for an argument sim:=true. "0x10" and "1_0" stay text. Servo and
# camera numbers that are aligned by zeros are so renamed without a word. ${'%02d' % id} writes the
# zeros back.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'xacro==2.1.1'

"$folder/venv/bin/python" - "$folder/arm.xacro" <<'PYTHON'
import sys
from importlib.metadata import version

import xacro

path = sys.argv[1]
FILE = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="id" default="1"/>
  <xacro:property name="id" value="$(arg id)"/>
  <xacro:macro name="finger" params="number"><link name="macro_${number}"/></xacro:macro>
  <link name="argument_$(arg id)"/>
  <link name="property_${id}"/>
  <xacro:finger number="$(arg id)"/>
  <xacro:if value="${id == '$(arg id)'}"><link name="equal"/></xacro:if>
</robot>"""


def names(value: str) -> list[str]:
    """Return the names of the links for an argument."""
    links = xacro.process_file(path, mappings={"id": value}).getElementsByTagName("link")
    return [link.getAttribute("name") for link in links]


with open(path, "w") as file:
    file.write(FILE)
print("xacro", version("xacro"))
found = {value: names(value) for value in ("01", "1.10", "1e3", "true", "0x10", "a")}
for value, links in found.items():
    print(f"{value}:", *links)
SEEN = {"01": "1", "1.10": "1.1", "1e3": "1000.0", "true": "True", "0x10": "0x10", "a": "a"}
for value, links in found.items():
    turned = SEEN[value]
    expected = [f"argument_{value}", f"property_{turned}", f"macro_{turned}"]
    if links != expected + ["equal"] * (value == turned):
        sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# xacro 2.1.1
# 01: argument_01 property_1 macro_1
# 1.10: argument_1.10 property_1.1 macro_1.1
# 1e3: argument_1e3 property_1000.0 macro_1000.0
# true: argument_true property_True macro_True
# 0x10: argument_0x10 property_0x10 macro_0x10 equal
# a: argument_a property_a macro_a equal
