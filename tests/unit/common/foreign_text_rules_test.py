#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Foreign text has one way in and one way out: JSON is parsed by parse_json() alone, the log is written by common/log
alone (by client_lib/process/log.h in other people's processes), in quotes that in_quotes() makes, and no size is
guarded by an assertion. Looks at the sources."""
import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
FOLDERS = ("client_lib", "common", "walld", "tileserver", "tools")


def sources() -> dict[str, str]:
    files = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*")) if path.suffix in (".cpp", ".h")]
    return {str(path.relative_to(ROOT)): path.read_text() for path in files}


def uses(pattern: str, but: tuple[str, ...] = ()) -> list[str]:
    """FILE:LINE of each place that matches, outside of the files in `but`."""
    found = []
    for name, text in sources().items():
        if name not in but:
            found += [f"{name}:{text.count(chr(10), 0, match.start()) + 1}" for match in re.finditer(pattern, text)]
    return found


# Each was looked at: our functions' names and words, OpenGL's errors, what the standard library throws, and the text
# that complain_once() has made harmless.
OWN = r'(?:function|name|node->up \? "up" : "down"|message\.text\.c_str\(\)|e\.what\(\)|harmless\.c_str\(\))'


def library_logs() -> list[tuple[str, str]]:
    """FILE:LINE of each line that client_lib logs, and what it gives log() behind the level."""
    found = []
    for name, text in sources().items():
        if name.startswith("client_lib/"):
            found += [(f"{name}:{text.count(chr(10), 0, match.start()) + 1}", match.group(1))
                      for match in re.finditer(r"\blog\(LogLevel::\w+,\s*([^;]*)\);", text)]
    return found


def harmless(call: str) -> bool:
    """Whether each text of a line is one of ours or in_quotes()."""
    return call.count("%s") == len(re.findall(r",\s*(?:(?:wall::)?in_quotes\(|" + OWN + r"(?=,|$))", call))


class Rules(unittest.TestCase):
    def test_the_sources_are_there(self) -> None:
        self.assertGreater(len(sources()), 200)
        self.assertTrue(uses(r"json::parse\s*\("))
        self.assertTrue(uses(r"spdlog::"))

    def test_json_is_parsed_within_limits(self) -> None:
        parsers = r"json::(parse|accept|sax_parse|from_\w+)\s*\("
        self.assertEqual(uses(parsers, ("common/json/parse_json.cpp",)), [])

    def test_the_log_takes_only_harmless_text(self) -> None:
        self.assertEqual(uses(r"spdlog::", ("common/log/log.cpp",)), [])
        by_hand = uses(r'\\"\{\}\\"|=\\""')
        self.assertEqual(by_hand, [], "quotes by hand do not escape: use log::quoted(), in client_lib in_quotes()")

    def test_the_client_library_logs_only_harmless_text(self) -> None:
        self.assertGreater(len(library_logs()), 20)
        careless = [f"{place}: {call}" for place, call in library_logs() if not harmless(call)]
        self.assertEqual(careless, [], "texts of others are given as in_quotes()")

    def test_a_careless_line_is_found(self) -> None:
        self.assertTrue(harmless('"lost node=%u why=%s", node, in_quotes(why).c_str()'))
        self.assertFalse(harmless('"lost node=%u why=%s", node, why.c_str()'))
        self.assertFalse(harmless('"lost address=%s why=%s", in_quotes(address).c_str(), why.c_str()'))
        self.assertFalse(harmless('"%s", ("lost why=" + why).c_str()'))

    def test_plain_text_in_the_log_is_ours(self) -> None:
        # Each use was looked at: names of enumerations and tasks, and the audit line, which quotes what is in it.
        allowed = r"log::plain\((config::name_of\(node\.backend\)|name|audit_line\()"
        self.assertEqual(set(uses(r"log::plain\(")) - set(uses(allowed)), set())

    def test_no_assertion_guards_a_size(self) -> None:
        # A size that foreign bytes or the wall's description decide is refused. The one there is: a Huffman table of
        # our own.
        sizes = r"WALL_ASSERT\([^;]*(\bsize\(|[bB]ytes\b|kMax|limit)"
        self.assertEqual(uses(sizes, ("common/base/assert.h", "common/codec/huffman.cpp")), [])


if __name__ == "__main__":
    unittest.main(verbosity=2)
