"""`arm launch ros_gz_sim_demos joint_states.launch.py`: a pendulum swings, and publishes it."""

from sensor_msgs.msg import JointState


def test_the_pendulum_swings_freely(launch, client):
    demo = launch("ros_gz_sim_demos", "joint_states.launch.py", "viewer:=false")
    states = client.subscribe(JointState, "/joint_states")
    demo.wait_until_ready()
    swung = states.wait_until(
        lambda messages: (
            bool(messages)
            and max(m.position[0] for m in messages) - min(m.position[0] for m in messages) > 1.0
        ),
        "the upper joint has swung by more than 1 rad",
    )
    assert sorted(swung[-1].name) == ["lower_joint", "upper_joint"]
