"""What every package needs: files, processes, measurements. Of KRL only which files have it."""
