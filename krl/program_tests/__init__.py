"""Unit tests of robot programs: their files, their runs, and the plug-in that gives them to pytest.

They lie in `krl` because they join what the packages below have: sources as commands load them,
runs of `interp`, expectations of `conformance`, pages of `reports`.
"""
