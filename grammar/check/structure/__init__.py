"""Structure: where declarations, statements and spline segments may stand, and folds."""
