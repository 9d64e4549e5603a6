"""What stands between executors and controller: requests, replies, events."""
