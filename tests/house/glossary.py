#!/usr/bin/env python3
"""Checks the glossary: glossary.py ENGINE. Words are in order, each once, and the file that a row names uses the word."""

import pathlib
import re
import sys

ROW = re.compile(r'^\| ([a-z ]+) \| (.+) \| `([\w/.]+)` \|$', re.M)


def main():
    engine = pathlib.Path(sys.argv[1])
    rows = ROW.findall((engine / 'docs' / 'glossary.md').read_text(encoding='utf-8'))
    words = [word for word, _, _ in rows if word != 'word']
    faults = [] if len(words) >= 40 else [f'the glossary has {len(words)} words, 40 are wanted']
    faults += [f'"{b}" stands after "{a}"' for a, b in zip(words, words[1:]) if a >= b]
    for word, _, file in rows:
        path = engine / file
        text = path.read_text(encoding='utf-8').lower() if path.is_file() else ''
        is_used = re.search(rf'\b{word}s?\b', text) or (' ' in word and word.replace(' ', '') in text)
        if not is_used:
            faults.append(f'{word}: {file} ' + ('does not use the word' if text else 'does not exist'))
    print('\n'.join(faults) or f'{len(words)} words')
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
