"""The judge: do two executors agree with each other and with the documented rules of KRL?

The cases, the registry of rules, the runner, the comparison of traces, the generator and the
reducer will stand here. Nothing of it is built yet.
"""

__all__: list[str] = []
