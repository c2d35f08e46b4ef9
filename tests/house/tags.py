#!/usr/bin/env python3
"""Checks that Universal Ctags, by which editors find names, sees those of ten files: tags.py CTAGS ENGINE.

Each type that begins at the first column of a file must have a tag, within the namespace tessera.
"""

import pathlib
import re
import subprocess
import sys

FILES = ['include/tessera/status.h', 'include/tessera/patch_set.h', 'include/tessera/tessellation.h',
         'include/tessera/ray_scene.h', 'include/tessera/evaluate.h', 'include/tessera/bezier_patch.h', 'src/tess/plan/certified_plan.h',
         'src/tess/closing/edge_runs.h', 'src/model/box_tree.h', 'src/trim/curve_extractions.h']
TYPE = re.compile(r'^(?:class|struct|enum class)(?: \[\[\w+\]\])? (\w+)\b[^;{]*\{', re.M)


def tags_of(ctags, file):
    """The names within tessera."""
    command = [ctags, '-f', '-', '--languages=C++', '--kinds-C++=+p', '--fields=+s', file]
    lines = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    return {line.split('\t')[0] for line in lines if re.search(r'\t(?:namespace|class|struct):tessera', line)}


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
    print('\n'.join(faults))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
