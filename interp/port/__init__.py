"""The port between executors and the controller: requests, replies and events."""
