"""Unit tests of robot programs: test files, their execution, the pytest plug-in.

They are part of `krl` because they combine the packages below: sources as commands load them, runs
of `interp`, expectations of `conformance`, pages of `reports`.
"""
