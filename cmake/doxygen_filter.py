#!/usr/bin/env python3
"""Shows a public header to Doxygen the way people read it: a comment on a line of several variables is that of each, and
moving needs no words. Lines keep their numbers."""

import re
import sys

NAME = r'\w+(?:\s*=\s*[^,;{}()]+|\s*=\s*\{\}|\{\})?'
SEVERAL = re.compile(rf'^(\s*)((?:std::)?[\w:]+(?:<[^;=]*?>)?)\s+({NAME}(?:,\s*{NAME})+);\s*(?:///<\s*(.*))?$')
MOVE = re.compile(r'^\s*\w+(?:& operator=)?\(\w+&&\)(?: noexcept)?(?: = default)?;$')


def shown(lines):
    above = ''  # the comment that stands above
    for line in lines:
        several = SEVERAL.match(line)
        if several:
            indent, kind, names, beside = several.groups()
            text = f' /**< {beside or above} */' if beside or above else ''
            yield indent + ' '.join(f'{kind} {name.strip()};{text}' for name in names.split(','))
        elif MOVE.match(line):
            yield line + '  ///< moves'
        else:
            yield line
        comment = re.match(r'\s*/// ?(.*)', line)
        above = (above + ' ' + comment[1]).strip() if comment else ''


with open(sys.argv[1], encoding='utf-8') as header:
    print('\n'.join(shown(header.read().split('\n'))), end='')
