"""The robot arm: its kinematics, its path and motion planning, its commands, and a simulated robot.

`kinematics.machine_data` and what it imports need nothing beyond Python. Modules that compute with
arrays need the extra `arm`, and are imported only by code that moves an arm.
"""
