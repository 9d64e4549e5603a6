"""From a checked program to a trace: executors, the controller they share, and the simulated arm.

Executors (`tree`, `bytecode`, `native`) and the controller with its robot know nothing of one
another: between them stand the requests and events of `port`. `session` puts them together.
"""
