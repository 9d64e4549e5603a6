"""The arm: where it is, how it moves, and its commands.

`frames` and `machine` need nothing beyond Python. `kinematics` and all that builds upon it need the
extra `arm`, and are imported only by those who move an arm.
"""
