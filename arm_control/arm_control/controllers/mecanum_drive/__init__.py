"""mecanum_drive_controller/MecanumDriveController: drives a robot with four mecanum wheels."""
