"""Conformance: do executors agree with one another, and with the documented rules of KRL?"""
