"""Small valid files of each kind, made here."""
# ruff: noqa: E501 - lines of XML

import io
import struct
import tempfile
from pathlib import Path

MASS = '<inertial><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/>'
URDF = f"""<robot name="r"><material name="m"><color rgba="1 0 0 1"/></material>
<link name="base"><visual><origin xyz="0 0 0" rpy="0 0 0"/><geometry><box size="1 1 1"/></geometry>
<material name="m"/></visual></link>
<link name="arm">{MASS}</inertial><collision><geometry><cylinder radius=".1" length="1"/></geometry>
</collision></link><link name="tip">{MASS}</inertial><visual><geometry><sphere radius=".1"/>
</geometry></visual><collision><geometry><mesh filename="gone.stl" scale="1 1 1"/></geometry>
</collision></link>
<joint name="j0" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="0 0 1"/>
<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="5" velocity="2"/>
<dynamics damping=".1" friction=".1"/><safety_controller k_velocity="1"/></joint>
<joint name="j1" type="prismatic"><parent link="arm"/><child link="tip"/><axis xyz="1 0 0"/>
<limit lower="0" upper="1" effort="5" velocity="2"/><mimic joint="j0" multiplier="2" offset="0"/>
</joint>
<ros2_control name="s" type="system"><hardware><plugin>x/Y</plugin><param name="p">1</param>
</hardware><joint name="j0"><command_interface name="position"><param name="min">-1</param>
</command_interface><state_interface name="position"><param name="initial_value">0.1</param>
</state_interface><state_interface name="velocity"/></joint></ros2_control>
<gazebo reference="arm"><mu1>0.3</mu1><selfCollide>true</selfCollide><material>Gazebo/Red</material>
<sensor name="i" type="imu"><update_rate>50</update_rate><imu><angular_velocity><x>
<noise type="gaussian"><mean>0</mean><stddev>0.1</stddev></noise></x></angular_velocity></imu></sensor>
<sensor name="c" type="camera"><update_rate>10</update_rate><camera><horizontal_fov>1</horizontal_fov>
<image><width>64</width><height>48</height><format>R8G8B8</format></image>
<clip><near>.1</near><far>9</far></clip></camera></sensor></gazebo></robot>"""
SRDF = """<robot name="r"><group name="arm"><joint name="j0"/><link name="tip"/>
<chain base_link="base" tip_link="tip"/></group><group name="all"><group name="arm"/></group>
<group_state name="home" group="arm"><joint name="j0" value="0.5"/></group_state>
<end_effector name="e" parent_link="arm" group="all" parent_group="arm"/>
<virtual_joint name="v" type="planar" parent_frame="odom" child_link="base"/>
<passive_joint name="j1"/><joint_property joint_name="j0" property_name="p" value="1"/>
<disable_collisions link1="base" link2="arm" reason="Adjacent"/>
<enable_collisions link1="base" link2="tip"/><disable_default_collisions link="tip"/></robot>"""
JOINT_LIMITS = """default_velocity_scaling_factor: 0.5
joint_limits:
  j0: {has_velocity_limits: true, max_velocity: 2.0, min_position: -1.0, max_position: 1}
  j1: {has_acceleration_limits: false, max_acceleration: 5.0, max_deceleration: -5.0}
"""
SCENE_FILE = """table
* box
0.5 0 0.25
0 0 0 1
2
box
0.2 0.05 0.5
0 0 0
0 0 0.6 0.8
1 0 0 0.5
mesh
3 1
0 0 0
1 0 0
0 1 0
0 1 2
0 0 0
0 0 0 1
0 0 0 0
1
top
0 0 0.25
0 0 0 1
.
"""
XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="side" default="left"/><xacro:property name="size" value="${2 * 0.1}"/>
<xacro:property name="names" value="${['a', 'b']}"/>
<xacro:macro name="part" params="name:=x size *block"><link name="${name}_$(arg side)">
<xacro:insert_block name="block"/></link></xacro:macro>
<xacro:if value="${size > 0}"><xacro:part name="a" size="${size}"><visual><geometry>
<box size="${size} ${size} 1"/></geometry></visual></xacro:part></xacro:if>
<xacro:unless value="false"><link name="${names[0]}"/></xacro:unless>
<joint name="j" type="fixed"><parent link="a_$(arg side)"/><child link="a"/></joint></robot>"""
SDF = """<sdf version="1.9"><world name="w"><gravity>0 0 -9.8</gravity><scene><ambient>1 1 1 1</ambient>
<sky/></scene><light name="l" type="spot"><pose>0 0 3 0 0 0</pose><diffuse>1 1 1 1</diffuse><spot>
<inner_angle>.1</inner_angle><outer_angle>.5</outer_angle><falloff>1</falloff></spot></light>
<model name="a"><pose relative_to="b">1 0 0 0 0 0</pose><link name="l"><inertial><mass>1</mass>
<inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial><collision name="c"><geometry>
<box><size>1 1 1</size></box></geometry><surface><friction><ode><mu>.5</mu></ode></friction></surface>
</collision><visual name="v"><geometry><cylinder><radius>.1</radius><length>1</length></cylinder>
</geometry><material><diffuse>1 0 0 1</diffuse></material></visual></link></model>
<model name="b"><static>true</static><link name="l"><collision name="c"><geometry><plane>
<normal>0 0 1</normal><size>9 9</size></plane></geometry></collision></link>
<model name="inner"><link name="l"><inertial auto="true"><density>100</density></inertial>
<collision name="c"><geometry><sphere><radius>.2</radius></sphere></geometry></collision></link></model>
<frame name="f" attached_to="l"><pose>0 0 1 0 0 0</pose></frame></model></world></sdf>"""
MJCF = """<mujoco model="m"><compiler angle="radian"/><option timestep="0.002"/><size memory="1M"/>
<default><geom friction="1 .1 .1"/></default><asset><texture name="t" type="2d" builtin="checker"
 width="32" height="32" rgb1="1 1 1" rgb2="0 0 0"/><material name="m" texture="t"/>
<mesh name="p" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/><hfield name="h" nrow="4" ncol="4" size="1 1 1 1"/>
</asset><worldbody><body name="b" pos="0 0 1"><freejoint/><inertial pos="0 0 0" mass="1"
 diaginertia=".1 .1 .1"/><geom type="box" size=".1 .1 .1" material="m"/><body name="c">
<joint name="j" type="hinge" axis="0 1 0" range="-1 1"/><geom type="mesh" mesh="p"/>
<geom type="hfield" hfield="h" mass="1"/><site name="s" size=".01"/></body>
<replicate count="3" offset="1 0 0"><geom size=".1"/></replicate></body></worldbody>
<actuator><position name="a" joint="j" kp="5"/></actuator><sensor><jointpos joint="j"/>
<user dim="3"/></sensor><equality><joint joint1="j" polycoef="0 1 0 0 0"/></equality>
<tendon><fixed><joint joint="j" coef="1"/></fixed></tendon></mujoco>"""
CONTROLLERS = """controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster: {type: joint_state_broadcaster/JointStateBroadcaster}
    arm: {type: joint_trajectory_controller/JointTrajectoryController}
    defaults: &d {joints: [j0, j1]}
/left/arm:
  ros__parameters:
    <<: *d
    joints: [j0, j1]
    command_interfaces: [position]
    gains: {j0: {p: 1.0, i: 0.0, d: !!float 2}, j1: {p: 1e3}}
    "quoted ${side}": 'single'
/**: {ros__parameters: {use_sim_time: true, when: 2026-01-02, text: |
  more
  }}
"""
ROBOTS = (
    "left: {model: a.urdf, pose: [0, 0, 0, 0, 0, 1.5], spawn: [a, b]}\nright:\n  model: b.urdf\n"
)
PARAMETERS = "poses:\n  - [0.5, 0.5]\n  - [0.0, 1e-3]\n"
ARGUMENTS = (
    "demo demo.launch.py world:=empty model:=a.urdf rate:=100.0",
    "-r -s -v 4 objects.sdf",
    "side:='left arm' size:=1e-3 names:=[a,b]",
    "$(var model) $(env HOME x) $(if true a b) $(eval 1 + 1)",
    "{a: [1, 2.0, true], 'b': \"c\"}",
)


def meshes() -> dict[str, tuple[bytes, ...]]:
    """Return mesh files by their suffix."""
    import trimesh

    box = trimesh.creation.box([0.1, 0.2, 0.3])
    kinds = {kind: (_bytes(box.export(file_type=kind)),) for kind in ("obj", "ply", "off", "glb")}
    kinds["stl"] = (_bytes(box.export(file_type="stl")), _bytes(box.export(file_type="stl_ascii")))
    kinds["obj"] = (b"mtllib gone.mtl\nusemtl a\n" + kinds["obj"][0], kinds["obj"][0])
    kinds["dae"] = (COLLADA.encode(),)
    kinds["gltf"] = (
        trimesh.exchange.gltf.export_gltf(box.scene(), embed_buffers=True)["model.gltf"],
    )
    kinds["3mf"] = (_bytes(box.scene().export(file_type="3mf")),)
    return {f".{kind}": files for kind, files in kinds.items()}


def bags() -> tuple[bytes, ...]:
    """Return MCAP files: packed or not, finished or not."""
    return tuple(
        _bag(compression, finished) for compression in ("zstd", "") for finished in (True, False)
    )


def _bag(compression: str, finished: bool) -> bytes:
    from mcap.writer import CompressionType, Writer

    stream = io.BytesIO()
    kind = CompressionType.ZSTD if compression else CompressionType.NONE
    writer = Writer(stream, chunk_size=200, compression=kind)
    writer.start()
    offers = "- {history: 1, depth: 5, reliability: 1, durability: 2}"
    schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data")
    channel = writer.register_channel(
        "/x", "cdr", schema, {"offered_qos_profiles": offers, "topic_type_hash": "RIHS01_0"}
    )
    for number in range(6):
        data = struct.pack("<II6s", 0x100, 6, b"hello\0")
        writer.add_message(channel, number, data * 5, number)
    if finished:
        writer.add_metadata("rosbag2", {"serialized_metadata": "{ros_distro: jazzy}"})
        writer.finish()
    return stream.getvalue()


def _bytes(content: bytes | str) -> bytes:
    return content.encode() if isinstance(content, str) else content


def scratch() -> tempfile.TemporaryDirectory[str]:
    """Return a folder for one worker."""
    return tempfile.TemporaryDirectory(prefix="fuzz-")


def write(folder: Path, name: str, data: bytes) -> Path:
    """Write a file, and return its path."""
    path = folder / name
    path.write_bytes(data)
    return path


COLLADA = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema"
 version="1.4.1"><asset><unit meter="0.01"/><up_axis>Z_UP</up_axis></asset><library_geometries>
<geometry id="g"><mesh><source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1
</float_array><technique_common><accessor source="#a" count="4" stride="3"><param name="X"
 type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 1 2 3 0 3 2</p>
</triangles></mesh></geometry></library_geometries><library_nodes><node id="m"><matrix>1 0 0 0 0 1 0 0
 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node></library_nodes><library_visual_scenes>
<visual_scene id="s"><node id="n"><instance_node url="#m"/><translate>1 0 0</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes><scene>
<instance_visual_scene url="#s"/></scene></COLLADA>"""
