"""diff_drive_controller/DiffDriveController: drives a robot with two rows of wheels."""
