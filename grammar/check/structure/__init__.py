"""Structure: the places of declarations, statements and spline segments, and folds."""
