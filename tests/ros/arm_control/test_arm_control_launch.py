"""arm_control.launch.py: the controllers of a world that is already up."""


def test_one_spawner_after_the_other_and_unspawner_takes_them_out(
    manager, control, launch, unspawn
):
    launched = launch("arm_control", "arm_control.launch.py")
    assert launched.wait() == 0, launched.output
    assert control.states() == {
        "position_controller": "active",
        "joint_state_broadcaster": "active",
    }
    done = "Configured and activated joint_state_broadcaster"
    first = next(i for i, line in enumerate(launched.lines) if done in line)
    second = next(i for i, line in enumerate(launched.lines) if "position_controller]" in line)
    assert first < second
    unspawn("position_controller", "joint_state_broadcaster").succeed()
    assert control.states() == {}


def test_a_controller_that_cannot_be_started_ends_it_with_a_sentence(manager, control, launch):
    control.start("position_controller")
    launched = launch("arm_control", "arm_control.launch.py")
    assert launched.wait() == 1, launched.output
    assert "Failed to configure controller position_controller" in launched.output
    assert "Traceback" not in launched.output
