#!/usr/bin/env python3
"""Shows a public header to Doxygen the way people read it: a comment on a line of several variables is that of each, and
functions whose name says everything need no words. In a guide, a link out of the guides' folder becomes its text. Lines
keep their numbers."""

import re
import sys

NAME = r'\w+(?:\s*=\s*[^,;{}()]+|\s*=\s*\{\}|\{\})?'
SEVERAL = re.compile(rf'^(\s*)((?:std::)?[\w:]+(?:<[^;=]*?>)?)\s+({NAME}(?:,\s*{NAME})+);\s*(?:///<\s*(.*))?$')
ENDS = r'\)(?: const)?(?: &&?|&&?)?(?: noexcept)?(?: \{.*\}| = default;|;)$'

# Functions of one line that are shown without a comment, and the words that the reference has for them.
TRIVIAL = [
    (re.compile(r'^\s*\w+(?:& operator=)?\(\w+&&\)(?: noexcept)?(?: = default)?;$'), 'moves'),
    (re.compile(r'^  (?:const )?T(?:\*|&&?) (?:value|operator\*|operator->)\(' + ENDS), 'the value'),
    (re.compile(r'^  (?:bool ok|explicit operator bool)\(' + ENDS), 'whether there is no error'),
    (re.compile(r'^  std::size_t (\w+)_count\(' + ENDS), r'number of records: \1'),
    (re.compile(r'^  int degree_(\w)\(' + ENDS), r'degree along \1'),
    (re.compile(r'^  friend bool operator==\(.*' + ENDS), 'compares all members'),
    (re.compile(r'^  void write\((?:std::string_view bytes|char c)\)(?: \{|;)$'), 'writes it'),
    (re.compile(r'^  \w+& operator([-+*/])=\(.*\)'), r'like \1'),
]


def words_for(line):
    for pattern, words in TRIVIAL:
        if found := pattern.match(line):
            return found.expand(words)
    return ''


def shown(lines):
    above = ''  # the comment that stands above
    for line in lines:
        several = SEVERAL.match(line)
        if several:
            indent, kind, names, beside = several.groups()
            text = f' /**< {beside or above} */' if beside or above else ''
            yield indent + ' '.join(f'{kind} {name.strip()};{text}' for name in names.split(','))
        elif not above and '///' not in line and (words := words_for(line)):
            yield f'{line}  ///< {words}'
        else:
            yield line
        comment = re.match(r'\s*/// ?(.*)', line)
        above = (above + ' ' + comment[1]).strip() if comment else ''


def without_outer_links(text):
    return re.sub(r'\[([^]]*)\]\(\.\./[^)]*\)', r'\1', text)


with open(sys.argv[1], encoding='utf-8') as file:
    content = file.read()
if sys.argv[1].endswith('.md'):
    print(without_outer_links(content), end='')
else:
    print('\n'.join(shown(content.split('\n'))), end='')
