#!/usr/bin/env python3
"""Compiles each fragment of the kernels (engine/src/kernel/*/*.inl.h) alone: fragments.py SOURCE COMPILE_COMMANDS.

A fragment is included inside the namespace of an instruction set. It includes the fragments that it needs, and names at
its top the headers that must stand before it, outside of the namespace. Both lists are enough if it compiles with
nothing else. The flags are those of a unit in the build's compile_commands.json: AVX2's, or AVX-512's for fragments
with avx512 in their names.
"""

import concurrent.futures
import json
import pathlib
import re
import shlex
import subprocess
import sys

NEEDS = re.compile(r"^// Needs before it, outside of the instruction set's namespace: ((?:.*\n)(?://.*\n)*)", re.M)
FRAGMENT = re.compile(r'#include "([^"]+\.inl\.h)"')


def command_of(commands, isa):
    """The compiler and its flags for a unit of this instruction set, without files."""
    for entry in json.loads(commands.read_text()):
        if entry['file'].endswith('/unit_grid.cpp') and f'tessera_kernel_{isa}.dir' in entry['command']:
            words = shlex.split(entry['command'])
            if 'ccache' in words[0]:
                words = words[1:]
            end = min(words.index(flag) for flag in ('-o', '-c', '-MD') if flag in words)
            return words[:end] + ['-fsyntax-only', '-Wno-unused-function', '-x', 'c++', '-']
    return None


def headers_of(source, fragment, seen):
    """The headers that a fragment and those that it includes need before them."""
    if fragment in seen:
        return []
    seen.add(fragment)
    text = (source / fragment).read_text()
    named = NEEDS.search(text)
    if not named:
        raise ValueError(f'{fragment} has no line "Needs before it, ..."')
    headers = re.findall(r'[\w/]+\.h\b', named[1])
    for needed in FRAGMENT.findall(text):
        headers += headers_of(source, needed, seen)
    return headers


def fault_of(source, fragment, commands):
    """The first error of the compiler, or nothing."""
    isa = 'avx512' if 'avx512' in fragment else 'avx2'
    if commands[isa] is None:
        return ''
    lines = [f'#include "{header}"' for header in dict.fromkeys(headers_of(source, fragment, set()))]
    lines += ['namespace tessera { inline namespace abi_0_1 { namespace kernel { namespace TESSERA_ISA_NAMESPACE {']
    lines += ['namespace {', f'#include "{fragment}"', '}}}}}']
    done = subprocess.run(commands[isa], input='\n'.join(lines) + '\n', text=True, capture_output=True, check=False)
    return f'{fragment}:\n{done.stderr[:400]}' if done.returncode else ''


def main():
    source, commands = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    commands = {isa: command_of(commands, isa) for isa in ('avx2', 'avx512')}
    if not any(commands.values()):
        print('no unit of AVX2 or AVX-512 is built here')
        return 77
    fragments = [path.relative_to(source).as_posix() for path in sorted(source.glob('kernel/*/*.inl.h'))]
    fragments = [name for name in fragments if not name.endswith('/isa_tables.inl.h')]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        faults = [fault for fault in pool.map(lambda name: fault_of(source, name, commands), fragments) if fault]
    print(f'{len(fragments)} fragments, {len(faults)} do not compile alone', *faults, sep='\n')
    return 1 if faults or not fragments else 0


if __name__ == '__main__':
    sys.exit(main())
