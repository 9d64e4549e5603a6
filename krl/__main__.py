"""`python -m krl` is `krl`, for places where scripts are not on the search path."""

from krl.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
