"""Forward and inverse kinematics of planning groups, on MuJoCo's kinematics."""
