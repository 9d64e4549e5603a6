"""Inputs: scripts, channels, the operator, and automatic inputs."""
