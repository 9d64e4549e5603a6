"""What every package needs and is not about KRL: files, processes, measurements."""
