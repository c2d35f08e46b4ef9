#!/usr/bin/env python3
"""Checks that Universal Ctags, by which editors find names, sees those of ten files: tags.py CTAGS ENGINE.

Each type that begins at the first column of a file must have a tag, within the namespace tessera. No class of the engine
may have more than 25 member functions, overloads counted once, but for those that say why.
"""

import pathlib
import re
import subprocess
import sys

FILES = ['include/tessera/status.h', 'include/tessera/patch_set.h', 'include/tessera/tessellation.h',
         'include/tessera/ray_scene.h', 'include/tessera/evaluate.h', 'include/tessera/bezier_patch.h', 'src/tess/plan/certified_plan.h',
         'src/tess/closing/edge_runs.h', 'src/model/box_tree.h', 'src/trim/curve_extractions.h']
TYPE = re.compile(r'^(?:class|struct|enum class)(?: \[\[\w+\]\])? (\w+)\b[^;{]*\{', re.M)

MAX_MEMBERS = 25
LARGER = {  # classes with more: how many, and why
    'ObjFreeformReader': (35, 'a function for each statement of the format'),
    'ExactScene': (33, 'implements the interface of scenes'),
    'Lanes': (29, 'the operations of a vector'),
    'RayScene::Impl': (29, 'the interface that scenes implement'),
    'RibReader': (27, 'a function for each request of the format'),
    'TextCursor': (27, 'a function for each kind of token'),
    'ProvenMesh': (29, 'makes, writes and updates a mesh: to be divided'),
    'Welder': (27, 'one pass over borders: to be divided'),
    'ChordMarks': (26, 'one pass over chords: to be divided'),
    'MeshTables': (26, 'an accessor for each table'),
}


def tags_of(ctags, file):
    """The names within tessera."""
    command = [ctags, '-f', '-', '--languages=C++', '--kinds-C++=+p', '--fields=+s', file]
    lines = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    return {line.split('\t')[0] for line in lines if re.search(r'\t(?:namespace|class|struct):tessera', line)}


def large_classes(ctags, engine):
    """A fault for each class with too many member functions."""
    command = [ctags, '-f', '-', '--languages=C++', '--kinds-C++=pf', '--fields=+s', '-R', engine / 'src', engine / 'include']
    members = {}
    for line in subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines():
        if scope := re.search(r'\t(?:class|struct):(\S+)', line):
            members.setdefault(scope[1], set()).add(line.split('\t')[0])
    print(f'{len(members)} classes with member functions')
    faults = [] if len(members) > 300 else ['the test finds few classes']
    largest = {}
    for scope, names in members.items():
        name = re.sub(r'^tessera::(?:abi_\w+::)?|__anon\w+::|kernel::isa_\w+?::', '', scope)
        limit = LARGER[name][0] if name in LARGER else MAX_MEMBERS
        largest[name] = max(largest.get(name, 0), len(names))
        if len(names) > limit:
            faults.append(f'{name} has {len(names)} member functions, the limit is {limit}')
    faults += [f'{name} has {largest.get(name, 0)} member functions, the list says {count}'
               for name, (count, _) in LARGER.items() if largest.get(name, 0) < count]
    return faults


def main():
    ctags, engine = sys.argv[1], pathlib.Path(sys.argv[2])
    if not ctags or 'Universal' not in subprocess.run([ctags, '--version'], stdout=subprocess.PIPE, text=True, check=False).stdout:
        print('there is no Universal Ctags here')
        return 77
    faults = []
    for name in FILES:
        text, tags = (engine / name).read_text(encoding='utf-8'), tags_of(ctags, engine / name)
        wanted = set(TYPE.findall(text))
        print(f'{name}: {len(tags)} tags, {len(wanted)} types looked for')
        if not wanted:
            faults.append(f'{name}: the test finds no type in it')
        faults += [f'{name}: no tag for {missing}' for missing in sorted(wanted - tags)]
    faults += large_classes(ctags, engine)
    print('\n'.join(faults))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
