"""sim.launch.py: what it comes to, without starting anything."""

from arm_cli.main import main

LINE = ["launch", "arm_gazebo", "sim.launch.py", "--print"]


def test_the_page_finds_the_meshes_of_a_robot_that_is_not_installed(capsys, tmp_path, parts):
    model = tmp_path / "arm_x" / "urdf" / "arm.urdf"
    model.parent.mkdir(parents=True)
    model.write_text(parts.pendulum())
    elsewhere = tmp_path / "elsewhere"
    assert main([*LINE, "viewer:=true", f"model:={model}", f"package_path:={elsewhere}"]) == 0
    page = capsys.readouterr().out.partition("\narm_viewer_node\n")[2]
    (folders,) = (line for line in page.splitlines() if "GZ_SIM_RESOURCE_PATH=" in line)
    assert {str(elsewhere), str(tmp_path)} <= set(folders.partition("=")[2].split(":"))


def test_a_world_that_is_not_there_is_refused_before_anything_starts(capsys):
    assert main([*LINE, "model:=any.urdf", "world:=object"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "no world 'object': it is no file" in captured.err
    assert "the shipped worlds are empty, house, objects" in captured.err
