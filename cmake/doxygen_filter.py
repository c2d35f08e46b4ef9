#!/usr/bin/env python3
"""Shows a public header to Doxygen the way people read it: its first comment is that of the file, the inline namespace
has no name, a comment on a line of several variables is that of each, an overload without a comment is as the one above
it, and functions whose name says everything need no words. In a guide, a link out of the guides' folder becomes its
text. Lines keep their numbers."""

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
    (re.compile(r'^inline Vec3 operator[-+*]\(.*'), 'by components'),
    (re.compile(r'^inline \w+ (dot|cross)\(.*'), r'\1 product'),
]
FUNCTION = re.compile(r'^(?:inline )?[\w:]+(?:<.*>)? (\w+)\(')


def words_for(line):
    for pattern, words in TRIVIAL:
        if found := pattern.match(line):
            return found.expand(words)
    return ''


def shown(lines):
    above = ''  # the comment that stands above
    documented = ''  # the function whose comment was the last
    for line, after in zip(lines, lines[1:] + ['']):
        several = SEVERAL.match(line)
        function = FUNCTION.match(after if line.startswith('template <') else line)
        if function and above:
            documented = function[1]
        if several:
            indent, kind, names, beside = several.groups()
            text = f' /**< {beside or above} */' if beside or above else ''
            yield indent + ' '.join(f'{kind} {name.strip()};{text}' for name in names.split(','))
        elif not above and '///' not in line and (words := words_for(line)):
            yield f'{line}  ///< {words}' if line.endswith(';') else f'/** {words} */ {line}'
        elif function and not above and function[1] == documented:
            yield f'/** As above. */ {line}'
        else:
            yield line
        comment = re.match(r'\s*/// ?(.*)', line)
        above = (above + ' ' + comment[1]).strip() if comment else ''


def with_file_comment(lines):
    """Turns the comment below #pragma once into one that Doxygen shows."""
    if lines[:1] != ['#pragma once'] or len(lines) < 2 or not lines[1].startswith('// '):
        return lines
    end = next(k for k in range(1, len(lines)) if not lines[k].startswith('//'))
    return ['/// @file'] + ['/' + line for line in lines[1:end]] + lines[end:]


def without_outer_links(text):
    return re.sub(r'\[([^]]*)\]\(\.\./[^)]*\)', r'\1', text)


with open(sys.argv[1], encoding='utf-8') as file:
    content = file.read()
if sys.argv[1].endswith('.md'):
    print(without_outer_links(content), end='')
else:
    content = re.sub(r' inline namespace \w+ \{', '', content)
    content = re.sub(r'\}\}(  // namespace tessera)::\w+\n', r'}\1\n', content)
    print('\n'.join(shown(with_file_comment(content.split('\n')))), end='')
