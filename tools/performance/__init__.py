"""The parts of tools/perf. Python 3.9 and its standard library alone."""
