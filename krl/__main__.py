"""`python -m krl` is `krl`, for systems where scripts are not on the search path."""

from krl.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
