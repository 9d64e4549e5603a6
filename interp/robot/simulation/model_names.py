"""The names that a model of an arm uses, for those who read it. It imports nothing of ours.

A process that renders frames starts twice as fast without the readers of machine data.
"""

from typing import Final

#: The name of the site at the flange.
FLANGE: Final = "flange"
#: The names of the geoms of the floor and of the pedestal.
GROUND: Final = ("floor", "pedestal")
#: If the vertical component of the foot's Z axis is smaller, the arm hangs or is on a wall.
UPRIGHT: Final = 0.7
