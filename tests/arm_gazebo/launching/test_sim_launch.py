"""sim.launch.py: what it comes to, without starting anything."""

from arm_cli.main import main


def test_the_page_finds_the_meshes_of_a_robot_that_is_not_installed(capsys, tmp_path, parts):
    model = tmp_path / "arm_x" / "urdf" / "arm.urdf"
    model.parent.mkdir(parents=True)
    model.write_text(parts.pendulum())
    elsewhere = tmp_path / "elsewhere"
    line = ["launch", "arm_gazebo", "sim.launch.py", "--print", "viewer:=true"]
    assert main([*line, f"model:={model}", f"package_path:={elsewhere}"]) == 0
    page = capsys.readouterr().out.partition("\narm_viewer_node\n")[2]
    (folders,) = (line for line in page.splitlines() if "GZ_SIM_RESOURCE_PATH=" in line)
    assert {str(elsewhere), str(tmp_path)} <= set(folders.partition("=")[2].split(":"))
