"""Machine data, forward and inverse kinematics, Status and Turn."""
