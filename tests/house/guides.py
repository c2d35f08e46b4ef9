#!/usr/bin/env python3
"""Follows the guides as a newcomer would: guides.py GUIDE.md FOLDER PREFIX CMAKE GENERATOR COMPILER [--print] [--shell BUILD].

A block of a guide whose fence names a file, ```cpp main.cpp, goes to that file, one block after the other. The project
is built against the package installed in PREFIX; a block of Rust is a program of its own, tried where rustc is. An
```output PROGRAM ARGUMENTS block must be what PROGRAM prints, and its exit status 0; with ```failure instead of
```output the status must be 1. Arguments that begin with tools/ are files of the sources. --print shows what it prints
instead. --shell runs the lines of all ```sh blocks instead, in one shell whose build/demo is the folder BUILD; they must
build the project.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys


SOURCES = pathlib.Path(__file__).resolve().parents[2]
STATUS = {'output': 0, 'failure': 1}


def blocks_of(text):
    """(language, file or command, content, line) of each fenced block that has a name."""
    for found in re.finditer(r'^```(\w+) (\S[^\n]*)\n(.*?)^```$', text, re.M | re.S):
        yield (*found.groups(), text.count('\n', 0, found.start()) + 1)


def run_shell_lines(text, folder, build):
    """Runs them where a clone's tools, build/demo and home would be. Set-up and builds have been made: tools/*.sh, sudo."""
    (folder / 'build').mkdir(exist_ok=True)
    for name, target in (('tools', SOURCES / 'tools'), ('build/demo', pathlib.Path(build).resolve())):
        (folder / name).symlink_to(target)
    lines = ''.join(re.findall(r'^```sh\n(.*?)^```$', text, re.M | re.S)).splitlines()
    lines = [line for line in lines if not re.match(r'(tools/\w+\.sh|sudo) ?', line)]
    subprocess.run(['bash', '-euxc', '\n'.join(lines)], check=True, cwd=folder, stdin=subprocess.DEVNULL,
                   env=os.environ | {'HOME': str(folder)})


def main():
    guide, folder, prefix, cmake, generator, compiler = sys.argv[1:7]
    guide, folder = pathlib.Path(guide), pathlib.Path(folder)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    outputs, places = {}, {}
    for language, name, content, line in blocks_of(guide.read_text(encoding='utf-8')):
        if language in STATUS:
            outputs[name] = STATUS[language], content
            continue
        # Messages of the compiler name the guide's own lines.
        mark = f'#line {line + 1} "{guide}"\n' if language in ('c', 'cpp') else ''
        places[name] = places.get(name, '') + mark + content
    if not outputs or 'CMakeLists.txt' not in places:
        sys.exit(f'{guide} has no project, or no program that prints anything')
    for name, content in places.items():
        (folder / name).write_text(content, encoding='utf-8')
    if '--shell' in sys.argv:
        run_shell_lines(guide.read_text(encoding='utf-8'), folder, sys.argv[sys.argv.index('--shell') + 1])
    else:
        subprocess.run([cmake, '-S', folder, '-B', folder / 'build', '-G', generator, f'-DCMAKE_PREFIX_PATH={prefix}',
                        '-DCMAKE_BUILD_TYPE=Release', f'-DCMAKE_CXX_COMPILER={compiler}',
                        '-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror', '-DCMAKE_C_FLAGS=-Wall -Wextra -Werror'], check=True)
        subprocess.run([cmake, '--build', folder / 'build'], check=True)
    for name in places:
        if not name.endswith('.rs'):
            continue
        program = name.removesuffix('.rs')
        if not shutil.which('rustc'):
            print(f'{guide}: {name} is not tried, there is no rustc')
            outputs.pop(program)
            continue
        library = next(pathlib.Path(prefix).resolve().glob('lib*/**/libtessera_c.so')).parent
        subprocess.run(['rustc', '-O', folder / name, '-o', folder / 'build' / program, '-L', f'native={library}', '-l',
                        'tessera_c', '-C', f'link-arg=-Wl,-rpath,{library}'], check=True)
    wrong = 0
    reader = pathlib.Path(prefix).resolve() / 'libexec/tessera/tessera-cad-reader'
    for command, (status, expected) in outputs.items():
        program, *arguments = command.split()
        arguments = [SOURCES / word if word.startswith('tools/') else word for word in arguments]
        ran = subprocess.run([folder / 'build' / program, *arguments], stdout=subprocess.PIPE, text=True, cwd=folder,
                             env=os.environ | {'TESSERA_CAD_READER': str(reader)})
        if '--print' in sys.argv:
            print(ran.stdout, end='')
        elif (ran.returncode, ran.stdout) != (status, expected):
            wrong += 1
            print(f'{guide}: {command} ends with {ran.returncode} and prints\n{ran.stdout}and not, as the guide says, with '
                  f'{status} and\n{expected}')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
