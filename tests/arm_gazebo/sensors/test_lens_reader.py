"""`<lens><intrinsics>` and `<distortion>` of a URDF's cameras."""

import numpy as np
import pytest

from arm_gazebo.build_report import Finding
from arm_gazebo.errors import SensorError
from arm_gazebo.ros.camera_publisher import info_message
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.camera_reader import parse_cameras

INTRINSICS = "<lens><intrinsics>{}</intrinsics></lens>"
WRITTEN = INTRINSICS.format("<fx>700</fx><fy>600</fy><cx>300</cx><cy>250</cy><s>0</s>")
DISTORTION = "<distortion>{}</distortion>"
FOCAL_LENGTH = 536.514


def read(
    inside: str, type_name: str = "camera", width: int = 640
) -> tuple[CameraSensor, list[Finding]]:
    """Return a camera, by default of 640x480, hfov 1.0756, and the findings about it."""
    findings: list[Finding] = []
    (camera,) = parse_cameras(
        f"""<robot name="r"><link name="l"/><link name="o"/>
        <joint name="j" type="fixed"><parent link="l"/><child link="o"/>
          <origin rpy="-1.5707963 0 -1.5707963"/></joint>
        <gazebo reference="l"><sensor name="eye" type="{type_name}"><camera>
          <horizontal_fov>1.0756</horizontal_fov>
          <image><width>{width}</width><height>480</height></image>
          {inside}
        </camera></sensor></gazebo></robot>""",
        findings.append,
    )
    return camera, findings


@pytest.mark.parametrize("type_name", ["camera", "depth_camera", "rgbd_camera"])
def test_camera_info_has_what_is_written(type_name):
    k1 = DISTORTION.format("<k1>0.1</k1><k2>0.2</k2><k3>0.3</k3><p1>0.01</p1><p2>0.02</p2>")
    camera, findings = read(WRITTEN + k1, type_name)
    info = info_message(camera)
    assert tuple(info.k) == (700, 0, 300, 0, 600, 250, 0, 0, 1)
    assert tuple(info.p) == (700, 0, 300, 0, 0, 600, 250, 0, 0, 0, 1, 0)
    assert info.d.tolist() == [0.1, 0.2, 0.01, 0.02, 0.3]
    assert findings == []


def test_the_skew_is_in_k_and_p():
    camera, _ = read(WRITTEN.replace("<s>0</s>", "<s>5</s>"))
    assert (info_message(camera).k[1], info_message(camera).p[1]) == (5, 5)


def test_without_intrinsics_the_field_of_view_counts():
    camera, _ = read(DISTORTION.format("<k1>0.1</k1>"))
    info = info_message(camera)
    assert info.k == pytest.approx((FOCAL_LENGTH, 0, 320, 0, FOCAL_LENGTH, 240, 0, 0, 1), abs=1e-3)
    assert info.d.tolist() == [0.1, 0, 0, 0, 0]


def test_the_center_is_the_principal_point():
    camera, findings = read(DISTORTION.format("<k1>0.1</k1><center>0.4 0.6</center>"))
    assert info_message(camera).k == pytest.approx(
        (FOCAL_LENGTH, 0, 256, 0, FOCAL_LENGTH, 288, 0, 0, 1), abs=1e-3
    )
    assert findings == []


@pytest.mark.parametrize("inside", ["<center>0.4 0.6</center>", "<k1>0.1</k1>"])
def test_a_center_in_the_middle_or_without_coefficients_moves_nothing(inside):
    camera, findings = read(DISTORTION.format(inside + "<k2>0</k2>"))
    assert (camera.lens.cx, camera.lens.cy) == (320, 240)
    assert findings == []


def test_intrinsics_outweigh_another_center():
    inside = DISTORTION.format("<k1>0.1</k1><center>0.4 0.6</center>")
    camera, findings = read(WRITTEN + inside)
    assert (camera.lens.cx, camera.lens.cy) == (300, 250)
    assert [str(finding) for finding in findings] == [
        "<distortion/center> of camera 'eye' (line 7): this is the pixel 256 288, but the "
        "principal point of <intrinsics>, 300 250, is the centre of the distortion"
    ]
    same = DISTORTION.format(f"<k1>0.1</k1><center>{300 / 640} {250 / 480}</center>")
    assert read(WRITTEN + same)[1] == []


def test_what_intrinsics_leave_out_has_sdf_s_value_and_a_remark():
    camera, findings = read(INTRINSICS.format("<fx>500</fx><cx>320</cx>"))
    np.testing.assert_array_equal(camera.lens.matrix, [[500, 0, 320], [0, 277, 120], [0, 0, 1]])
    assert [str(finding) for finding in findings] == [
        "<lens/intrinsics> of camera 'eye' (line 7): what it leaves out has SDF's value for "
        "320x240: <fy> 277, <cy> 120"
    ]


@pytest.mark.parametrize(
    ("inside", "said"),
    [
        (WRITTEN.replace("700", "0"), "<lens/intrinsics/fx> (line 7): must be from 1 to 1e+06"),
        (WRITTEN.replace("250", "nan"), "<lens/intrinsics/cy> (line 7): must be from -100000 to"),
        (DISTORTION.format("<k1>x</k1>"), "<distortion/k1> (line 7): must be from -1e+06 to"),
        (DISTORTION.format("<k1>.1</k1><center>1</center>"), "'1' is not two numbers"),
        (DISTORTION.format("<k1>.1</k1><center>9 1</center>"), "must be from 0 to 1"),
        (
            DISTORTION.format("<k1>-0.9</k1>"),
            "<distortion> (line 4): it folds back 218 pixels from the principal point (at x / z = "
            "0.609), but the farthest corner of the picture is 400 pixels away",
        ),
    ],
)
def test_a_lens_that_cannot_be_is_refused_with_its_line(inside, said):
    with pytest.raises(SensorError) as caught:
        read(inside)
    assert said in str(caught.value)


def test_a_picture_that_would_be_too_wide_without_the_distortion_is_refused():
    inside = DISTORTION.format("<k1>-0.3</k1><k2>0.09</k2>")
    with pytest.raises(SensorError, match=r"would have \d+x\d+ pixels; at most 8192 can be"):
        read(inside, width=8000)
    assert read(inside, width=7000)[0].lens.is_distorted
