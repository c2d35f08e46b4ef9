"""Files and texts of JSON: read with messages that say what is wrong, written whole or not at all."""

import json
import math
from pathlib import Path

from .console import Failure


def parse(text, origin):
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise Failure(f"{origin} is not JSON: {error}") from None


def read(path, keys=()):
    """An object of JSON with all required keys. None if there is no such file."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise Failure(f"{path} can't be read: {error}") from None
    content = parse(text, path)
    for key in keys:
        if not isinstance(content, dict) or key not in content:
            raise Failure(f"{path} has no \"{key}\"")
    return content


def write(path, content):
    """Each case is a line of text, so that a change is a line of a diff."""
    write_text(path, json.dumps(content, indent=1, sort_keys=True) + "\n")


def write_text(path, text):
    """Writes the file whole or not at all, and its folder if there is none."""
    path = Path(path)
    temporary = path.with_suffix(".new")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_text(text, encoding="utf-8")
        temporary.replace(path)
    except OSError as error:
        raise Failure(f"{path} can't be written: {error.strerror}") from None


def is_positive(value):
    """Whether it is a number above zero and below infinity."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and 0 < value < math.inf
