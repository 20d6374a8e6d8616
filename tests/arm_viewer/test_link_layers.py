"""What is drawn of a link, and what is said where that cannot be done."""

import pytest
from viser import SceneApi

from arm_description.urdf import parse_urdf
from arm_viewer.scene.link_layers import draw_collisions, draw_visuals

URDF = """<robot name="r"><link name="hand">
<visual><geometry><mesh filename="{mesh}"/></geometry></visual>
<collision><geometry><mesh filename="{mesh}"/></geometry></collision></link></robot>"""


class NoScene(SceneApi):
    """A scene in which nothing can be drawn."""

    def __init__(self) -> None:
        """Have nothing."""


@pytest.mark.parametrize("draw", [draw_visuals, draw_collisions])
def test_a_mesh_that_cannot_be_had_is_named_with_its_link(draw, tmp_path):
    broken = tmp_path / "broken.stl"
    broken.write_bytes(b"no mesh")
    problems: list[str] = []
    for mesh in ("package://nowhere/hand.stl", str(broken)):
        (link,) = parse_urdf(URDF.format(mesh=mesh)).links
        assert list(draw(NoScene(), "/hand", link, problems.append)) == []
    missing, unreadable = problems
    assert missing == "link 'hand': no file for 'package://nowhere/hand.stl'"
    assert unreadable.startswith(f"link 'hand': cannot use the mesh {broken}: ")
