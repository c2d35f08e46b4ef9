#!/usr/bin/env python3
"""Holds the preprocessed lines of each public header to tests/house/header_lines.txt: header_lines.py COMPILER INCLUDE [--write].

Whoever includes a header parses these lines in each file. A header may take a hundredth more than its line of the table
says, since standard libraries change; beyond that the test fails, and so it does for a header that is not in the table.
--write makes the table anew. Other compilers than the table's count other standard headers: the test is skipped.
"""

import pathlib
import subprocess
import sys

TABLE = pathlib.Path(__file__).with_name('header_lines.txt')


def lines_of(compiler, include, header):
    """The lines that are not empty after preprocessing."""
    done = subprocess.run([compiler, '-std=c++20', '-w', '-E', '-P', f'-I{include}', '-x', 'c++', include / header],
                          stdout=subprocess.PIPE, text=True, check=True)
    return sum(1 for line in done.stdout.splitlines() if line.strip())


def main():
    compiler, include = sys.argv[1], pathlib.Path(sys.argv[2])
    version = subprocess.run([compiler, '-dumpfullversion'], stdout=subprocess.PIPE, text=True, check=True).stdout.strip()
    headers = sorted(path.relative_to(include).as_posix() for path in include.glob('tessera/*.h'))
    others = ('tessera/mpi.h', 'tessera/ray_embree.h', 'tessera/occt')  # with headers of MPI, Embree and OpenCASCADE
    headers = [name for name in headers if not name.startswith(others)]
    found = {name: lines_of(compiler, include, name) for name in headers}
    if '--write' in sys.argv:
        TABLE.write_text(f'g++ {version}\n' + ''.join(f'{count:6} {name}\n' for name, count in found.items()))
        return 0
    first, *rows = TABLE.read_text().splitlines()
    if first != f'g++ {version}':
        print(f'the table is of {first}, this is {version}')
        return 77
    known = {name: int(count) for count, name in (row.split() for row in rows)}
    faults = [f'{name}: {count} lines, the table says {known.get(name, "nothing")}' for name, count in found.items()
              if count > 1.01 * known.get(name, 0)]
    print(f'{len(found)} headers, {len(faults)} too long', *faults, sep='\n')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
