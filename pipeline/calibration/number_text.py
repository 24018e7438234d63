"""How numbers are written for people: with as many digits as they deserve."""

# Of the units that people see no sensor resolves the billionth.
MOST_PLACES = 9


def with_sigma(value: float, sigma: float) -> tuple[str, str]:
    """Return a value and its standard deviation: two digits of that, and as many places of the value."""
    if not sigma:
        return signed(f"{value:.4f}"), "0"
    places = min(places_of(sigma), MOST_PLACES)
    least = 10.0**-MOST_PLACES
    return signed(
        f"{value:.{places}f}"
    ), f"{sigma:.{places}f}" if sigma >= least else f"under {least:.{places}f}"


def plain(value: float) -> str:
    """Return a number that is not negative, with two digits and no exponent."""
    if 0 < value < 1e-6:
        return "under 0.000001"
    return f"{value:.{places_of(value)}f}" if value else "0"


def places_of(value: float) -> int:
    """Return how many places show two digits of a number above 0."""
    return max(1 - int(f"{value:.1e}".split("e")[1]), 0)


def signed(number: str) -> str:
    """Return a number with a real minus sign, and none before zero."""
    if not number.strip("-0."):
        return number.removeprefix("-")
    return number.replace("-", "\N{MINUS SIGN}")
