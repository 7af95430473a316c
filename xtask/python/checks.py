"""One line per check for `cargo xtask`: how it ended, its name, seconds, and the reason, separated by tabs."""

import time


class NotRun(Exception):
    """The check cannot be run here."""


class Failed(Exception):
    """The check found something; one argument per finding."""


def check(name, action):
    """Runs one check and prints its line. Gives what the action gives, or None."""
    start = time.monotonic()
    word, reason, result = "passed", "", None
    try:
        result = action()
    except NotRun as error:
        word, reason = "not run", " | ".join(map(str, error.args))
    except Failed as error:
        word, reason = "failed", " | ".join(map(str, error.args[:12]))
        if len(error.args) > 12:
            reason += f" | … and {len(error.args) - 12} more"
    except Exception as error:  # whatever breaks a check has failed it
        word, reason = "failed", f"{type(error).__name__}: {error}"
    reason = reason.replace("\n", " | ").replace("\t", " ")
    print(f"{word}\t{name}\t{time.monotonic() - start:.2f}\t{reason}", flush=True)
    return result


def fail_on(problems):
    """Fails when there are any."""
    if problems:
        raise Failed(*problems)
