"""Hit conditions of breakpoints."""

from __future__ import annotations

from interp.values.faults import LinkError


def is_hit(hits: str | None, count: int) -> bool:
    """Whether the hit of a number counts; raises `LinkError` for what says nothing about hits."""
    text = (hits or ">=1").replace(" ", "")
    for sign in (">=", ">", "<=", "<", "==", "=", "%", ""):
        if text.startswith(sign) and text[len(sign) :].isdigit():
            number = int(text[len(sign) :])
            match sign:
                case ">=":
                    return count >= number
                case ">":
                    return count > number
                case "<=":
                    return count <= number
                case "<":
                    return count < number
                case "%" if number > 0:
                    return count % number == 0
                case "" | "=" | "==":
                    return count == number
    raise LinkError(f"{hits}: hits are a number such as 3, >=3 or %3")
