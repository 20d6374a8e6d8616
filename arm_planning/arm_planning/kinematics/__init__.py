"""Forward and inverse kinematics of groups, with MuJoCo."""
