"""Convert Gazebo worlds and models to parts of a MuJoCo model."""
