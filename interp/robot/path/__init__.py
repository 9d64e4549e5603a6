"""The geometry of motions: lines, arcs, splines, blends, orientation."""
