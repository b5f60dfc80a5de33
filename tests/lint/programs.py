# SPDX-License-Identifier: MIT
"""The programs that a script may start: words of its text where a program can stand. A word that is no program of this
machine does no harm, since it is looked up later; one too many is seen at once, one too few never."""
from __future__ import annotations

import ast
import re

# Where a command begins in a line of a shell script: behind separators, keywords and assignments.
COMMAND = re.compile(r"""(?:^|[|&;(`])\s*
                         (?:(?:if|then|elif|else|while|until|do|!|exec|env|time|command\s-v|nice
                               |[A-Za-z_]\w*=\S*|"?\$\{?\w[^\s]*)\s+)*
                         ([A-Za-z_][\w.+-]*)""", re.VERBOSE)
COMMENT = re.compile(r"(^|\s)#.*")


def started_by_python(text: str) -> set[str]:
    """Every text in it that is one word: programs stand in lists, tables and calls of many functions."""
    texts = (node.value for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Constant))
    return {text for text in texts if isinstance(text, str) and text.split() == [text]}


def started_by_shell(text: str) -> set[str]:
    return {word for line in text.splitlines() for word in COMMAND.findall(COMMENT.sub("", line))}
