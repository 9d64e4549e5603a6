"""Robots that follow the planned set-points: kinematic and MuJoCo; videos."""
